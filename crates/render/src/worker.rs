//! What each worker thread does.

use crate::gate::Gate;
use indigo_film::{FilmDelta, MasterFilm};
use indigo_scene::Scene;
use indigo_transport::driver::Driver;
use indigo_transport::technique::Tracer;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// What workers and the session share.
pub(crate) struct Shared {
    pub scene: std::sync::Arc<Scene>,
    pub driver: Driver,
    /// The film; with an estimate of the error also one for each half of the session's samples, and the first holds
    /// only what was there before.
    pub films: Vec<MasterFilm>,
    /// The next unit that nobody does yet.
    pub next_unit: AtomicU64,
    /// Units at and beyond this one are not done.
    pub unit_limit: u64,
    /// Samples handed over or gathered so far.
    pub samples: AtomicU64,
    /// Rays traced so far.
    pub rays: AtomicU64,
    /// Workers hand over when this has moved on.
    pub epoch: AtomicU64,
    pub gate: Gate,
    /// Set when a worker died; the message says how to replay what it did.
    pub failure: Mutex<Option<String>>,
    pub ordered: Option<OrderedMerge>,
    pub seed: u64,
}

impl Shared {
    /// Ends the workers.
    pub fn stop(&self) {
        self.gate.stop();
        self.driver.cancel();
    }

    /// The film that a unit's samples go to.
    fn film_of(&self, unit: u64) -> usize {
        if self.films.len() == 1 { 0 } else { 1 + self.driver.half_of(unit) }
    }
}

/// Merges deltas in the order of their units.
pub(crate) struct OrderedMerge {
    queue: Mutex<Queue>,
}

/// The unit whose turn it is, and those after it that are done: the number of their film, and what they gathered.
struct Queue {
    next: u64,
    done: BTreeMap<u64, (usize, FilmDelta)>,
}

impl OrderedMerge {
    /// With the first unit.
    pub fn from(first: u64) -> Self {
        Self { queue: Mutex::new(Queue { next: first, done: BTreeMap::new() }) }
    }

    fn hand_over(&self, films: &[MasterFilm], unit: u64, film: usize, delta: FilmDelta) {
        let mut queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        queue.done.insert(unit, (film, delta));
        loop {
            let next = queue.next;
            let Some((film, delta)) = queue.done.remove(&next) else { break };
            merge(&films[film], &delta);
            queue.next += 1;
        }
    }
}

/// Deltas are made by the film that they go to, so they always fit.
fn merge(film: &MasterFilm, delta: &FilmDelta) {
    film.merge(delta).unwrap_or_else(|e| unreachable!("a delta of this film: {e}"));
}

/// Does units until told to stop or until there are no more.
pub(crate) fn work(shared: &Shared) {
    let mut deltas: Vec<FilmDelta> = shared.films.iter().map(MasterFilm::delta).collect();
    let mut tracer = shared.driver.tracer();
    let mut rays_told = tracer.rays();
    let mut seen_epoch = shared.epoch.load(Ordering::Relaxed);
    loop {
        // In order, everything has been handed over already.
        shared.gate.rest(|| hand_over(shared, &mut deltas));
        if shared.gate.is_stopped() {
            break;
        }
        let unit = shared.next_unit.fetch_add(1, Ordering::Relaxed);
        if unit >= shared.unit_limit {
            break;
        }
        let film = shared.film_of(unit);
        let samples = render_unit(shared, unit, &mut tracer, &mut deltas[film]);
        shared.samples.fetch_add(samples.unwrap_or(0), Ordering::Relaxed);
        shared.rays.fetch_add(tracer.rays() - rays_told, Ordering::Relaxed);
        rays_told = tracer.rays();
        if let Some(ordered) = &shared.ordered {
            // Also what a unit that failed has done: those after it wait for it.
            ordered.hand_over(&shared.films, unit, film, deltas[film].take());
        }
        if samples.is_none() {
            break;
        }
        if shared.ordered.is_none() {
            let epoch = shared.epoch.load(Ordering::Relaxed);
            if epoch != seen_epoch {
                seen_epoch = epoch;
                hand_over(shared, &mut deltas);
            }
        }
    }
    if shared.ordered.is_none() {
        hand_over(shared, &mut deltas);
    }
}

fn hand_over(shared: &Shared, deltas: &mut [FilmDelta]) {
    for (film, delta) in shared.films.iter().zip(deltas) {
        if !delta.is_empty() {
            merge(film, delta);
            delta.clear();
        }
    }
}

/// A panic in the renderer is a bug; it must neither hang the session nor pass unseen.
///
/// What it leaves in the delta is sound and stays, with all that the worker did before: drivers count each
/// sample when it is complete.
fn render_unit(shared: &Shared, unit: u64, tracer: &mut Tracer, delta: &mut FilmDelta) -> Option<u64> {
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        shared.driver.render_unit(&shared.scene, unit, tracer, delta)
    }));
    match result {
        Ok(samples) => Some(samples),
        Err(panic) => {
            let what = panic
                .downcast_ref::<String>()
                .map(String::as_str)
                .or_else(|| panic.downcast_ref::<&str>().copied())
                .unwrap_or("no message");
            let message = format!(
                "a render thread failed in unit {unit} with seed {}: {what}; render the same scene with -seed {} to see it again",
                shared.seed, shared.seed
            );
            *shared.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(message);
            shared.stop();
            None
        }
    }
}
