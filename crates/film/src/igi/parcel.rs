//! Parcels: films on their way, added to others without being unpacked as a whole.

use super::blocks::{BLOCK, Scratch};
use super::read::{Content, PackedLayer, check_counts, parcel_content};
use super::{IgiError, parcel_size};
use crate::share::{Counted, Share};
use crate::{FilmError, FilmRecord, FilmSize, FilmState, Mismatch, SavedFilm};

/// What [`write_parcel`](super::write_parcel) has written, looked through and found sound:
/// all sums and counts can be. Its numbers stay packed: block by block they are unpacked to be looked at and again to be
/// added, in the processor's cache, which takes less time than a film of room that is cleared, filled and read again.
pub struct Parcel<'a> {
    content: Content<'a>,
    counted: Vec<Counted>,
}

impl<'a> Parcel<'a> {
    /// Looks through a parcel.
    ///
    /// # Errors
    /// See [`IgiError`]: what comes from another machine is believed as little as a file.
    pub fn open(parcel: &'a [u8]) -> Result<Self, IgiError> {
        let size = parcel_size(parcel)?;
        let content = parcel_content(parcel, size)?;
        let counted = content.layers.iter().map(|layer| look_through(layer, size));
        let counted = counted.collect::<Result<_, _>>()?;
        Ok(Self { content, counted })
    }

    /// The size of the film.
    pub fn size(&self) -> FilmSize {
        self.content.size
    }

    /// Adds the sums and counts of all layers.
    fn add_layers(&self, film: &mut FilmState) -> Result<(), FilmError> {
        if self.content.size != film.size {
            return Err(FilmError::SizeMismatch(film.size, self.content.size));
        }
        let layers = &self.content.layers;
        let is_same = film.layers.len() == layers.len()
            && film.layers.iter().zip(layers).all(|(a, b)| (a.kind, &a.name) == (b.kind, &b.name));
        if !is_same {
            return Err(FilmError::LayerMismatch);
        }
        let mut scratch = Scratch::default();
        for (mine, theirs) in film.layers.iter_mut().zip(layers) {
            mine.totals.add(&theirs.totals);
            for (packed, sums) in
                [(&theirs.sums, mine.sums.as_flattened_mut()), (&theirs.counts, &mut mine.counts[..])]
            {
                for (i, sums) in sums.chunks_mut(BLOCK).enumerate() {
                    // The same bytes were unpacked before without a fault.
                    packed.add_block(i, &mut scratch, sums).map_err(|_| FilmError::LayerMismatch)?;
                }
            }
        }
        // A peer's number may be any.
        film.refused = film.refused.saturating_add(self.content.refused);
        Ok(())
    }
}

/// Unpacks all blocks of a layer and sees that they are sound; what it counts.
fn look_through(layer: &PackedLayer<'_>, size: FilmSize) -> Result<Counted, IgiError> {
    let (pixels, mut scratch, mut values) = (size.internal_pixels(), Scratch::default(), vec![]);
    let mut counted = Counted::new(layer.kind, layer.totals, &[]);
    for (i, sums) in block_lengths(4 * pixels) {
        layer.sums.check_block(i, &mut scratch, sums)?;
    }
    for (i, counts) in block_lengths(layer.kind.count_slots(pixels)) {
        values.resize(counts, 0.0);
        layer.counts.unpack_block(i, &mut scratch, &mut values)?;
        counted.count(&values);
        check_counts(&values)?;
    }
    Ok(counted)
}

/// The blocks of so many numbers: which it is, and how many numbers it has.
fn block_lengths(numbers: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..numbers.div_ceil(BLOCK)).map(move |i| (i, BLOCK.min(numbers - i * BLOCK)))
}

impl Share for Parcel<'_> {
    fn record(&self) -> Option<&FilmRecord> {
        Some(&self.content.record)
    }

    fn counted(&self) -> Vec<Counted> {
        self.counted.clone()
    }

    fn add_to(&self, sum: &mut SavedFilm) -> Result<(), Vec<Mismatch>> {
        sum.add(&self.content.record, |film| self.add_layers(film))
    }
}
