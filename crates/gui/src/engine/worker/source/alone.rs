//! A render of this machine alone.

use super::{Ended, Source, set};
use crate::work::Work;
use indigo_film::{FilmState, SavedFilm};
use indigo_front::messages::{Messages, say_saved};
use indigo_front::prepare::{Prepared, fail};
use indigo_front::saver::Saver;
use indigo_net::master::Status;
use indigo_render::output::SaveJob;
use indigo_render::{Event, HaltReason, Options, Progress, Session};
use std::sync::Arc;
use std::time::Duration;

/// See the module.
pub struct Alone {
    session: Session,
    options: Options,
    saver: Saver,
    /// Rendering time of sessions before this one.
    before: Duration,
    /// Holds the picture's name.
    prepared: Prepared,
}

impl Alone {
    /// Begins to render, or goes on with a film; `None` where that cannot be, after telling why.
    pub fn begin(
        prepared: Prepared,
        job: SaveJob,
        work: &Work,
        film: Option<&SavedFilm>,
        messages: &mut dyn Messages,
    ) -> Option<Self> {
        let mut options = prepared.options.clone();
        set(&mut options, work, Duration::ZERO);
        let session = match film {
            Some(film) => Session::go_on(Arc::clone(&prepared.scene), &options, film),
            None => Session::start(Arc::clone(&prepared.scene), &options),
        };
        let session = session.map_err(|error| fail(&error, messages)).ok()?;
        Some(Self { session, options, saver: Saver::new(job), before: Duration::ZERO, prepared })
    }

    fn with_before(&self, progress: &Progress) -> Progress {
        Progress { elapsed: progress.elapsed + self.before, ..*progress }
    }
}

impl Source for Alone {
    fn step(&mut self, time: Duration, messages: &mut dyn Messages) -> (Progress, Option<HaltReason>) {
        match self.session.wait(time) {
            Event::Halted(reason, progress) => (self.with_before(&progress), Some(reason)),
            Event::Progress(progress) => {
                let version = self.saver.job().version.clone();
                self.saver.tend(|| self.session.saved(&version), messages);
                (self.with_before(&progress), None)
            }
        }
    }

    fn sums(&mut self, _messages: &mut dyn Messages) -> FilmState {
        self.session.snapshot()
    }

    fn film(&mut self, _messages: &mut dyn Messages) -> SavedFilm {
        self.session.saved(&self.saver.job().version)
    }

    fn job(&self) -> &SaveJob {
        self.saver.job()
    }

    fn job_mut(&mut self) -> &mut SaveJob {
        self.saver.job_mut()
    }

    fn save_soon(&mut self) {
        self.saver.save_soon();
    }

    fn save_by_wish(&mut self) {
        self.saver.save_by_wish();
    }

    fn is_saving(&self) -> bool {
        self.saver.is_at_work()
    }

    fn set_rest(&mut self, rests: bool) {
        if rests {
            self.session.pause();
        } else {
            self.session.resume();
        }
    }

    fn is_resting(&self) -> bool {
        self.session.is_resting()
    }

    fn adjust(&mut self, work: &Work, messages: &mut dyn Messages) -> Result<(), HaltReason> {
        let reason = self.stop();
        let film = self.film(messages);
        self.before += self.session.elapsed();
        set(&mut self.options, work, self.before);
        match Session::go_on(Arc::clone(&self.prepared.scene), &self.options, &film) {
            Ok(session) => self.session = session,
            Err(error) => {
                fail(&error, messages);
                return Err(reason);
            }
        }
        Ok(())
    }

    fn stop(&mut self) -> HaltReason {
        self.session.stop();
        loop {
            if let Event::Halted(reason, _) = self.session.wait(Duration::from_millis(20)) {
                return reason;
            }
        }
    }

    fn end(mut self: Box<Self>, reason: &HaltReason, saves: bool, messages: &mut dyn Messages) -> Ended {
        if let HaltReason::Failed(message) = reason {
            messages.error(message);
        }
        let progress = self.session.progress();
        let film = self.film(messages);
        let is_saved = if saves {
            self.saver.wait_for_last(messages);
            say_saved(&self.job().save(&film), messages)
        } else {
            self.saver.keep_word(|| film.clone(), messages);
            true
        };
        Ended::Film { progress: self.with_before(&progress), film: film.into(), is_saved }
    }

    fn slaves(&self) -> Option<Status> {
        None
    }
}
