//! The developed film: radiance per internal pixel, with gaps filled for previews.

use crate::FilmSize;
use crate::band::BAND_ROWS;
use indigo_math::pages::fresh;
use rayon::prelude::*;
use std::convert::Infallible;

/// A film developed, at internal resolution.
#[derive(Clone, Debug, PartialEq)]
pub struct XyzImage {
    /// The film's resolution; the image has its internal width and height.
    pub size: FilmSize,
    /// X, Y, Z in cd/m² and alpha (0 background to 1 foreground), rows from top to bottom.
    pub pixels: Vec<[f32; 4]>,
    /// Where no per-pixel layer has a sample yet, while others of the film may have. Such a pixel
    /// shows the mean of the sampled internal pixels of its output pixel, so that a render that
    /// has just begun can be previewed, else black. All false in a film without per-pixel layers.
    pub missing: Vec<bool>,
}

impl XyzImage {
    /// Develops a film band by band, on the caller's rayon pool: `develop` adds the radiance of a
    /// band's pixels to its second argument and clears the third where there are samples.
    /// `counted` tells whether the film has a per-pixel layer at all.
    pub(crate) fn from_bands(
        size: FilmSize,
        counted: bool,
        develop: impl Fn(usize, &mut [[f32; 4]], &mut [bool]) + Sync,
    ) -> Self {
        let band_pixels = BAND_ROWS * size.internal_width() as usize;
        let band = |(): &mut (), band, out: &mut [_], missing: &mut [_]| {
            develop(band, out, missing);
            Ok::<_, Infallible>(())
        };
        let Ok(image) = Self::from_chunks(size, counted, band_pixels, || (), band);
        image
    }

    /// The same by runs of so many pixels, whose development may fail, with room that is made once for many of them.
    pub(crate) fn from_chunks<R, E: Send>(
        size: FilmSize,
        counted: bool,
        chunk_pixels: usize,
        room: impl Fn() -> R + Sync + Send,
        develop: impl Fn(&mut R, usize, &mut [[f32; 4]], &mut [bool]) -> Result<(), E> + Sync,
    ) -> Result<Self, E> {
        let mut pixels = fresh(vec![[0.0; 4]; size.internal_pixels()]);
        let mut missing = vec![counted; size.internal_pixels()];
        let chunks = pixels.par_chunks_mut(chunk_pixels).zip(missing.par_chunks_mut(chunk_pixels));
        chunks
            .enumerate()
            .try_for_each_init(room, |room, (i, (out, missing))| develop(room, i, out, missing))?;
        let mut image = Self { size, pixels, missing };
        if counted {
            image.fill_missing();
        }
        Ok(image)
    }

    /// Gives each pixel without a sample the mean of the sampled ones of its output pixel.
    fn fill_missing(&mut self) {
        let side = self.size.super_sample() as usize;
        let width = self.size.internal_width() as usize;
        self.pixels
            .par_chunks_mut(side * width)
            .zip(self.missing.par_chunks(side * width))
            .filter(|(_, missing)| missing.contains(&true))
            .for_each(|(rows, missing)| {
                for x in (0..width).step_by(side) {
                    fill_block(rows, missing, (0..side).map(|y| y * width + x), side);
                }
            });
    }
}

/// Fills one output pixel's block, whose rows of `side` pixels start at the given indices.
fn fill_block(
    pixels: &mut [[f32; 4]],
    missing: &[bool],
    starts: impl Iterator<Item = usize> + Clone,
    side: usize,
) {
    let indices = starts.flat_map(|s| s..s + side);
    let (mut sum, mut n) = ([0.0f32; 4], 0);
    for i in indices.clone().filter(|&i| !missing[i]) {
        n += 1;
        for (s, p) in sum.iter_mut().zip(pixels[i]) {
            *s += p;
        }
    }
    let mean = sum.map(|s| if n > 0 { s / n as f32 } else { 0.0 });
    for i in indices.filter(|&i| missing[i]) {
        pixels[i] = mean;
    }
}
