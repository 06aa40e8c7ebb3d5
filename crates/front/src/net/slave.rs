//! A slave: renders what masters give it.

use super::key::key;
use super::scene::SceneLoader;
use super::{events, fail, machine};
use crate::flags::Arguments;
use crate::messages::Messages;
use crate::status::{BAD_INPUT, FAILED, RENDERED};
use crate::{logical_cores, paths, program};
use indigo_net::event::Event;
use indigo_net::slave::{Options, Slave};
use indigo_render::Progress;
use indigo_scene::schema::settings::MOST_THREADS;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

/// A slave at work.
pub struct SlaveRender {
    slave: Slave,
    events: Receiver<Event>,
    halt: Option<Duration>,
    started: Instant,
}

impl SlaveRender {
    /// Starts to render for masters.
    ///
    /// # Errors
    /// The exit status where that cannot be; the reason was told.
    pub fn start(arguments: &Arguments, messages: &mut dyn Messages) -> Result<Self, u8> {
        let key = key(arguments, messages)?;
        let (threads, halt) =
            threads(arguments).and_then(|n| Ok((n, halt(arguments)?))).map_err(|wrong| {
                messages.error(&wrong);
                BAD_INPUT
            })?;
        let options = Options {
            master: arguments.host.clone(),
            key,
            seed: arguments.seed,
            name: machine(),
            threads,
            program: program(),
            cache: paths::pack_cache(),
        };
        let (sink, events) = events();
        let slave =
            Slave::start(options, Arc::new(SceneLoader), sink).map_err(|error| fail(&error, messages))?;
        Ok(Self { slave, events, halt, started: Instant::now() })
    }

    /// Works for so long; whether it goes on.
    pub fn step(&mut self, time: Duration, messages: &mut dyn Messages) -> bool {
        match self.events.recv_timeout(time) {
            Ok(event) => messages.event(&event),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return false,
        }
        if self.halt.is_some_and(|halt| self.started.elapsed() >= halt) {
            self.stop();
        }
        !self.slave.is_finished()
    }

    /// How far it is with the scene that it renders, if any.
    pub fn progress(&self) -> Option<Progress> {
        self.slave.progress()
    }

    /// Asks it to send what it has, and to end.
    pub fn stop(&self) {
        self.slave.stop();
    }

    /// Waits for the end; the exit status.
    pub fn finish(self, messages: &mut dyn Messages) -> u8 {
        let ended = self.slave.finish();
        for event in self.events.try_iter() {
            messages.event(&event);
        }
        match ended {
            Ok(()) => RENDERED,
            Err(message) => {
                messages.error(&message);
                FAILED
            }
        }
    }
}

/// What the command line says of a setting.
fn setting<'a>(arguments: &'a Arguments, name: &str) -> Option<&'a str> {
    arguments.settings.iter().rev().find(|setting| setting.setting == name).map(|setting| &*setting.value)
}

fn threads(arguments: &Arguments) -> Result<usize, String> {
    let Some(text) = setting(arguments, "num_threads") else { return Ok(logical_cores().min(MOST_THREADS)) };
    let threads = text.parse().ok().filter(|threads| (1..=MOST_THREADS).contains(threads));
    threads.ok_or_else(|| format!("-t needs a whole number from 1 to {MOST_THREADS}"))
}

fn halt(arguments: &Arguments) -> Result<Option<Duration>, String> {
    let Some(text) = setting(arguments, "halt_time") else { return Ok(None) };
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0);
    // More than can be said is for ever.
    seconds
        .map(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "-halt needs a number of seconds above 0".to_owned())
}
