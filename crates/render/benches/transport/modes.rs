//! Techniques under drivers.

use indigo_scene::{MetropolisSettings, Scene};

/// A technique under a driver.
pub struct Mode {
    pub name: &'static str,
    bidirectional: bool,
    metropolis: bool,
    hybrid: bool,
}

/// All of them.
pub const MODES: &[Mode] = &[
    mode("path", [false, false, false]),
    mode("bidirectional", [true, false, false]),
    mode("path-metropolis", [false, true, false]),
    mode("bidirectional-metropolis", [true, true, false]),
    mode("path-hybrid", [false, true, true]),
    mode("bidirectional-hybrid", [true, true, true]),
];

const fn mode(name: &'static str, [bidirectional, metropolis, hybrid]: [bool; 3]) -> Mode {
    Mode { name, bidirectional, metropolis, hybrid }
}

impl Mode {
    /// The scene, to be rendered in this mode. It keeps its own settings of Metropolis sampling, if it has any.
    pub fn of(&self, mut scene: Scene) -> Scene {
        let transport = &mut scene.transport;
        transport.bidirectional = self.bidirectional;
        transport.hybrid = self.hybrid;
        // The manual's default, but for the bias of a limit of rejections.
        let settings = MetropolisSettings {
            large_mutation_prob: 0.4,
            max_change: 0.01,
            max_consecutive_rejections: i64::MAX,
        };
        transport.metropolis = self.metropolis.then(|| transport.metropolis.unwrap_or(settings));
        scene
    }
}
