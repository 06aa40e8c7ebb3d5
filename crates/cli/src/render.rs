//! Rendering a scene until it is done, saving on the way.

use crate::console::Console;
use indigo_film::SavedFilm;
use indigo_front::flags::Arguments;
use indigo_front::messages::{Messages as _, say_saved};
use indigo_front::prepare::{Prepared, describe_film, fail, prepare};
use indigo_front::saver::Saver;
use indigo_front::status::{FAILED, RENDERED};
use indigo_render::output::SaveJob;
use indigo_render::{Event, HaltReason, Progress, Session};
use indigo_scene::{OutputSettings, Scene};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// How often Ctrl-C was pressed.
static INTERRUPTS: AtomicUsize = AtomicUsize::new(0);

/// How often the progress line is renewed on a terminal, where it costs no room. Elsewhere the setting
/// `display_period` decides how often a line is written.
const ON_TERMINAL: Duration = Duration::from_millis(250);
/// The least time between lines of progress elsewhere, however small the setting: ten a second say all that can be read, and
/// a log is not flooded.
const LEAST_BETWEEN_LINES: Duration = Duration::from_millis(100);

/// Renders a scene; the exit status.
///
/// `saved` is the film to go on with, if any; `named` is the picture's path, if the user has given one; `read` are the files
/// that the scene was read from.
pub fn render(
    scene: Scene,
    read: &[PathBuf],
    arguments: &Arguments,
    saved: Option<SavedFilm>,
    named: Option<PathBuf>,
    console: &mut Console,
) -> u8 {
    let prepared = match prepare(Arc::new(scene), read, arguments, saved.as_ref(), named, console) {
        Ok(prepared) => prepared,
        Err(status) => return status,
    };
    catch_interrupts(console);
    let Prepared { scene, options, job, .. } = &prepared;
    let session = match &saved {
        Some(saved) => Session::go_on(Arc::clone(scene), options, saved),
        None => Session::start(Arc::clone(scene), options),
    };
    match session {
        Ok(session) => {
            describe_film(arguments.resume.as_deref(), saved.as_ref(), console);
            // The session has a copy.
            drop(saved);
            follow(session, job, console)
        }
        Err(error) => fail(&error, console),
    }
}

/// Whether Ctrl-C was pressed.
pub fn is_interrupted() -> bool {
    INTERRUPTS.load(Ordering::Relaxed) > 0
}

/// The first Ctrl-C ends the render in good order, the second one leaves at once.
pub fn catch_interrupts(console: &mut Console) {
    #[expect(clippy::disallowed_methods, reason = "the second Ctrl-C asks for just that")]
    let leave = || std::process::exit(130);
    let caught = ctrlc::set_handler(move || {
        if INTERRUPTS.fetch_add(1, Ordering::Relaxed) > 0 {
            leave();
        }
    });
    if let Err(error) = caught {
        console.warn(&format!("Ctrl-C will not save the picture: {error}"));
    }
}

/// Time between lines of progress.
pub fn between_lines(output: &OutputSettings, console: &Console) -> Duration {
    if console.is_terminal() {
        ON_TERMINAL
    } else {
        Duration::try_from_secs_f64(output.display_period).unwrap_or(Duration::MAX).max(LEAST_BETWEEN_LINES)
    }
}

/// Follows a session to its end; the exit status.
fn follow(mut session: Session, job: &SaveJob, console: &mut Console) -> u8 {
    let output = &job.development.output;
    let mut saver = Saver::new(job.clone());
    let mut last_line: Option<Instant> = None;
    let between = between_lines(output, console);
    loop {
        match session.wait(ON_TERMINAL.min(between).min(saver.until_due())) {
            Event::Progress(progress) => {
                if last_line.is_none_or(|t| t.elapsed() >= between) {
                    console.progress(&progress);
                    last_line = Some(Instant::now());
                }
                saver.tend(|| session.saved(&job.version), console);
                if is_interrupted() {
                    session.stop();
                }
            }
            Event::Halted(reason, progress) => return finish(&session, &reason, &progress, saver, console),
        }
    }
}

fn finish(
    session: &Session,
    reason: &HaltReason,
    progress: &Progress,
    mut saver: Saver,
    console: &mut Console,
) -> u8 {
    saver.wait_for_last(console);
    console.last_progress(progress);
    if let HaltReason::Failed(message) = reason {
        console.error(message);
    }
    let saved = session.saved(&saver.job().version);
    if saved.film.refused > 0 {
        console.warn(&format!(
            "{} contributions were not finite and were left out: this is a bug, please report it",
            saved.film.refused
        ));
    }
    let start = Instant::now();
    let is_saved = say_saved(&saver.job().save(&saved), console);
    console.detail(&format!("Developed and saved in {:.2} s", start.elapsed().as_secs_f64()));
    if is_saved && !matches!(reason, HaltReason::Failed(_)) { RENDERED } else { FAILED }
}
