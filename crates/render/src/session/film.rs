//! The film of a running render: copied, saved, drained.

use super::Session;
use crate::saved::blank_record;
use indigo_film::{FilmState, MasterFilm, Run, SavedFilm};
use std::sync::atomic::Ordering;

impl Session {
    /// A copy of the film as it has been handed over so far.
    pub fn snapshot(&self) -> FilmState {
        self.sum_of(MasterFilm::snapshot)
    }

    /// The sum of the session's films, each as `taken`.
    fn sum_of(&self, taken: impl Fn(&MasterFilm) -> FilmState) -> FilmState {
        let mut films = self.shared.films.iter().map(taken);
        let first = films.next().unwrap_or_else(|| unreachable!("a session has a film"));
        films.fold(first, |mut sum, film| {
            sum.merge_state(&film).unwrap_or_else(|e| unreachable!("films of one session: {e}"));
            sum
        })
    }

    /// The same with its record, ready to be saved.
    pub fn saved(&self, program: &str) -> SavedFilm {
        let film = self.snapshot();
        // Read after the sums were copied, so that no unit in them is beyond it.
        let end = self.end_of_units();
        self.with_record(film, program, end)
    }

    /// Takes the film as it has been handed over so far, with its record: the session goes on with an empty one, as a
    /// network slave does after each upload. Records of films drained one after another have runs that follow each
    /// other and are never empty; their sum is the film that would have been without drains. `None` while nothing has
    /// been handed over since the last drain.
    ///
    /// Not for sessions that estimate an error ([`Halt::relative_error`](crate::Halt::relative_error)): that would be of what is left.
    pub fn drain(&mut self, program: &str) -> Option<SavedFilm> {
        let has_ended = self.workers.is_empty();
        let is_nameless = self.end_of_units() == self.first_unit;
        // Units that were begun before the last drain may have been handed over when none has been begun since. Then they
        // wait for the next that is begun, by which the run is told from the last one.
        if self.shared.films.iter().all(MasterFilm::is_empty) || is_nameless && !has_ended {
            return None;
        }
        let film = self.sum_of(MasterFilm::drain);
        // After the end none is begun any more: the run claims one that nobody has rendered, and nobody will.
        let end = self.end_of_units().max(self.first_unit + 1);
        let drained = self.with_record(film, program, end);
        self.first_unit = end;
        self.drained_after = self.elapsed();
        self.before = blank_record(&self.shared.scene, "");
        Some(drained)
    }

    /// The unit after the last one that was begun.
    fn end_of_units(&self) -> u64 {
        self.shared.next_unit.load(Ordering::Relaxed).min(self.shared.unit_limit)
    }

    /// A film of this session with its record, with units up to `end`.
    fn with_record(&self, film: FilmState, program: &str, end: u64) -> SavedFilm {
        let mut record = self.before.clone();
        program.clone_into(&mut record.program);
        record.add_run(Run { seed: self.shared.seed, first: self.first_unit, end });
        record.samples = (film.samples_per_pixel() * film.size.pixels() as f64).round() as u64;
        record.elapsed_s += self.elapsed().saturating_sub(self.drained_after).as_secs_f64();
        SavedFilm { film, record: Some(record) }
    }
}
