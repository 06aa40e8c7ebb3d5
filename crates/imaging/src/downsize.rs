//! Downsizing: from internal to output pixels by a separable filter.

use crate::Region;
use indigo_film::{FilmSize, Filter};
use indigo_math::pages::fresh;
use rayon::prelude::*;

/// The least mass of a filter cut off by the border by which its weights are divided. Parameters
/// in [0, 1] never leave less than 0.5; absurd ones lose light there instead of exploding.
const LEAST_MASS: f64 = 0.25;

/// Filters the internal pixels of a region down to its output pixels. `fill_row` writes the
/// internal row of that index (counted from the region's top) for the region's columns. The
/// result holds the region's rows from top to bottom.
pub(crate) fn downsize(
    size: FilmSize,
    region: Region,
    filter: Filter,
    fill_row: impl Fn(usize, &mut [[f32; 4]]) + Sync,
) -> Vec<[f32; 4]> {
    let [width, height] = extent(region);
    let factor = size.super_sample() as usize;
    if width == 0 || height == 0 {
        return Vec::new();
    }
    if factor == 1 {
        // A pixel is its own, without buffers between.
        let mut out = fresh(vec![[0.0; 4]; width * height]);
        out.par_chunks_mut(width).enumerate().for_each(|(y, row)| fill_row(y, row));
        return out;
    }
    let columns = Kernel::new(filter, width, factor);
    let rows = Kernel::new(filter, height, factor);
    // Along the rows first, so that only narrow rows need to be kept.
    let mut narrow = fresh(vec![[0.0; 4]; width * height * factor]);
    narrow.par_chunks_mut(width).enumerate().for_each_init(
        || vec![[0.0; 4]; width * factor],
        |wide, (y, row)| {
            fill_row(y, wide);
            columns.filter_row(wide, row);
        },
    );
    let mut out = fresh(vec![[0.0; 4]; width * height]);
    out.par_chunks_mut(width).enumerate().for_each(|(y, row)| rows.sum_rows(y, &narrow, row));
    out
}

/// Width and height of a region in output pixels.
pub(crate) fn extent(region: Region) -> [usize; 2] {
    let ([x1, y1], [x2, y2]) = (region.start(), region.end());
    [(x2 - x1) as usize, (y2 - y1) as usize]
}

/// The weights with which internal pixels make up output pixels along one axis.
struct Kernel {
    taps: Vec<Taps>,
    weights: Vec<f32>,
}

/// A run of internal pixels, from `first`, and where their weights begin and end.
struct Taps {
    first: usize,
    weights: std::ops::Range<usize>,
}

impl Kernel {
    /// For `len` output pixels of `factor` internal ones each.
    fn new(filter: Filter, len: usize, factor: usize) -> Self {
        let mut kernel = Self { taps: Vec::with_capacity(len), weights: Vec::new() };
        for i in 0..len {
            kernel.push_filter(filter, i, len * factor, factor as f64);
        }
        kernel
    }

    fn push_filter(&mut self, filter: Filter, i: usize, internal: usize, factor: f64) {
        let centre = (i as f64 + 0.5) * factor;
        let reach = filter.radius() * factor;
        let first = (centre - reach).floor().max(0.0) as usize;
        let last = ((centre + reach).ceil() as usize).min(internal);
        let weight = |p: usize| filter.eval((p as f64 + 0.5 - centre) / factor);
        let mass = ((first..last).map(weight).sum::<f64>() / factor).max(LEAST_MASS);
        self.push(first, (first..last).map(|p| weight(p) / (mass * factor)));
    }

    fn push(&mut self, first: usize, weights: impl Iterator<Item = f64>) {
        let start = self.weights.len();
        self.weights.extend(weights.map(|w| w as f32));
        self.taps.push(Taps { first, weights: start..self.weights.len() });
    }

    fn filter_row(&self, from: &[[f32; 4]], to: &mut [[f32; 4]]) {
        for (taps, out) in self.taps.iter().zip(to) {
            *out = [0.0; 4];
            for (weight, pixel) in self.weights[taps.weights.clone()].iter().zip(&from[taps.first..]) {
                add_scaled(out, pixel, *weight);
            }
        }
    }

    /// Output row `y` from the internal rows, which are as long as it is.
    fn sum_rows(&self, y: usize, rows: &[[f32; 4]], to: &mut [[f32; 4]]) {
        let taps = &self.taps[y];
        let rows = rows.chunks_exact(to.len()).skip(taps.first);
        for (weight, row) in self.weights[taps.weights.clone()].iter().zip(rows) {
            for (out, pixel) in to.iter_mut().zip(row) {
                add_scaled(out, pixel, *weight);
            }
        }
    }
}

#[inline]
fn add_scaled(sum: &mut [f32; 4], pixel: &[f32; 4], weight: f32) {
    for (s, p) in sum.iter_mut().zip(pixel) {
        *s += p * weight;
    }
}
