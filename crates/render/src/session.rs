//! A running render.

mod film;

use crate::error_meter::ErrorMeter;
use crate::gate::Gate;
use crate::memory;
use crate::options::{Halt, Options};
use crate::progress::{Progress, RateMeter};
use crate::saved::{blank_record, lines};
use crate::worker::{self, OrderedMerge, Shared};
use indigo_film::{FilmError, FilmRecord, FilmSize, FilmState, MasterFilm, Mismatch, SavedFilm};
use indigo_scene::Scene;
use indigo_transport::driver::Driver;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// No epoch need be shorter: nobody waits for less than a blink.
const SHORTEST_EPOCH: Duration = Duration::from_millis(50);
/// The first epoch, where no error is looked for.
const FIRST_EPOCH: Duration = Duration::from_millis(100);

/// Why a session ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HaltReason {
    /// The number of samples per pixel was reached.
    Samples,
    /// The estimated error is small enough.
    Error,
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
    #[error("cannot start render thread {number}: {source}; use fewer (num_threads, -t)")]
    NoThread {
        /// Which one, from 1.
        number: usize,
        /// What the system said.
        source: std::io::Error,
    },
    /// The system has not as much memory as the film needs.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// The system has, by its own account, less memory than rendering and saving the picture will take.
    #[error(
        "a picture of width {} and height {} with super_sample_factor {} needs at least {} MiB of memory, but the \
         system has {} MiB left",
        .size.width(), .size.height(), .size.super_sample(), .needed.div_ceil(1 << 20), .available >> 20
    )]
    Memory {
        /// The picture's.
        size: FilmSize,
        /// Bytes.
        needed: u64,
        /// Bytes.
        available: u64,
    },
    /// The film to go on with is of another picture.
    #[error("the film cannot be gone on with: {}", lines(.0))]
    Mismatch(Vec<Mismatch>),
}

/// A scene being rendered by worker threads.
///
/// Somebody must call [`wait`](Self::wait) now and then: the calling thread is the coordinator, which
/// moves the epochs on and tests the halting conditions. Dropping a session stops it.
pub struct Session {
    shared: Arc<Shared>,
    /// The first unit that is in the film, or will be.
    first_unit: u64,
    /// What the film held before this session, or before the last [`drain`](Session::drain).
    before: FilmRecord,
    /// Time of rendering until the last drain.
    drained_after: Duration,
    workers: Vec<JoinHandle<()>>,
    halt: Halt,
    epoch: Duration,
    started: Instant,
    paused_since: Option<Instant>,
    paused_for: Duration,
    last_epoch: Instant,
    rate: RateMeter,
    /// Samples of the film that were there before this session.
    rate_from: u64,
    error: ErrorMeter,
    reason: Option<HaltReason>,
}

impl Session {
    /// Starts rendering.
    ///
    /// # Errors
    /// Where the system gives no threads, or not the memory.
    pub fn start(scene: Arc<Scene>, options: &Options) -> Result<Self, SessionError> {
        Self::start_beside(scene, options, &FilmRecord::default())
    }

    /// Starts rendering with an empty film, for [`drain`](Self::drain)s that are added to another film: with none of the
    /// random numbers that its record tells of.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn start_beside(
        scene: Arc<Scene>,
        options: &Options,
        other: &FilmRecord,
    ) -> Result<Self, SessionError> {
        let nothing = blank_record(&scene, "");
        Self::begin(scene, options, nothing, other.first_fresh_unit(options.seed), None)
    }

    /// Goes on with a film. Its samples count towards [`Halt::samples_per_pixel`], its time does not count
    /// towards [`Halt::time`]. The film's own seed goes on where it ended.
    ///
    /// # Errors
    /// Where the film is of another picture, with all that differs; where the system gives no threads, or not the
    /// memory.
    pub fn go_on(scene: Arc<Scene>, options: &Options, saved: &SavedFilm) -> Result<Self, SessionError> {
        let record = Self::check(&scene, saved)?.clone();
        let first_unit = record.first_fresh_unit(options.seed);
        Self::begin(scene, options, record, first_unit, Some(&saved.film))
    }

    /// The record of a film if a scene can go on with it.
    ///
    /// # Errors
    /// [`SessionError::Mismatch`] with all that differs.
    pub fn check<'a>(scene: &Scene, saved: &'a SavedFilm) -> Result<&'a FilmRecord, SessionError> {
        let Some(record) = &saved.record else {
            return Err(SessionError::Mismatch(vec![FilmError::Foreign.into()]));
        };
        let differences = blank_record(scene, "").differences(record);
        if differences.is_empty() { Ok(record) } else { Err(SessionError::Mismatch(differences)) }
    }

    fn begin(
        scene: Arc<Scene>,
        options: &Options,
        before: FilmRecord,
        first_unit: u64,
        film_before: Option<&FilmState>,
    ) -> Result<Self, SessionError> {
        let mut driver = Driver::going_on(&scene, options.seed, first_unit);
        let estimates_error = options.estimates_error || options.halt.relative_error.is_some();
        if estimates_error {
            driver = driver.in_halves();
        }
        let (size, count) = (scene.film.size, if estimates_error { 3 } else { 1 });
        let kinds = driver.layers().iter().map(|l| l.0);
        let is_diffracted = scene.picture.diffraction.is_some();
        memory::check(size, memory::needed(size, kinds, count, is_diffracted), memory::available())?;
        let films = (0..count).map(|_| MasterFilm::new(size, driver.layers()));
        let films = films.collect::<Result<Vec<_>, _>>()?;
        let threads = options.threads.clamp(1, driver.most_workers());
        if let Some(state) = film_before {
            films[0].merge_state(state).map_err(|e| SessionError::Mismatch(vec![e.into()]))?;
        }
        let shared = Arc::new(Shared {
            unit_limit: unit_limit(&driver, &options.halt, first_unit, before.samples),
            scene,
            driver,
            films,
            next_unit: AtomicU64::new(first_unit),
            samples: AtomicU64::new(before.samples),
            rays: AtomicU64::new(0),
            epoch: AtomicU64::new(0),
            gate: Gate::default(),
            failure: Mutex::new(None),
            ordered: options.deterministic.then(|| OrderedMerge::from(first_unit)),
            seed: options.seed,
        });
        let now = Instant::now();
        let mut session = Self {
            shared,
            first_unit,
            rate_from: before.samples,
            before,
            drained_after: Duration::ZERO,
            workers: vec![],
            halt: options.halt,
            epoch: options.epoch,
            started: now,
            paused_since: None,
            paused_for: Duration::ZERO,
            last_epoch: now,
            rate: RateMeter::default(),
            error: ErrorMeter::new(options.threads),
            reason: None,
        };
        // They wait for each other: those that were at work already would leave no time to start the rest.
        session.shared.gate.pause();
        for number in 1..=threads {
            let shared = Arc::clone(&session.shared);
            let builder = std::thread::Builder::new().name(format!("render {number}"));
            let spawned = builder.spawn(move || worker::work(&shared));
            session.workers.push(spawned.map_err(|source| SessionError::NoThread { number, source })?);
        }
        session.started = Instant::now();
        session.shared.gate.resume();
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
                let reason = self.join();
                // Of the film as it is now: samples have come since the estimate that may have ended the session.
                self.error.estimate(&self.shared);
                return Event::Halted(reason, self.progress());
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
            self.shared.stop();
        }
        if self.last_epoch.elapsed() >= self.epoch_now() {
            self.last_epoch = Instant::now();
            self.shared.epoch.fetch_add(1, Ordering::Relaxed);
            let error = self.error.update(&self.shared);
            if let (Some(wanted), Some(error)) = (self.halt.relative_error, error)
                && error <= wanted
                && self.reason.is_none()
            {
                self.reason = Some(HaltReason::Error);
                self.shared.stop();
            }
        }
    }

    /// How long this epoch is: no longer than the time so far, so that there soon is something to look at; where an error is
    /// looked for no more than a quarter of it, so that a picture that is soon good enough soon ends.
    fn epoch_now(&self) -> Duration {
        match self.halt.relative_error {
            Some(_) => self.epoch.min((self.elapsed() / 4).max(SHORTEST_EPOCH)),
            None => self.epoch.min(self.elapsed().max(FIRST_EPOCH)),
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

    /// Asks the workers to end; [`wait`](Self::wait) tells when they have.
    pub fn stop(&mut self) {
        self.reason.get_or_insert(HaltReason::Stopped);
        self.shared.stop();
    }

    /// Lets the workers rest; the clock stops too.
    pub fn pause(&mut self) {
        self.shared.gate.pause();
        self.paused_since.get_or_insert_with(Instant::now);
    }

    /// Whether a pause is in full effect: every worker has finished the unit it was at and handed it over, so
    /// that [`snapshot`](Self::snapshot) has all that was rendered.
    pub fn is_resting(&self) -> bool {
        let ended = self.workers.iter().filter(|worker| worker.is_finished()).count();
        self.paused_since.is_some() && self.shared.gate.n_resting() + ended == self.workers.len()
    }

    /// Goes on after a pause.
    pub fn resume(&mut self) {
        self.shared.gate.resume();
        if let Some(since) = self.paused_since.take() {
            self.paused_for += since.elapsed();
        }
    }

    /// Time spent rendering.
    pub fn elapsed(&self) -> Duration {
        let pause = self.paused_since.map_or(Duration::ZERO, |s| s.elapsed());
        self.started.elapsed().saturating_sub(self.paused_for + pause)
    }

    /// How far the session is.
    pub fn progress(&mut self) -> Progress {
        let samples = self.shared.samples.load(Ordering::Relaxed);
        let elapsed = self.elapsed();
        let rate = self.rate.update(elapsed, samples - self.rate_from);
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
            rays: self.shared.rays.load(Ordering::Relaxed),
            elapsed,
            left: next.and_then(|n| Duration::try_from_secs_f64(n.1).ok()),
            fraction: next.map(|n| n.0.clamp(0.0, 1.0)),
            relative_error: self.error.last(),
        }
    }
}

/// The unit after the last one that a halting condition leaves to do.
fn unit_limit(driver: &Driver, halt: &Halt, first: u64, samples_before: u64) -> u64 {
    halt.samples_per_pixel.map_or(u64::MAX, |passes| {
        let wanted = u128::from(driver.pixels()) * u128::from(passes);
        first.saturating_add(driver.units_of(wanted.saturating_sub(samples_before.into()), first))
    })
}

impl Drop for Session {
    fn drop(&mut self) {
        self.shared.stop();
        for worker in self.workers.drain(..) {
            // Nobody is left to hear of a failure.
            drop(worker.join());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_beyond_the_memory_is_refused_with_its_numbers() {
        let size = FilmSize::new(32_768, 8_192, 2).expect("a size");
        assert!(memory::check(size, 5 << 30, None).is_ok());
        assert!(memory::check(size, 5 << 30, Some(5 << 30)).is_ok());
        let error = memory::check(size, 5 << 30, Some(1 << 30)).expect_err("too little");
        let said = error.to_string();
        for part in ["width 32768", "height 8192", "super_sample_factor 2", "5120 MiB", "1024 MiB"] {
            assert!(said.contains(part), "{part}: {said}");
        }
    }
}
