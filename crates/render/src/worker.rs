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
    pub film: MasterFilm,
    /// The next unit that nobody does yet.
    pub next_unit: AtomicU64,
    /// Units at and beyond this one are not done.
    pub unit_limit: u64,
    /// Samples handed over or gathered so far.
    pub samples: AtomicU64,
    /// Workers hand over when this has moved on.
    pub epoch: AtomicU64,
    pub gate: Gate,
    /// Set when a worker died; the message says how to replay what it did.
    pub failure: Mutex<Option<String>>,
    pub ordered: Option<OrderedMerge>,
    pub seed: u64,
}

/// Merges deltas in the order of their units.
#[derive(Default)]
pub(crate) struct OrderedMerge {
    waiting: Mutex<(u64, BTreeMap<u64, FilmDelta>)>,
}

impl OrderedMerge {
    fn hand_over(&self, film: &MasterFilm, unit: u64, delta: FilmDelta) {
        let mut guard = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let (next, waiting) = &mut *guard;
        waiting.insert(unit, delta);
        while let Some(delta) = waiting.remove(next) {
            merge(film, &delta);
            *next += 1;
        }
    }
}

/// Deltas are made by the film that they go to, so they always fit.
fn merge(film: &MasterFilm, delta: &FilmDelta) {
    film.merge(delta).unwrap_or_else(|e| unreachable!("a delta of this film: {e}"));
}

/// Does units until told to stop or until there are no more.
pub(crate) fn work(shared: &Shared) {
    let mut delta = shared.film.delta();
    let mut tracer = shared.driver.tracer();
    let mut seen_epoch = shared.epoch.load(Ordering::Relaxed);
    loop {
        // In order, everything has been handed over already.
        shared.gate.rest(|| hand_over(shared, &mut delta));
        if shared.gate.is_stopped() {
            break;
        }
        let unit = shared.next_unit.fetch_add(1, Ordering::Relaxed);
        if unit >= shared.unit_limit {
            break;
        }
        let Some(samples) = render_unit(shared, unit, &mut tracer, &mut delta) else { break };
        shared.samples.fetch_add(samples, Ordering::Relaxed);
        if let Some(ordered) = &shared.ordered {
            ordered.hand_over(&shared.film, unit, delta.take());
        } else {
            let epoch = shared.epoch.load(Ordering::Relaxed);
            if epoch != seen_epoch {
                seen_epoch = epoch;
                hand_over(shared, &mut delta);
            }
        }
    }
    if shared.ordered.is_none() {
        hand_over(shared, &mut delta);
    }
}

fn hand_over(shared: &Shared, delta: &mut FilmDelta) {
    if !delta.is_empty() {
        merge(&shared.film, delta);
        delta.clear();
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
            shared.gate.stop();
            None
        }
    }
}
