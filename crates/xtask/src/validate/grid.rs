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
/// Scenes whose rare paths need more samples, and how many times as many.
const NOISY: &[(&str, u32)] =
    &[("lamp_out_of_focus_in_fog", 40), ("coloured_walls_and_lamps", 6), ("lamps_out_of_focus", 5)];
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
    let times = NOISY.iter().find(|(noisy, _)| *noisy == name).map_or(1, |(_, times)| *times);
    let mut check = Check::new(GROUP, name.replace('_', " "), about, scene.text)
        .unit(stage::UNIT)
        .by(ALL)
        .effort(times * SAMPLES, DEMAND)
        .blocks(BLOCKS, BLOCKS)
        .row("picture", Quantity::Y, None, Target::First(0.0));
    check.longer =
        [Renderer::Path, Renderer::PathMetropolis, Renderer::PathHybrid].map(|by| (by, PATHS_ALONE)).to_vec();
    check.files = scene.files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect();
    check.full_only = true;
    check
}
