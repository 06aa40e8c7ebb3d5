//! Parcels: films on their way, added to others without being unpacked as a whole.

use super::blocks::{BLOCK, Packed};
use super::read::{Content, PackedLayer, check_counts, sound_content};
use super::{IgiError, parcel_size};
use crate::share::{Counted, Share};
use crate::{FilmError, FilmRecord, FilmSize, FilmState, Mismatch, SavedFilm};

/// What [`write_parcel`](super::write_parcel) has written, looked through and found sound: the hash is that of the content,
/// and all sums and counts can be. Its numbers stay packed: block by block they are unpacked to be looked at and again to be
/// added, in the processor's cache, which takes less time than a film of room that is cleared, filled and read again.
pub struct Parcel<'a> {
    content: Content<'a>,
    counted: Vec<Counted>,
}

impl<'a> Parcel<'a> {
    /// Looks through a parcel. Runs on the caller's rayon pool.
    ///
    /// # Errors
    /// See [`IgiError`]: what comes from another machine is believed as little as a file.
    pub fn open(parcel: &'a [u8]) -> Result<Self, IgiError> {
        let size = parcel_size(parcel)?;
        let (is_sound, opened) = sound_content(parcel, size, |content| {
            let counted = content.layers.iter().map(|layer| look_through(layer, size));
            let counted = counted.collect::<Result<_, _>>()?;
            Ok(Self { content, counted })
        })?;
        if is_sound { opened } else { Err(IgiError::Checksum) }
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
        let mut room = Room::default();
        for (mine, theirs) in film.layers.iter_mut().zip(layers) {
            mine.totals.add(&theirs.totals);
            let Room { planes, values } = &mut room;
            for (packed, sums) in
                [(&theirs.sums, mine.sums.as_flattened_mut()), (&theirs.counts, &mut mine.counts[..])]
            {
                for (i, sums) in sums.chunks_mut(BLOCK).enumerate() {
                    values.resize(sums.len(), 0.0);
                    // The same bytes were unpacked before without a fault.
                    packed.unpack_block(i, planes, values).map_err(|_| FilmError::LayerMismatch)?;
                    sums.iter_mut().zip(&*values).for_each(|(sum, value)| *sum += value);
                }
            }
        }
        film.refused += self.content.refused;
        Ok(())
    }
}

/// What unpacking needs room for.
#[derive(Default)]
struct Room {
    planes: Vec<u8>,
    values: Vec<f64>,
}

/// Unpacks all blocks of a layer and sees that they are sound; what it counts.
fn look_through(layer: &PackedLayer<'_>, size: FilmSize) -> Result<Counted, IgiError> {
    let (pixels, mut room) = (size.internal_pixels(), Room::default());
    let mut counted = Counted::new(layer.kind, layer.totals, &[]);
    room.each_block(&layer.sums, 4 * pixels, |_| Ok(()))?;
    room.each_block(&layer.counts, layer.kind.count_slots(pixels), |counts| {
        counted.count(counts);
        check_counts(counts)
    })?;
    Ok(counted)
}

impl Room {
    /// Shows `look` so many numbers, block by block.
    fn each_block(
        &mut self,
        packed: &Packed<'_>,
        numbers: usize,
        mut look: impl FnMut(&[f64]) -> Result<(), IgiError>,
    ) -> Result<(), IgiError> {
        for i in 0..numbers.div_ceil(BLOCK) {
            self.values.resize(BLOCK.min(numbers - i * BLOCK), 0.0);
            packed.unpack_block(i, &mut self.planes, &mut self.values)?;
            look(&self.values)?;
        }
        Ok(())
    }
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
