//! Rendering a scene until it is done, saving on the way.

use crate::console::Console;
use crate::interrupts::{end_in_order, is_interrupted};
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
use std::time::{Duration, Instant};

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
    end_in_order();
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

/// Says why a render has ended.
pub fn say_why(reason: &HaltReason, progress: &Progress, console: &mut Console) {
    let spp = progress.samples_per_pixel;
    match reason {
        HaltReason::Samples => {
            console.say(&format!("Halted with the samples per pixel that were asked for: {spp:.2}"));
        }
        HaltReason::Time => {
            let seconds = progress.elapsed.as_secs_f64();
            console.say(&format!("Halted after the time that was asked for: {seconds:.1} s"));
        }
        HaltReason::Error => {
            let error = 100.0 * progress.relative_error.unwrap_or_default();
            console.say(&format!("Halted with the estimated error that was asked for: {error:.2}%"));
        }
        // Whether it is then is told behind it.
        HaltReason::Stopped => console.say("Interrupted: saving what was rendered"),
        HaltReason::Failed(message) => console.error(message),
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
    say_why(reason, progress, console);
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
