//! The power spectrum of a drawing.

// tidy: load-time mathematics

use super::fft::{Complex, Transform};
use crate::Mask;
use rayon::prelude::*;

/// Columns that are transformed together: what is read from a row of memory at once.
const BATCH: usize = 8;

/// |Â|² of a drawing A of the unit square at low frequencies, in cycles across the square.
pub(super) struct PowerSpectrum {
    /// The spectrum is known for 0 ≤ x ≤ half and -half ≤ y ≤ half, in steps.
    half: usize,
    /// Steps per cycle.
    steps: usize,
    /// Column after column.
    values: Vec<f32>,
}

impl PowerSpectrum {
    /// The spectrum up to `cycles` in steps of 1 / `steps` of a cycle: the drawing is surrounded by
    /// so many of its widths of darkness. Both it and the drawing's side are powers of two; `cycles` is less than half the cells of a side.
    ///
    /// A drawing holds means over its cells, which damps high frequencies by the transform of a cell; that
    /// is taken back. What lies beyond the cells' own frequency and is folded back remains.
    pub fn new(mask: &Mask, steps: usize, cycles: usize) -> Self {
        let half = cycles * steps + 1;
        let rows = transformed_rows(mask, steps, half + 1);
        let height = 2 * half + 1;
        let mut values = vec![0.0; (half + 1) * height];
        let fft = Transform::new(mask.side * steps);
        let scale = 1.0 / (mask.side * mask.side) as f64;
        values.par_chunks_mut(BATCH * height).enumerate().for_each_init(
            || vec![[0.0; 2]; BATCH * mask.side * steps],
            |buffer, (batch, out)| {
                let first = batch * BATCH;
                let count = out.len() / height;
                buffer.fill([0.0; 2]);
                for (y, row) in rows.chunks_exact(half + 1).enumerate() {
                    for (i, &v) in row[first..first + count].iter().enumerate() {
                        buffer[i * mask.side * steps + y] = v;
                    }
                }
                let columns = buffer.chunks_exact_mut(mask.side * steps).zip(out.chunks_exact_mut(height));
                for (i, (column, out)) in columns.enumerate() {
                    fft.process(column);
                    let x = cell_spectrum((first + i) as f64 / (steps * mask.side) as f64);
                    for (k, out) in out.iter_mut().enumerate() {
                        // Rows count downwards, frequencies upwards.
                        let down = half as isize - k as isize;
                        let v = column[down.rem_euclid(column.len() as isize) as usize];
                        let y = cell_spectrum(down as f64 / (steps * mask.side) as f64);
                        let amplitude = scale / (x * y);
                        let [re, im] = v.map(f64::from);
                        *out = ((re * re + im * im) * amplitude * amplitude) as f32;
                    }
                }
            },
        );
        Self { half, steps, values }
    }

    /// The spectrum between its points, linear along both axes; x ≥ 0.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let (x, y) = (x * self.steps as f64, y * self.steps as f64 + self.half as f64);
        let height = 2 * self.half + 1;
        let (i, j) = ((x as usize).min(self.half - 1), (y as usize).min(height - 2));
        let (s, t) = (x - i as f64, y - j as f64);
        let column = |i: usize| {
            let at = i * height + j;
            let (a, b) = (f64::from(self.values[at]), f64::from(self.values[at + 1]));
            a + t * (b - a)
        };
        let (a, b) = (column(i), column(i + 1));
        a + s * (b - a)
    }
}

/// The transform of a cell at a frequency in cycles per cell, 1 at 0.
fn cell_spectrum(f: f64) -> f64 {
    let x = std::f64::consts::PI * f;
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

/// The first `keep` values of each row's transform, darkness added to its length. Two real rows make one
/// complex sequence F, whose transform holds those of both: (F_k ± F*_-k) / 2, the second over i.
fn transformed_rows(mask: &Mask, steps: usize, keep: usize) -> Vec<Complex> {
    let length = mask.side * steps;
    let fft = Transform::new(length);
    let mut rows = vec![[0.0; 2]; mask.side * keep];
    rows.par_chunks_mut(2 * keep).zip(mask.cells.par_chunks(2 * mask.side)).for_each_init(
        || vec![[0.0; 2]; length],
        |buffer, (out, cells)| {
            let (first, second) = cells.split_at(mask.side);
            buffer.fill([0.0; 2]);
            for ((b, &u), &v) in buffer.iter_mut().zip(first).zip(second) {
                *b = [u, v];
            }
            fft.process(buffer);
            let (first, second) = out.split_at_mut(keep);
            for (k, (u, v)) in first.iter_mut().zip(second).enumerate() {
                let (a, b) = (buffer[k], buffer[(length - k) % length]);
                *u = [0.5 * (a[0] + b[0]), 0.5 * (a[1] - b[1])];
                *v = [0.5 * (a[1] + b[1]), 0.5 * (b[0] - a[0])];
            }
        },
    );
    rows
}
