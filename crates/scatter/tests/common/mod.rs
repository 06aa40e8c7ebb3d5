//! The models that the laws are tried on, and the places that they are tried at.

use indigo_decl::{Node, ResolveError, Resolved, Resolver, bind};
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{Limits, read_document};
use indigo_math::{Real, Vec2, Vec3};
use indigo_scatter::materials::{KINDS, MATERIAL};
use indigo_scatter::{
    Interface, Leaf, Material, MaterialContext, MaterialResources, MediumId, Scatter, ShadingPoint,
};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};
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
];

/// Air above, glass below.
const INTERFACE: Interface = Interface { above: SampledSpectrum::ONE, below: SampledSpectrum::splat(1.5) };

/// Angles between the view and the geometric normal, in degrees.
const ANGLES: [f64; 4] = [0.0, 30.0, 60.0, 85.0];
/// Angles between the shading normal and the geometric one, in degrees; a positive one leans away
/// from the view, so that at the flattest angle the view is below the shading normal's horizon.
const TILTS: [f64; 3] = [0.0, 25.0, -40.0];

/// A model with its text.
pub struct Example {
    /// Name of its kind.
    pub kind: &'static str,
    /// Its element.
    pub text: &'static str,
    material: Material,
}

impl Example {
    /// The model at some wavelengths.
    pub fn leaf(&self, lambda: &SampledWavelengths) -> Leaf {
        let context =
            MaterialContext { textures: &[], materials: &[], lambda, interface: INTERFACE, choice: 0.5 };
        self.material.leaf(&context, |_| Vec2::new(0.3, 0.6)).expect("a material that does something")
    }
}

/// A model at a place.
pub struct Case {
    /// Name of its kind.
    pub kind: &'static str,
    /// Its element.
    pub text: &'static str,
    /// The model.
    pub leaf: Leaf,
    /// Geometric normal.
    pub n_g: Vec3,
    /// Shading normal.
    pub n_s: Vec3,
    /// Towards the viewer.
    pub wo: Vec3,
    /// How far the shading normal leans.
    pub tilt: f64,
    angle: f64,
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
        ShadingPoint::new(self.leaf, self.n_g, self.n_s, wo)
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {}°, normal leaning {}°", self.text, self.angle, self.tilt)
    }
}

/// Wavelengths by the random number that draws them.
pub fn wavelengths(u: Real) -> SampledWavelengths {
    SampledWavelengths::sample(u)
}

/// Every model at every place.
pub fn cases() -> Vec<Case> {
    let direction = |degrees: f64| {
        let (s, c) = degrees.to_radians().sin_cos();
        Vec3::new(s as Real, 0.0, c as Real)
    };
    let lambda = wavelengths(0.4);
    let mut cases = vec![];
    for example in examples() {
        for (angle, tilt) in ANGLES.into_iter().flat_map(|a| TILTS.map(|t| (a, t))) {
            cases.push(Case {
                kind: example.kind,
                text: example.text,
                leaf: example.leaf(&lambda),
                n_g: Vec3::new(0.0, 0.0, 1.0),
                n_s: direction(-tilt),
                wo: direction(angle),
                tilt,
                angle,
                is_black: example.text.contains("<value>0</value>"),
            });
        }
    }
    cases
}

/// The models of which directions can be asked: those that are not of delta kind alone.
pub fn examples() -> Vec<Example> {
    let lambda = wavelengths(0.4);
    all_examples().into_iter().filter(|e| e.leaf(&lambda).is_connectable()).collect()
}

/// All models that are rendered: of each kind the declaration's example, and then [`EXAMPLES`].
pub fn all_examples() -> Vec<Example> {
    let declared = KINDS.iter().map(|block| block.example);
    declared.chain(EXAMPLES.iter().copied()).filter_map(example).collect()
}

/// The model of an element; `None` where its kind is read but not rendered, or does nothing to light.
fn example(text: &'static str) -> Option<Example> {
    let mut sink = Sink::new();
    let file = format!("<material><name>m</name>{text}</material>");
    let root = read_document("m", &Text(file), &mut SourceMap::default(), &mut sink, &Limits::default());
    let node = bind(root.expect("readable text"), &MATERIAL, &mut sink);
    assert!(!sink.has_errors(), "{text}: {:?}", sink.diagnostics());
    let kind = node.alternative().expect("a kind of material");
    let material = Material::build(kind, &mut Plain(sink))?;
    let name = kind.block.name;
    (!material.is_invisible()).then_some(Example { kind: name, text, material })
}

struct Text(String);

impl Resolver for Text {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        Ok(Resolved { path: path.to_owned(), bytes: self.0.as_bytes().into() })
    }
}

/// Materials without files.
struct Plain(Sink);

impl MaterialResources for Plain {
    fn texture(&mut self, node: &Node) -> TextureId {
        panic!("the examples have no textures, but {} asks for one", node.block.name)
    }

    fn medium(&mut self, _node: &Node, _field: &str) -> MediumId {
        MediumId::new(1).expect("a small number")
    }

    fn sink(&mut self) -> &mut Sink {
        &mut self.0
    }
}
