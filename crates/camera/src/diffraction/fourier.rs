//! The power spectrum of a drawing.

// tidy: load-time mathematics

use crate::Mask;
use indigo_math::pages;
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
    /// The spectrum up to `cycles` in steps of 1 / `steps` of a cycle: the drawing is surrounded by so many of its
    /// widths of darkness. `cycles` is less than half the cells of a side.
    ///
    /// A drawing holds means over its cells, which damps high frequencies by the transform of a cell; that
    /// is taken back. What lies beyond the cells' own frequency and is folded back remains.
    pub fn new(mask: &Mask, steps: usize, cycles: usize) -> Self {
        let half = cycles * steps + 1;
        let rows = transformed_rows(mask, steps, half + 1);
        let (length, height) = (mask.side * steps, 2 * half + 1);
        // Columns whose length is a power of two would all fall into the same lines of the processor's cache.
        let stride = length + BATCH;
        let undamping: Vec<f64> =
            (0..=half).map(|k| cell_spectrum(k as f64 / length as f64).powi(-2)).collect();
        let scale = (mask.side as f64).powi(-4);
        let fft = FftPlanner::new().plan_fft_forward(length);
        let mut values = pages::fresh(vec![0.0; (half + 1) * height]);
        values.par_chunks_mut(BATCH * height).enumerate().for_each_init(
            || {
                let zero = Complex::<f32>::default();
                (vec![zero; BATCH * stride], vec![zero; fft.get_inplace_scratch_len()])
            },
            |(buffer, scratch), (batch, out)| {
                let first = batch * BATCH;
                let count = out.len() / height;
                buffer.fill(Complex::default());
                for (y, row) in rows.chunks_exact(half + 1).enumerate() {
                    for (i, &v) in row[first..first + count].iter().enumerate() {
                        buffer[i * stride + y] = v;
                    }
                }
                let columns = buffer.chunks_exact_mut(stride).zip(out.chunks_exact_mut(height));
                for (i, (column, out)) in columns.enumerate() {
                    let column = &mut column[..length];
                    fft.process_with_scratch(column, scratch);
                    let scale = scale * undamping[first + i];
                    let power =
                        |v: Complex<f32>, k: usize| (f64::from(v.norm_sqr()) * scale * undamping[k]) as f32;
                    // Rows count downwards, frequencies upwards.
                    for k in 0..=half {
                        out[half - k] = power(column[k], k);
                        out[half + k] = power(column[(length - k) % length], k);
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

/// The first `keep` values of each row's transform, darkness added to its length.
fn transformed_rows(mask: &Mask, steps: usize, keep: usize) -> Vec<Complex<f32>> {
    let fft = RealFftPlanner::<f32>::new().plan_fft_forward(mask.side * steps);
    let mut rows = pages::filled(Complex::default(), mask.side * keep);
    rows.par_chunks_mut(keep).zip(mask.cells.par_chunks(mask.side)).for_each_init(
        || (fft.make_input_vec(), fft.make_output_vec(), fft.make_scratch_vec()),
        |(input, output, scratch), (out, cells)| {
            let (inside, beyond) = input.split_at_mut(mask.side);
            inside.copy_from_slice(cells);
            beyond.fill(0.0);
            let done = fft.process_with_scratch(input, output, scratch);
            debug_assert!(done.is_ok(), "buffers of the plan's own sizes");
            out.copy_from_slice(&output[..keep]);
        },
    );
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// |Σ A exp(-2πi f·x)|² over the cells' middles, over the square of the transform of a cell.
    fn power(mask: &Mask, [x, y]: [f64; 2]) -> f64 {
        let side = mask.side as f64;
        let mut sum = [0.0; 2];
        for (i, &a) in mask.cells.iter().enumerate() {
            let (u, v) = ((i % mask.side) as f64 / side, -((i / mask.side) as f64) / side);
            let (s, c) = (-TAU * (x * u + y * v)).sin_cos();
            sum = [sum[0] + f64::from(a) * c, sum[1] + f64::from(a) * s];
        }
        let damping = cell_spectrum(x / side) * cell_spectrum(y / side) * side * side;
        (sum[0] * sum[0] + sum[1] * sum[1]) / (damping * damping)
    }

    /// At its own points it is the sum that defines it, upside and right way round.
    #[test]
    fn it_is_the_sum_that_defines_it() {
        let cells = (0..256).map(|i| ((i * 7 + i / 16 * 3) % 11) as f32 / 10.0).collect();
        let mask = Mask { side: 16, cells };
        let (steps, cycles) = (4, 3);
        let spectrum = PowerSpectrum::new(&mask, steps, cycles);
        let whole = power(&mask, [0.0; 2]);
        for i in 0..=cycles * steps {
            for j in 0..=2 * cycles * steps {
                let f = [i as f64, j as f64 - (cycles * steps) as f64].map(|k| k / steps as f64);
                let (got, want) = (spectrum.at(f[0], f[1]), power(&mask, f));
                assert!((got - want).abs() < 1e-5 * whole, "{f:?}: {got} instead of {want}");
            }
        }
    }
}
