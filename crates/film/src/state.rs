//! A film as plain data: what is saved, resumed, merged and developed.

use crate::band::{BAND_ROWS, RowsMut, add_bricks, develop_layer};
use crate::{FilmDelta, FilmError, FilmSize, Layer, LayerKind, LightMix, Totals, XyzImage};

/// All sums of a film in double precision.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmState {
    /// Its resolution.
    pub size: FilmSize,
    /// Its layers; the film's radiance is their sum.
    pub layers: Vec<Layer>,
    /// Contributions that were refused since they were not finite.
    pub refused: u64,
}

impl FilmState {
    /// A film without samples, with layers of these kinds and names.
    pub fn new(size: FilmSize, layers: &[(LayerKind, impl AsRef<str>)]) -> Self {
        let layers = layers
            .iter()
            .map(|(kind, name)| Layer::new(*kind, name.as_ref(), size.internal_pixels()))
            .collect();
        Self { size, layers, refused: 0 }
    }

    /// An empty delta that fits this film.
    pub fn delta(&self) -> FilmDelta {
        FilmDelta::new(self.size, self.layers.iter().map(|l| l.kind))
    }

    /// Adds what a delta holds. Errors: the delta was made for another film.
    pub fn merge(&mut self, delta: &FilmDelta) -> Result<(), FilmError> {
        check_fit(delta, self.size, self.layers.iter().map(|l| l.kind))?;
        let width = self.size.internal_width() as usize;
        for (index, layer) in self.layers.iter_mut().enumerate() {
            layer.totals.add(&delta.layers()[index].totals);
            let mut counts = layer.counts.chunks_mut(BAND_ROWS * width);
            for (band, sums) in layer.sums.chunks_mut(BAND_ROWS * width).enumerate() {
                let counts = counts.next().unwrap_or_default();
                add_bricks(delta.band(index, band), width, &mut RowsMut { sums, counts });
            }
        }
        self.refused += delta.refused();
        Ok(())
    }

    /// Adds another film: of another thread, machine or session. Errors: sizes differ, or layers
    /// differ in number, kind or name.
    pub fn merge_state(&mut self, other: &Self) -> Result<(), FilmError> {
        if self.size != other.size {
            return Err(FilmError::SizeMismatch(self.size, other.size));
        }
        let same = |(a, b): (&Layer, &Layer)| {
            (a.kind, &a.name, a.sums.len(), a.counts.len()) == (b.kind, &b.name, b.sums.len(), b.counts.len())
        };
        if self.layers.len() != other.layers.len() || !self.layers.iter().zip(&other.layers).all(same) {
            return Err(FilmError::LayerMismatch);
        }
        for (mine, theirs) in self.layers.iter_mut().zip(&other.layers) {
            mine.totals.add(&theirs.totals);
            for (a, b) in mine.sums.iter_mut().flatten().zip(theirs.sums.iter().flatten()) {
                *a += b;
            }
            for (a, b) in mine.counts.iter_mut().zip(&theirs.counts) {
                *a += b;
            }
        }
        self.refused = self.refused.saturating_add(other.refused);
        Ok(())
    }

    /// The film's radiance per internal pixel: the sum of its layers, each by its own
    /// normalisation. Runs on the caller's rayon pool.
    pub fn develop(&self) -> XyzImage {
        self.develop_layers(|_| true)
    }

    /// The same of the layers whose names are wanted.
    pub fn develop_layers(&self, is_wanted: impl Fn(&str) -> bool) -> XyzImage {
        self.develop_mixed(&LightMix::default(), is_wanted)
    }

    /// The same with each group of lights as bright as it is in a mix.
    pub fn develop_mixed(&self, mix: &LightMix, is_wanted: impl Fn(&str) -> bool) -> XyzImage {
        let wanted = self.layers.iter().filter(|l| is_wanted(&l.name));
        let wanted: Vec<(&Layer, f64)> = wanted.map(|layer| (layer, mix.gain(&layer.name))).collect();
        let counted = wanted.iter().any(|(l, _)| l.kind == LayerKind::PerPixel);
        let band_pixels = BAND_ROWS * self.size.internal_width() as usize;
        XyzImage::from_bands(self.size, counted, |band, out, missing| {
            for (layer, gain) in &wanted {
                let from = (band * band_pixels).min(layer.sums.len());
                let pixels = from..(from + band_pixels).min(layer.sums.len());
                let counts = match layer.kind {
                    LayerKind::PerPixel => &layer.counts[pixels.clone()],
                    LayerKind::PerScreen => &[],
                };
                let rows = (&layer.sums[pixels], counts);
                let is = (layer.kind, &layer.totals);
                develop_layer(is, *gain, self.size.internal_pixels(), rows, out, missing);
            }
        })
    }

    /// Samples per output pixel: camera paths (with the light paths drawn with them) and mutations, by the
    /// pixels of the whole picture, whether or not only a region of it is rendered.
    pub fn samples_per_pixel(&self) -> f64 {
        Totals::draws(self.layers.iter().map(|l| &l.totals)) / self.size.pixels() as f64
    }

    /// Bytes that its sums and counts hold.
    pub fn memory_bytes(&self) -> usize {
        self.layers.iter().map(|l| size_of_val(&*l.sums) + size_of_val(&*l.counts)).sum()
    }
}

/// Whether a delta was made for a film of that size with layers of these kinds.
pub(crate) fn check_fit(
    delta: &FilmDelta,
    size: FilmSize,
    kinds: impl Iterator<Item = LayerKind>,
) -> Result<(), FilmError> {
    if delta.size() != size {
        return Err(FilmError::SizeMismatch(size, delta.size()));
    }
    if !delta.fits(size, kinds) {
        return Err(FilmError::LayerMismatch);
    }
    Ok(())
}
