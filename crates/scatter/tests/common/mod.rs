//! The models that the laws are tried on, and the places that they are tried at.
#![allow(dead_code, reason = "every test program uses its own part")]

use indigo_decl::{Node, ResolveError, Resolved, Resolver, bind};
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{Limits, read_document};
use indigo_math::{Real, Vec2, Vec3};
use indigo_scatter::materials::{KINDS, MATERIAL};
use indigo_scatter::media::{Cauchy, Medium};
use indigo_scatter::{
    Interface, Leaf, Material, MaterialContext, MaterialId, MaterialResources, MediumId, Scatter,
    ShadingPoint,
};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};
use indigo_texture::TextureId;
use std::fmt;

/// Parameter sets beyond the example of each kind's declaration. A new material adds its own here,
/// above all its extremes: the roughest, the smoothest, black and white.
const EXAMPLES: &[&str] = &[
    "<diffuse><albedo_spectrum><uniform><value>0.37</value></uniform></albedo_spectrum></diffuse>",
    "<diffuse><albedo_spectrum><uniform><value>1</value></uniform></albedo_spectrum></diffuse>",
    "<diffuse><albedo_spectrum><uniform><value>0</value></uniform></albedo_spectrum></diffuse>",
    "<diffuse_transmitter><albedo_spectrum><rgb><rgb>0.9 0.5 0.1</rgb></rgb></albedo_spectrum></diffuse_transmitter>",
    "<diffuse_transmitter><albedo_spectrum><uniform><value>1</value></uniform></albedo_spectrum></diffuse_transmitter>",
    "<oren_nayar><sigma>0</sigma><albedo_spectrum><uniform><value>1</value></uniform></albedo_spectrum></oren_nayar>",
    "<oren_nayar><sigma>0.12</sigma><albedo_spectrum><uniform><value>1</value></uniform></albedo_spectrum></oren_nayar>",
    "<oren_nayar><sigma>1</sigma><albedo_spectrum><uniform><value>1</value></uniform></albedo_spectrum></oren_nayar>",
    "<oren_nayar><sigma>0.6</sigma><albedo_spectrum><rgb><rgb>0.9 0.5 0.1</rgb></rgb></albedo_spectrum></oren_nayar>",
    "<oren_nayar><sigma>1</sigma><albedo_spectrum><uniform><value>0.1</value></uniform></albedo_spectrum></oren_nayar>",
    "<phong><ior>1.5</ior><exponent>1</exponent><diffuse_albedo_spectrum><uniform><value>1</value></uniform></diffuse_albedo_spectrum></phong>",
    "<phong><ior>2.5</ior><exponent>100</exponent><diffuse_albedo_spectrum><rgb><rgb>0.9 0.5 0.1</rgb></rgb></diffuse_albedo_spectrum></phong>",
    "<phong><ior>1.3</ior><exponent>30</exponent></phong>",
    "<phong><ior>1.7</ior><roughness><constant>0.4</constant></roughness><fresnel_scale>0.6</fresnel_scale><diffuse_albedo_spectrum><uniform><value>0.9</value></uniform></diffuse_albedo_spectrum></phong>",
    "<phong><specular_reflectivity_spectrum><uniform><value>0.9</value></uniform></specular_reflectivity_spectrum><roughness>0.5</roughness><fresnel_scale>0.5</fresnel_scale></phong>",
    "<phong><ior>1.5</ior><exponent>20000</exponent><diffuse_albedo_spectrum><uniform><value>1</value></uniform></diffuse_albedo_spectrum></phong>",
    "<phong><nk_data>gold.nk</nk_data><exponent>0.1</exponent></phong>",
    "<phong><nk_data>gold.nk</nk_data><exponent>60</exponent></phong>",
    "<phong><specular_reflectivity_spectrum><uniform><value>1</value></uniform></specular_reflectivity_spectrum><exponent>3</exponent></phong>",
    "<phong><specular_reflectivity_spectrum><uniform><value>1</value></uniform></specular_reflectivity_spectrum><exponent>45</exponent></phong>",
    "<glossy_transparent><internal_medium_name>glass</internal_medium_name><exponent>1</exponent></glossy_transparent>",
    "<glossy_transparent><internal_medium_name>glass</internal_medium_name><exponent>60</exponent></glossy_transparent>",
    "<glossy_transparent><internal_medium_name>glass</internal_medium_name><exponent>20000</exponent></glossy_transparent>",
    "<specular><internal_medium_name>glass</internal_medium_name><transparent>false</transparent></specular>",
];

/// Coats over white, and films on gold.
const COATS: &[&str] = &[
    "<coating><substrate_material_name>below</substrate_material_name><ior>1.6</ior><roughness>0.5</roughness></coating>",
    "<coating><substrate_material_name>below</substrate_material_name><roughness>0.4</roughness><thickness>0.001</thickness><absorption><constant><rgb><rgb>900 300 40</rgb></rgb></constant></absorption></coating>",
    "<coating><substrate_material_name>below</substrate_material_name><ior>2.2</ior><interference>true</interference><thickness>1.7e-7</thickness></coating>",
    "<coating><substrate_material_name>below</substrate_material_name><ior>1.4</ior><fresnel_scale>0.7</fresnel_scale><interference>true</interference><thickness>2e-6</thickness></coating>",
];

/// Coats inside of media that are denser than they are, one of them dispersive (SF10), or whose index for some wavelengths
/// only is above theirs.
const IMMERSED: &[(&str, Cauchy)] = &[
    (
        "<phong><ior>1.5</ior><exponent>30</exponent><diffuse_albedo_spectrum><uniform><value>1</value></uniform></diffuse_albedo_spectrum></phong>",
        Cauchy { a: 1.7, b: 0.0 },
    ),
    (
        "<phong><ior>1.5</ior><exponent>1000</exponent><diffuse_albedo_spectrum><uniform><value>1</value></uniform></diffuse_albedo_spectrum></phong>",
        Cauchy { a: 1.728, b: 0.01342 },
    ),
    (
        "<phong><ior>1.5</ior><exponent>3</exponent><diffuse_albedo_spectrum><uniform><value>1</value></uniform></diffuse_albedo_spectrum></phong>",
        Cauchy { a: 1.45, b: 0.02 },
    ),
    (
        "<coating><substrate_material_name>below</substrate_material_name><roughness>0.6</roughness><thickness>0.001</thickness><absorption><constant><uniform><value>200</value></uniform></constant></absorption></coating>",
        Cauchy { a: 1.45, b: 0.02 },
    ),
    (
        "<coating><substrate_material_name>below</substrate_material_name><interference>true</interference><thickness>3e-7</thickness></coating>",
        Cauchy { a: 1.728, b: 0.01342 },
    ),
];

/// What lies outside above, and below a glass that is more dispersive than any real one: Cauchy's A = 1.45, B = 0.02 µm².
fn interface(outside: Cauchy, lambda: &SampledWavelengths) -> Interface {
    let glass = SampledSpectrum(lambda.lambda.map(|nm| 1.45 + 0.02 / (nm * nm * 1e-6)));
    Interface { above: outside.eval(lambda), below: glass }
}

/// Places: the angle between the view and the geometric normal, and that between the shading normal and the
/// geometric one, in degrees. A positive one leans away from the view, so that at the flattest angle the view
/// is below the shading normal's horizon.
const PLACES: [(f64, f64); 6] =
    [(0.0, 0.0), (60.0, 0.0), (85.0, 0.0), (0.0, 25.0), (30.0, -40.0), (85.0, 25.0)];

/// A model with its text.
pub struct Example {
    /// Name of its kind.
    pub kind: &'static str,
    /// Its element.
    pub text: &'static str,
    /// Whether it is seen from inside the medium, where it has one.
    is_inside: bool,
    /// What lies outside.
    outside: Cauchy,
    material: Material,
}

impl Example {
    /// The model at some wavelengths.
    pub fn leaf(&self, lambda: &SampledWavelengths) -> Leaf {
        self.leaf_seen(lambda, self.is_inside)
    }

    /// The model seen from the other side.
    pub fn leaf_behind(&self, lambda: &SampledWavelengths) -> Leaf {
        self.leaf_seen(lambda, !self.is_inside)
    }

    fn leaf_seen(&self, lambda: &SampledWavelengths, is_inside: bool) -> Leaf {
        let Interface { above, below } = interface(self.outside, lambda);
        let interface =
            if is_inside { Interface { above: below, below: above } } else { Interface { above, below } };
        let context =
            MaterialContext { textures: &[], materials: &[], lambda, interface, choice: 0.5, is_front: true };
        self.material.leaf(&context, |_| Vec2::new(0.3, 0.6)).expect("a material that does something")
    }
}

/// A model at a place.
pub struct Case {
    /// Name of its kind.
    pub kind: &'static str,
    /// Its element.
    pub text: &'static str,
    leaf: Leaf,
    /// The model from the other side.
    leaf_behind: Leaf,
    is_inside: bool,
    /// Geometric normal.
    pub n_g: Vec3,
    /// Shading normal.
    pub n_s: Vec3,
    /// Towards the viewer.
    pub wo: Vec3,
    /// How far the shading normal leans.
    pub tilt: f64,
    angle: f64,
    /// How much more than a flat function the model makes of a rounding of its directions.
    pub sharpness: Real,
    /// Whether it is known to scatter nothing.
    pub is_black: bool,
}

impl Case {
    /// The model set up at its place.
    pub fn point(&self) -> ShadingPoint {
        self.from(self.wo)
    }

    /// The same seen from elsewhere.
    pub fn from(&self, wo: Vec3) -> ShadingPoint {
        let leaf = if wo.dot(self.n_g) < 0.0 { self.leaf_behind } else { self.leaf };
        ShadingPoint::new(leaf, self.n_g, self.n_s, wo)
    }

    /// What makes power of the hero's radiance that comes along `wi`: the square of its index there over that
    /// where it goes (radiance over squared index is what refraction keeps).
    pub fn power(&self, wi: Vec3) -> f64 {
        let eta = self.leaf.eta().hero() as f64;
        if wi.dot(self.n_g) < 0.0 { eta * eta } else { 1.0 }
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let inside = if self.is_inside { ", inside" } else { "" };
        write!(f, "{} at {}°{inside}, normal leaning {}°", self.text, self.angle, self.tilt)
    }
}

/// Wavelengths by the random number that draws them.
pub fn wavelengths(u: Real) -> SampledWavelengths {
    SampledWavelengths::sample(u)
}

/// Every model of which directions can be asked, at every place.
pub fn cases() -> Vec<Case> {
    cases_of(examples())
}

/// Every model of delta kind, at every place.
pub fn delta_cases() -> Vec<Case> {
    cases_of(delta_examples())
}

fn cases_of(examples: Vec<Example>) -> Vec<Case> {
    let direction = |degrees: f64| {
        let (s, c) = degrees.to_radians().sin_cos();
        Vec3::new(s as Real, 0.0, c as Real)
    };
    let lambda = wavelengths(0.4);
    let mut cases = vec![];
    for example in examples {
        for (angle, tilt) in PLACES {
            cases.push(Case {
                kind: example.kind,
                text: example.text,
                leaf: example.leaf(&lambda),
                leaf_behind: example.leaf_behind(&lambda),
                is_inside: example.is_inside,
                n_g: Vec3::new(0.0, 0.0, 1.0),
                n_s: direction(-tilt),
                wo: direction(angle),
                tilt,
                angle,
                sharpness: sharpness(example.text),
                is_black: example.text.contains("<value>0</value>"),
            });
        }
    }
    cases
}

/// A lobe of normals of exponent n is √(2/n) wide, and so much steeper than flat; refraction finds the normal
/// from a sum of directions that nearly cancel, a third of them in glass.
fn sharpness(text: &str) -> Real {
    let exponent = text.split("<exponent>").nth(1).and_then(|rest| rest.split('<').next());
    let n: Real = exponent.map_or(0.0, |n| n.parse().expect("a number"));
    let refraction = if text.contains("<glossy_transparent>") { 3.0 } else { 1.0 };
    // Near the angle of total reflection the way through a coat goes like one over a cosine, and the cosine like a root.
    let way = if text.contains("<absorption>") { 4.0 } else { 1.0 };
    way * refraction * (1.0 + (0.5 * n).sqrt())
}

/// The models of which directions can be asked: those that are not of delta kind alone.
pub fn examples() -> Vec<Example> {
    let lambda = wavelengths(0.4);
    all_examples().into_iter().filter(|e| e.leaf(&lambda).is_connectable()).collect()
}

/// The others, which send light into single directions.
pub fn delta_examples() -> Vec<Example> {
    let lambda = wavelengths(0.4);
    all_examples().into_iter().filter(|e| !e.leaf(&lambda).is_connectable()).collect()
}

/// All models that are rendered: of each kind the declaration's example, and then [`EXAMPLES`], [`COATS`] and [`IMMERSED`].
pub fn all_examples() -> Vec<Example> {
    let declared = KINDS.iter().map(|block| block.example);
    let in_air = declared.chain(EXAMPLES.iter().copied()).chain(COATS.iter().copied()).flat_map(example);
    let immersed = IMMERSED.iter().flat_map(|&(text, outside)| {
        example(text).into_iter().map(move |mut example| {
            example.material.immerse(&[Medium::AIR, Medium::clear(outside)]);
            Example { outside, ..example }
        })
    });
    in_air.chain(immersed).collect()
}

/// The model of an element, from both sides where they differ; nothing where it has no leaf.
pub fn example(text: &'static str) -> Vec<Example> {
    if text.is_empty() {
        return vec![];
    }
    let mut sink = Sink::new();
    let file = format!("<material><name>m</name>{text}</material>");
    let root = read_document("m", &Text(file), &mut SourceMap::default(), &mut sink, &Limits::default());
    let node = bind(root.expect("readable text"), &MATERIAL, &mut sink);
    assert!(!sink.has_errors(), "{text}: {:?}", sink.diagnostics());
    let kind = node.alternative().expect("a kind of material");
    let below = match kind.block.name {
        "coating" if kind.bool("interference") => {
            "<phong><nk_data>gold.nk</nk_data><exponent>3</exponent></phong>"
        }
        "coating" => {
            "<diffuse><albedo_spectrum><uniform><value>1</value></uniform></albedo_spectrum></diffuse>"
        }
        _ => "",
    };
    let other = example(below).pop().map_or_else(Material::black, |below| below.material);
    let material = Material::build(kind, &mut Plain { sink, other });
    let kind = kind.block.name;
    let sides: &[bool] = match material {
        Material::Null | Material::Blend(_) => &[],
        _ if material.internal_medium().is_some() => &[false, true],
        _ => &[false],
    };
    let outside = Cauchy::constant(1.0);
    let side = |&is_inside: &bool| Example { kind, text, is_inside, outside, material: material.clone() };
    sides.iter().map(side).collect()
}

struct Text(String);

impl Resolver for Text {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        Ok(Resolved { path: path.to_owned(), bytes: self.0.as_bytes().into() })
    }
}

/// Materials without files, but for gold's index.
struct Plain {
    sink: Sink,
    other: Material,
}

impl MaterialResources for Plain {
    fn texture(&mut self, node: &Node) -> TextureId {
        panic!("the examples have no textures, but {} asks for one", node.block.name)
    }

    fn complex_index(&mut self, _node: &Node, _field: &str) -> [Spectrum; 2] {
        // Johnson and Christy 1972, every 50 nm from 400 on.
        let table = |values: &[f64]| Spectrum::regular_tabulated(400e-9, 700e-9, values).expect("a table");
        [
            table(&[1.469, 1.416, 0.863, 0.331, 0.200, 0.162, 0.161]),
            table(&[1.953, 1.904, 1.862, 2.324, 3.014, 3.562, 4.034]),
        ]
    }

    fn material(&mut self, _node: &Node, _field: &str) -> MaterialId {
        0
    }

    fn built(&self, _id: MaterialId) -> &Material {
        &self.other
    }

    fn medium(&mut self, _node: &Node, _field: &str) -> MediumId {
        MediumId::new(1).expect("a small number")
    }

    fn sink(&mut self) -> &mut Sink {
        &mut self.sink
    }
}
