//! The film that many workers share: one lock per band of rows.

use crate::band::{BAND_ROWS, RowsMut, add_bricks, band_count, develop_layer};
use crate::state::check_fit;
use crate::{FilmDelta, FilmError, FilmSize, FilmState, Layer, LayerKind, LightMix, Totals, XyzImage};
use std::sync::{Mutex, MutexGuard, PoisonError, RwLock, TryLockError};

/// A film that workers merge their deltas into at the same time.
///
/// A merge holds the gate as a reader and one band at a time; a snapshot holds the gate alone, so
/// that sums and totals always agree in what it sees. Deltas merged in the same order by one
/// thread give the same bits.
#[derive(Debug)]
pub struct MasterFilm {
    size: FilmSize,
    layers: Vec<(LayerKind, String)>,
    gate: RwLock<()>,
    bands: Vec<Mutex<Band>>,
    tally: Mutex<Tally>,
}

/// The rows of a band, layer by layer.
#[derive(Debug)]
struct Band {
    layers: Vec<BandLayer>,
}

#[derive(Debug)]
struct BandLayer {
    sums: Vec<[f64; 4]>,
    counts: Vec<f64>,
}

/// What is counted for the film as a whole.
#[derive(Debug)]
struct Tally {
    layers: Vec<Totals>,
    refused: u64,
}

impl MasterFilm {
    /// A film without samples, with layers of these kinds and names. Errors: the system has not as much
    /// memory.
    pub fn new(size: FilmSize, layers: &[(LayerKind, impl AsRef<str>)]) -> Result<Self, FilmError> {
        let width = size.internal_width() as usize;
        let height = size.internal_height() as usize;
        let pixels = |band: usize| width * BAND_ROWS.min(height - band * BAND_ROWS);
        let band = |band: usize| {
            let layers = layers.iter().map(|(kind, _)| {
                let (sums, counts) = (pixels(band), kind.count_slots(pixels(band)));
                Some(BandLayer { sums: reserved(sums)?, counts: reserved(counts)? })
            });
            Some(Band { layers: layers.collect::<Option<_>>()? })
        };
        // All of it is asked for before any of it is used: a film that is too large fails at once.
        let Some(mut bands) = (0..band_count(size)).map(band).collect::<Option<Vec<Band>>>() else {
            return Err(FilmError::OutOfMemory {
                width: size.width(),
                height: size.height(),
                super_sample: size.super_sample(),
                bytes: Self::bytes_needed(size, layers.iter().map(|l| l.0)),
            });
        };
        for (number, band) in bands.iter_mut().enumerate() {
            for (layer, (kind, _)) in band.layers.iter_mut().zip(layers) {
                layer.sums.resize(pixels(number), [0.0; 4]);
                layer.counts.resize(kind.count_slots(pixels(number)), 0.0);
            }
        }
        Ok(Self {
            size,
            layers: layers.iter().map(|(kind, name)| (*kind, name.as_ref().to_owned())).collect(),
            gate: RwLock::new(()),
            bands: bands.into_iter().map(Mutex::new).collect(),
            tally: Mutex::new(Tally { layers: vec![Totals::default(); layers.len()], refused: 0 }),
        })
    }

    /// Bytes of the sums and counts of a film of that size with layers of these kinds.
    pub fn bytes_needed(size: FilmSize, kinds: impl IntoIterator<Item = LayerKind>) -> u64 {
        let pixel: usize = kinds.into_iter().map(LayerKind::pixel_bytes).sum();
        size.internal_pixels() as u64 * pixel as u64
    }

    /// The film's resolution.
    pub fn size(&self) -> FilmSize {
        self.size
    }

    /// An empty delta that fits this film.
    pub fn delta(&self) -> FilmDelta {
        FilmDelta::new(self.size, self.kinds())
    }

    /// Adds what a delta holds; may be called by any number of threads. Errors: the delta was made
    /// for another film.
    pub fn merge(&self, delta: &FilmDelta) -> Result<(), FilmError> {
        check_fit(delta, self.size, self.kinds())?;
        let _gate = self.gate.read().unwrap_or_else(PoisonError::into_inner);
        // Bands that another worker holds are left for a second pass, so that workers who hand
        // over together do not queue behind one another.
        let busy: Vec<usize> =
            (0..self.bands.len()).filter(|&band| !self.try_merge_band(delta, band)).collect();
        for band in busy {
            self.merge_band(delta, band, &mut lock(&self.bands[band]));
        }
        let mut tally = lock(&self.tally);
        for (mine, layer) in tally.layers.iter_mut().zip(delta.layers()) {
            mine.add(&layer.totals);
        }
        tally.refused += delta.refused();
        Ok(())
    }

    /// Adds a saved film, as a resumed or merged run does. Errors: sizes or layers differ.
    pub fn merge_state(&self, state: &FilmState) -> Result<(), FilmError> {
        if state.size != self.size {
            return Err(FilmError::SizeMismatch(self.size, state.size));
        }
        let pixels = self.size.internal_pixels();
        let same = |(mine, theirs): (&(LayerKind, String), &Layer)| {
            mine.0 == theirs.kind
                && mine.1 == theirs.name
                && theirs.sums.len() == pixels
                && theirs.counts.len() == theirs.kind.count_slots(pixels)
        };
        if self.layers.len() != state.layers.len() || !self.layers.iter().zip(&state.layers).all(same) {
            return Err(FilmError::LayerMismatch);
        }
        let _gate = self.gate.read().unwrap_or_else(PoisonError::into_inner);
        for (index, band) in self.bands.iter().enumerate() {
            lock(band).add_state(state, index * BAND_ROWS * self.size.internal_width() as usize);
        }
        let mut tally = lock(&self.tally);
        for (mine, layer) in tally.layers.iter_mut().zip(&state.layers) {
            mine.add(&layer.totals);
        }
        tally.refused = tally.refused.saturating_add(state.refused);
        Ok(())
    }

    /// A copy of the film as it stands, for saving.
    pub fn snapshot(&self) -> FilmState {
        self.copy_then(|_| {}, |_| {})
    }

    /// The film as it stands, of which nothing stays: as if all that is merged from now on went to a new film. What is
    /// drained and what stays are whole merges each, with the totals that go with them.
    pub fn drain(&self) -> FilmState {
        let empty_rows = |rows: &mut BandLayer| {
            rows.sums.fill([0.0; 4]);
            rows.counts.fill(0.0);
        };
        self.copy_then(empty_rows, |tally| {
            tally.layers.fill(Totals::default());
            tally.refused = 0;
        })
    }

    /// A copy of the film, made while nobody merges; then does something to its rows, and to what is counted for it as a
    /// whole.
    fn copy_then(&self, rows_done: impl Fn(&mut BandLayer), done: impl FnOnce(&mut Tally)) -> FilmState {
        let _gate = self.gate.write().unwrap_or_else(PoisonError::into_inner);
        let mut tally = lock(&self.tally);
        let mut layers: Vec<Layer> = self
            .layers
            .iter()
            .zip(&tally.layers)
            .map(|((kind, name), totals)| Layer {
                kind: *kind,
                name: name.clone(),
                sums: Vec::with_capacity(self.size.internal_pixels()),
                counts: Vec::with_capacity(kind.count_slots(self.size.internal_pixels())),
                totals: *totals,
            })
            .collect();
        for band in &self.bands {
            for (layer, rows) in layers.iter_mut().zip(&mut lock(band).layers) {
                layer.sums.extend_from_slice(&rows.sums);
                layer.counts.extend_from_slice(&rows.counts);
                rows_done(rows);
            }
        }
        let copy = FilmState { size: self.size, layers, refused: tally.refused };
        done(&mut tally);
        copy
    }

    /// Whether nothing has been merged, not even a sample that shows nothing.
    pub fn is_empty(&self) -> bool {
        let tally = lock(&self.tally);
        tally.refused == 0 && tally.layers.iter().all(|totals| *totals == Totals::default())
    }

    /// The film's radiance as it stands, without copying its sums; see [`FilmState::develop_mixed`].
    /// Merges wait meanwhile, and so must not themselves be tasks of the rayon pool that this
    /// runs on, which is the caller's.
    pub fn develop(&self, mix: &LightMix) -> XyzImage {
        let _gate = self.gate.write().unwrap_or_else(PoisonError::into_inner);
        let totals = lock(&self.tally).layers.clone();
        let counted = self.kinds().any(|kind| kind == LayerKind::PerPixel);
        let gains: Vec<f64> = self.layers.iter().map(|(_, name)| mix.gain(name)).collect();
        XyzImage::from_bands(self.size, counted, |index, out, missing| {
            let band = lock(&self.bands[index]);
            for (((kind, totals), rows), gain) in self.kinds().zip(&totals).zip(&band.layers).zip(&gains) {
                let rows = (&*rows.sums, &*rows.counts);
                develop_layer((kind, totals), *gain, self.size.internal_pixels(), rows, out, missing);
            }
        })
    }

    /// Samples per output pixel so far; see [`FilmState::samples_per_pixel`].
    pub fn samples_per_pixel(&self) -> f64 {
        Totals::draws(lock(&self.tally).layers.iter()) / self.size.pixels() as f64
    }

    /// Contributions that were refused since they were not finite.
    pub fn refused(&self) -> u64 {
        lock(&self.tally).refused
    }

    /// Bytes that its sums and counts hold.
    pub fn memory_bytes(&self) -> usize {
        Self::bytes_needed(self.size, self.kinds()) as usize
    }

    fn kinds(&self) -> impl Iterator<Item = LayerKind> + '_ {
        self.layers.iter().map(|&(kind, _)| kind)
    }

    /// Merges a band unless another thread holds it; whether it did.
    fn try_merge_band(&self, delta: &FilmDelta, index: usize) -> bool {
        let mut band = match self.bands[index].try_lock() {
            Ok(band) => band,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return false,
        };
        self.merge_band(delta, index, &mut band);
        true
    }

    fn merge_band(&self, delta: &FilmDelta, index: usize, band: &mut Band) {
        for (layer, rows) in band.layers.iter_mut().enumerate() {
            let mut rows = RowsMut { sums: &mut rows.sums, counts: &mut rows.counts };
            add_bricks(delta.band(layer, index), self.size.internal_width() as usize, &mut rows);
        }
    }
}

impl Band {
    /// Adds the rows of a saved film that start at pixel `from`.
    fn add_state(&mut self, state: &FilmState, from: usize) {
        for (rows, layer) in self.layers.iter_mut().zip(&state.layers) {
            for (a, b) in rows.sums.iter_mut().flatten().zip(layer.sums[from..].iter().flatten()) {
                *a += b;
            }
            for (a, b) in rows.counts.iter_mut().zip(layer.counts.iter().skip(from)) {
                *a += b;
            }
        }
    }
}

/// An empty vector with room for so many elements; `None` where the system has no memory for them.
fn reserved<T>(elements: usize) -> Option<Vec<T>> {
    let mut vec = Vec::new();
    vec.try_reserve_exact(elements).ok()?;
    Some(vec)
}

/// A lock whatever became of its last holder: additions leave no half-made state that matters more
/// than the panic that is already on its way.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_is_not_there_is_not_given() {
        assert!(reserved::<[f64; 4]>(usize::MAX / 32).is_none());
        assert!(reserved::<[f64; 4]>(0).is_some_and(|v| v.is_empty()));
    }
}
