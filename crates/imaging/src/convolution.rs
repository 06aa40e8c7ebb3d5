//! Convolution of a picture with a kernel as large as itself, by the Fourier transform.
//!
//! The picture is surrounded by darkness, wide enough that nothing comes round from the other side. What
//! lies beyond its borders is not known, and would have sent light into it as the picture sends light
//! out. So each pixel gets the part of the kernel that falls outside times its own light: as if all beyond were as bright
//! as the pixel that looks there. An even picture stays even up to its borders, and what a lamp close to them adds to
//! other pixels is what it would add in the middle.
//!
//! Kernels are the same in opposite directions. So a kernel's rows above the middle are its rows below
//! read backwards, with conjugate transforms; and its columns' transforms are real. Half of the work is saved.
//!
//! All is done in double precision: a lamp may be 10⁹ times as bright as its surroundings, and the
//! rounding of single precision would cover those with a veil of noise.

use crate::window::Window;
use indigo_film::XyzImage;
use indigo_math::pages;
use rayon::prelude::*;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Rows or columns that are copied together: what is read from memory at once.
const BATCH: usize = 8;

/// The periodic plane on which pictures of one size are convolved.
pub(crate) struct Plane {
    /// Size of the pictures.
    pub width: usize,
    pub height: usize,
    /// Period: at least twice the size, less one, and made of small factors.
    pub columns: usize,
    pub rows: usize,
    forward_row: Arc<dyn RealToComplex<f64>>,
    inverse_row: Arc<dyn ComplexToReal<f64>>,
    forward_column: Arc<dyn Fft<f64>>,
    inverse_column: Arc<dyn Fft<f64>>,
    /// For columns that are conjugate in opposite places.
    kernel_column: Arc<dyn ComplexToReal<f64>>,
}

/// How a kernel repeats itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symmetry {
    /// In opposite directions.
    Opposite,
    /// To the left and to the right, too.
    Mirror,
}

/// Room that work on a plane takes. Kept from one step to the next, since fresh memory costs as much time as using it.
#[derive(Default)]
pub(crate) struct Room {
    values: Vec<Complex<f64>>,
}

impl std::fmt::Debug for Room {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "room for {} numbers", self.values.len())
    }
}

impl Room {
    /// So many numbers, of any values.
    fn take(&mut self, length: usize) -> &mut [Complex<f64>] {
        if self.values.len() < length {
            self.values = pages::filled(Complex::default(), length);
        }
        &mut self.values[..length]
    }
}

/// The transform of a kernel that is the same in opposite directions, which is real; column after column.
pub(crate) struct Spectrum {
    values: Vec<f64>,
    /// Part of the kernel round each pixel that does not fall into the picture, the kernel's whole being 1.
    outside: Vec<f32>,
}

impl Plane {
    /// Convolves X, Y and Z of a window of the plane's size, each with its kernel; `blend` makes the new value of the
    /// component's number, the old value and the convolved one.
    pub fn convolve(
        &self,
        image: &mut XyzImage,
        window: Window,
        kernels: [&Spectrum; 3],
        room: &mut Room,
        blend: impl Fn(usize, f32, f32) -> f32 + Sync,
    ) {
        let transformed = self.height * self.kept();
        let (rows, columns) = room.take(2 * transformed).split_at_mut(transformed);
        let mut out = pages::fresh(vec![0.0; self.width * self.height]);
        for (component, kernel) in kernels.into_iter().enumerate() {
            self.transform_rows(rows, |y, row| {
                let from = window.row(image, y);
                row.iter_mut().zip(from).for_each(|(v, p)| *v = f64::from(p[component]));
            });
            self.filter_columns(rows, kernel, columns);
            self.restore_rows(columns, &mut out);
            let convolved = out.par_chunks_exact(self.width).zip(kernel.outside.par_chunks_exact(self.width));
            window.rows_mut(image).zip(convolved).for_each(|(row, (from, outside))| {
                for (p, (&v, outside)) in row.iter_mut().zip(from.iter().zip(outside)) {
                    p[component] = blend(component, p[component], v + outside * p[component]);
                }
            });
        }
    }

    /// For pictures of a size, none of whose sides is 0.
    pub fn new(width: usize, height: usize) -> Self {
        let (columns, rows) = (smooth(2 * width - 1), smooth(2 * height - 1));
        let (mut real, mut complex) = (RealFftPlanner::new(), FftPlanner::new());
        Self {
            width,
            height,
            columns,
            rows,
            forward_row: real.plan_fft_forward(columns),
            inverse_row: real.plan_fft_inverse(columns),
            forward_column: complex.plan_fft_forward(rows),
            inverse_column: complex.plan_fft_inverse(rows),
            kernel_column: real.plan_fft_inverse(rows),
        }
    }

    /// Memory that making the spectra of `kernels` kernels and convolving with them takes, in bytes.
    pub fn bytes_needed(&self, kernels: u64) -> u64 {
        let [kept, rows, width, height] = [self.kept(), self.rows, self.width, self.height].map(|n| n as u64);
        let spectra = kernels * (kept * rows * 8 + width * height * 4);
        // For the rows of kernels, then for those of pictures and their columns.
        let room = height * kernels.max(2) * kept * 16;
        // Sums of kernels are gone before anything is convolved.
        let others = width * height * 4 * kernels.max(1);
        spectra + room + others
    }

    /// Frequencies of a row.
    fn kept(&self) -> usize {
        self.columns / 2 + 1
    }

    /// The spectra of kernels given by their values at an offset, columns to the right and rows down.
    pub fn spectra<const N: usize>(
        &self,
        symmetry: Symmetry,
        room: &mut Room,
        kernels: impl Fn(i64, i64) -> [f64; N] + Sync,
    ) -> [Spectrum; N] {
        let (kept, reach) = (self.kept(), self.width as i64 - 1);
        // Row after row, in each of them kernel after kernel.
        let rows = room.take(N * kept * self.height);
        // Each but rounded once from a sum in double precision; what is made of them is rounded likewise.
        let mut sums = pages::fresh(vec![0.0; N * self.width * self.height]);
        let chunks = rows.par_chunks_mut(N * kept).zip(sums.par_chunks_mut(N * self.width));
        chunks.enumerate().for_each_init(
            || (self.forward_row.make_input_vec(), self.forward_row.make_scratch_vec()),
            |(input, scratch), (y, (out, sums))| {
                let line: Vec<[f64; N]> = match symmetry {
                    Symmetry::Opposite => (-reach..=reach).map(|x| kernels(x, y as i64)).collect(),
                    Symmetry::Mirror => {
                        let half: Vec<[f64; N]> = (0..=reach).map(|x| kernels(x, y as i64)).collect();
                        half.iter().rev().chain(&half[1..]).copied().collect()
                    }
                };
                for (c, sums) in sums.chunks_exact_mut(self.width).enumerate() {
                    sum_windows(line.iter().map(|v| v[c]), sums);
                }
                for (c, out) in out.chunks_exact_mut(kept).enumerate() {
                    // Backwards, for the conjugate of the transform: columns go through the inverse one, which
                    // is the other's conjugate.
                    let (left, right) = line.split_at(reach as usize);
                    input.fill(0.0);
                    input
                        .iter_mut()
                        .zip(right[..1].iter().chain(left.iter().rev()))
                        .for_each(|(i, v)| *i = v[c]);
                    input.iter_mut().rev().zip(&right[1..]).for_each(|(i, v)| *i = v[c]);
                    let done = self.forward_row.process_with_scratch(input, out, scratch);
                    debug_assert!(done.is_ok(), "buffers of the plan's own sizes");
                }
            },
        );
        std::array::from_fn(|c| Spectrum {
            values: self.kernel_columns(rows, N, c),
            outside: self.outside(|y| &sums[(N * y + c) * self.width..][..self.width]),
        })
    }

    /// Kernel `c` of `n`: the columns' transforms, from those of the rows from the middle down.
    fn kernel_columns(&self, rows: &[Complex<f64>], n: usize, c: usize) -> Vec<f64> {
        let half = self.rows / 2 + 1;
        let mut values = pages::fresh(vec![0.0; self.kept() * self.rows]);
        values.par_chunks_mut(BATCH * self.rows).enumerate().for_each_init(
            || (vec![Complex::default(); BATCH * half], self.kernel_column.make_scratch_vec()),
            |(buffer, scratch), (batch, out)| {
                let rows = rows.chunks_exact(self.kept()).skip(c).step_by(n);
                load_columns(rows, batch * BATCH, out.len() / self.rows, buffer, half);
                for (column, out) in buffer.chunks_exact_mut(half).zip(out.chunks_exact_mut(self.rows)) {
                    // Real by symmetry, but for rounding.
                    column[0].im = 0.0;
                    let done = self.kernel_column.process_with_scratch(column, out, scratch);
                    debug_assert!(done.is_ok(), "buffers of the plan's own sizes");
                }
            },
        );
        values
    }

    /// The part of a kernel that does not fall into the picture, pixel after pixel. `sums` gives, for a row from the
    /// middle down, its sum over the offsets that lead from each pixel's column into the picture.
    fn outside<'a>(&self, sums: impl Fn(usize) -> &'a [f32]) -> Vec<f32> {
        // Of the uppermost pixels: the rows from the middle up, which are those down read backwards.
        let mut running = vec![0.0; self.width];
        for y in 0..self.height {
            running.iter_mut().zip(sums(y).iter().rev()).for_each(|(r, &s)| *r += f64::from(s));
        }
        let mut outside = Vec::with_capacity(self.width * self.height);
        outside.extend(running.iter().map(|&r| (1.0 - r) as f32));
        for y in 1..self.height {
            let changes = sums(y).iter().zip(sums(self.height - y).iter().rev());
            running
                .iter_mut()
                .zip(changes)
                .for_each(|(r, (&enters, &leaves))| *r += f64::from(enters) - f64::from(leaves));
            outside.extend(running.iter().map(|&r| (1.0 - r) as f32));
        }
        outside
    }

    /// The transforms of the picture's rows, of which `fill` writes row `y`, with darkness beside them.
    fn transform_rows(&self, rows: &mut [Complex<f64>], fill: impl Fn(usize, &mut [f64]) + Sync) {
        rows.par_chunks_mut(self.kept()).enumerate().for_each_init(
            || (self.forward_row.make_input_vec(), self.forward_row.make_scratch_vec()),
            |(input, scratch), (y, out)| {
                let (inside, beyond) = input.split_at_mut(self.width);
                fill(y, inside);
                beyond.fill(0.0);
                let done = self.forward_row.process_with_scratch(input, out, scratch);
                debug_assert!(done.is_ok(), "buffers of the plan's own sizes");
            },
        );
    }

    /// Transforms columns, multiplies them with the kernel's and transforms them back: the picture's
    /// part of each, column after column.
    fn filter_columns(&self, rows: &[Complex<f64>], kernel: &Spectrum, columns: &mut [Complex<f64>]) {
        let scratch =
            self.forward_column.get_inplace_scratch_len().max(self.inverse_column.get_inplace_scratch_len());
        columns.par_chunks_mut(BATCH * self.height).enumerate().for_each_init(
            || (vec![Complex::default(); BATCH * self.rows], vec![Complex::default(); scratch]),
            |(buffer, scratch), (batch, out)| {
                let first = batch * BATCH;
                load_columns(
                    rows.chunks_exact(self.kept()),
                    first,
                    out.len() / self.height,
                    buffer,
                    self.rows,
                );
                let spectra = kernel.values[first * self.rows..].chunks_exact(self.rows);
                let columns = buffer.chunks_exact_mut(self.rows).zip(spectra);
                for ((column, spectrum), out) in columns.zip(out.chunks_exact_mut(self.height)) {
                    self.forward_column.process_with_scratch(column, scratch);
                    column.iter_mut().zip(spectrum).for_each(|(c, s)| *c *= s);
                    self.inverse_column.process_with_scratch(column, scratch);
                    out.copy_from_slice(&column[..self.height]);
                }
            },
        );
    }

    /// Transforms filtered columns back to the picture, row after row.
    fn restore_rows(&self, columns: &[Complex<f64>], out: &mut [f32]) {
        let scale = 1.0 / (self.columns * self.rows) as f64;
        let chunks = out.par_chunks_mut(BATCH * self.width);
        chunks.enumerate().for_each_init(
            || {
                let rows = vec![Complex::default(); BATCH * self.kept()];
                (rows, self.inverse_row.make_output_vec(), self.inverse_row.make_scratch_vec())
            },
            |(rows, real, scratch), (batch, out)| {
                load_columns(
                    columns.chunks_exact(self.height),
                    batch * BATCH,
                    out.len() / self.width,
                    rows,
                    self.kept(),
                );
                let lines = out.chunks_exact_mut(self.width);
                for (row, out) in rows.chunks_exact_mut(self.kept()).zip(lines) {
                    // Real by symmetry, but for rounding.
                    row[0].im = 0.0;
                    row[self.kept() - 1].im = 0.0;
                    let done = self.inverse_row.process_with_scratch(row, real, scratch);
                    debug_assert!(done.is_ok(), "buffers of the plan's own sizes");
                    out.iter_mut().zip(&*real).for_each(|(out, &v)| *out = (v * scale) as f32);
                }
            },
        );
    }
}

/// Copies `count` columns of some rows into a buffer for columns of a length, with zeros below.
fn load_columns<'a>(
    rows: impl Iterator<Item = &'a [Complex<f64>]>,
    first: usize,
    count: usize,
    buffer: &mut [Complex<f64>],
    length: usize,
) {
    let mut filled = 0;
    for (y, row) in rows.enumerate() {
        for (i, &v) in row[first..first + count].iter().enumerate() {
            buffer[i * length + y] = v;
        }
        filled = y + 1;
    }
    buffer.chunks_exact_mut(length).for_each(|column| column[filled..].fill(Complex::default()));
}

/// The sums of as many neighbours as there are sums, from each value on.
fn sum_windows(values: impl Iterator<Item = f64> + Clone, sums: &mut [f32]) {
    let mut sum: f64 = values.clone().take(sums.len()).sum();
    let mut next = values.clone().skip(sums.len()).zip(values);
    for out in sums {
        *out = sum as f32;
        if let Some((enters, leaves)) = next.next() {
            sum += enters - leaves;
        }
    }
}

/// The least even number from `n` on whose prime factors are 2, 3, 5 and 7, which transforms quickly.
fn smooth(n: usize) -> usize {
    let is_smooth = |mut n: usize| {
        for p in [2, 3, 5, 7] {
            while n.is_multiple_of(p) {
                n /= p;
            }
        }
        n == 1
    };
    // A power of 2 is among them.
    (n.max(2)..=2 * n.max(2)).find(|&n| n.is_multiple_of(2) && is_smooth(n)).unwrap_or(n)
}

#[cfg(test)]
mod tests;
