//! Ways of rendering that must make one picture: scenes each with something that one of them could get wrong.
//!
//! Path tracing finds light by scattering and by drawing lamps; bidirectional path tracing also follows light from
//! the lamps and connects the two; Metropolis sampling walks among the paths of either, with or without those of direct light. They share models and geometry,
//! but hardly any density: what one gets wrong, another does not.

use super::check::{ALL, Check, Quantity, Renderer, Target};
use super::cross::scenes::{self, Entry};
use super::cross::stage;
use super::hung;
use super::oracles::{AROUND, material};
use super::shapes::{Mesh, Point, mesh_light, model};
use super::text::{ONE_PIXEL, basic, flat_camera, grey, medium, scene_file, settings, specular, uniform};

/// The chapter.
pub const GROUP: &str = "One picture by all ways";
/// Samples per pixel of each render.
const SAMPLES: u32 = 32;
/// Share of the mean that must be seen in the quick form.
const QUICK_DEMAND: f64 = 1e-1;
/// In the full form, where Metropolis sampling walks quickly, and where slowly.
const FULL_DEMAND: [f64; 2] = [2e-2, 4e-2];
/// How many times the samples the full form takes: with four times the renders a quarter of what the quick form
/// resolves is resolved.
const FULL_TIMES: u32 = 2;
/// Share of its light that half of the blocks must show, in the quick form and in the full one: Metropolis sampling gathers little
/// in dark corners.
const BLOCKS: [f64; 2] = [0.5, 0.2];
/// Scenes in which all ways have so little noise that the full form can show 2 %.
const QUIET: &[&str] = &["bump maps", "smooth glass", "thin lens", "lamps", "environment map"];
/// Of these the quick form takes half of the samples.
const QUIETEST: &[&str] = &["smooth glass", "lamps", "environment map"];
/// The scenes beside Mitsuba that are rendered by all ways, too.
const SHARED: &[&str] =
    &["coloured box", "smooth glass", "fog, Henyey and Greenstein", "thin lens", "lamps", "environment map"];

/// All of them.
pub fn all() -> Vec<Check> {
    let shared = scenes::all().into_iter().filter(|entry| SHARED.contains(&entry.name));
    let shared = shared.map(|Entry { name, about, stage, .. }| {
        let mut check = by_all_ways(name, about, stage.text());
        check.files = stage.files();
        if QUIETEST.contains(&name) { check.quickly(SAMPLES / 2) } else { check }
    });
    [vec![bumps(), frosted_pane(), prism()], shared.collect()].concat()
}

fn by_all_ways(name: &str, about: &str, scene: String) -> Check {
    let check = Check::new(GROUP, name, about, scene).unit(stage::UNIT).by(ALL);
    let mut check = effort(check, SAMPLES).blocks(BLOCKS[0], BLOCKS[1]);
    // Paths that wander alone find the least.
    check.longer = vec![(Renderer::PathMetropolis, 2)];
    check.row("picture", Quantity::Y, None, Target::First(0.0))
}

/// So many samples in the quick form, and what both must show of the mean.
fn effort(check: Check, samples: u32) -> Check {
    let full = FULL_DEMAND[usize::from(!QUIET.contains(&check.name.as_str()))];
    check.effort(samples, QUICK_DEMAND).in_full(FULL_TIMES * samples, full)
}

/// A room of side 2 whose walls have a material each, and a lamp.
fn room(materials: &[String], [floor, back, left, right]: [&str; 4], things: &[String]) -> String {
    let walls = [
        ([0.0, 0.0, 1.0], floor, 2.0),
        ([0.0, -1.0, 0.0], back, 3.0),
        ([1.0, 0.0, 0.0], left, 1.0),
        ([-1.0, 0.0, 0.0], right, 1.0),
        ([0.0, 0.0, -1.0], "white", 1.0),
    ];
    let walls = walls.iter().map(|(towards, material, times)| wall(*towards, material, *times));
    let lamp = Mesh::square(0.3, 0.0).inside_out().text("lamp", "black")
        + &mesh_light("lamp", &uniform(10.0 * AROUND), [0.0, 0.0, 0.98], 1.0, "");
    let head = [
        settings(stage::SIDE, ONE_PIXEL),
        flat_camera([0.0, -3.6, 0.0], [0.0, 1.0, 0.0], 0.42),
        grey("white", 0.7) + &grey("black", 0.0),
    ];
    scene_file(&[&head, materials, &walls.collect::<Vec<_>>(), things, &[lamp]].concat())
}

/// A wall of the room, on which a map is shown so many times along each side.
pub fn wall(towards: Point, material: &str, times: f64) -> String {
    let name = format!("wall {} {} {}", towards[0], towards[1], towards[2]);
    hung::mesh(&name, material, hung::corners(towards.map(|x| -x), towards, 1.0), times) + &model(&name)
}

fn cuboid(name: &str, half: [f64; 3], at: [f64; 3]) -> String {
    let [x, y, z] = half;
    let mesh = Mesh::cube(1.0).placed([x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z], 1.0, at);
    mesh.text(name, name) + &model(name)
}

/// Hills of up to 45 degrees: shading normals lean far from the walls' own, so that light arriving and light leaving are
/// weighed differently.
fn bumps() -> Check {
    let bump = "<bump_map><path>hills.exr</path><exponent>1</exponent><b>0.3</b></bump_map>";
    let albedo = format!("<albedo_spectrum>{}</albedo_spectrum>", uniform(0.7));
    let metal = format!(
        "<phong><exponent>80</exponent><specular_reflectivity_spectrum>{}</specular_reflectivity_spectrum>{bump}</phong>",
        uniform(0.8)
    );
    let materials =
        [material("matt", &format!("<diffuse>{albedo}{bump}</diffuse>")), material("metal", &metal)];
    let scene = room(&materials, ["matt", "matt", "metal", "matt"], &[]);
    let about = "Hills on matt and metal walls: normals for shading lean up to 45° from the walls’ own, and light that is followed \
                 from lamps needs their adjoint (Veach 1997, section 5.3).";
    let mut check = by_all_ways("bump maps", about, scene);
    check.files.push(("hills.exr".to_owned(), hills()));
    check
}

fn hills() -> Vec<u8> {
    hung::picture([16; 2], |x, y| {
        let [x, y] = [x, y].map(|c| (std::f64::consts::TAU * c as f64 / 16.0).sin());
        (0.5 + 0.25 * (x + y)) as f32
    })
}

/// All light goes through a rough pane of coloured glass below the lamp.
fn frosted_pane() -> Check {
    let glass = "<rgb><rgb>1 4 9</rgb><gamma>1</gamma></rgb>";
    let kind = "<glossy_transparent><internal_medium_name>glass</internal_medium_name><exponent>100</exponent></glossy_transparent>";
    let materials = [medium("glass", 10, &basic(1.5, glass, "")), material("pane", kind)];
    let scene = room(&materials, ["white"; 4], &[cuboid("pane", [0.98, 0.98, 0.04], [0.0, -0.01, 0.7])]);
    // Metropolis sampling walks slowly here: too slowly for the samples of the others.
    let check = by_all_ways("frosted pane", "All light goes through a rough pane of coloured glass.", scene);
    let mut check = effort(check, 2 * SAMPLES);
    check.longer = vec![(Renderer::PathMetropolis, 6), (Renderer::PathHybrid, 4)];
    check
}

/// Each wavelength goes a way of its own, far more so than in any glass.
fn prism() -> Check {
    let flint = "<basic><ior>1.4</ior><cauchy_b_coeff>0.05</cauchy_b_coeff></basic>";
    let ends = |y: f64| [[-0.5, y, -0.8], [0.5, y, -0.8], [0.0, y, 0.1]];
    let triangles = [[0, 1, 2], [3, 5, 4], [0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2], [2, 5, 3], [2, 3, 0]];
    let mesh = Mesh { points: [ends(-0.5), ends(0.5)].concat(), triangles: triangles.to_vec() };
    let things = [mesh.text("prism", "flint") + &model("prism")];
    let materials = [medium("f", 10, flint), specular("flint", "f")];
    by_all_ways(
        "prism",
        "Strong dispersion: each wavelength goes its own way.",
        room(&materials, ["white"; 4], &things),
    )
}
