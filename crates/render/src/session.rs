//! A running render.

use crate::options::{Halt, Options};
use crate::progress::{Progress, RateMeter};
use crate::worker::{self, OrderedMerge, Shared};
use indigo_film::{FilmState, MasterFilm};
use indigo_scene::Scene;
use indigo_transport::driver::Driver;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Why a session ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HaltReason {
    /// The number of samples per pixel was reached.
    Samples,
    /// The time was up.
    Time,
    /// Somebody called [`Session::stop`].
    Stopped,
    /// A worker failed: a bug, with what is known about it.
    Failed(String),
}

/// What [`Session::wait`] saw.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Still at it.
    Progress(Progress),
    /// All workers have handed over and ended.
    Halted(HaltReason, Progress),
}

/// Why a session could not start.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// The system gave no thread.
    #[error("cannot start a render thread: {0}")]
    NoThread(#[from] std::io::Error),
}

/// A scene being rendered by worker threads.
///
/// Somebody must call [`wait`](Self::wait) now and then: the calling thread is the coordinator, which
/// moves the epochs on and tests the halting conditions. Dropping a session stops it.
pub struct Session {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
    halt: Halt,
    epoch: Duration,
    started: Instant,
    paused_since: Option<Instant>,
    paused_for: Duration,
    last_epoch: Instant,
    rate: RateMeter,
    reason: Option<HaltReason>,
}

impl Session {
    /// Starts rendering.
    ///
    /// # Errors
    /// Where the system gives no threads.
    pub fn start(scene: Arc<Scene>, options: &Options) -> Result<Self, SessionError> {
        let driver = Driver::new(&scene, options.seed);
        let film = MasterFilm::new(scene.film.size, driver.layers());
        let passes = options.halt.samples_per_pixel.unwrap_or(u64::MAX);
        let shared = Arc::new(Shared {
            unit_limit: driver.units(passes),
            scene,
            driver,
            film,
            next_unit: AtomicU64::new(0),
            samples: AtomicU64::new(0),
            epoch: AtomicU64::new(0),
            stop: AtomicBool::new(false),
            paused: Mutex::new(false),
            resumed: Condvar::new(),
            failure: Mutex::new(None),
            ordered: options.deterministic.then(OrderedMerge::default),
            seed: options.seed,
        });
        let now = Instant::now();
        let mut session = Self {
            shared,
            workers: vec![],
            halt: options.halt,
            epoch: options.epoch,
            started: now,
            paused_since: None,
            paused_for: Duration::ZERO,
            last_epoch: now,
            rate: RateMeter::default(),
            reason: None,
        };
        for i in 0..options.threads.max(1) {
            let shared = Arc::clone(&session.shared);
            let builder = std::thread::Builder::new().name(format!("render {i}"));
            session.workers.push(builder.spawn(move || worker::work(&shared))?);
        }
        Ok(session)
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.shared.scene
    }

    /// Waits up to `timeout` (less if an epoch or the halting time comes first), and says how things stand.
    pub fn wait(&mut self, timeout: Duration) -> Event {
        let deadline = Instant::now() + timeout;
        loop {
            self.test_conditions();
            if self.workers.iter().all(JoinHandle::is_finished) {
                return Event::Halted(self.join(), self.progress());
            }
            let now = Instant::now();
            if now >= deadline {
                return Event::Progress(self.progress());
            }
            std::thread::sleep(self.nap(now, deadline));
        }
    }

    /// Long enough not to burn the processor, short enough to end on time.
    fn nap(&self, now: Instant, deadline: Instant) -> Duration {
        let until_halt = self.halt.time.map_or(Duration::MAX, |t| t.saturating_sub(self.elapsed()));
        (deadline - now).min(until_halt).clamp(Duration::from_micros(200), Duration::from_millis(20))
    }

    fn test_conditions(&mut self) {
        if self.halt.time.is_some_and(|t| self.elapsed() >= t) && self.reason.is_none() {
            self.reason = Some(HaltReason::Time);
            self.end_workers();
        }
        if self.last_epoch.elapsed() >= self.epoch {
            self.last_epoch = Instant::now();
            self.shared.epoch.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn join(&mut self) -> HaltReason {
        for worker in self.workers.drain(..) {
            // A panic inside a unit was caught and noted; one outside is noted here.
            if worker.join().is_err() {
                let mut failure = self.shared.failure.lock().unwrap_or_else(PoisonError::into_inner);
                failure.get_or_insert_with(|| "a render thread failed outside its work".to_owned());
            }
        }
        let failure = self.shared.failure.lock().unwrap_or_else(PoisonError::into_inner).clone();
        match failure {
            Some(message) => HaltReason::Failed(message),
            None => self.reason.clone().unwrap_or(HaltReason::Samples),
        }
    }

    fn end_workers(&self) {
        self.shared.stop.store(true, Ordering::Relaxed);
        self.shared.resumed.notify_all();
    }

    /// Asks the workers to end; [`wait`](Self::wait) tells when they have.
    pub fn stop(&mut self) {
        self.reason.get_or_insert(HaltReason::Stopped);
        self.end_workers();
    }

    /// Lets the workers rest; the clock stops too.
    pub fn pause(&mut self) {
        *self.shared.paused.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.paused_since.get_or_insert_with(Instant::now);
    }

    /// Goes on after a pause.
    pub fn resume(&mut self) {
        *self.shared.paused.lock().unwrap_or_else(PoisonError::into_inner) = false;
        self.shared.resumed.notify_all();
        if let Some(since) = self.paused_since.take() {
            self.paused_for += since.elapsed();
        }
    }

    /// Time spent rendering.
    pub fn elapsed(&self) -> Duration {
        let pause = self.paused_since.map_or(Duration::ZERO, |s| s.elapsed());
        self.started.elapsed().saturating_sub(self.paused_for + pause)
    }

    /// A copy of the film as it has been handed over so far.
    pub fn snapshot(&self) -> FilmState {
        self.shared.film.snapshot()
    }

    /// How far the session is.
    pub fn progress(&mut self) -> Progress {
        let samples = self.shared.samples.load(Ordering::Relaxed);
        let elapsed = self.elapsed();
        let rate = self.rate.update(elapsed, samples);
        let spp = samples as f64 / self.shared.driver.pixels() as f64;
        let by_samples = self.halt.samples_per_pixel.map(|n| {
            let total = n as f64 * self.shared.driver.pixels() as f64;
            let left = if rate > 0.0 { (total - samples as f64).max(0.0) / rate } else { f64::MAX };
            (samples as f64 / total.max(1.0), left)
        });
        let by_time = self.halt.time.map(|t| {
            (elapsed.as_secs_f64() / t.as_secs_f64().max(1e-9), t.saturating_sub(elapsed).as_secs_f64())
        });
        // Whichever comes first.
        let next = [by_samples, by_time].into_iter().flatten().min_by(|a, b| a.1.total_cmp(&b.1));
        Progress {
            samples,
            samples_per_pixel: spp,
            samples_per_second: rate,
            elapsed,
            left: next.and_then(|n| Duration::try_from_secs_f64(n.1).ok()),
            fraction: next.map(|n| n.0.clamp(0.0, 1.0)),
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.end_workers();
        for worker in self.workers.drain(..) {
            // Nobody is left to hear of a failure.
            drop(worker.join());
        }
    }
}
