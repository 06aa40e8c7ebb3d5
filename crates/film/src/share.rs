//! What can be added to a film: another one, or one that is still packed.

use crate::{FilmError, FilmRecord, LayerKind, Mismatch, SavedFilm, Totals};

/// The most samples, of a pixel or a film, that are counted: beyond it doubles do not count by ones.
const MOST_SAMPLES: f64 = (1u64 << 53) as f64;

/// Whether a number is one that counting by ones gives.
pub fn is_count(n: f64) -> bool {
    n.trunc() == n && (0.0..=MOST_SAMPLES).contains(&n)
}

/// What a layer counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted {
    /// How its sums become radiance.
    pub kind: LayerKind,
    /// Of the film as a whole.
    pub totals: Totals,
    /// Samples of all pixels together, if those of each are [counts](is_count).
    pub samples: Option<f64>,
}

impl Counted {
    /// With the counts of its pixels.
    pub(crate) fn new(kind: LayerKind, totals: Totals, counts: &[f64]) -> Self {
        let mut counted = Self { kind, totals, samples: Some(0.0) };
        counted.count(counts);
        counted
    }

    /// Adds the counts of more pixels.
    pub(crate) fn count(&mut self, counts: &[f64]) {
        // Without an early end, so that it is done for many at a time.
        let all = counts.iter().fold(true, |all, n| all & is_count(*n));
        self.samples = self.samples.filter(|_| all).map(|sum| sum + counts.iter().sum::<f64>());
    }
}

/// A film's share of a picture, to be added to others.
pub trait Share {
    /// Where it comes from.
    fn record(&self) -> Option<&FilmRecord>;

    /// What its layers count.
    fn counted(&self) -> Vec<Counted>;

    /// Adds it to an independent film of the same picture.
    ///
    /// # Errors
    /// All that keeps them apart; the film is untouched then.
    fn add_to(&self, sum: &mut SavedFilm) -> Result<(), Vec<Mismatch>>;

    /// Samples of the whole picture by what the layers count: see [`FilmState::samples_per_pixel`](crate::FilmState::samples_per_pixel).
    fn samples(&self) -> f64 {
        Totals::draws(self.counted().iter().map(|layer| &layer.totals))
    }
}

impl Share for SavedFilm {
    fn record(&self) -> Option<&FilmRecord> {
        self.record.as_ref()
    }

    fn counted(&self) -> Vec<Counted> {
        let of = |layer: &crate::Layer| Counted::new(layer.kind, layer.totals, &layer.counts);
        self.film.layers.iter().map(of).collect()
    }

    fn add_to(&self, sum: &mut SavedFilm) -> Result<(), Vec<Mismatch>> {
        let record = self.record.as_ref().ok_or_else(|| vec![Mismatch::Film(FilmError::Foreign)])?;
        sum.add(record, |film| film.merge_state(&self.film))
    }
}
