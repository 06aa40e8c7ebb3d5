//! What a session is told to do.

use std::time::Duration;

/// When to stop by itself, at the first of these. Without any, a session runs for ever.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Halt {
    /// After this time of rendering.
    pub time: Option<Duration>,
    /// At this number of samples per pixel of the whole picture, or more: independent samples end with a pass over
    /// what is rendered (over a whole picture, at this number exactly), Metropolis mutations with a unit of
    /// some thousands.
    pub samples_per_pixel: Option<u64>,
    /// When the picture's relative error is estimated to be no more than this; see
    /// [`Progress::relative_error`](crate::Progress::relative_error). Costs the memory of two more films.
    pub relative_error: Option<f64>,
}

/// Options of a session.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Number of worker threads; at least one is started, and no more than can be at work at once.
    pub threads: usize,
    /// Names the whole random sequence.
    pub seed: u64,
    /// When to stop.
    pub halt: Halt,
    /// Whether the picture's relative error is estimated, also where it is no reason to stop. Costs the memory of two more films,
    /// and independent samples then form a low-discrepancy sequence in each half of them only.
    pub estimates_error: bool,
    /// How often workers hand over what they have gathered.
    pub epoch: Duration,
    /// Whether sums are taken in the order of the work units, so that the film has the same bits for
    /// any number of threads. Costs memory and time.
    pub deterministic: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            threads: 1,
            seed: 0,
            halt: Halt::default(),
            estimates_error: false,
            epoch: Duration::from_secs(1),
            deterministic: false,
        }
    }
}
