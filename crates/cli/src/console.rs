//! What the user sees: messages, and a progress line that renews itself on a terminal.

use indigo_render::Progress;
use std::fs::{File, OpenOptions};
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::time::Duration;

/// Standard error, and a log file if one is wanted.
pub struct Console {
    log: Option<File>,
    terminal: bool,
    /// Length of the progress line on the terminal, to be wiped before anything else is written.
    line: usize,
}

impl Console {
    /// A console without a log.
    pub fn new() -> Self {
        Self { log: None, terminal: std::io::stderr().is_terminal(), line: 0 }
    }

    /// Whether messages may be coloured.
    pub fn is_coloured(&self) -> bool {
        self.terminal && std::env::var_os("NO_COLOR").is_none()
    }

    /// Whether a progress line can renew itself.
    pub fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// From now on writes everything to a file, too; a file that cannot be written costs a warning.
    pub fn log_to(&mut self, path: &Path) {
        match OpenOptions::new().create(true).append(true).open(path) {
            Ok(file) => self.log = Some(file),
            Err(error) => self.say(&format!("warning: no log is kept: {}: {error}", path.display())),
        }
    }

    /// Writes a message of one or more lines.
    pub fn say(&mut self, message: &str) {
        self.wipe();
        // Nobody is left to be told if standard error or the log fails.
        drop(writeln!(std::io::stderr(), "{message}"));
        if let Some(log) = &mut self.log {
            drop(writeln!(log, "{}", without_escapes(message)));
        }
    }

    /// Writes what was asked for to standard output; whether it arrived there. If not, says so.
    pub fn answer(&mut self, text: &str) -> bool {
        let mut out = std::io::stdout().lock();
        match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
            Ok(()) => true,
            Err(error) => {
                self.say(&format!("error: cannot write to standard output: {error}"));
                false
            }
        }
    }

    /// Renews the progress line on a terminal; a line of its own elsewhere.
    pub fn progress(&mut self, text: &str) {
        if !self.terminal {
            self.say(text);
            return;
        }
        let padding = " ".repeat(self.line.saturating_sub(text.chars().count()));
        self.line = text.chars().count();
        let mut out = std::io::stderr();
        drop(write!(out, "\r{text}{padding}").and_then(|()| out.flush()));
    }

    fn wipe(&mut self) {
        if self.line > 0 {
            drop(write!(std::io::stderr(), "\r{}\r", " ".repeat(self.line)));
            self.line = 0;
        }
    }
}

/// A message without colour codes.
fn without_escapes(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut chars = text.chars();
    while let Some(c) = chars.next() {
        if c == '\x1b' {
            // A colour code ends with its first letter.
            for c in chars.by_ref() {
                if c.is_ascii_alphabetic() {
                    break;
                }
            }
        } else {
            out.push(c);
        }
    }
    out
}

/// A progress line: " 12.5%   8.0 spp   1.23 M samples/s   0:12 elapsed   0:44 left".
pub fn progress_text(p: &Progress) -> String {
    let mut parts = vec![];
    if let Some(fraction) = p.fraction {
        parts.push(format!("{:5.1}%", fraction * 100.0));
    }
    parts.push(format!("{:.1} spp", p.samples_per_pixel));
    parts.push(format!("{} samples/s", scaled(p.samples_per_second)));
    parts.push(format!("{} elapsed", clock(p.elapsed)));
    if let Some(error) = p.relative_error {
        parts.push(format!("error {:.2}%", 100.0 * error));
    }
    if let Some(left) = p.left {
        parts.push(format!("{} left", clock(left)));
    }
    parts.join("   ")
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

    #[test]
    fn the_line_names_what_is_known() {
        let p = Progress {
            samples: 10,
            samples_per_pixel: 8.0,
            samples_per_second: 1.234e6,
            elapsed: Duration::from_secs(12),
            left: Some(Duration::from_secs(44)),
            fraction: Some(0.125),
            relative_error: None,
        };
        assert_eq!(progress_text(&p), " 12.5%   8.0 spp   1.23 M samples/s   0:12 elapsed   0:44 left");
        let rough = Progress { relative_error: Some(0.0312), ..p };
        assert!(progress_text(&rough).contains("elapsed   error 3.12%   0:44 left"));
        let endless = Progress { left: None, fraction: None, ..p };
        assert_eq!(progress_text(&endless), "8.0 spp   1.23 M samples/s   0:12 elapsed");
    }

    #[test]
    fn the_log_has_no_colours() {
        assert_eq!(without_escapes("\x1b[1;31merror\x1b[0m: x"), "error: x");
    }
}
