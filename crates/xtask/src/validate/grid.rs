//! The scenes in which the renderer's own tests compare its ways of rendering, each with something that one of them could get
//! wrong, as the console renders them.

use super::check::{ALL, Check, Quantity, Renderer, Target};
use super::cross::stage;
use super::{encode, shapes, text};

/// The chapter.
pub const GROUP: &str = "Agreement grid";
/// Samples per pixel of each of the full form's renders by bidirectional path tracing, and how many times as many paths
/// alone take in as long.
const SAMPLES: u32 = 12;
const PATHS_ALONE: u32 = 2;
/// A scene in which paths alone find the light so rarely that they need more samples.
struct Noisy {
    name: &'static str,
    /// How many times as many by path tracing, and by Metropolis sampling and hybrids of it.
    times: [u32; 3],
    /// Share of its light that half of the blocks must show.
    blocks: f64,
}

const NOISY: &[Noisy] = &[
    // Metropolis sampling of paths alone hardly gets to the dark blocks: 20 times the samples took nothing off the median one's noise.
    Noisy { name: "lamp_out_of_focus_in_fog", times: [8, 20, 40], blocks: 1.1 },
    Noisy { name: "coloured_walls_and_lamps", times: [1, 6, 6], blocks: BLOCKS },
    Noisy { name: "lamps_out_of_focus", times: [2, 4, 5], blocks: BLOCKS },
];
/// Share of the mean that must be seen, and of half of the blocks.
const DEMAND: f64 = 1e-1;
const BLOCKS: f64 = 0.5;
/// Side of the pictures.
const SIDE: u32 = 24;

#[path = "../../../render/tests/agreement/scenes/mod.rs"]
mod scenes;

/// All of them.
pub fn all() -> Vec<Check> {
    macro_rules! checks {
        (always: [$($scene:ident,)*] with_grid: [$($more:ident,)*]) => {
            vec![
                $(check(stringify!($scene), scenes::$scene()),)*
                $(check(stringify!($more), scenes::$more()),)*
            ]
        };
    }
    scenes::for_all!(checks)
}

fn check(name: &str, scene: scenes::Written) -> Check {
    let about = "One of the scenes of crates/render/tests/agreement, by all ways of rendering.";
    let noisy = NOISY.iter().find(|noisy| noisy.name == name);
    let (times, blocks) = noisy.map_or(([1; 3], BLOCKS), |noisy| (noisy.times, noisy.blocks));
    let mut check = Check::new(GROUP, name.replace('_', " "), about, scene.text)
        .unit(stage::UNIT)
        .by(ALL)
        .effort(SAMPLES, DEMAND)
        .blocks(blocks, blocks)
        .row("picture", Quantity::Y, None, Target::First(0.0));
    let alone = [Renderer::Path, Renderer::PathMetropolis, Renderer::PathHybrid];
    check.longer = alone.into_iter().zip(times.map(|times| PATHS_ALONE * times)).collect();
    check.files = scene.files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect();
    check.full_only = true;
    check
}
