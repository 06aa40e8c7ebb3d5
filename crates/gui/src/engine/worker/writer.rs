//! The thread that writes single files: one after another, as they were asked for.

use crate::engine::Outlet;
use crate::log::Weight;
use crate::words;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

type Job = Box<dyn FnOnce(&mut Outlet) + Send>;

/// See the module. What was asked for is written before this is gone.
pub struct Writer {
    jobs: Option<Sender<Job>>,
    thread: Option<JoinHandle<()>>,
}

impl Writer {
    /// Starts the thread.
    ///
    /// # Errors
    /// Where the system gives none.
    pub fn start(outlet: Outlet) -> std::io::Result<Self> {
        let (jobs, wanted) = channel();
        let thread = std::thread::Builder::new().name("save".to_owned());
        let thread = thread.spawn(move || work(&wanted, outlet))?;
        Ok(Self { jobs: Some(jobs), thread: Some(thread) })
    }

    /// Writes after all that was asked for before.
    pub fn write(&self, job: impl FnOnce(&mut Outlet) + Send + 'static) {
        if let Some(jobs) = &self.jobs {
            // The thread ends only when this does.
            drop(jobs.send(Box::new(job)));
        }
    }

    /// Waits until all is written that was asked for.
    pub fn wait(&self) {
        let (done, waiting) = channel::<()>();
        self.write(move |_| drop(done));
        // Nothing is ever sent: the wait is for the other end to go.
        _ = waiting.recv();
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            // It catches what its jobs do.
            drop(thread.join());
        }
    }
}

/// A job that fails is told, and does not keep others from being done.
fn work(wanted: &Receiver<Job>, mut outlet: Outlet) {
    for job in wanted {
        if catch_unwind(AssertUnwindSafe(|| job(&mut outlet))).is_err() {
            outlet.line(Weight::Error, words::SAVING_FAILED);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Update;
    use eframe::egui::Context;
    use std::sync::{Arc, Mutex};
    use std::time::Duration;

    #[test]
    fn files_are_written_in_order_and_waited_for() {
        let (updates, news) = channel();
        let outlet = Outlet { updates, context: Context::default() };
        let writer = Writer::start(outlet).expect("a thread");
        let done = Arc::new(Mutex::new(vec![]));
        let note = |number: u64, delay: u64| {
            let done = Arc::clone(&done);
            move |_: &mut Outlet| {
                std::thread::sleep(Duration::from_millis(delay));
                done.lock().unwrap().push(number);
            }
        };
        // The first takes longest.
        writer.write(note(1, 60));
        writer.write(|_| panic!("a job of the test fails"));
        writer.write(note(2, 0));
        writer.wait();
        assert_eq!(*done.lock().unwrap(), [1, 2]);
        assert!(matches!(news.try_recv(), Ok(Update::Line(line)) if line.weight == Weight::Error));
        writer.write(note(3, 60));
        drop(writer);
        assert_eq!(*done.lock().unwrap(), [1, 2, 3], "nothing is given up at the end");
    }
}
