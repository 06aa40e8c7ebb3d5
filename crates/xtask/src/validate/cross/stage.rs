//! A scene in terms of no renderer, written for both: as text of Indigo's format, and as the dictionary that Mitsuba
//! loads. Radiances are relative to that of even light, 1.

use std::f64::consts::{PI, TAU};

use serde_json::{Value, json};

use super::super::change::with_lens;
use super::super::hung;
use super::super::oracles::{AROUND, NITS_PER_UNIFORM, constant_nk};
use super::super::shapes::{Mesh, Point, dot, mesh_light, model, sub};
use super::super::text::{
    ONE_PIXEL, background, basic, diffuse, flat_camera, grey, henyey_greenstein, medium, scattering,
    scene_file, settings, specular, sphere, uniform,
};

/// Side of the pictures.
pub const SIDE: u32 = 24;
/// Luminance of radiance 1 in Indigo, cd/m².
pub const UNIT: f64 = AROUND * NITS_PER_UNIFORM;
/// Wavelengths of tables, nm: the range of both renderers.
const RANGE_NM: [f64; 2] = [360.0, 830.0];

/// The name of a map beside a scene.
const MAP_FILE: &str = "map.exr";

/// A number at each wavelength.
#[derive(Clone, Debug)]
pub enum Tone {
    /// The same at all.
    Even(f64),
    /// Linear between equal steps from 360 to 830 nm.
    Table(Vec<f64>),
}

/// What something is made of.
#[derive(Clone, Debug)]
pub enum Surface {
    /// Lambert's.
    Matt(Tone),
    /// Smooth and clear, or absorbing with a coefficient in 1/m.
    Glass(f64, f64),
    /// Rough and clear: index and exponent.
    Frosted(f64, f64),
    /// A complex index, and the exponent of a rough one.
    Metal(Index, f64),
    /// Index of the body; absorption and scattering in 1/m; mean cosine.
    Fog(f64, f64, f64, f64),
    /// Shines with a radiance from its front, and reflects nothing.
    Lamp(Tone),
    /// The same with a picture, of a square.
    Screen(Map),
}

/// A complex index of refraction.
#[derive(Clone, Debug)]
pub enum Index {
    /// The same at all wavelengths.
    Constant(f64, f64),
    /// The text of a file that comes with Indigo: steps of micrometres.
    Shipped(&'static str),
}

impl Index {
    /// As a file of Indigo's.
    fn file(&self) -> Vec<u8> {
        match self {
            Self::Constant(n, k) => constant_nk(*n, *k),
            Self::Shipped(text) => text.as_bytes().to_vec(),
        }
    }

    /// n and k as Mitsuba has them.
    fn dictionaries(&self) -> [Value; 2] {
        let text = match self {
            Self::Constant(n, k) => return [*n, *k].map(|v| Tone::Even(v).dictionary()),
            Self::Shipped(text) => text,
        };
        let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let (head, values) = numbers.split_at(4);
        assert!(head[0] == 2.0, "micrometres");
        let range = [head[1] * 1e3, head[2] * 1e3];
        [0, 1].map(|i| regular(range, &values.chunks_exact(2).map(|pair| pair[i]).collect::<Vec<_>>()))
    }
}

/// Its shape.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Centre and radius.
    Ball(Point, f64),
    /// Triangles.
    Triangles(Mesh),
    /// Lower left, lower right, upper right and upper left of a square on which a picture hangs.
    Square([Point; 4]),
}

/// Where it is seen from.
#[derive(Clone, Debug)]
pub struct View {
    /// The camera.
    pub eye: Point,
    /// What is in the middle of the picture.
    pub target: Point,
    /// Half the width of the picture at distance 1.
    pub tangent: f64,
    /// Radius of the aperture and distance of focus.
    pub lens: Option<[f64; 2]>,
}

/// All of it.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The camera.
    pub view: View,
    /// What stands there.
    pub things: Vec<(Shape, Surface)>,
    /// Radiance of even light round it.
    pub around: f64,
    /// Light by a map in latitude and longitude.
    pub map: Option<Map>,
}

/// Texels of one colour each, rows from the top.
#[derive(Clone, Debug)]
pub struct Map {
    size: [usize; 2],
    values: Vec<f32>,
}

impl Map {
    /// Of columns and rows, whose values are given by column and row from the top.
    pub fn new(size: [usize; 2], value: impl Fn(usize, usize) -> f32) -> Self {
        let values = (0..size[0] * size[1]).map(|i| value(i % size[0], i / size[0])).collect();
        Self { size, values }
    }

    /// A wide soft light in a direction, and a little everywhere.
    pub fn bright_towards(direction: Point) -> Self {
        let size = [128, 64];
        let texel = |x: usize, y: usize| {
            let [x, y] = [x, y].map(|c| c as f64 + 0.5);
            // The middle lies towards +y, the right half towards +x, the top towards +z.
            let (azimuth, polar) = (TAU * (x / size[0] as f64 - 0.5), PI * y / size[1] as f64);
            let d = [polar.sin() * azimuth.sin(), polar.sin() * azimuth.cos(), polar.cos()];
            (0.2 + 2.0 * (4.0 * (dot(d, direction) - 1.0)).exp()) as f32
        };
        Self::new(size, texel)
    }

    /// As an EXR file.
    fn file(&self) -> Vec<u8> {
        hung::picture(self.size, |x, y| self.values[y * self.size[0] + x])
    }
}

impl Tone {
    /// As a spectrum of Indigo, times a factor.
    fn text(&self, factor: f64) -> String {
        match self {
            Self::Even(value) => uniform(value * factor),
            Self::Table(values) => {
                let list: Vec<String> = values.iter().map(|v| (v * factor).to_string()).collect();
                let [from, to] = RANGE_NM.map(|nm| nm * 1e-9);
                format!(
                    "<regular_tabulated><start_wavelength>{from}</start_wavelength><end_wavelength>{to}</end_wavelength>\
                     <num_values>{}</num_values><values>{}</values></regular_tabulated>",
                    list.len(),
                    list.join(" ")
                )
            }
        }
    }

    fn dictionary(&self) -> Value {
        match self {
            Self::Even(value) => json!({"type": "uniform", "value": value}),
            Self::Table(values) => regular(RANGE_NM, values),
        }
    }
}

/// Mitsuba's spectrum of values at equal steps of a range in nm.
fn regular([from, to]: [f64; 2], values: &[f64]) -> Value {
    let list: Vec<String> = values.iter().map(f64::to_string).collect();
    json!({"type": "regular", "wavelength_min": from, "wavelength_max": to, "values": list.join(" ")})
}

/// Width of Trowbridge and Reitz's distribution that has the density of a Phong lobe along the normal (Walter et al. 2007).
fn width(exponent: f64) -> f64 {
    // Indigo's smoothest surface has the width 1e-4.
    (2.0 / (exponent + 2.0)).sqrt().max(1e-4)
}

impl Surface {
    /// Definitions of a material `name`.
    fn text(&self, name: &str) -> String {
        let kind = |kind: String| format!("<material><name>{name}</name>{kind}</material>");
        let body = |ior: f64, absorption: f64, more: &str| {
            medium(&format!("in {name}"), 10, &basic(ior, &uniform(absorption), more))
        };
        match self {
            Self::Matt(tone) => diffuse(name, &tone.text(1.0)),
            Self::Lamp(_) | Self::Screen(_) => grey(name, 0.0),
            Self::Glass(ior, absorption) => {
                body(*ior, *absorption, "") + &specular(name, &format!("in {name}"))
            }
            Self::Frosted(ior, exponent) => {
                body(*ior, 0.0, "")
                    + &kind(format!(
                        "<glossy_transparent><internal_medium_name>in {name}</internal_medium_name><exponent>{exponent}</exponent></glossy_transparent>"
                    ))
            }
            Self::Metal(_, exponent) => {
                kind(format!("<phong><nk_data>{name}.nk</nk_data><exponent>{exponent}</exponent></phong>"))
            }
            Self::Fog(ior, absorption, coefficient, g) => {
                let phase = if *g == 0.0 { "<uniform/>".to_owned() } else { henyey_greenstein(*g) };
                body(*ior, *absorption, &scattering(&uniform(*coefficient), &phase))
                    + &specular(name, &format!("in {name}"))
            }
        }
    }

    /// A file of the material's, if it needs one.
    fn file(&self, name: &str) -> Option<(String, Vec<u8>)> {
        match self {
            Self::Metal(index, _) => Some((format!("{name}.nk"), index.file())),
            Self::Screen(map) => Some((format!("{name}.exr"), map.file())),
            _ => None,
        }
    }

    /// What Mitsuba's shape holds beside its shape.
    fn dictionary(&self) -> Value {
        let matt = |tone: &Tone| json!({"type": "twosided", "inner": {"type": "diffuse", "reflectance": tone.dictionary()}});
        let homogeneous = |absorption: f64, coefficient: f64, g: f64| {
            let extinction = absorption + coefficient;
            let phase = if g == 0.0 { json!({"type": "isotropic"}) } else { json!({"type": "hg", "g": g}) };
            json!({
                "type": "homogeneous",
                "albedo": coefficient / extinction,
                "sigma_t": extinction,
                "phase": phase,
            })
        };
        let smooth = |ior: f64| json!({"type": "dielectric", "int_ior": ior, "ext_ior": 1.0});
        match self {
            Self::Matt(tone) => json!({"bsdf": matt(tone)}),
            Self::Lamp(tone) => json!({
                "bsdf": matt(&Tone::Even(0.0)),
                "emitter": {"type": "area", "radiance": tone.dictionary()},
            }),
            Self::Screen(map) => json!({
                "bsdf": matt(&Tone::Even(0.0)),
                "emitter": {"type": "area", "radiance": {"type": "picture", "size": map.size, "grey": map.values}},
            }),
            Self::Glass(ior, 0.0) => json!({"bsdf": smooth(*ior)}),
            Self::Glass(ior, absorption) => {
                json!({"bsdf": smooth(*ior), "interior": homogeneous(*absorption, 0.0, 0.0)})
            }
            Self::Frosted(ior, exponent) => json!({"bsdf": {
                "type": "roughdielectric", "distribution": "ggx", "alpha": width(*exponent), "int_ior": ior, "ext_ior": 1.0,
            }}),
            Self::Metal(index, exponent) => {
                let [n, k] = index.dictionaries();
                json!({"bsdf": {"type": "twosided", "inner": {
                    "type": "roughconductor", "distribution": "ggx", "alpha": width(*exponent), "eta": n, "k": k,
                }}})
            }
            Self::Fog(ior, absorption, coefficient, g) => {
                let bsdf = if *ior == 1.0 { json!({"type": "null"}) } else { smooth(*ior) };
                json!({"bsdf": bsdf, "interior": homogeneous(*absorption, *coefficient, *g)})
            }
        }
    }
}

impl Stage {
    /// The scene of Indigo.
    pub fn text(&self) -> String {
        let view = &self.view;
        let mut camera = flat_camera(view.eye, sub(view.target, view.eye), view.tangent);
        if let Some([radius, focus]) = view.lens {
            camera = with_lens(&camera, radius, focus);
        }
        let mut parts = vec![settings(SIDE, ONE_PIXEL), camera];
        if self.around > 0.0 {
            parts.push(background(&uniform(self.around * AROUND)));
        }
        if self.map.is_some() {
            parts.push(format!(
                "<env_map><latlong><path>{MAP_FILE}</path><gain>{AROUND}</gain></latlong></env_map>"
            ));
        }
        for (i, (shape, surface)) in self.things.iter().enumerate() {
            let name = format!("thing{i}");
            parts.push(surface.text(&name));
            parts.push(match (shape, surface) {
                (Shape::Ball(center, radius), _) => sphere(*center, *radius, &name),
                (Shape::Triangles(mesh), Surface::Lamp(tone)) => {
                    mesh.text(&name, &name) + &mesh_light(&name, &tone.text(AROUND), [0.0; 3], 1.0, "")
                }
                (Shape::Triangles(mesh), _) => mesh.text(&name, &name) + &model(&name),
                (Shape::Square(corners), _) => {
                    let picture = format!("<texture><path>{name}.exr</path><exponent>1</exponent></texture>");
                    hung::mesh(&name, &name, *corners, 1.0)
                        + &mesh_light(&name, &uniform(AROUND), [0.0; 3], 1.0, &picture)
                }
            });
        }
        scene_file(&parts)
    }

    /// Files that the scene names.
    pub fn files(&self) -> Vec<(String, Vec<u8>)> {
        let of = |(i, (_, surface)): (usize, &(Shape, Surface))| surface.file(&format!("thing{i}"));
        let map = self.map.iter().map(|map| (MAP_FILE.to_owned(), map.file()));
        self.things.iter().enumerate().filter_map(of).chain(map).collect()
    }

    /// The scene of Mitsuba; `mesh` and `look_at` are made by the script that loads it.
    pub fn dictionary(&self) -> Value {
        let view = &self.view;
        let has_medium = |(_, surface): &(Shape, Surface)| {
            matches!(surface, Surface::Fog(..))
                || matches!(surface, Surface::Glass(_, absorption) if *absorption > 0.0)
        };
        let integrator = if self.things.iter().any(has_medium) { "volpath" } else { "path" };
        let mut sensor = json!({
            "type": "perspective",
            "fov": 2.0 * view.tangent.atan().to_degrees(),
            "to_world": {"look_at": [view.eye, view.target, [0.0, 0.0, 1.0]]},
            "film": {
                "type": "hdrfilm", "width": SIDE, "height": SIDE, "rfilter": {"type": "box"},
                "pixel_format": "xyz", "component_format": "float32",
            },
            "sampler": {"type": "independent"},
        });
        if let Some([radius, focus]) = view.lens {
            sensor["type"] = "thinlens".into();
            sensor["aperture_radius"] = radius.into();
            sensor["focus_distance"] = focus.into();
        }
        let mut scene =
            json!({"type": "scene", "integrator": {"type": integrator, "max_depth": -1}, "sensor": sensor});
        if self.around > 0.0 {
            scene["around"] = json!({"type": "constant", "radiance": Tone::Even(self.around).dictionary()});
        }
        if let Some(map) = &self.map {
            // Mitsuba's middle lies towards its +z, the right half towards -x, the top towards +y.
            let turn = [[-1, 0, 0, 0], [0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 1]];
            scene["map"] =
                json!({"type": "envmap", "size": map.size, "grey": map.values, "to_world": {"matrix": turn}});
        }
        for (i, (shape, surface)) in self.things.iter().enumerate() {
            let mut thing = surface.dictionary();
            match shape {
                Shape::Ball(center, radius) => {
                    thing["type"] = "sphere".into();
                    thing["center"] = json!(center);
                    thing["radius"] = json!(radius);
                }
                Shape::Triangles(mesh) => {
                    thing["type"] = "mesh".into();
                    thing["vertices"] = json!(mesh.points);
                    thing["faces"] = json!(mesh.triangles);
                }
                Shape::Square(corners) => {
                    thing["type"] = "mesh".into();
                    thing["vertices"] = json!(corners);
                    thing["faces"] = json!([[0, 1, 2], [0, 2, 3]]);
                    thing["places"] = json!([[0, 0], [1, 0], [1, 1], [0, 1]]);
                }
            }
            scene[format!("thing{i}")] = thing;
        }
        scene
    }
}
