//! The slave: fetches a scene, renders it, and sends what it has rendered, until told to stop.

pub(crate) mod calls;
mod connect;
mod engine;
pub(crate) mod fetch;
mod load;
mod parcels;
mod parting;
mod reach;
pub(crate) mod visit;
mod work;

pub use connect::{Connector, host_and_port, written};
pub use fetch::SceneFiles;

use crate::NetError;
use crate::event::{Event, Sink};
use crate::key::Key;
use calls::Outcome;
use indigo_render::Progress;
use indigo_scene::Scene;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tokio::sync::watch;
use visit::Life;

/// The time until the next try after a first failure, and the longest.
const FIRST_PAUSE: Duration = Duration::from_secs(1);
const LONGEST_PAUSE: Duration = Duration::from_secs(10);
/// The time until a master that has refused is asked again: somebody must do something first.
const AFTER_REFUSAL: Duration = Duration::from_secs(30);
/// Rendering goes on for so long while there is no master: longer than one takes to be started anew.
const ALONE: Duration = Duration::from_mins(10);

/// What a slave is told to do.
#[derive(Clone)]
pub struct Options {
    /// Host and port of the master; without them one is looked for in the local network.
    pub master: Option<(String, u16)>,
    /// The shared key; without one only masters on this machine are joined.
    pub key: Option<Key>,
    /// The random sequence to render; without one, one that nobody else has.
    pub seed: Option<u64>,
    /// What people call this machine.
    pub name: String,
    /// Threads that render.
    pub threads: usize,
    /// Name, version and platform of the program.
    pub program: String,
    /// The folder that keeps packed scenes.
    pub cache: PathBuf,
}

/// Loads scenes: that takes a disk and folders of its own, which the front end knows.
pub trait Loader: Send + Sync {
    /// Loads a packed scene with the settings of its master.
    ///
    /// # Errors
    /// Why there is none, in words.
    fn load(&self, files: &SceneFiles) -> Result<Scene, String>;
}

/// A running slave. Dropping it stops it.
pub struct Slave {
    stop: watch::Sender<bool>,
    seen: Arc<Mutex<Option<Progress>>>,
    thread: Option<JoinHandle<Result<(), String>>>,
}

impl Slave {
    /// Starts.
    ///
    /// # Errors
    /// Where there are no threads, no randomness or no encryption.
    pub fn start(options: Options, loader: Arc<dyn Loader>, sink: Sink) -> Result<Self, NetError> {
        let runtime =
            tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(NetError::Threads)?;
        let (stop, stopped) = watch::channel(false);
        let life = Life::new(options, loader, sink, stopped)?;
        let seen = Arc::clone(&life.seen);
        let thread = std::thread::Builder::new().name("slave".to_owned()).spawn(move || {
            let result = runtime.block_on(live(life));
            // A scene that is being loaded is not waited for.
            runtime.shutdown_background();
            result
        });
        Ok(Self { stop, seen, thread: Some(thread.map_err(NetError::Threads)?) })
    }

    /// How far it is with the scene that it renders, if any.
    pub fn progress(&self) -> Option<Progress> {
        *self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Asks it to send what it has, and to end.
    pub fn stop(&self) {
        // It may have ended.
        let _ = self.stop.send(true);
    }

    /// Whether it has ended.
    pub fn is_finished(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Waits for the end.
    ///
    /// # Errors
    /// A fault in the renderer, in words.
    pub fn finish(mut self) -> Result<(), String> {
        self.stop();
        let ended = self.thread.take().map(JoinHandle::join);
        ended.map_or(Ok(()), |ended| {
            ended.unwrap_or_else(|_| Err("the thread of the network failed".to_owned()))
        })
    }
}

impl Drop for Slave {
    fn drop(&mut self) {
        self.stop();
        if let Some(thread) = self.thread.take() {
            // Nobody is left to hear of it.
            drop(thread.join());
        }
    }
}

/// Visits masters until told to stop.
async fn live(mut life: Life) -> Result<(), String> {
    if life.options.master.is_none() {
        life.tell(Event::Searching);
    }
    let mut pause = FIRST_PAUSE;
    let mut failures = 0u64;
    // When a master was there last.
    let mut last_seen = Instant::now();
    let mut has_left = true;
    while !life.is_stopped() {
        let mut reached = false;
        let outcome = life.visit(&mut reached).await;
        if reached {
            (pause, failures, last_seen) = (FIRST_PAUSE, 0, Instant::now());
        }
        // Who never came in has not said good-bye.
        has_left = reached && matches!(outcome, Outcome::Stopped | Outcome::Finished);
        let (reason, wait) = match outcome {
            Outcome::Stopped => break,
            Outcome::Broken(message) => {
                life.lose(false, "the renderer has failed").await;
                return Err(message);
            }
            Outcome::Finished => {
                life.work = None;
                life.tell(Event::Finished);
                // Another render has other samples, unless they were asked for.
                life.begin_anew()?;
                (None, FIRST_PAUSE)
            }
            Outcome::Refused(reason) => (Some(reason), AFTER_REFUSAL),
            Outcome::Lost(reason) => (Some(reason), pause),
        };
        if let Some(reason) = reason {
            failures += 1;
            pause = (2 * pause).min(LONGEST_PAUSE);
            // Ever more rarely: a slave may wait for days.
            if failures.is_power_of_two() {
                life.tell(Event::Disconnected { reason, again_in: wait });
            }
        }
        life.wait(wait).await;
        if last_seen.elapsed() >= ALONE {
            life.rest();
        }
    }
    // Who is told to stop between two visits may find a master all the same.
    let has_left = has_left || life.deliver().await.is_ok();
    life.lose(has_left, "there is no master to send them to, or to say that it has saved them").await;
    Ok(())
}
