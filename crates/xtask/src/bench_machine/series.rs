//! What is made larger, step by step.

use crate::validate::agreement::wall;
use crate::validate::hung;
use crate::validate::oracles::{AROUND, material};
use crate::validate::shapes::{Mesh, mesh_light, model};
use crate::validate::text::{ONE_PIXEL, background, flat_camera, grey, scene_file, settings, uniform};

/// A series of scenes.
pub struct Series {
    /// A word.
    pub name: &'static str,
    /// What is made larger.
    pub axis: &'static str,
    /// Figures that it tells of.
    pub figures: &'static [&'static str],
    /// The scenes.
    pub points: fn() -> Vec<Point>,
}

/// One of them.
pub struct Point {
    /// How large.
    pub x: f64,
    /// The scene.
    pub scene: String,
    /// Files that it names.
    pub files: Vec<(String, Vec<u8>)>,
    /// Threads that render it.
    pub threads: usize,
    /// Samples per pixel.
    pub samples: u32,
}

/// All of them.
pub const SERIES: &[Series] = &[
    Series {
        name: "threads",
        axis: "threads",
        figures: &["samples_per_second", "rays_per_second", "peak_memory_mb"],
        points: threads,
    },
    Series {
        name: "triangles",
        axis: "triangles",
        figures: &["rays_per_second", "read_s", "build_s", "first_pixel_s", "peak_memory_mb"],
        points: triangles,
    },
    Series { name: "lamps", axis: "lamps", figures: &["samples_per_second", "first_pixel_s"], points: lamps },
    Series {
        name: "texels",
        axis: "texels",
        figures: &["samples_per_second", "first_pixel_s", "peak_memory_mb"],
        points: texels,
    },
    Series {
        name: "pixels",
        axis: "pixels",
        figures: &[
            "samples_per_second",
            "first_pixel_s",
            "develop_s",
            "develop_and_save_s",
            "peak_memory_mb",
        ],
        points: pixels,
    },
];

/// Things on a floor in even light.
fn seen(side: u32, things: &[String]) -> String {
    let floor = Mesh::square(5.0, -1.0).text("floor", "grey") + &model("floor");
    let head = [
        settings(side, ONE_PIXEL),
        flat_camera([0.0, -6.0, 1.5], [0.0, 6.0, -1.5], 0.35),
        grey("grey", 0.5),
        floor,
        background(&uniform(AROUND)),
    ];
    scene_file(&[&head, things].concat())
}

fn point(x: f64, scene: String) -> Point {
    Point { x, scene, files: vec![], threads: 1, samples: 4 }
}

fn ball(levels: u32) -> String {
    Mesh::ball(levels).text("ball", "grey") + &model("ball")
}

/// 1, 2, 4 and so on, up to all cores.
fn threads() -> Vec<Point> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut counts: Vec<usize> = (0..16).map(|i| 1 << i).take_while(|n| *n < cores).collect();
    counts.push(cores);
    let of = |threads: usize| Point { threads, samples: 16, ..point(threads as f64, seen(256, &[ball(3)])) };
    counts.into_iter().map(of).collect()
}

/// A ball of 2048 triangles, and of sixteen times as many, twice.
fn triangles() -> Vec<Point> {
    [4, 6, 8].map(|levels| point(8.0 * 4f64.powi(levels as i32), seen(128, &[ball(levels)]))).into()
}

/// Small lamps in rows over the floor, of the same power together.
fn lamps() -> Vec<Point> {
    let of = |side: u32| {
        let count = f64::from(side * side);
        let half = 0.5 / f64::from(side);
        let lamp = Mesh::square(half, 0.0).inside_out().text("lamp", "black");
        let mut things = vec![grey("black", 0.0), lamp, ball(3)];
        for i in 0..side * side {
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(side) * 4.0 - 2.0;
            things.push(mesh_light("lamp", &uniform(AROUND), [at(i % side), at(i / side), 2.5], 1.0, ""));
        }
        point(count, seen(128, &things))
    };
    [1, 4, 16, 64].map(of).into()
}

/// A wall with a picture.
fn texels() -> Vec<Point> {
    let of = |side: usize| {
        let kind = "<diffuse><albedo_texture><path>map.exr</path><exponent>1</exponent><b>0.8</b></albedo_texture></diffuse>";
        let scene = seen(128, &[material("mapped", kind), wall([0.0, -1.0, 0.0], "mapped", 1.0)]);
        let value =
            |x: usize, y: usize| if (x * 8 / side + y * 8 / side).is_multiple_of(2) { 0.9 } else { 0.3 };
        Point {
            files: vec![("map.exr".into(), hung::picture([side; 2], value))],
            ..point((side * side) as f64, scene)
        }
    };
    [64, 512, 2048].map(of).into()
}

fn pixels() -> Vec<Point> {
    [128, 512, 2048]
        .map(|side| Point { samples: 1, ..point(f64::from(side * side), seen(side, &[ball(3)])) })
        .into()
}
