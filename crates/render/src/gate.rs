//! Whether workers go on, rest or end.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// What workers ask before each unit of work.
#[derive(Debug, Default)]
pub(crate) struct Gate {
    stopped: AtomicBool,
    paused: Mutex<bool>,
    changed: Condvar,
}

impl Gate {
    fn paused(&self) -> MutexGuard<'_, bool> {
        self.paused.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether workers are to end.
    pub(crate) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Ends the workers, at rest or not.
    pub(crate) fn stop(&self) {
        // A worker looks at `stopped` under this lock before it falls asleep. Set without the lock it could
        // change just between the look and the sleep, from which nothing would wake the worker.
        let paused = self.paused();
        self.stopped.store(true, Ordering::Relaxed);
        drop(paused);
        self.changed.notify_all();
    }

    /// Lets the workers rest.
    pub(crate) fn pause(&self) {
        *self.paused() = true;
    }

    /// Ends the rest.
    pub(crate) fn resume(&self) {
        *self.paused() = false;
        self.changed.notify_all();
    }

    /// Rests as long as there is a pause and no stop; before that, if so, calls `before`.
    pub(crate) fn rest(&self, before: impl FnOnce()) {
        if !*self.paused() {
            return;
        }
        before();
        let mut paused = self.paused();
        while *paused && !self.is_stopped() {
            paused = self.changed.wait(paused).unwrap_or_else(PoisonError::into_inner);
        }
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
            let about_to_sleep = gate.paused();
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
            gate.resume();
        });
        assert!(!gate.is_stopped());
    }
}
