//! The steps that every film shares: adding a brick of a delta to rows of sums, and turning sums
//! into radiance.

use crate::delta::{BRICK, Brick};
use crate::{FilmSize, LayerKind, Totals};

/// Rows of a film that are locked, merged and developed together: one row of bricks.
pub(crate) const BAND_ROWS: usize = BRICK;

/// Sums and counts of a run of rows, exclusively.
pub(crate) struct RowsMut<'a> {
    pub(crate) sums: &'a mut [[f64; 4]],
    pub(crate) counts: &'a mut [f64],
}

/// Number of bands of a film.
pub(crate) fn band_count(size: FilmSize) -> usize {
    (size.internal_height() as usize).div_ceil(BAND_ROWS)
}

/// Adds the touched bricks of one row of bricks to the band of rows that they cover.
pub(crate) fn add_bricks(bricks: &[Brick], width: usize, rows: &mut RowsMut<'_>) {
    for (column, brick) in bricks.iter().enumerate().filter(|(_, b)| b.touched()) {
        let x0 = column * BRICK;
        let n = BRICK.min(width - x0);
        for (r, row) in rows.sums.chunks_exact_mut(width).enumerate() {
            add_sums(&mut row[x0..x0 + n], brick.sums_of_row(r));
        }
        // A per-screen layer has no counts, hence no rows of them.
        for (r, row) in rows.counts.chunks_exact_mut(width).enumerate() {
            add_counts(&mut row[x0..x0 + n], brick.counts_of_row(r));
        }
    }
}

fn add_sums(into: &mut [[f64; 4]], from: &[[f32; 4]]) {
    for (sum, add) in into.iter_mut().zip(from) {
        // Most pixels of a sparse delta hold nothing: do not pull their sums into the cache.
        if *add != [0.0; 4] {
            for (s, &a) in sum.iter_mut().zip(add) {
                *s += f64::from(a);
            }
        }
    }
}

fn add_counts(into: &mut [f64], from: &[f32]) {
    for (count, &add) in into.iter_mut().zip(from) {
        *count += f64::from(add);
    }
}

/// Adds a layer's radiance to `out` (XYZ and alpha), and clears `missing` where the layer says
/// that a pixel has a sample. All slices cover the same pixels. `gain` multiplies the light, but not
/// what it covers.
pub(crate) fn develop_layer(
    (kind, totals): (LayerKind, &Totals),
    gain: f64,
    internal_pixels: usize,
    (sums, counts): (&[[f64; 4]], &[f64]),
    out: &mut [[f32; 4]],
    missing: &mut [bool],
) {
    match kind {
        LayerKind::PerPixel => {
            for (((sum, &count), pixel), missing) in sums.iter().zip(counts).zip(out).zip(missing) {
                if count > 0.0 {
                    accumulate(pixel, sum, 1.0 / count, gain);
                    *missing = false;
                }
            }
        }
        LayerKind::PerScreen => {
            let scale = totals.screen_scale(internal_pixels);
            for (sum, pixel) in sums.iter().zip(out) {
                accumulate(pixel, sum, scale, gain);
            }
        }
    }
}

#[inline]
fn accumulate(pixel: &mut [f32; 4], sum: &[f64; 4], scale: f64, gain: f64) {
    let light = scale * gain;
    for ((p, s), scale) in pixel.iter_mut().zip(sum).zip([light, light, light, scale]) {
        *p += (s * scale) as f32;
    }
}
