//! `-n s`.

use super::scene::SceneLoader;
use super::{events, fail, key, machine};
use crate::console::Console;
use crate::interrupts::{end_in_order, is_interrupted};
use indigo_front::flags::Arguments;
use indigo_front::messages::Messages as _;
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_front::{logical_cores, paths, program};
use indigo_net::slave::{Options, Slave};
use indigo_scene::schema::settings::MOST_THREADS;
use std::sync::Arc;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

/// Time between lines of progress, on a terminal and elsewhere: the master has the picture, so a slave's log says little.
const LINES: [Duration; 2] = [Duration::from_millis(250), Duration::from_mins(1)];
/// How long Ctrl-C may go unnoticed.
const PULSE: Duration = Duration::from_millis(100);

/// Renders for masters until told to stop; the exit status.
pub fn slave(arguments: &Arguments, console: &mut Console) -> u8 {
    let key = match key(arguments, console) {
        Ok(key) => key,
        Err(status) => return status,
    };
    let setting = |name: &str| arguments.settings.iter().rev().find(|s| s.setting == name).map(|s| &*s.value);
    let threads = match setting("num_threads").map(str::parse::<usize>) {
        None => logical_cores().min(MOST_THREADS),
        Some(Ok(threads)) if (1..=MOST_THREADS).contains(&threads) => threads,
        Some(_) => {
            console.error(&format!("-t needs a whole number from 1 to {MOST_THREADS}"));
            return BAD_INPUT;
        }
    };
    let halt = match setting("halt_time").map(str::parse::<f64>) {
        None => None,
        Some(Ok(seconds)) if seconds > 0.0 => Duration::try_from_secs_f64(seconds).ok(),
        Some(_) => {
            console.error("-halt needs a number of seconds above 0");
            return BAD_INPUT;
        }
    };
    let options = Options {
        master: arguments.host.clone(),
        key,
        seed: arguments.seed,
        name: machine(),
        threads,
        program: program(),
        cache: paths::pack_cache(),
    };
    end_in_order();
    let (sink, events) = events();
    let slave = match Slave::start(options, Arc::new(SceneLoader), sink) {
        Ok(slave) => slave,
        Err(error) => return fail(&error, console),
    };
    let start = Instant::now();
    let between = LINES[usize::from(!console.is_terminal())];
    let mut last_line = Instant::now();
    while !slave.is_finished() {
        match events.recv_timeout(PULSE) {
            Ok(event) => console.event(&event),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        if last_line.elapsed() >= between
            && let Some(progress) = slave.progress()
        {
            last_line = Instant::now();
            console.progress(&progress);
        }
        if is_interrupted() || halt.is_some_and(|halt| start.elapsed() >= halt) {
            slave.stop();
        }
    }
    let ended = slave.finish();
    for event in events.try_iter() {
        console.event(&event);
    }
    match ended {
        Ok(()) => RENDERED,
        Err(message) => {
            console.error(&message);
            FAILED
        }
    }
}
