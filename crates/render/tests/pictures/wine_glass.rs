//! A liquid in a glass by the manual's Appendix A, where it reaches into the wall and the precedence of media settles
//! what is there, is the same picture as one in which every interface is a surface of its own with the media on
//! both its sides known.
//!
//! The latter is traced by a few lines that have neither stacks of media nor precedence: in double precision but for
//! the intersections, which are those of the accelerator.
//!
//! The glass that `cargo xtask scenes wineglass` makes, of tens of thousands of triangles, is compared with its twin of
//! explicit interfaces. Both are rendered with stacks; what the twin shows, a liquid that displaces its glass, is held
//! to the tracer without them by the other test.

use super::common::judge::{NITS_PER_UNIFORM, assert_same};
use super::common::shapes::{Mesh, model};
use super::common::text::{
    ONE_PIXEL, background, basic, flat_camera, grey, medium, scene_file, settings, specular, uniform,
};
use super::common::{MODES, Measured, Region, measure_regions, scene};
use indigo_geom::{Ray, offset_origin};
use indigo_math::Vec3;
use indigo_scene::Scene;
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use std::f64::consts::TAU;
use xtask::scenes::glassware;

const AROUND: f64 = 3.0e4;
const SIDE: u32 = 16;
/// Blocks of pixels that are compared, along a side.
const BLOCKS: usize = 4;
const TANGENT: f64 = 0.23;
const CAMERA: [f64; 3] = [0.0, -3.5, 1.5];
const VIEW: [f64; 3] = [0.0, 3.5, -0.9];
const ALBEDO: f64 = 0.5;
const STEPS: usize = 24;

/// Outside of the glass from the middle of its bottom to the lip, its inside above the liquid, and below it.
const OUTSIDE: [[f64; 2]; 4] = [[0.0, 0.05], [0.5, 0.05], [0.6, 1.2], [0.5, 1.2]];
const LEVEL: [f64; 2] = [0.468, 0.8];
const INSIDE: [[f64; 2]; 3] = [LEVEL, [0.42, 0.2], [0.0, 0.2]];

/// The surface of revolution of a profile; its front is on the right of the walk.
fn turned(profile: &[[f64; 2]]) -> Mesh {
    let mut mesh = Mesh { points: vec![], triangles: vec![] };
    let mut rings = vec![];
    for &[r, z] in profile {
        rings.push(mesh.points.len());
        for step in 0..if r == 0.0 { 1 } else { STEPS } {
            let (sin, cos) = (TAU * step as f64 / STEPS as f64).sin_cos();
            mesh.points.push([r * cos, r * sin, z]);
        }
    }
    for i in 1..profile.len() {
        let vertex = |k: usize, step: usize| rings[k] + if profile[k][0] == 0.0 { 0 } else { step % STEPS };
        for step in 0..STEPS {
            let [a, b] = [vertex(i - 1, step), vertex(i - 1, step + 1)];
            let [c, d] = [vertex(i, step), vertex(i, step + 1)];
            mesh.triangles
                .extend([[a, b, d], [a, d, c]].into_iter().filter(|[a, b, c]| a != b && b != c && c != a));
        }
    }
    mesh
}

/// The surfaces with their materials, over a floor in even light.
fn table(glass: u32, wine: u32, surfaces: &[(&[[f64; 2]], &str)]) -> Scene {
    let mut parts = vec![
        settings(SIDE, ONE_PIXEL),
        flat_camera(CAMERA, VIEW, TANGENT),
        background(&uniform(AROUND)),
        grey("floor", ALBEDO),
        medium("glass", glass, &basic(GLASS.0, &uniform(GLASS.1), "")),
        medium("wine", wine, &basic(WINE.0, &uniform(WINE.1), "")),
        specular("of glass", "glass"),
        specular("of wine", "wine"),
    ];
    parts.extend([Mesh::square(3.0, 0.0).text("floor", "floor"), model("floor")]);
    for (i, (profile, material)) in surfaces.iter().enumerate() {
        parts.extend([turned(profile).text(&format!("m{i}"), material), model(&format!("m{i}"))]);
    }
    scene(&scene_file(&parts))
}

/// Index and absorption.
const GLASS: (f64, f64) = (1.5, 0.5);
const WINE: (f64, f64) = (1.33, 2.0);

fn regions() -> Vec<Region> {
    let size = SIDE as usize / BLOCKS;
    let block = |b: usize| [b % BLOCKS * size, b / BLOCKS * size];
    (0..BLOCKS * BLOCKS).map(|b| block(b).map(|first| [first, first + size])).collect()
}

/// An interface that knows its sides: media on its front and its back, or the floor.
#[derive(Clone, Copy)]
enum Sheet {
    Floor,
    Between((f64, f64), (f64, f64)),
}

const AIR: (f64, f64) = (1.0, 0.0);

/// Radiance over that of the surroundings, along a ray that begins in air.
fn radiance(scene: &Scene, sheets: &[Sheet], mut ray: Ray, rng: &mut Rng) -> f64 {
    let mut throughput = 1.0;
    let mut medium = AIR;
    while let Some(hit) = scene.accel.intersect(&ray) {
        let at = scene.accel.surface(&ray, &hit);
        let d = ray.d.to_array().map(f64::from);
        throughput *= (-medium.1 * f64::from(hit.t)).exp();
        let mut n = at.n_g.to_array().map(f64::from);
        let to_front = dot(d, n) > 0.0;
        if to_front {
            n = n.map(|x| -x);
        }
        let wi = match sheets[hit.object as usize] {
            Sheet::Floor => {
                throughput *= ALBEDO;
                // Lambert's law: the normal and a point of the unit sphere.
                let (z, phi) = (2.0 * rng.uniform() - 1.0, TAU * rng.uniform());
                let r = (1.0 - z * z).sqrt();
                medium = AIR;
                unit([n[0] + r * phi.cos(), n[1] + r * phi.sin(), n[2] + z])
            }
            Sheet::Between(front, back) => {
                let [here, there] = if to_front { [back, front] } else { [front, back] };
                let eta = here.0 / there.0;
                let cos = -dot(d, n);
                let cos2 = 1.0 - eta * eta * (1.0 - cos * cos);
                let reflectance = if cos2 <= 0.0 { 1.0 } else { fresnel(cos, cos2.sqrt(), eta) };
                let is_reflected = rng.uniform() < reflectance;
                medium = if is_reflected { here } else { there };
                let (along, across) =
                    if is_reflected { (1.0, 2.0 * cos) } else { (eta, eta * cos - cos2.sqrt()) };
                unit([0, 1, 2].map(|k| along * d[k] + across * n[k]))
            }
        };
        let wi = Vec3::from(wi.map(|x| x as f32));
        ray = Ray::new(offset_origin(at.p, at.p_error, at.n_g, wi, 0.0), wi);
    }
    throughput
}

/// Unpolarised, by the cosines on both sides; `eta` is the index here over that there.
fn fresnel(cos: f64, cos_t: f64, eta: f64) -> f64 {
    let s = (eta * cos - cos_t) / (eta * cos + cos_t);
    let p = (eta * cos_t - cos) / (eta * cos_t + cos);
    0.5 * (s * s + p * p)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// Luminances of the blocks of a picture of explicit interfaces.
fn traced(scene: &Scene, sheets: &[Sheet], samples: u32) -> Vec<Moments> {
    let forwards = unit(VIEW);
    let right = unit([forwards[1], -forwards[0], 0.0]);
    let up = [
        right[1] * forwards[2] - right[2] * forwards[1],
        right[2] * forwards[0] - right[0] * forwards[2],
        right[0] * forwards[1] - right[1] * forwards[0],
    ];
    let mut rng = Rng::new(77);
    let block = |b: usize| {
        let corner = [b % BLOCKS, b / BLOCKS].map(|x| x as f64 / BLOCKS as f64);
        let ray = |rng: &mut Rng| {
            let [x, y] = corner.map(|c| 2.0 * (c + rng.uniform() / BLOCKS as f64) - 1.0);
            let d = [0, 1, 2].map(|k| forwards[k] + TANGENT * (x * right[k] - y * up[k]));
            Ray::new(Vec3::ZERO, Vec3::from(unit(d).map(|x| x as f32)))
        };
        Moments::of((0..samples).map(|_| {
            let ray = ray(&mut rng);
            AROUND * NITS_PER_UNIFORM * radiance(scene, sheets, ray, &mut rng)
        }))
    };
    (0..BLOCKS * BLOCKS).map(block).collect()
}

fn compare(what: &str, scene: &mut Scene, explicit: &[Moments]) {
    for bidirectional in [false, true] {
        scene.transport.bidirectional = bidirectional;
        let blocks: Vec<Measured> = measure_regions(scene, &regions(), 16, 128);
        for (i, (block, expected)) in blocks.iter().zip(explicit).enumerate() {
            let measured = block.luminance();
            assert!(
                measured.std_error() < 0.01 * expected.mean(),
                "block {i} is too uncertain: {measured:?}"
            );
            assert_same(&format!("{what}, block {i}, bidirectional {bidirectional}"), measured, expected);
        }
    }
}

#[test]
fn precedence_and_explicit_interfaces_make_the_same_picture() {
    let glass: Vec<_> = OUTSIDE.into_iter().chain(INSIDE).collect();
    let above_liquid: Vec<_> = OUTSIDE.into_iter().chain([LEVEL]).collect();
    let surface = [LEVEL, [0.0, LEVEL[1]]];
    // Of the explicit scene only the geometry is used.
    let geometry = [(above_liquid.as_slice(), "of glass"), (&INSIDE, "of glass"), (&surface, "of wine")];
    let explicit = table(20, 10, &geometry);
    let sheets =
        [Sheet::Floor, Sheet::Between(AIR, GLASS), Sheet::Between(WINE, GLASS), Sheet::Between(AIR, WINE)];
    let expected = traced(&explicit, &sheets, 60_000);

    // By the manual: the liquid ends within the wall, which displaces it.
    let liquid = [[0.0, 0.12], [0.47, 0.12], [0.52, LEVEL[1]], [0.0, LEVEL[1]]];
    compare("Appendix A", &mut table(20, 10, &[(&glass, "of glass"), (&liquid, "of wine")]), &expected);

    // The other way round: the glass ends within the liquid.
    let within: Vec<_> = above_liquid.iter().copied().chain([[0.3, 0.7], [0.0, 0.7]]).collect();
    let liquid = [[0.0, 0.2], [0.42, 0.2], LEVEL, [0.0, LEVEL[1]]];
    compare(
        "glass within liquid",
        &mut table(10, 20, &[(&within, "of glass"), (&liquid, "of wine")]),
        &expected,
    );

    // Empty, the inside of the glass borders on air.
    let sheets = [Sheet::Floor, Sheet::Between(AIR, GLASS), Sheet::Between(AIR, GLASS)];
    let explicit = table(20, 10, &geometry[..2]);
    let empty = traced(&explicit, &sheets, 60_000);
    compare("empty", &mut table(20, 10, &[(&glass, "of glass")]), &empty);

    // And the comparison can tell: with liquid and without it are two pictures.
    let told = expected.iter().zip(&empty).any(|(a, b)| (a.mean() / b.mean() - 1.0).abs() > 0.1);
    assert!(told, "the liquid is not to be seen");
}

/// The text of a glass's meshes and models.
fn lathe(write: fn(&mut dyn std::io::Write) -> std::io::Result<()>) -> String {
    let mut text = vec![];
    write(&mut text).expect("memory takes all");
    let text = String::from_utf8(text).expect("text");
    assert!(text.matches("<tri>").count() >= 40_000, "too coarse");
    text
}

/// Where the glass is looked at: whole, and the near edge of the wine's surface, which the wall of the glass enlarges.
#[derive(Clone, Copy)]
enum View {
    Whole,
    Meniscus,
}

/// The blocks of a picture of a glass on a table in even light.
fn lathe_in_light(view: View, [glass, wine]: [u32; 2], meshes: &str, bidirectional: bool) -> Vec<Measured> {
    let (forwards, tangent) = match view {
        View::Whole => ([0.0, 0.7, -0.19], 0.2),
        View::Meniscus => ([0.0, 0.659, -0.1471], 0.004),
    };
    let mut scene = scene(&scene_file(&[
        // Surfaces meet at edges: near there they are less than the usual nudge apart.
        settings(SIDE, &format!("{ONE_PIXEL}<ray_origin_nudge_distance>0</ray_origin_nudge_distance>")),
        flat_camera([0.0, -0.7, 0.3], forwards, tangent),
        background(&uniform(AROUND)),
        grey("floor", ALBEDO),
        medium("in glass", glass, &basic(GLASS.0, &uniform(5.0), "")),
        medium("in wine", wine, &basic(WINE.0, &uniform(20.0), "")),
        specular("glass", "in glass"),
        specular("wine", "in wine"),
        Mesh::square(0.6, 0.0).text("floor", "floor"),
        model("floor"),
        meshes.to_owned(),
    ]));
    MODES[usize::from(bidirectional)].set(&mut scene);
    measure_regions(&scene, &regions(), 16, 96)
}

#[test]
fn a_turned_glass_and_its_twin_of_explicit_interfaces_make_the_same_picture() {
    let writers =
        [glassware::write_explicit_wine_glass, glassware::write_wine_glass, glassware::write_empty_glass];
    let [explicit, by_rules, empty] = writers.map(lathe);
    for view in [View::Whole, View::Meniscus] {
        let explicit = lathe_in_light(view, [20, 30], &explicit, false);
        for bidirectional in [false, true] {
            let by_precedence = lathe_in_light(view, [20, 10], &by_rules, bidirectional);
            for (i, (a, b)) in by_precedence.iter().zip(&explicit).enumerate() {
                let [a, b] = [a, b].map(Measured::luminance);
                assert!(a.std_error() < 0.01 * b.mean(), "block {i} is too uncertain: {a:?}");
                assert_same(&format!("block {i}, bidirectional {bidirectional}"), a, b);
            }
        }
        // And without the wine it is another picture.
        let empty = lathe_in_light(view, [20, 10], &empty, false);
        let changed =
            empty.iter().zip(&explicit).any(|(a, b)| a.luminance().mean() > 1.1 * b.luminance().mean());
        assert!(changed, "the wine is not to be seen");
    }
}
