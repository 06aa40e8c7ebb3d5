//! Every technique under every driver makes the same picture.
//!
//! Each scene is rendered by path tracing and by every other mode in independent batches, and the
//! pictures are compared block by block with Welch's t-test; Šidák's correction keeps the probability of
//! any false alarm in the whole grid at 1e-4. Seeds are fixed, so a failure is the same one every time.
//!
//! `INDIGO_GRID_BATCHES=n` takes n times as many batches, and `INDIGO_GRID_PICTURES=dir` writes the
//! modes' pictures of each scene side by side, and the map of t, into a folder.

#[path = "../common/mod.rs"]
mod common;
mod encode;
mod modes;
mod pictures;
mod scenes;

use common::again::replay;
use common::{film, scene_with, shapes, text};
use indigo_scene::Scene;
use indigo_testkit::sidak;
use indigo_testkit::zgrid::{BlockGrid, ZGrid};
use modes::{MODES, Mode};
use scenes::Written;
use std::fmt::Write;

/// Probability of any false alarm in the whole grid.
const FAMILY: f64 = 1e-4;
/// Independent renders of a mode.
const BATCHES: u64 = 16;
/// Blocks along a side of the picture.
const BLOCKS: usize = 6;
/// Side of the pictures.
pub const SIDE: u32 = 24;

/// The batches of a mode: block means of luminance, and of X and Z so that colour counts.
struct Rendered {
    grids: [BlockGrid; 3],
    mean: Vec<[f64; 3]>,
}

fn render(scene: &Scene, mode: &Mode, passes: u64) -> Rendered {
    let batches = BATCHES * std::env::var("INDIGO_GRID_BATCHES").map_or(1, |n| n.parse().expect("a number"));
    let pixels = (SIDE * SIDE) as usize;
    let mut rendered =
        Rendered { grids: [(); 3].map(|()| BlockGrid::new(BLOCKS, BLOCKS)), mean: vec![[0.0; 3]; pixels] };
    for batch in 0..batches {
        let picture = film(scene, mode.seed + batch, passes).develop();
        for (sum, p) in rendered.mean.iter_mut().zip(&picture.pixels) {
            for c in 0..3 {
                sum[c] += f64::from(p[c]) / batches as f64;
            }
        }
        for (c, grid) in rendered.grids.iter_mut().enumerate() {
            let of = |i: usize| f64::from(picture.pixels[i][c]);
            grid.add_batch(&block_means(of)).expect("a mean for each block");
        }
    }
    rendered
}

fn block_means(value: impl Fn(usize) -> f64) -> Vec<f64> {
    let side = SIDE as usize / BLOCKS;
    let block = |b: usize| {
        let (bx, by) = (b % BLOCKS * side, b / BLOCKS * side);
        let pixels = (0..side * side).map(|i| (by + i / side) * SIDE as usize + bx + i % side);
        pixels.map(&value).sum::<f64>() / (side * side) as f64
    };
    (0..BLOCKS * BLOCKS).map(block).collect()
}

/// Renders a scene in all modes and compares each with the first.
#[track_caller]
fn agree(name: &str, written: &Written) {
    let mut scene = scene_with(&written.text, written.files.iter().cloned());
    let mut pictures = vec![];
    let mut reference = None;
    let mut faults = String::new();
    // Three channels of each scene in each mode but the first.
    let comparisons = 3 * SCENES * (MODES.len() - 1);
    let test = ZGrid { family_level: sidak(FAMILY, comparisons), rounding: 1e-5 };
    for mode in MODES {
        mode.set(&mut scene);
        // Paths through media have many more vertices, so that half of them take as long.
        let passes = if scene.media.is_empty() { mode.passes } else { mode.passes / 2 };
        let rendered = render(&scene, mode, passes);
        pictures.push(rendered.mean);
        let Some(expected) = &reference else {
            reference = Some(rendered.grids);
            continue;
        };
        for ((expected, grid), channel) in expected.iter().zip(&rendered.grids).zip(["X", "Y", "Z"]) {
            let result = test.compare(expected, grid).expect("grids of one shape");
            if !result.passed() {
                let (again, base) = (replay(), MODES[0].name);
                let _ = writeln!(
                    faults,
                    "{name}, {} against {base}, {channel}: {result}; seeds from {} on\nagain: {again}",
                    mode.name, mode.seed
                );
            }
        }
    }
    pictures::write(name, &pictures);
    assert!(faults.is_empty(), "{faults}");
}

/// A test for each scene.
macro_rules! grid {
    (always: [$($scene:ident,)*] with_grid: [$($more:ident,)*]) => {
        const SCENES: usize = [$(stringify!($scene),)* $(stringify!($more),)*].len();

        $(#[test]
        fn $scene() {
            agree(stringify!($scene), &scenes::$scene());
        })*
        $(#[test]
        #[ignore = "cargo xtask test --grid"]
        fn $more() {
            agree(stringify!($more), &scenes::$more());
        })*
    };
}

scenes::for_all!(grid);
