//! The internal pixels of a region of a picture.

use crate::Region;
use indigo_film::{FilmSize, XyzImage};
use rayon::prelude::*;

/// A rectangle of internal pixels, which may be empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    /// Column of the first pixel.
    pub left: usize,
    /// Its row.
    pub top: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Window {
    /// Of a region of a film.
    pub fn of(size: FilmSize, region: Region) -> Self {
        let factor = size.super_sample() as usize;
        let [x1, y1] = region.start().map(|v| v as usize * factor);
        let [x2, y2] = region.end().map(|v| v as usize * factor);
        Self { left: x1, top: y1, width: x2 - x1, height: y2 - y1 }
    }

    /// Whether there is no pixel in it.
    pub fn is_empty(&self) -> bool {
        self.width == 0 || self.height == 0
    }

    /// Row `y`, counted from its top.
    pub fn row<'a>(&self, image: &'a XyzImage, y: usize) -> &'a [[f32; 4]] {
        let start = (self.top + y) * image.size.internal_width() as usize + self.left;
        &image.pixels[start..start + self.width]
    }

    /// Its rows.
    pub fn rows<'a>(&self, image: &'a XyzImage) -> impl IndexedParallelIterator<Item = &'a [[f32; 4]]> {
        let window = *self;
        (0..self.height).into_par_iter().map(move |y| window.row(image, y))
    }

    /// Its rows, to be changed.
    pub fn rows_mut<'a>(
        &self,
        image: &'a mut XyzImage,
    ) -> impl IndexedParallelIterator<Item = &'a mut [[f32; 4]]> + use<'a> {
        let Self { left, top, width, height } = *self;
        let stride = image.size.internal_width() as usize;
        let rows = image.pixels.par_chunks_exact_mut(stride).skip(top).take(height);
        rows.map(move |row| &mut row[left..left + width])
    }
}
