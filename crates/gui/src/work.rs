//! How a scene is rendered, as the controls have it.

use indigo_front::logical_cores;
use indigo_scene::{OutputSettings, Override, TransportSettings};
use std::time::Duration;

/// How light is transported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// From both ends.
    pub bidirectional: bool,
    /// Who chooses the paths.
    pub sampling: Sampling,
}

/// Who chooses paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// Independent samples.
    Independent,
    /// Metropolis sampling.
    Metropolis,
    /// Both: direct light by the one, the rest by the other.
    Hybrid,
}

impl Sampling {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Independent, Self::Metropolis, Self::Hybrid];
}

impl Mode {
    /// That of a scene.
    pub fn of(transport: &TransportSettings) -> Self {
        let sampling = match (transport.metropolis.is_some(), transport.hybrid) {
            (false, _) => Sampling::Independent,
            (true, false) => Sampling::Metropolis,
            (true, true) => Sampling::Hybrid,
        };
        Self { bidirectional: transport.bidirectional, sampling }
    }

    /// Settings that choose it, whatever a scene says.
    pub fn overrides(self) -> Vec<Override<'static>> {
        let value = |setting, on: bool| Override { option: "mode", setting, value: on.to_string() };
        vec![
            value("bidirectional", self.bidirectional),
            value("metropolis", self.sampling == Sampling::Metropolis),
            value("hybrid", self.sampling == Sampling::Hybrid),
        ]
    }
}

/// What can be changed while a scene is rendered, without losing what is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// Number of threads.
    pub threads: usize,
    /// Whether to stop after a time, and which, in seconds.
    pub halt_time: (bool, f64),
    /// Whether to stop at a number of samples per pixel, and which.
    pub halt_spp: (bool, u64),
    /// Whether to stop at an estimated relative error, and which, in per cent.
    pub halt_error: (bool, f64),
    /// Whether the error is estimated where it is no reason to stop.
    pub estimates_error: bool,
}

impl Work {
    /// That of a scene.
    pub fn of(output: &OutputSettings, halt_error: Option<f64>) -> Self {
        Self {
            threads: output.threads.unwrap_or_else(logical_cores),
            halt_time: (output.halt_time.is_some(), output.halt_time.unwrap_or(600.0)),
            halt_spp: (
                output.halt_samples_per_pixel.is_some(),
                output.halt_samples_per_pixel.map_or(256, |n| n.ceil() as u64),
            ),
            halt_error: (halt_error.is_some(), 100.0 * halt_error.unwrap_or(0.01)),
            estimates_error: false,
        }
    }

    /// One thread without end.
    #[cfg(test)]
    pub fn endless() -> Self {
        Self {
            threads: 1,
            halt_time: (false, 1.0),
            halt_spp: (false, 1),
            halt_error: (false, 1.0),
            estimates_error: false,
        }
    }

    /// Halts at a number of samples per pixel if nothing else would.
    pub fn halt_by(&mut self, samples: u64) {
        if !(self.halt_time.0 || self.halt_spp.0 || self.halt_error.0) {
            self.halt_spp = (true, samples);
        }
    }

    /// When to stop.
    pub fn halt(&self) -> indigo_render::Halt {
        let wanted = |(is_wanted, value): (bool, f64)| is_wanted.then_some(value);
        indigo_render::Halt {
            time: wanted(self.halt_time).and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
            samples_per_pixel: self.halt_spp.0.then_some(self.halt_spp.1),
            relative_error: wanted(self.halt_error).map(|percent| percent / 100.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_is_what_its_settings_make() {
        for bidirectional in [false, true] {
            for sampling in Sampling::ALL {
                let mode = Mode { bidirectional, sampling };
                let value =
                    |name: &str| mode.overrides().iter().any(|o| o.setting == name && o.value == "true");
                assert_eq!(value("bidirectional"), bidirectional);
                assert_eq!(value("metropolis"), sampling == Sampling::Metropolis);
                assert_eq!(value("hybrid"), sampling == Sampling::Hybrid);
            }
        }
    }

    #[test]
    fn only_wanted_conditions_halt() {
        let work =
            Work { halt_time: (true, 2.5), halt_spp: (false, 7), halt_error: (true, 3.0), ..Work::endless() };
        let halt = work.halt();
        assert_eq!(halt.time, Some(Duration::from_millis(2500)));
        assert_eq!(halt.samples_per_pixel, None);
        assert_eq!(halt.relative_error, Some(0.03));
    }
}
