//! Whether workers go on, rest or end.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// What workers ask before each unit of work.
#[derive(Debug, Default)]
pub(crate) struct Gate {
    stopped: AtomicBool,
    pause: Mutex<Pause>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Pause {
    wanted: bool,
    /// Workers that wait for its end.
    resting: usize,
}

impl Gate {
    fn lock(&self) -> MutexGuard<'_, Pause> {
        self.pause.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether workers are to end.
    pub(crate) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Ends the workers, at rest or not.
    pub(crate) fn stop(&self) {
        // A worker looks at `stopped` under this lock before it falls asleep. Set without the lock it could
        // change just between the look and the sleep, from which nothing would wake the worker.
        let pause = self.lock();
        self.stopped.store(true, Ordering::Relaxed);
        drop(pause);
        self.changed.notify_all();
    }

    /// Lets the workers rest.
    pub(crate) fn pause(&self) {
        self.lock().wanted = true;
    }

    /// How many workers rest, all their work handed over.
    pub(crate) fn n_resting(&self) -> usize {
        self.lock().resting
    }

    /// Ends the rest.
    pub(crate) fn resume(&self) {
        self.lock().wanted = false;
        self.changed.notify_all();
    }

    /// Rests as long as there is a pause and no stop; before that, if so, calls `before`.
    pub(crate) fn rest(&self, before: impl FnOnce()) {
        if !self.lock().wanted {
            return;
        }
        before();
        let mut pause = self.lock();
        pause.resting += 1;
        while pause.wanted && !self.is_stopped() {
            pause = self.changed.wait(pause).unwrap_or_else(PoisonError::into_inner);
        }
        pause.resting -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// A stop that comes while a worker is between its look and its sleep must wait until it sleeps.
    #[test]
    fn a_stop_cannot_slip_in_before_the_sleep() {
        let gate = Gate::default();
        gate.pause();
        std::thread::scope(|scope| {
            let about_to_sleep = gate.lock();
            let stopping = scope.spawn(|| gate.stop());
            std::thread::sleep(Duration::from_millis(50));
            assert!(!gate.is_stopped() && !stopping.is_finished());
            drop(about_to_sleep);
        });
        assert!(gate.is_stopped());
        gate.rest(|| {});
    }

    #[test]
    fn resting_ends_with_the_pause() {
        let gate = Gate::default();
        gate.rest(|| panic!("there is no pause"));
        gate.pause();
        let (tell, told) = std::sync::mpsc::channel();
        std::thread::scope(|scope| {
            scope.spawn(|| gate.rest(|| tell.send(()).expect("somebody listens")));
            told.recv().expect("it rests");
            while gate.n_resting() == 0 {
                std::thread::yield_now();
            }
            gate.resume();
        });
        assert_eq!(gate.n_resting(), 0);
        assert!(!gate.is_stopped());
    }
}
