//! What a working master renders itself.

use super::PULSE;
use indigo_net::event::Event;
use indigo_net::ledger::Refusal;
use indigo_net::master::{Master, OwnStatus};
use indigo_render::{Event as SessionEvent, Halt, HaltReason, Options, Progress, Session};
use indigo_scene::Scene;
use std::sync::Arc;
use std::time::Duration;

/// What a working master renders itself.
pub struct Own {
    session: Session,
    seed: u64,
    threads: usize,
    /// Samples that were added to the film.
    added: u64,
    pub progress: Progress,
    /// Why it has ended by itself.
    pub ended: Option<HaltReason>,
}

impl Own {
    /// Starts, beside what the master's film has of that seed.
    ///
    /// # Errors
    /// Where there is no session.
    pub fn start(
        scene: &Arc<Scene>,
        options: &Options,
        seed: u64,
        master: &Master,
    ) -> Result<Self, indigo_render::SessionError> {
        // The film's halting conditions are not the session's.
        let options = Options { seed, halt: Halt::default(), ..options.clone() };
        let mut session = Session::start_beside(Arc::clone(scene), &options, &master.record())?;
        let progress = session.progress();
        Ok(Self { session, seed, threads: options.threads, added: 0, progress, ended: None })
    }

    /// Lets it work for so long.
    pub fn wait(&mut self, time: Duration, master: &Master) {
        match self.session.wait(time) {
            SessionEvent::Progress(progress) => self.progress = progress,
            SessionEvent::Halted(reason, progress) => {
                self.progress = progress;
                self.ended.get_or_insert(reason);
                // It waits no more by itself.
                std::thread::sleep(time);
            }
        }
        self.tell(master);
    }

    fn tell(&self, master: &Master) {
        master.tell_own(OwnStatus {
            threads: self.threads,
            samples_per_second: self.progress.samples_per_second,
            pending: self.progress.samples.saturating_sub(self.added),
        });
    }

    /// Adds what it has rendered to the film; what that was.
    pub fn hand_over(&mut self, master: &Master, program: &str) -> Result<Option<Event>, Refusal> {
        let Some(film) = self.session.drain(program) else { return Ok(None) };
        master.add(self.seed, &film)?;
        let samples = film.record.as_ref().map_or(0, |record| record.samples);
        self.added += samples;
        self.progress = self.session.progress();
        self.tell(master);
        let run = film.record.and_then(|record| record.runs.first().copied());
        Ok(run.map(|run| Event::Rendered { samples, run }))
    }

    /// Ends it, with all that it has.
    pub fn end(&mut self, master: &Master, program: &str) -> Result<Option<Event>, Refusal> {
        self.session.stop();
        while !matches!(self.session.wait(PULSE), SessionEvent::Halted(..)) {}
        self.hand_over(master, program)
    }
}
