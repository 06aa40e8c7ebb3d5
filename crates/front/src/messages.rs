//! What is said to the user, whatever shows it; and numbers in words.

use indigo_net::event::Event;
use indigo_render::output::Saved;
use std::time::Duration;

/// How much is said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verbosity {
    /// Nothing: what is said goes to the logs alone.
    Silent,
    /// Warnings and errors.
    Quiet,
    /// Also what is done, and how far it is.
    #[default]
    Usual,
    /// Also what takes time.
    Verbose,
}

/// Where messages go: a terminal, or the log of a window.
pub trait Messages {
    /// Says what went wrong.
    fn error(&mut self, message: &str);
    /// Says what the user should know.
    fn warn(&mut self, message: &str);
    /// Says what is done.
    fn say(&mut self, message: &str);
    /// Says what takes time, to those who want to know.
    fn detail(&mut self, message: &str);
    /// Tells of something that has happened in a network render.
    fn event(&mut self, event: &Event);
}

/// Names the files that were written and those that were not; whether all were.
pub fn say_saved(saved: &Saved, messages: &mut dyn Messages) -> bool {
    for file in &saved.written {
        messages.say(&format!("Saved {}", file.display()));
    }
    for file in &saved.kept {
        messages.say(&format!("{} stays as it was: there are no samples to take its place", file.display()));
    }
    for error in &saved.failures {
        messages.error(&error.to_string());
    }
    saved.failures.is_empty()
}

/// "1 error", "2 errors".
pub fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// A number with three digits and a prefix: 1.23 M.
pub fn scaled(v: f64) -> String {
    match v {
        v if v >= 1e9 => format!("{:.2} G", v / 1e9),
        v if v >= 1e6 => format!("{:.2} M", v / 1e6),
        v if v >= 1e3 => format!("{:.1} k", v / 1e3),
        v => format!("{v:.0}"),
    }
}

/// A time as m:ss, h:mm:ss or days.
pub fn clock(t: Duration) -> String {
    let s = t.as_secs();
    let (d, h, m, s) = (s / 86_400, s / 3600 % 24, s / 60 % 60, s % 60);
    if d > 0 {
        format!("{d}d {h}:{m:02}:{s:02}")
    } else if h > 0 {
        format!("{h}:{m:02}:{s:02}")
    } else {
        format!("{m}:{s:02}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_rates_read_well() {
        assert_eq!(clock(Duration::from_secs(5)), "0:05");
        assert_eq!(clock(Duration::from_secs(3_725)), "1:02:05");
        assert_eq!(clock(Duration::from_secs(200_000)), "2d 7:33:20");
        assert_eq!(
            (scaled(12.4), scaled(1234.0), scaled(2.5e6)),
            ("12".into(), "1.2 k".into(), "2.50 M".into())
        );
    }
}
