//! Techniques and drivers.

use indigo_scene::{MetropolisSettings, Scene};

/// A technique under a driver.
pub struct Mode {
    pub name: &'static str,
    bidirectional: bool,
    metropolis: bool,
    hybrid: bool,
    /// Samples per pixel of a batch: about the same time for each.
    pub passes: u64,
    /// Seed of the first batch; however many there are, no two modes share one.
    pub seed: u64,
}

/// All of them; the first is what the others are compared with.
pub const MODES: &[Mode] = &[
    mode("path", [false, false, false], 96, 1 << 32),
    mode("bidirectional", [true, false, false], 48, 2 << 32),
    mode("path, Metropolis", [false, true, false], 96, 3 << 32),
    mode("bidirectional, Metropolis", [true, true, false], 48, 4 << 32),
    mode("path, hybrid", [false, true, true], 96, 5 << 32),
    mode("bidirectional, hybrid", [true, true, true], 48, 6 << 32),
];

const fn mode(name: &'static str, [b, m, h]: [bool; 3], passes: u64, seed: u64) -> Mode {
    Mode { name, bidirectional: b, metropolis: m, hybrid: h, passes, seed }
}

impl Mode {
    /// Makes a scene render in this mode.
    pub fn set(&self, scene: &mut Scene) {
        scene.transport.bidirectional = self.bidirectional;
        scene.transport.hybrid = self.hybrid;
        scene.transport.metropolis = self.metropolis.then_some(MetropolisSettings {
            large_mutation_prob: 0.4,
            max_change: 0.01,
            // What the manual's finite default does is a bias, if a tiny one.
            max_consecutive_rejections: i64::MAX,
        });
    }
}
