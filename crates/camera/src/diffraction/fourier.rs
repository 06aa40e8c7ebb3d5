//! The power spectrum of a drawing.

// tidy: load-time mathematics

use crate::Mask;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

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
    /// so many of its widths of darkness. `cycles` is less than half the cells of a side.
    ///
    /// A drawing holds means over its cells, which damps high frequencies by the transform of a cell; that
    /// is taken back. What lies beyond the cells' own frequency and is folded back remains.
    pub fn new(mask: &Mask, steps: usize, cycles: usize) -> Self {
        let half = cycles * steps + 1;
        let rows = transformed_rows(mask, steps, half + 1);
        let height = 2 * half + 1;
        let mut values = vec![0.0; (half + 1) * height];
        let fft = FftPlanner::new().plan_fft_forward(mask.side * steps);
        let scale = 1.0 / (mask.side * mask.side) as f64;
        values.par_chunks_mut(BATCH * height).enumerate().for_each_init(
            || vec![Complex::new(0.0f32, 0.0); BATCH * mask.side * steps],
            |buffer, (batch, out)| {
                let first = batch * BATCH;
                let count = out.len() / height;
                buffer.fill(Complex::new(0.0, 0.0));
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
                        *out = (f64::from(v.norm_sqr()) * amplitude * amplitude) as f32;
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

/// The first `keep` values of each row's transform, rows of darkness added to its length.
fn transformed_rows(mask: &Mask, steps: usize, keep: usize) -> Vec<Complex<f32>> {
    let fft = RealFftPlanner::<f32>::new().plan_fft_forward(mask.side * steps);
    let mut rows = vec![Complex::new(0.0, 0.0); mask.side * keep];
    rows.par_chunks_mut(keep).zip(mask.cells.par_chunks(mask.side)).for_each_init(
        || (fft.make_input_vec(), fft.make_output_vec(), fft.make_scratch_vec()),
        |(input, output, scratch), (row, cells)| {
            input.fill(0.0);
            input[..cells.len()].copy_from_slice(cells);
            // Only a buffer of the wrong length could fail, and these are of the plan's own making.
            let done = fft.process_with_scratch(input, output, scratch);
            debug_assert!(done.is_ok());
            row.copy_from_slice(&output[..keep]);
        },
    );
    rows
}
