//! The master's film, to which each slave's work is added exactly once.
//!
//! No list of received uploads is kept beside the film, which could then say something else than the film: its record
//! tells which units of which seed are in it ([`FilmRecord::runs`]), and each slave renders a seed of its own, in order.
//! So an upload of units that are in the film already is a repetition, whose first answer was lost, before the master was
//! killed or after. What a file of the film holds is known to its reader in the same way.

use indigo_film::{
    FilmError, FilmRecord, FilmSize, FilmState, LayerKind, Mismatch, Run, SavedFilm, Share, Totals, is_count,
};
use std::collections::HashMap;

/// The longest time of rendering of an upload, in seconds: a year.
const LONGEST: f64 = 365.0 * 86_400.0;

/// The film and what of it is on the disk.
#[derive(Debug)]
pub struct Ledger {
    sum: SavedFilm,
    /// Which units were in the last film that was saved.
    durable: FilmRecord,
    /// How many copies of the film were taken to be saved.
    generation: u64,
    /// Where each seed's last upload ended, and which generation it went to.
    last: HashMap<u64, (u64, u64)>,
}

/// What became of an upload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Receipt {
    /// The unit after the last of that seed in the film.
    pub merged_end: u64,
    /// The same of the film on the disk.
    pub durable_end: u64,
    /// Uploads of one generation are saved together. That of a repetition is known if it came last.
    pub generation: Option<u64>,
    /// Whether it was there already.
    pub is_repeated: bool,
    /// Units before the upload that never came, and will not.
    pub missing: u64,
}

/// Why an upload is not added. Whoever sent it is not what it says it is, or damaged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// It tells nothing of where it comes from, or too much.
    #[error("an upload holds one run of units of the slave's own seed")]
    NotOneRun,
    /// It holds units that are in the film, and others that are not.
    #[error("units {first} to {last} of seed {seed} would count twice")]
    Overlap {
        /// The seed.
        seed: u64,
        /// First unit in both.
        first: u64,
        /// Last unit in both.
        last: u64,
    },
    /// Its samples are not as many as it says, or more than can be.
    #[error("the number of samples is impossible")]
    Samples,
    /// It says that it took longer than can be.
    #[error("the time of rendering is impossible")]
    Time,
    /// It is of another picture.
    #[error("it is of another picture: {}", words(.0))]
    Mismatch(Vec<Mismatch>),
}

fn words(reasons: &[Mismatch]) -> String {
    let words: Vec<String> = reasons.iter().map(ToString::to_string).collect();
    words.join("; ")
}

impl Ledger {
    /// With a film without samples, or one that was saved and is gone on with.
    ///
    /// # Errors
    /// A film of another program cannot be added to.
    pub fn new(film: SavedFilm) -> Result<Self, FilmError> {
        let durable = film.record.clone().ok_or(FilmError::Foreign)?;
        Ok(Self { sum: film, durable, generation: 0, last: HashMap::new() })
    }

    /// The record of the film as it stands.
    pub fn record(&self) -> &FilmRecord {
        // `new` has seen to it that there is one.
        self.sum.record.as_ref().unwrap_or(&self.durable)
    }

    /// Where a seed's units end in the film, and in the one on the disk.
    pub fn ends(&self, seed: u64) -> (u64, u64) {
        (self.record().first_fresh_unit(seed), self.durable.first_fresh_unit(seed))
    }

    /// The generation of the upload of a seed that ended there, if it is the last.
    pub fn generation_of(&self, seed: u64, end: u64) -> Option<u64> {
        self.last.get(&seed).filter(|last| last.0 == end).map(|last| last.1)
    }

    /// The film's resolution.
    pub fn size(&self) -> FilmSize {
        self.sum.film.size
    }

    /// The film's sums.
    pub fn sums(&self) -> &FilmState {
        &self.sum.film
    }

    /// Adds a film to the sum, unless it is there already. Nothing changes where it is refused.
    ///
    /// # Errors
    /// Why it is refused.
    pub fn take(&mut self, seed: u64, film: &impl Share) -> Result<Receipt, Refusal> {
        let record = film.record().ok_or(Refusal::NotOneRun)?;
        let run = match record.runs[..] {
            [run] if run.seed == seed && run.first < run.end => run,
            _ => return Err(Refusal::NotOneRun),
        };
        let (merged_end, durable_end) = self.ends(seed);
        if run.end <= merged_end {
            let generation = self.generation_of(seed, run.end);
            return Ok(Receipt { merged_end, durable_end, generation, is_repeated: true, missing: 0 });
        }
        if run.first < merged_end {
            return Err(Refusal::Overlap { seed, first: run.first, last: merged_end - 1 });
        }
        check_counts(film, record)?;
        film.add_to(&mut self.sum).map_err(Refusal::Mismatch)?;
        self.last.insert(seed, (run.end, self.generation));
        let generation = Some(self.generation);
        let missing = run.first - merged_end;
        Ok(Receipt { merged_end: run.end, durable_end, generation, is_repeated: false, missing })
    }

    /// A copy of the film, to be saved: what is added from now on belongs to the next one.
    pub fn copy(&mut self) -> SavedFilm {
        self.generation += 1;
        self.sum.clone()
    }

    /// A copy of the film was saved, and this was its record.
    pub fn saved(&mut self, record: FilmRecord) {
        self.durable = record;
    }
}

/// Sums are finite, as their reader has made sure; what is counted must be such numbers as counting gives.
fn check_counts(film: &impl Share, record: &FilmRecord) -> Result<(), Refusal> {
    for layer in film.counted() {
        let Totals { n_samples, n_idle, b_sum, b_count } = layer.totals;
        let has_counts = [n_samples, n_idle, b_count].into_iter().all(is_count)
            && (0.0..=f64::from(f32::MAX) * b_count).contains(&b_sum);
        // Each sample of such a layer belongs to one pixel.
        let adds_up =
            layer.samples.is_some_and(|samples| layer.kind != LayerKind::PerPixel || samples == n_samples);
        if !(has_counts && adds_up) {
            return Err(Refusal::Samples);
        }
    }
    if !(0.0..=LONGEST).contains(&record.elapsed_s) {
        return Err(Refusal::Time);
    }
    if film.samples().round() as u64 == record.samples { Ok(()) } else { Err(Refusal::Samples) }
}

/// The run of a film that has one.
pub(crate) fn run_of(film: &impl Share) -> Option<Run> {
    match film.record()?.runs[..] {
        [run] => Some(run),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
