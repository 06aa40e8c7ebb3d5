//! The scenes: a room of diffuse light, a caustic, glossy balls under the sky, and coloured twins of each, whose
//! errors are to be read in XYZ; a room lit through a gap from the next one; and lamps by the dozen, of which the camera's
//! room has a few, or all.

use super::common::scene;
use super::common::shapes::{Mesh, mesh_light, model};
use super::common::text::{
    background, basic, diffuse, flat_camera, grey, medium, scene_file, settings, specular, sphere, uniform,
};
use indigo_render::disk::DiskResolver;
use indigo_scene::{LoadOptions, Scene, load};
use std::fs;

/// A scene to be raced on.
pub struct BenchScene {
    pub name: String,
    pub text: String,
    /// The mode that makes its reference.
    pub reference: &'static str,
    /// A file on disk that it was read from.
    file: Option<String>,
}

impl BenchScene {
    fn new(name: &str, reference: &'static str, parts: &[Vec<String>]) -> Self {
        Self { name: name.to_owned(), text: scene_file(&parts.concat()), reference, file: None }
    }

    pub fn load(&self) -> Scene {
        let Some(file) = &self.file else { return scene(&self.text) };
        let resolver = DiskResolver::new(vec![]).for_scene(file);
        let options = LoadOptions::new(&resolver);
        load(file, &options).scene.unwrap_or_else(|| panic!("{file} has errors: see --check"))
    }
}

/// A scene of ours, or a file. A file's reference is bidirectional where its settings ask for that.
pub fn named(name: &str) -> BenchScene {
    if let Some(found) = all().into_iter().find(|s| s.name == name) {
        return found;
    }
    let text = fs::read_to_string(name).unwrap_or_else(|e| panic!("no scene {name}: {e}"));
    let is_bidirectional = text.contains("<bidirectional>true");
    BenchScene {
        name: name.rsplit(['/', '\\']).next().unwrap_or(name).trim_end_matches(".igs").to_owned(),
        text,
        reference: if is_bidirectional { "bidirectional" } else { "path" },
        file: Some(name.to_owned()),
    }
}

/// All scenes of ours.
pub fn all() -> Vec<BenchScene> {
    let [white, coloured] = [Paint::grey(), Paint::coloured()];
    vec![
        room("room", &white),
        room("room-coloured", &coloured),
        caustic("caustic", &white),
        caustic("caustic-coloured", &coloured),
        balls("balls", &white),
        balls("balls-coloured", &coloured),
        gap("gap", &white),
        rooms("rooms"),
        hall("hall"),
    ]
}

/// What is coloured in a coloured twin.
struct Paint {
    left: String,
    right: String,
    lamp: fn(f64) -> String,
    hot: fn(f64) -> String,
    glass: String,
}

impl Paint {
    fn grey() -> Self {
        let [left, right] = [0.6, 0.3].map(uniform);
        Self { left, right, lamp: uniform, hot: uniform, glass: uniform(0.0) }
    }

    /// Saturated walls, daylight, a lamp of nearly one wavelength like sodium's, and green glass.
    fn coloured() -> Self {
        Self {
            left: rgb("0.8 0.03 0.03"),
            right: rgb("0.03 0.5 0.05"),
            // Of about the same luminance as the even spectrum.
            lamp: |value| {
                format!(
                    "<blackbody><temperature>6500</temperature><gain>{}</gain></blackbody>",
                    value * 2.4e-14
                )
            },
            hot: |value| {
                format!(
                    "<peak><peak_min>580</peak_min><peak_width>20</peak_width><base_value>{}</base_value>\
                     <peak_value>{}</peak_value></peak>",
                    0.02 * value,
                    5.0 * value
                )
            },
            glass: rgb("4 0.3 3"),
        }
    }
}

fn rgb(triple: &str) -> String {
    format!("<rgb><rgb>{triple}</rgb><gamma>1</gamma></rgb>")
}

/// 256 pixels a side, a box filter, at most 15 scattering events.
fn head(camera: String) -> Vec<String> {
    let more = "<splat_filter><box/></splat_filter><downsize_filter><box/></downsize_filter><max_depth>15</max_depth>";
    vec![settings(256, more), camera, grey("black", 0.0), grey("white", 0.6), grey("grey", 0.5)]
}

fn square(corners: [[f64; 3]; 4], name: &str, material: &str) -> Vec<String> {
    vec![Mesh::polygon(corners.to_vec()).text(name, material), model(name)]
}

/// A room of side 2 with a square lamp in the ceiling.
fn walls(paint: &Paint) -> Vec<String> {
    let at = |x: f64, y: f64, z: f64| [x, y, z];
    [
        vec![diffuse("left", &paint.left), diffuse("right", &paint.right)],
        square([at(-1., -1., 0.), at(1., -1., 0.), at(1., 1., 0.), at(-1., 1., 0.)], "floor", "grey"),
        square([at(-1., -1., 2.), at(-1., 1., 2.), at(1., 1., 2.), at(1., -1., 2.)], "ceiling", "white"),
        square([at(-1., 1., 0.), at(1., 1., 0.), at(1., 1., 2.), at(-1., 1., 2.)], "back", "white"),
        square([at(-1., -1., 0.), at(-1., 1., 0.), at(-1., 1., 2.), at(-1., -1., 2.)], "left side", "left"),
        square([at(1., 1., 0.), at(1., -1., 0.), at(1., -1., 2.), at(1., 1., 2.)], "right side", "right"),
    ]
    .concat()
}

/// Just below the ceiling; its front looks down.
fn lamp(half: f64, spectrum: &str) -> Vec<String> {
    let z = 1.999;
    let corners = [[-half, -half, z], [-half, half, z], [half, half, z], [half, -half, z]];
    let mesh = Mesh::polygon(corners.to_vec()).text("lamp", "black");
    vec![mesh, mesh_light("lamp", spectrum, [0.0; 3], 1.0, "")]
}

fn block(name: &str, half: [f64; 2], turn: f64, at: [f64; 2]) -> Vec<String> {
    let (s, c) = turn.to_radians().sin_cos();
    let ([x, z], [px, py]) = (half, at);
    let mesh = Mesh::cube(1.0).placed([x * c, -x * s, 0.0, x * s, x * c, 0.0, 0.0, 0.0, z], 1.0, [px, py, z]);
    vec![mesh.text(name, "grey"), model(name)]
}

fn into_the_room() -> String {
    flat_camera([0.0, -3.8, 1.0], [0.0, 1.0, 0.0], 0.344_327_6)
}

/// Two blocks in a room with a middling lamp: direct and diffuse indirect light.
fn room(name: &str, paint: &Paint) -> BenchScene {
    let parts = [
        head(into_the_room()),
        walls(paint),
        block("tall", [0.3, 0.6], 20.0, [-0.35, 0.3]),
        block("short", [0.28, 0.28], -18.0, [0.35, -0.3]),
        lamp(0.25, &(paint.lamp)(137_018.0)),
    ];
    BenchScene::new(name, "path", &parts)
}

/// A ball of glass under a small lamp.
fn caustic(name: &str, paint: &Paint) -> BenchScene {
    let parts = [
        head(into_the_room()),
        walls(paint),
        vec![medium("glass", 10, &basic(1.5, &paint.glass, "")), specular("glass", "glass")],
        vec![sphere([0.25, -0.1, 0.5], 0.45, "glass")],
        lamp(0.125, &(paint.hot)(548_073.0)),
    ];
    BenchScene::new(name, "bidirectional", &parts)
}

/// A room that gets its light through a narrow gap, from a room that is not seen.
fn gap(name: &str, paint: &Paint) -> BenchScene {
    let partition = [[-0.3, -1., 0.], [-0.3, 0.95, 0.], [-0.3, 0.95, 2.], [-0.3, -1., 2.]];
    let front = [[-1., -1., 0.], [-0.3, -1., 0.], [-0.3, -1., 2.], [-1., -1., 2.]];
    let corners = [[-0.2, -0.2, 1.99], [-0.2, 0.2, 1.99], [0.2, 0.2, 1.99], [0.2, -0.2, 1.99]];
    let parts = [
        head(flat_camera([0.35, -3.8, 1.0], [0.0, 1.0, 0.0], 0.25)),
        walls(paint),
        square(partition, "partition", "white"),
        square(front, "front", "white"),
        block("tall", [0.2, 0.5], 20.0, [0.35, 0.2]),
        vec![Mesh::polygon(corners.to_vec()).text("lamp", "black")],
        vec![mesh_light("lamp", &(paint.lamp)(2e6), [-0.65, -0.3, 0.0], 1.0, "")],
    ];
    BenchScene::new(name, "bidirectional", &parts)
}

/// Glossy and matt balls under an even sky.
fn balls(name: &str, paint: &Paint) -> BenchScene {
    let glossy = |name: &str, exponent: f64| {
        format!(
            "<material><name>{name}</name><phong><exponent>{exponent}</exponent><specular_reflectivity_spectrum>{}\
             </specular_reflectivity_spectrum></phong></material>",
            uniform(0.891_403)
        )
    };
    let ground = [[-10., -10., 0.], [10., -10., 0.], [10., 10., 0.], [-10., 10., 0.]];
    let parts = [
        head(flat_camera([0.0, -8.0, 2.5], [0.0, 0.978_158_851, -0.207_858_756], 0.315_298_9)),
        vec![glossy("smooth", 198.0), glossy("rough", 20.2222), diffuse("ball", &paint.left)],
        square(ground, "ground", "grey"),
        vec![sphere([-1.1, 0.0, 1.0], 1.0, "smooth"), sphere([1.1, 0.0, 1.0], 1.0, "ball")],
        vec![sphere([0.0, -1.5, 0.5], 0.5, "rough"), background(&(paint.lamp)(13_702.0))],
    ];
    BenchScene::new(name, "path", &parts)
}

/// A lamp of some flux (lm) in the form of a square that looks down, some way round a point of the ceiling.
fn panel(at: [f64; 3], side: f64, flux: f64) -> String {
    let [x, y, z] = at;
    format!(
        "<rectanglelight><pos>{x} {y} {z}</pos><width>{side}</width><height>{side}</height><spectrum>{}</spectrum>\
         <efficacy_scale><power_drawn>{flux}</power_drawn><overall_luminous_efficacy>1</overall_luminous_efficacy>\
         </efficacy_scale></rectanglelight>",
        uniform(1.0)
    )
}

/// The same in the form of a ball of 128 triangles.
fn bulb(at: [f64; 3], flux: f64) -> String {
    let efficacy = format!(
        "<efficacy_scale><power_drawn>{flux}</power_drawn><overall_luminous_efficacy>1</overall_luminous_efficacy>\
         </efficacy_scale>"
    );
    mesh_light("bulb", &uniform(1.0), at, 0.04, &efficacy)
}

/// A closed room of 4 m by 4 m by 2.5 m.
fn closed_room(at: [f64; 2]) -> String {
    let pos = format!("<pos>{} {} 0</pos>", at[0], at[1]);
    model("walls").replace("<pos>0 0 0</pos>", &pos)
}

/// A building of four by four rooms that are closed, with two panels and two bulbs in each, and a floodlight of
/// 1.75 million lm in a closed box 50 m off.
fn rooms(name: &str) -> BenchScene {
    let walls =
        Mesh::cube(1.0).inside_out().placed([2., 0., 0., 0., 2., 0., 0., 0., 1.25], 1.0, [0., 0., 1.25]);
    let camera = flat_camera([-1.7, -1.8, 1.6], [0.6, 0.75, -0.12], 0.75);
    let block = Mesh::cube(0.4).placed([1., 0., 0., 0., 1., 0., 0., 0., 1.], 1.0, [0.6, 0.5, 0.4]);
    let mut parts = vec![
        head(camera),
        vec![walls.text("walls", "white"), Mesh::ball(2).text("bulb", "black")],
        vec![block.text("block", "grey"), model("block")],
    ];
    for i in 0..16 {
        let [x, y] = [i % 4 - 1, i / 4 - 1].map(|k| 4.2 * f64::from(k));
        let lamps = vec![
            closed_room([x, y]),
            panel([x + 0.8, y + 0.9, 2.45], 0.4, 1750.0),
            panel([x - 0.9, y - 0.7, 2.45], 0.2, 900.0),
            bulb([x - 1.2, y + 1.3, 1.4], 800.0),
            bulb([x + 1.5, y - 1.4, 1.9], 400.0),
        ];
        parts.push(lamps);
    }
    parts.push(vec![closed_room([50.0, 0.0]), panel([50.0, 0.0, 2.4], 1.0, 1.75e6)]);
    BenchScene::new(name, "path", &parts)
}

/// A hall of 30 m by 30 m under 400 panels, with 50 bulbs about knee-high.
fn hall(name: &str) -> BenchScene {
    let walls =
        Mesh::cube(1.0).inside_out().placed([15., 0., 0., 0., 15., 0., 0., 0., 3.], 1.0, [0., 0., 3.]);
    let camera = flat_camera([-12.0, -13.0, 2.2], [0.6, 0.75, -0.12], 0.75);
    let mut parts = vec![
        head(camera),
        vec![walls.text("walls", "grey"), model("walls"), Mesh::ball(2).text("bulb", "black")],
    ];
    for i in 0..400 {
        let [x, y] = [i % 20, i / 20].map(|k| 1.45 * f64::from(k) - 13.8);
        parts.push(vec![panel([x, y, 5.9], 0.3, 300.0 + 50.0 * f64::from(i * 7 % 13))]);
    }
    for i in 0..50 {
        let [x, y] = [i * 37 % 50, i * 13 % 49].map(|k| 0.55 * f64::from(k) - 13.5);
        parts.push(vec![bulb([x, y, 0.5], 100.0 + 20.0 * f64::from(i % 10))]);
    }
    BenchScene::new(name, "path", &parts)
}
