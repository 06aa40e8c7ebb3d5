//! An opening drawn in an image.

// tidy: load-time mathematics

use super::Mask;
use indigo_math::{Real, Vec2};
use rayon::prelude::*;

/// A grey image of what lets light through: values from 0 to 1, rows from the top, texels from the left.
#[derive(Clone, Debug, PartialEq)]
pub struct GreyImage {
    /// Texels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width · height` values.
    pub texels: Vec<f32>,
}

/// An image that lets no light through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("all of the image is black: nothing is open")]
pub struct NothingOpen;

/// How much light each texel of the square lets through, and how to choose points by it.
#[derive(Clone, Debug)]
pub struct Transmission {
    image: GreyImage,
    /// Part of the light of the rows up to each row's beginning, from 0 to 1.
    rows: Vec<f32>,
    /// The same along each row; `width + 1` values each.
    columns: Vec<f32>,
    area: f64,
}

impl GreyImage {
    /// With the nearest of 0 and 1 for values beyond, and 0 for NaN.
    pub(crate) fn clamped(mut self) -> Self {
        for t in &mut self.texels {
            *t = if *t > 0.0 { t.min(1.0) } else { 0.0 };
        }
        self
    }

    /// The image on `side` × `side` cells, each the mean of a function of the texels that it covers;
    /// texels that are cut by cells count by their covered part.
    pub fn resized(&self, side: usize, f: impl Fn(f32) -> f32 + Sync) -> Mask {
        let mut narrow = vec![0.0; side * self.height];
        narrow.par_chunks_mut(side).zip(self.texels.par_chunks(self.width)).for_each(|(to, from)| {
            for (x, cell) in to.iter_mut().enumerate() {
                *cell = mean(self.width, side, x, |i| f(from[i]));
            }
        });
        let mut cells = vec![0.0; side * side];
        cells.par_chunks_mut(side).enumerate().for_each(|(y, to)| {
            for (x, cell) in to.iter_mut().enumerate() {
                *cell = mean(self.height, side, y, |row| narrow[row * side + x]);
            }
        });
        Mask { side, cells }
    }
}

/// The mean over part `i` of `parts` even parts of a row of `len` values.
fn mean(len: usize, parts: usize, i: usize, value: impl Fn(usize) -> f32) -> f32 {
    let scale = len as f64 / parts as f64;
    let (lo, hi) = (i as f64 * scale, (i + 1) as f64 * scale);
    let mut sum = 0.0;
    for k in lo as usize..(hi.ceil() as usize).min(len) {
        let covered = hi.min(k as f64 + 1.0) - lo.max(k as f64);
        sum += covered * f64::from(value(k));
    }
    (sum / scale) as f32
}

impl Transmission {
    /// From an image; values outside [0, 1] and NaN count as the nearest of the two, 0 for NaN.
    ///
    /// # Errors
    /// Where nothing is open.
    pub fn new(image: &GreyImage) -> Result<Self, NothingOpen> {
        let image = image.clone().clamped();
        let mut columns = Vec::with_capacity((image.width + 1) * image.height);
        let mut sums = Vec::with_capacity(image.height);
        for row in image.texels.chunks_exact(image.width) {
            sums.push(push_cumulative(&mut columns, row.iter().map(|&t| f64::from(t))));
        }
        let mut rows = Vec::with_capacity(image.height + 1);
        let sum = push_cumulative(&mut rows, sums.iter().copied());
        if sum <= 0.0 {
            return Err(NothingOpen);
        }
        let area = 4.0 * sum / image.texels.len() as f64;
        Ok(Self { image, rows, columns, area })
    }

    /// The integral of the transmission over the square [-1, 1]².
    pub(super) fn area(&self) -> f64 {
        self.area
    }

    /// The image.
    pub fn image(&self) -> &GreyImage {
        &self.image
    }

    /// A point of the square with a density in proportion to the transmission.
    #[inline]
    pub(super) fn sample(&self, u: Vec2) -> Vec2 {
        let (width, height) = (self.image.width, self.image.height);
        let (row, v) = pick(&self.rows, u.y);
        let (column, t) = pick(&self.columns[row * (width + 1)..(row + 1) * (width + 1)], u.x);
        let x = (column as Real + t) / width as Real;
        let y = (row as Real + v) / height as Real;
        Vec2::new(2.0 * x - 1.0, 1.0 - 2.0 * y)
    }
}

/// Appends the cumulative parts of some values, from 0 to 1, and gives their sum.
fn push_cumulative(to: &mut Vec<f32>, values: impl Iterator<Item = f64> + Clone) -> f64 {
    let sum: f64 = values.clone().sum();
    let scale = if sum > 0.0 { 1.0 / sum } else { 0.0 };
    let mut running = 0.0;
    to.push(0.0);
    to.extend(values.map(|v| {
        running += v;
        (running * scale) as f32
    }));
    sum
}

/// The interval of a cumulative table in which a number of [0, 1) falls, and where in it.
#[inline]
fn pick(cumulative: &[f32], u: Real) -> (usize, Real) {
    let i = cumulative.partition_point(|&c| Real::from(c) <= u).clamp(1, cumulative.len() - 1);
    let (lo, hi) = (Real::from(cumulative[i - 1]), Real::from(cumulative[i]));
    let t = if hi > lo { ((u - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 };
    (i - 1, t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: usize, height: usize, texels: &[f32]) -> GreyImage {
        GreyImage { width, height, texels: texels.to_vec() }
    }

    #[test]
    fn resizing_keeps_the_mean_and_the_place() {
        let from = image(3, 2, &[1.0, 0.0, 0.5, 0.0, 0.0, 1.0]);
        for side in [1, 2, 3, 8, 64] {
            let to = from.resized(side, |t| t);
            let mean = to.cells.iter().sum::<f32>() / to.cells.len() as f32;
            assert!((mean - 2.5 / 6.0).abs() < 1e-5, "{side}: {mean}");
        }
        let to = from.resized(6, |t| t * t);
        assert_eq!((to.cells[0], to.cells[4], to.cells[35], to.cells[30]), (1.0, 0.25, 1.0, 0.0));
    }

    #[test]
    fn points_fall_where_light_passes() {
        let t = Transmission::new(&image(2, 2, &[0.0, 0.25, f32::NAN, 1.0])).unwrap();
        assert!((t.area() - 1.25).abs() < 1e-6);
        let n = 64;
        let mut upper = 0;
        for i in 0..n * n {
            let u = |k: i32| (k as Real + 0.5) / n as Real;
            let p = t.sample(Vec2::new(u(i % n), u(i / n)));
            assert!(p.x >= 0.0 && p.x <= 1.0 && p.y.abs() <= 1.0, "{p:?}");
            upper += i32::from(p.y > 0.0);
        }
        let part = f64::from(upper) / f64::from(n * n);
        assert!((part - 0.2).abs() < 0.02, "{part}");
    }

    #[test]
    fn black_images_are_refused() {
        assert_eq!(Transmission::new(&image(2, 1, &[0.0, -1.0])).unwrap_err(), NothingOpen);
    }
}
