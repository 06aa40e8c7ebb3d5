//! Saving now and then while rendering goes on.

use crate::messages::{Messages, say_saved};
use indigo_film::{FilmRecord, SavedFilm};
use indigo_render::output::{SaveError, SaveJob, Saving};
use std::time::{Duration, Instant};

/// Saves the picture now and then, one save at a time.
pub struct Saver {
    job: SaveJob,
    period: Duration,
    saving: Option<Underway>,
    last: Instant,
    next: Next,
    announced: bool,
    failures: usize,
}

/// When the next save begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Next {
    /// When the period has passed.
    InTime,
    /// As soon as none is under way.
    Soon,
    /// The same, by wish: what becomes of it is told, however often files were saved before.
    Wished,
}

/// A save that has begun, and the record of its film.
struct Underway {
    saving: Saving,
    record: Option<FilmRecord>,
    is_wished: bool,
}

impl Saver {
    /// The first save is due when the period has passed that the scene sets.
    pub fn new(job: SaveJob) -> Self {
        let period = job.development.output.image_save_period;
        let period = Duration::try_from_secs_f64(period).unwrap_or(Duration::MAX);
        let (last, next) = (Instant::now(), Next::InTime);
        Self { job, period, saving: None, last, next, announced: false, failures: 0 }
    }

    /// What is saved.
    pub fn job(&self) -> &SaveJob {
        &self.job
    }

    /// The same, to be changed from the next save on.
    pub fn job_mut(&mut self) -> &mut SaveJob {
        &mut self.job
    }

    /// The next save begins as soon as none is under way.
    pub fn save_soon(&mut self) {
        self.next = self.next.max(Next::Soon);
    }

    /// The same by somebody's wish, who is told what becomes of it.
    pub fn save_by_wish(&mut self) {
        self.next = Next::Wished;
    }

    /// Whether a save is under way, or will be as soon as none is.
    pub fn is_at_work(&self) -> bool {
        self.saving.is_some() || self.next != Next::InTime
    }

    /// Time until the next save is due. While one is under way the next cannot begin: then it is looked after
    /// as often as the system lets a thread sleep and wake without effort.
    pub fn until_due(&self) -> Duration {
        const WHILE_SAVING: Duration = Duration::from_millis(5);
        self.period.saturating_sub(self.last.elapsed()).max(WHILE_SAVING)
    }

    /// Begins a save, of the film that `film` gives, if one is due; the record of the film that was saved meanwhile, if
    /// any was.
    pub fn tend(
        &mut self,
        film: impl FnOnce() -> SavedFilm,
        messages: &mut dyn Messages,
    ) -> Option<FilmRecord> {
        let saved = self.look_after(messages);
        if self.is_due() {
            self.begin(film(), messages);
        }
        saved
    }

    /// The record of the film that has been saved since this was last asked, if any was.
    pub fn look_after(&mut self, messages: &mut dyn Messages) -> Option<FilmRecord> {
        let is_finished = self.saving.as_ref().is_some_and(|underway| underway.saving.is_finished());
        if is_finished { self.wait_for_last(messages) } else { None }
    }

    /// Whether it is time for a save, and none is under way.
    pub fn is_due(&self) -> bool {
        self.saving.is_none() && (self.next != Next::InTime || self.last.elapsed() >= self.period)
    }

    /// Begins a save.
    pub fn begin(&mut self, film: SavedFilm, messages: &mut dyn Messages) {
        self.last = Instant::now();
        let is_wished = std::mem::replace(&mut self.next, Next::InTime) == Next::Wished;
        let record = film.record.clone();
        match self.job.spawn(film) {
            Ok(saving) => self.saving = Some(Underway { saving, record, is_wished }),
            Err(error) if is_wished => messages.error(&error.to_string()),
            Err(error) => self.complain(&error, messages),
        }
    }

    /// Waits for a save that has begun, and does the one that was wished for meanwhile, of the film that `film` gives; for an end
    /// without a last save.
    pub fn keep_word(&mut self, film: impl FnOnce() -> SavedFilm, messages: &mut dyn Messages) {
        self.wait_for_last(messages);
        if self.next == Next::Wished {
            self.begin(film(), messages);
            self.wait_for_last(messages);
        }
    }

    /// Waits for a save that has begun; the record of its film, if that is a file now.
    pub fn wait_for_last(&mut self, messages: &mut dyn Messages) -> Option<FilmRecord> {
        let Underway { saving, record, is_wished } = self.saving.take()?;
        let mut saved = saving.finish();
        let has_film = saved.written.contains(&self.job.paths.igi());
        if is_wished {
            self.announced = true;
            say_saved(&saved, messages);
            return record.filter(|_| has_film);
        }
        let first_failure = (!saved.failures.is_empty()).then(|| saved.failures.swap_remove(0));
        if let Some(error) = first_failure {
            self.complain(&error, messages);
        } else if !self.announced && !saved.written.is_empty() {
            self.announced = true;
            say_saved(&saved, messages);
        } else {
            for file in &saved.written {
                messages.detail(&format!("Saved {} again", file.display()));
            }
        }
        record.filter(|_| has_film)
    }

    /// A save that fails does not end the render: the disk may have room again later. It is said the
    /// first time and then ever more rarely.
    fn complain(&mut self, error: &SaveError, messages: &mut dyn Messages) {
        self.failures += 1;
        if self.failures.is_power_of_two() {
            messages.warn(&format!("{error}; rendering goes on, and saving will be tried again"));
        }
    }
}
