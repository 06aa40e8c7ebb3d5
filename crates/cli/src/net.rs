//! Rendering on many machines, from the command line.

use crate::console::Console;
use crate::interrupts::{end_in_order, is_interrupted};
use crate::render::{between_lines, say_why};
use indigo_film::SavedFilm;
use indigo_front::flags::Arguments;
use indigo_front::messages::Messages as _;
use indigo_front::net::master::{Gathered, MasterRender, get_ready};
use indigo_front::net::slave::SlaveRender;
use indigo_front::prepare::say_missing_folder;
use indigo_front::status::{FAILED, RENDERED};
use indigo_render::{HaltReason, Progress};
use indigo_scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long Ctrl-C may go unnoticed.
const PULSE: Duration = Duration::from_millis(50);
/// Time between a slave's lines of progress, on a terminal and elsewhere: the master has the picture, so a slave's log says
/// little.
const LINES_OF_SLAVES: [Duration; 2] = [Duration::from_millis(250), Duration::from_mins(1)];

/// Makes a key; the exit status.
pub fn make_key(path: &Path, console: &mut Console) -> u8 {
    say_missing_folder(path, console);
    match indigo_front::net::make_key(path) {
        Ok(()) => {
            console.say(&format!(
                "Saved {0}: copy it to all machines of the render by a way that nobody else sees, and give it to master and \
                 slaves by --key-file {0}",
                in_shell(path)
            ));
            RENDERED
        }
        Err(message) => {
            console.error(&message);
            FAILED
        }
    }
}

/// A path as it can be copied into a shell.
fn in_shell(path: &Path) -> String {
    let path = path.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/:._-+,@".contains(c) || cfg!(windows) && c == '\\';
    if path.chars().all(is_plain) {
        path
    } else if cfg!(windows) {
        format!("\"{path}\"")
    } else {
        // Within such quotes nothing has a meaning but their end.
        format!("'{}'", path.replace('\'', r"'\''"))
    }
}

/// Adds up what slaves render until told to stop; the exit status. See [`render`](crate::render::render).
pub fn master(
    scene: Scene,
    read: &[PathBuf],
    arguments: &Arguments,
    saved: Option<SavedFilm>,
    named: Option<PathBuf>,
    console: &mut Console,
) -> u8 {
    let ready = get_ready(Arc::new(scene), read, arguments, saved.as_ref(), named, console);
    let started = ready.and_then(|ready| {
        end_in_order();
        ready.start(arguments, saved, console)
    });
    match started {
        Ok(render) => follow(render, console),
        Err(status) => status,
    }
}

/// Until it is to end; the exit status.
fn follow(mut render: MasterRender, console: &mut Console) -> u8 {
    let between = between_lines(&render.job().development.output, console);
    let mut last_line: Option<Instant> = None;
    loop {
        let progress = render.step(PULSE.min(between), console);
        if last_line.is_none_or(|t| t.elapsed() >= between) {
            last_line = Some(Instant::now());
            console.progress_of(&progress, &format!("   {}", render.company()));
        }
        let reason = render.why_end().or_else(|| is_interrupted().then_some(HaltReason::Stopped));
        let Some(reason) = reason else { continue };
        let gathered = gather(render, &reason, console);
        if !gathered.lacks_samples || is_interrupted() {
            return finish(gathered, &reason, progress.elapsed, console);
        }
        // Nobody's word ends a render that has not what was asked for.
        render = match gathered.go_on(console) {
            Ok(render) => render,
            Err(gathered) => {
                gathered.save(console);
                return FAILED;
            }
        };
    }
}

/// Gathers the last of what there is.
fn gather(mut render: MasterRender, reason: &HaltReason, console: &mut Console) -> Gathered {
    if let Some(slaves) = render.begin_end(console) {
        console.say(&format!(
            "Waiting for the last of {slaves}; Ctrl-C again ends at once, and saves nothing more"
        ));
    }
    render.gather(reason, console)
}

/// Saves what was gathered; the exit status.
fn finish(gathered: Gathered, reason: &HaltReason, elapsed: Duration, console: &mut Console) -> u8 {
    console.last_progress(&gathered.progress);
    if !gathered.lacks_samples {
        // The last of the slaves' samples are counted, and the time that they took to come is not.
        say_why(reason, &Progress { elapsed, ..gathered.progress }, console);
    }
    let (_, is_saved) = gathered.save(console);
    if is_saved && !matches!(reason, HaltReason::Failed(_)) { RENDERED } else { FAILED }
}

/// Renders for masters until told to stop; the exit status.
pub fn slave(arguments: &Arguments, console: &mut Console) -> u8 {
    end_in_order();
    let mut slave = match SlaveRender::start(arguments, console) {
        Ok(slave) => slave,
        Err(status) => return status,
    };
    let between = LINES_OF_SLAVES[usize::from(!console.is_terminal())];
    let mut last_line = Instant::now();
    while slave.step(PULSE, console) {
        if last_line.elapsed() >= between
            && let Some(progress) = slave.progress()
        {
            last_line = Instant::now();
            console.progress(&progress);
        }
        if is_interrupted() {
            slave.stop();
        }
    }
    slave.finish(console)
}
