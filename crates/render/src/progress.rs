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
    /// or [`Options::estimates_error`](crate::Options::estimates_error) asks for it: the root mean square, over the pixels, of
    /// the luminance's error, over the mean luminance. None while no light has been found; 0 where the scene has none.
    pub relative_error: Option<f64>,
}

/// Measures a rate over a sliding window, so that it follows changes of load but does not flicker.
#[derive(Debug, Default)]
pub(crate) struct RateMeter {
    points: std::collections::VecDeque<(Duration, u64)>,
}

impl RateMeter {
    const WINDOW: Duration = Duration::from_secs(5);
    /// Points are no closer than this, so that the window holds a few hundred, however often and for how long a session is
    /// asked whose clock stands still.
    const GAP: Duration = Duration::from_millis(10);

    /// Takes a reading of a counter and gives its rate per second.
    pub(crate) fn update(&mut self, at: Duration, count: u64) -> f64 {
        let n = self.points.len();
        if n >= 2 && self.points[n - 1].0.saturating_sub(self.points[n - 2].0) < Self::GAP {
            self.points.pop_back();
        }
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

    /// A session that rests is asked on and on.
    #[test]
    fn readings_at_one_time_take_no_memory() {
        let mut meter = RateMeter::default();
        meter.update(Duration::from_secs(9), 0);
        meter.update(Duration::from_secs(10), 500);
        // Its clock is not quite still.
        let at = |n: u64| Duration::from_secs(10) + Duration::from_nanos(n % 1000);
        let rates: Vec<f64> = (0..100_000).map(|n| meter.update(at(n), 500)).collect();
        assert!(meter.points.len() < 10, "{}", meter.points.len());
        assert!(rates.iter().all(|rate| (rate - 500.0).abs() < 0.01), "the same as before");
        for ms in 0..100_000 {
            meter.update(Duration::from_secs(11) + Duration::from_millis(ms), ms);
        }
        assert!(meter.points.len() <= 502, "{}", meter.points.len());
    }

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
