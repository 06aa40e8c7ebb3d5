//! What the user sees: messages, and a progress line that renews itself on a terminal; and the logs that keep it.

use indigo_diag::{Diagnostic, Severity, SourceMap, Style, quoted, shown, to_json, to_text};
use indigo_front::messages::{Messages, Verbosity, clock, scaled};
use indigo_front::paths::utc;
use indigo_net::event::{Event, Field, Weight};
use indigo_render::Progress;
use std::fs::{File, OpenOptions};
use std::io::{IsTerminal, Read as _, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// Time between lines of progress in logs, while a terminal has its line renewed several times a second.
const BETWEEN_LOGGED: Duration = Duration::from_secs(10);

/// What a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Error,
    Warning,
    Info,
    Detail,
}

impl Level {
    const fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Info => "info",
            Self::Detail => "detail",
        }
    }

    const fn least(self) -> Verbosity {
        match self {
            Self::Error | Self::Warning => Verbosity::Quiet,
            Self::Info => Verbosity::Usual,
            Self::Detail => Verbosity::Verbose,
        }
    }
}

/// Standard error, and log files if they are wanted.
pub struct Console {
    verbosity: Verbosity,
    /// The log in plain text.
    log: Option<Log>,
    /// The log as a line of JSON for each message.
    json_log: Option<Log>,
    /// Whether errors and warnings are written to standard output as a line of JSON each.
    json: bool,
    terminal: bool,
    /// When the logs last had a line of progress.
    last_logged: Option<Instant>,
    /// Length of the progress line on the terminal, to be wiped before anything else is written.
    line: usize,
}

impl Console {
    /// A console without logs.
    pub fn new(verbosity: Verbosity) -> Self {
        let terminal = std::io::stderr().is_terminal();
        Self { verbosity, log: None, json_log: None, json: false, terminal, last_logged: None, line: 0 }
    }

    /// The same for programs: errors and warnings are written to standard output, too, as a line of JSON each.
    pub fn with_json(self, json: bool) -> Self {
        Self { json, ..self }
    }

    /// Whether a progress line can renew itself.
    pub fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// From now on writes everything to a file, too; a file that cannot be written costs a warning.
    pub fn log_to(&mut self, path: &Path) {
        match OpenOptions::new().create(true).append(true).open(path) {
            Ok(file) => self.log = Some(Log::new(path, file)),
            Err(error) => self.warn(&format!("no log is kept: {}: {error}", path.display())),
        }
    }

    /// From now on writes everything to a file as a line of JSON each, too.
    ///
    /// # Errors
    /// What the system says: whoever asks for such a log wants to read it. And where something else is there, a key or a scene,
    /// to which nothing may be appended.
    pub fn log_json_to(&mut self, path: &Path) -> std::io::Result<()> {
        if !may_be_json_log(path)? {
            return Err(std::io::Error::other(
                "this is another file, and no log to append to; give another name",
            ));
        }
        self.json_log = Some(Log::new(path, OpenOptions::new().create(true).append(true).open(path)?));
        Ok(())
    }

    /// Says what was found in a file.
    pub fn diagnose(&mut self, diagnostic: &Diagnostic, sources: &SourceMap) {
        let is_coloured = self.terminal && std::env::var_os("NO_COLOR").is_none();
        let style = if is_coloured { Style::Colour } else { Style::Plain };
        let level = match diagnostic.severity {
            Severity::Error => Level::Error,
            Severity::Warning => Level::Warning,
            Severity::Note => Level::Info,
        };
        let fields = match self.json_log {
            Some(_) => format!(",\"diagnostic\":{}", to_json(diagnostic, sources)),
            None => String::new(),
        };
        let text = to_text(diagnostic, sources, style);
        self.write(level, text.trim_end(), &diagnostic.message, &fields);
    }

    /// Leaves what was found in a file to the logs alone.
    pub fn log_diagnostic(&mut self, diagnostic: &Diagnostic, sources: &SourceMap) {
        let verbosity = std::mem::replace(&mut self.verbosity, Verbosity::Silent);
        self.diagnose(diagnostic, sources);
        self.verbosity = verbosity;
    }

    /// Writes a message, in which there may be names of whatever files.
    fn tell(&mut self, level: Level, message: &str, fields: &str) {
        let word = match level {
            Level::Error => "error: ",
            Level::Warning => "warning: ",
            Level::Info | Level::Detail => "",
        };
        self.write(level, &format!("{word}{}", shown(message)), message, fields);
    }

    /// Writes a message of one or more lines, which a terminal may have as they are; the logs have what the console passes over. `fields` are more of a line
    /// of JSON, each behind a comma.
    fn write(&mut self, level: Level, text: &str, message: &str, fields: &str) {
        // Nobody is left to be told if standard error fails.
        if level.least() <= self.verbosity {
            self.wipe();
            drop(writeln!(std::io::stderr(), "{text}"));
        }
        if level.least() <= self.verbosity.max(Verbosity::Usual) {
            self.write_log(text);
        }
        self.write_json(level.name(), message, fields);
    }

    fn write_log(&mut self, text: &str) {
        let failure = self.log.as_mut().and_then(|log| log.write(&without_escapes(text)));
        self.tell_failure(failure);
    }

    fn write_json(&mut self, level: &str, message: &str, fields: &str) {
        let failure = self.json_log.as_mut().and_then(|log| {
            let time = utc(SystemTime::now());
            let message = quoted(message);
            log.write(&format!(
                "{START_OF_LINE}{time}\",\"level\":\"{level}\",\"message\":{message}{fields}}}"
            ))
        });
        self.tell_failure(failure);
    }

    /// Says what is wrong with a log, which it tells but once.
    fn tell_failure(&mut self, failure: Option<String>) {
        if let Some(failure) = failure {
            self.warn(&failure);
        }
    }

    /// Writes what was asked for to standard output; whether it arrived there. If not, says so.
    pub fn answer(&mut self, text: &str) -> bool {
        let mut out = std::io::stdout().lock();
        match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
            Ok(()) => true,
            Err(error) => {
                self.error(&format!("cannot write to standard output: {error}"));
                false
            }
        }
    }

    /// Renews the progress line on a terminal; a line of its own elsewhere.
    pub fn progress(&mut self, progress: &Progress) {
        self.progress_of(progress, "");
    }

    /// The same with something more to say at the end of the line.
    pub fn progress_of(&mut self, progress: &Progress, more: &str) {
        let text = progress_text(progress) + more;
        if self.verbosity <= Verbosity::Quiet {
        } else if self.terminal {
            let padding = " ".repeat(self.line.saturating_sub(text.chars().count()));
            self.line = text.chars().count();
            let mut out = std::io::stderr();
            drop(write!(out, "\r{text}{padding}").and_then(|()| out.flush()));
        } else {
            drop(writeln!(std::io::stderr(), "{text}"));
        }
        let is_due = |last: Instant| !self.terminal || last.elapsed() >= BETWEEN_LOGGED;
        if self.last_logged.is_none_or(is_due) {
            self.log_progress(progress, &text);
        }
    }

    /// The progress at the end of a render, which stays on the terminal.
    pub fn last_progress(&mut self, progress: &Progress) {
        let text = progress_text(progress);
        self.wipe();
        if self.verbosity > Verbosity::Quiet {
            drop(writeln!(std::io::stderr(), "{text}"));
        }
        self.log_progress(progress, &text);
    }

    fn log_progress(&mut self, p: &Progress, text: &str) {
        self.last_logged = Some(Instant::now());
        self.write_log(text);
        let error = p.relative_error.map(|e| format!(",\"relative_error\":{e}")).unwrap_or_default();
        let fields = format!(
            ",\"samples\":{},\"samples_per_pixel\":{},\"samples_per_second\":{},\"elapsed_s\":{}{error}",
            p.samples,
            p.samples_per_pixel,
            p.samples_per_second,
            p.elapsed.as_secs_f64(),
        );
        self.write_json("progress", text, &fields);
    }

    /// What went wrong beside what was found in a scene, for programs.
    fn write_for_programs(&mut self, diagnostic: &Diagnostic) {
        if self.json {
            // Nobody is left to be told if that fails.
            drop(writeln!(std::io::stdout(), "{}", to_json(diagnostic, &SourceMap::default())));
        }
    }

    fn wipe(&mut self) {
        if self.line > 0 {
            drop(write!(std::io::stderr(), "\r{}\r", " ".repeat(self.line)));
            self.line = 0;
        }
    }
}

impl Messages for Console {
    fn error(&mut self, message: &str) {
        self.write_for_programs(&Diagnostic::error("", None, message));
        self.tell(Level::Error, message, "");
    }

    fn warn(&mut self, message: &str) {
        self.write_for_programs(&Diagnostic::warning("", None, message));
        self.tell(Level::Warning, message, "");
    }

    fn say(&mut self, message: &str) {
        self.tell(Level::Info, message, "");
    }

    fn detail(&mut self, message: &str) {
        self.tell(Level::Detail, message, "");
    }

    fn event(&mut self, event: &Event) {
        let message = event.to_string();
        let values = event.fields().into_iter().map(|(name, value)| match value {
            Field::Text(text) => format!(",\"{name}\":{}", quoted(&text)),
            Field::Number(number) => format!(",\"{name}\":{number}"),
        });
        let fields = format!(",\"event\":\"{}\"{}", event.kind(), values.collect::<String>());
        let level = match event.weight() {
            Weight::Detail => Level::Detail,
            Weight::Info => Level::Info,
            Weight::Warning => Level::Warning,
        };
        self.tell(level, &message, &fields);
    }
}

/// A file that lines are appended to.
struct Log {
    path: PathBuf,
    file: File,
    /// Whether it was told that lines do not reach it.
    has_failed: bool,
    /// Whether the last line may have reached it in part.
    is_torn: bool,
}

impl Log {
    fn new(path: &Path, file: File) -> Self {
        Self { path: path.to_path_buf(), file, has_failed: false, is_torn: false }
    }

    /// Appends a text as lines of their own; what is to be said where that fails for the first time. It is tried again with the
    /// next: a full disk may have room later.
    fn write(&mut self, text: &str) -> Option<String> {
        let start = if self.is_torn { "\n" } else { "" };
        // In one piece: others may append to the same file.
        let written = self.file.write_all(format!("{start}{text}\n").as_bytes());
        self.is_torn = written.is_err();
        let is_first = !self.has_failed;
        self.has_failed |= self.is_torn;
        let error = written.err().filter(|_| is_first)?;
        Some(format!("the log lacks lines from now on: {}: {error}", self.path.display()))
    }
}

/// How each line of such a log begins.
const START_OF_LINE: &str = "{\"time\":\"";

/// Whether what is there is nothing yet, a log as this one writes it, or no file that keeps anything.
fn may_be_json_log(path: &Path) -> std::io::Result<bool> {
    if !std::fs::metadata(path).is_ok_and(|meta| meta.is_file()) {
        return Ok(true);
    }
    let mut start = vec![];
    let length = File::open(path)?.take(64).read_to_end(&mut start)?;
    // A line that did not reach it leaves its end.
    let is_line = start.trim_ascii_start().starts_with(START_OF_LINE.as_bytes());
    Ok(length == 0 || is_line)
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
fn progress_text(p: &Progress) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

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
            rays: 0,
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
