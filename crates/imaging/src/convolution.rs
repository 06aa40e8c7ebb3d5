//! Convolution of a picture with a kernel as large as itself, by the Fourier transform.
//!
//! The picture is surrounded by darkness, wide enough that nothing comes round from the other side. What
//! lies beyond its borders is not known, and would have sent light into it as the picture sends light
//! out. So the result is divided by the part of the kernel that falls inside: as if the light beyond
//! were the mean of what can be seen from there. An even picture stays even up to its borders.
//!
//! All is done in double precision: a lamp may be 10⁹ times as bright as its surroundings, and the
//! rounding of single precision would cover those with a veil of noise.

use crate::Region;
use indigo_film::{FilmSize, XyzImage};
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
}

/// The transform of a kernel with K(-x) = K(x), which is real; column after column.
pub(crate) struct Spectrum {
    values: Vec<f64>,
    /// Part of the kernel round each pixel that falls into the picture.
    inside: Vec<f32>,
}

/// The internal pixels of a region of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    left: usize,
    top: usize,
    pub width: usize,
    pub height: usize,
}

impl Window {
    /// Of a region; `None` where that is empty.
    pub fn of(size: FilmSize, region: Region) -> Option<Self> {
        let factor = size.super_sample() as usize;
        let [x1, y1] = region.start().map(|v| v as usize * factor);
        let [x2, y2] = region.end().map(|v| v as usize * factor);
        (x1 < x2 && y1 < y2).then(|| Self { left: x1, top: y1, width: x2 - x1, height: y2 - y1 })
    }

    /// Convolves a component of the pixels; `blend` makes the new value of the old one and the convolved
    /// one.
    pub fn convolve(
        &self,
        image: &mut XyzImage,
        component: usize,
        (plane, kernel): (&Plane, &Spectrum),
        blend: impl Fn(f32, f32) -> f32 + Sync,
    ) {
        let stride = image.size.internal_width() as usize;
        let pixels = &image.pixels;
        let convolved = plane.convolve(kernel, |y, row| {
            let from = &pixels[(self.top + y) * stride + self.left..];
            row.iter_mut().zip(from).for_each(|(v, p)| *v = f64::from(p[component]));
        });
        let rows = image.pixels.par_chunks_exact_mut(stride).skip(self.top);
        rows.zip(convolved.par_chunks_exact(self.width)).for_each(|(row, from)| {
            for (p, &v) in row[self.left..].iter_mut().zip(from) {
                p[component] = blend(p[component], v);
            }
        });
    }
}

impl Plane {
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
        }
    }

    /// Frequencies of a row.
    fn kept(&self) -> usize {
        self.columns / 2 + 1
    }

    /// The spectrum of a kernel given over a whole period, its middle at (0, 0), row after row.
    pub fn spectrum(&self, kernel: &[f64]) -> Spectrum {
        let rows = self.row_transforms(self.rows, |y, row| {
            row.copy_from_slice(&kernel[y * self.columns..(y + 1) * self.columns]);
        });
        let mut values = vec![0.0; self.kept() * self.rows];
        values.par_chunks_mut(BATCH * self.rows).enumerate().for_each_init(
            || self.column_buffer(),
            |buffer, (batch, out)| {
                self.load_columns(&rows, batch * BATCH, out.len() / self.rows, buffer);
                for (column, out) in buffer.chunks_exact_mut(self.rows).zip(out.chunks_exact_mut(self.rows)) {
                    self.forward_column.process(column);
                    out.iter_mut().zip(&*column).for_each(|(o, c)| *o = c.re);
                }
            },
        );
        let mut spectrum = Spectrum { values, inside: vec![] };
        spectrum.inside = self.convolve_open(&spectrum, |_, row| row.fill(1.0));
        spectrum
    }

    /// The picture whose row `y` is written by `fill`, convolved; row after row.
    pub fn convolve(&self, kernel: &Spectrum, fill: impl Fn(usize, &mut [f64]) + Sync) -> Vec<f32> {
        let mut out = self.convolve_open(kernel, fill);
        out.par_iter_mut().zip(&kernel.inside).for_each(|(v, inside)| *v /= inside);
        out
    }

    /// The same with darkness beyond the borders.
    fn convolve_open(&self, kernel: &Spectrum, fill: impl Fn(usize, &mut [f64]) + Sync) -> Vec<f32> {
        let rows = self.row_transforms(self.height, |y, row| {
            let (inside, beyond) = row.split_at_mut(self.width);
            fill(y, inside);
            beyond.fill(0.0);
        });
        let columns = self.filtered_columns(&rows, kernel);
        drop(rows);
        let mut out = vec![0.0; self.width * self.height];
        let scale = 1.0 / (self.columns * self.rows) as f64;
        out.par_chunks_mut(BATCH * self.width).enumerate().for_each_init(
            || {
                let rows = vec![Complex::default(); BATCH * self.kept()];
                (rows, self.inverse_row.make_output_vec(), self.inverse_row.make_scratch_vec())
            },
            |(rows, real, scratch), (batch, out)| {
                let first = batch * BATCH;
                for (x, column) in columns.chunks_exact(self.height).enumerate() {
                    for (i, &v) in column[first..].iter().take(BATCH).enumerate() {
                        rows[i * self.kept() + x] = v;
                    }
                }
                for (row, out) in rows.chunks_exact_mut(self.kept()).zip(out.chunks_exact_mut(self.width)) {
                    // Real by symmetry, but for rounding.
                    row[0].im = 0.0;
                    row[self.kept() - 1].im = 0.0;
                    let done = self.inverse_row.process_with_scratch(row, real, scratch);
                    debug_assert!(done.is_ok(), "buffers of the plan's own sizes");
                    out.iter_mut().zip(&*real).for_each(|(o, &v)| *o = (v * scale) as f32);
                }
            },
        );
        out
    }

    /// The transforms of the first `count` rows.
    fn row_transforms(&self, count: usize, fill: impl Fn(usize, &mut [f64]) + Sync) -> Vec<Complex<f64>> {
        let mut rows = vec![Complex::default(); count * self.kept()];
        rows.par_chunks_mut(self.kept()).enumerate().for_each_init(
            || (self.forward_row.make_input_vec(), self.forward_row.make_scratch_vec()),
            |(input, scratch), (y, out)| {
                fill(y, input);
                let done = self.forward_row.process_with_scratch(input, out, scratch);
                debug_assert!(done.is_ok(), "buffers of the plan's own sizes");
            },
        );
        rows
    }

    /// Transforms columns, multiplies them with the kernel's and transforms them back: the picture's
    /// part of each, column after column.
    fn filtered_columns(&self, rows: &[Complex<f64>], kernel: &Spectrum) -> Vec<Complex<f64>> {
        let mut columns = vec![Complex::default(); self.kept() * self.height];
        columns.par_chunks_mut(BATCH * self.height).enumerate().for_each_init(
            || self.column_buffer(),
            |buffer, (batch, out)| {
                let first = batch * BATCH;
                self.load_columns(rows, first, out.len() / self.height, buffer);
                let spectra = kernel.values[first * self.rows..].chunks_exact(self.rows);
                let columns = buffer.chunks_exact_mut(self.rows).zip(spectra);
                for ((column, spectrum), out) in columns.zip(out.chunks_exact_mut(self.height)) {
                    self.forward_column.process(column);
                    column.iter_mut().zip(spectrum).for_each(|(c, s)| *c *= s);
                    self.inverse_column.process(column);
                    out.copy_from_slice(&column[..self.height]);
                }
            },
        );
        columns
    }

    fn column_buffer(&self) -> Vec<Complex<f64>> {
        vec![Complex::default(); BATCH * self.rows]
    }

    /// Copies some columns of transformed rows, with zeros below.
    fn load_columns(&self, rows: &[Complex<f64>], first: usize, count: usize, buffer: &mut [Complex<f64>]) {
        buffer.fill(Complex::default());
        for (y, row) in rows.chunks_exact(self.kept()).enumerate() {
            for (i, &v) in row[first..first + count].iter().enumerate() {
                buffer[i * self.rows + y] = v;
            }
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
mod tests {
    use super::*;

    /// A kernel over a whole period from its values at offsets.
    fn kernel(plane: &Plane, value: impl Fn(i64, i64) -> f64) -> Spectrum {
        let wrapped = |i: usize, n: usize| if 2 * i > n { i as i64 - n as i64 } else { i as i64 };
        let values: Vec<f64> = (0..plane.rows * plane.columns)
            .map(|i| {
                let (x, y) = (i % plane.columns, i / plane.columns);
                value(wrapped(x, plane.columns), wrapped(y, plane.rows))
            })
            .collect();
        plane.spectrum(&values)
    }

    /// Falls off in no symmetric way but the one through the middle.
    fn lopsided(x: i64, y: i64) -> f64 {
        let (x, y) = (x as f64, y as f64);
        1.0 / (1.0 + x * x + 0.5 * x * y + 2.0 * y * y)
    }

    #[test]
    fn it_is_the_sum_over_all_pixels() {
        let (width, height) = (13usize, 6usize);
        let plane = Plane::new(width, height);
        let spectrum = kernel(&plane, lopsided);
        let picture = |x: usize, y: usize| ((x * 7 + y * 3) % 11) as f64;
        let got = plane.convolve(&spectrum, |y, row| {
            row.iter_mut().enumerate().for_each(|(x, v)| *v = picture(x, y));
        });
        for (i, got) in got.iter().enumerate() {
            let (x, y) = (i % width, i / width);
            let (mut sum, mut inside) = (0.0, 0.0);
            for (u, v) in (0..height).flat_map(|v| (0..width).map(move |u| (u, v))) {
                let k = lopsided(x as i64 - u as i64, y as i64 - v as i64);
                sum += k * picture(u, v);
                inside += k;
            }
            assert!((f64::from(*got) - sum / inside).abs() < 1e-6 * sum / inside, "{x} {y}: {got}");
        }
    }

    #[test]
    fn an_even_picture_stays_even() {
        let plane = Plane::new(9, 17);
        let spectrum = kernel(&plane, lopsided);
        for v in plane.convolve(&spectrum, |_, row| row.fill(3.0)) {
            assert!((v - 3.0).abs() < 1e-6, "{v}");
        }
    }

    /// One pixel 10⁹ times as bright as the rest leaves what it does not reach as it was.
    #[test]
    fn a_lamp_does_not_drown_the_dark() {
        let plane = Plane::new(300, 40);
        let spectrum = kernel(&plane, |x, y| if x.abs() + y.abs() < 2 { 0.2 } else { 0.0 });
        let got = plane.convolve(&spectrum, |y, row| {
            row.fill(1.0);
            if y == 20 {
                row[5] = 1e9;
            }
        });
        let worst = got.iter().skip(30).step_by(300).map(|v| (v - 1.0).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn periods_are_even_and_of_small_factors() {
        assert_eq!([1, 2, 11, 13, 127, 1199, 3839].map(smooth), [2, 2, 12, 14, 128, 1200, 3840]);
    }
}
