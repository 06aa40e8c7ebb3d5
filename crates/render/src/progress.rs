//! How far a session is.

use std::time::Duration;

/// A session's progress at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Samples of the film: those of this session, and those that it went on with.
    pub samples: u64,
    /// Samples per output pixel.
    pub samples_per_pixel: f64,
    /// Samples per second over the last few seconds.
    pub samples_per_second: f64,
    /// Rays traced in this session, between vertices of paths and to see whether one sees another.
    pub rays: u64,
    /// Time spent rendering, pauses left out.
    pub elapsed: Duration,
    /// Time until the halting condition, if there is one.
    pub left: Option<Duration>,
    /// Fraction of the work until the halting condition, if there is one.
    pub fraction: Option<f64>,
    /// The last estimate of the picture's relative error, where [`Halt::relative_error`](crate::Halt::relative_error)
    /// asks for it: the root mean square, over the pixels, of the luminance's error, over the mean luminance.
    pub relative_error: Option<f64>,
}

/// Measures a rate over a sliding window, so that it follows changes of load but does not flicker.
#[derive(Debug, Default)]
pub(crate) struct RateMeter {
    points: std::collections::VecDeque<(Duration, u64)>,
}

impl RateMeter {
    const WINDOW: Duration = Duration::from_secs(5);

    /// Takes a reading of a counter and gives its rate per second.
    pub(crate) fn update(&mut self, at: Duration, count: u64) -> f64 {
        self.points.push_back((at, count));
        while self.points.len() > 2 && at.saturating_sub(self.points[1].0) >= Self::WINDOW {
            self.points.pop_front();
        }
        let (first_at, first_count) = self.points[0];
        let seconds = at.saturating_sub(first_at).as_secs_f64();
        if seconds > 0.0 {
            (count - first_count) as f64 / seconds
        } else if at > Duration::ZERO {
            count as f64 / at.as_secs_f64()
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_follows_the_last_seconds() {
        let mut meter = RateMeter::default();
        for s in 0..10u64 {
            meter.update(Duration::from_secs(s), s * 100);
        }
        let mut rate = 0.0;
        for s in 10..20u64 {
            rate = meter.update(Duration::from_secs(s), 900 + (s - 9) * 300);
        }
        assert!((rate - 300.0).abs() < 1e-9, "{rate}");
    }
}
