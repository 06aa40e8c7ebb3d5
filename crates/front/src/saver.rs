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
    announced: bool,
    failures: usize,
}

/// A save that has begun, and the record of its film.
struct Underway {
    saving: Saving,
    record: Option<FilmRecord>,
}

impl Saver {
    /// The first save is due when the period has passed that the scene sets.
    pub fn new(job: SaveJob) -> Self {
        let period = job.development.output.image_save_period;
        let period = Duration::try_from_secs_f64(period).unwrap_or(Duration::MAX);
        Self { job, period, saving: None, last: Instant::now(), announced: false, failures: 0 }
    }

    /// What is saved.
    pub fn job(&self) -> &SaveJob {
        &self.job
    }

    /// The same, to be changed from the next save on.
    pub fn job_mut(&mut self) -> &mut SaveJob {
        &mut self.job
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
        self.saving.is_none() && self.last.elapsed() >= self.period
    }

    /// Begins a save.
    pub fn begin(&mut self, film: SavedFilm, messages: &mut dyn Messages) {
        self.last = Instant::now();
        let record = film.record.clone();
        match self.job.spawn(film) {
            Ok(saving) => self.saving = Some(Underway { saving, record }),
            Err(error) => self.complain(&error, messages),
        }
    }

    /// Waits for a save that has begun; the record of its film, if that is a file now.
    pub fn wait_for_last(&mut self, messages: &mut dyn Messages) -> Option<FilmRecord> {
        let Underway { saving, record } = self.saving.take()?;
        let mut saved = saving.finish();
        let has_film = saved.written.contains(&self.job.paths.igi());
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
