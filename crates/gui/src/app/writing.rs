//! Threads that write files, which the program does not end before.

use std::thread::JoinHandle;

/// See the module.
#[derive(Default)]
pub struct Writing(Vec<JoinHandle<()>>);

impl Writing {
    /// Starts one.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn spawn(&mut self, name: &str, work: impl FnOnce() + Send + 'static) -> std::io::Result<()> {
        self.0.retain(|thread| !thread.is_finished());
        self.0.push(std::thread::Builder::new().name(name.to_owned()).spawn(work)?);
        Ok(())
    }
}

impl Drop for Writing {
    fn drop(&mut self) {
        for thread in self.0.drain(..) {
            // Nobody is left to hear of a failure.
            drop(thread.join());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;

    #[test]
    fn what_is_written_is_waited_for() {
        let written = Arc::new(AtomicBool::new(false));
        let tells = Arc::clone(&written);
        let mut writing = Writing::default();
        let work = move || {
            std::thread::sleep(Duration::from_millis(60));
            tells.store(true, Ordering::Relaxed);
        };
        writing.spawn("test", work).expect("a thread");
        drop(writing);
        assert!(written.load(Ordering::Relaxed));
    }
}
