//! A splat filter fitted to a film: the two ways in which a filter forms an image.
//!
//! *Splatting* spreads a contribution at a film position p over the pixels j around it with
//! weights f(j − p). *Sampling* goes the other way: a camera sample belongs to one pixel, and its
//! film position is drawn from |f| around the pixel's centre (filter importance sampling:
//! Ernst, Stamminger and Greiner, "Filter Importance Sampling", IEEE Interactive Ray Tracing
//! 2006), so that it touches that pixel alone and averages need no weights to be kept. Both expect
//! the same image, also at the border: there each pixel's filter is cut off at the film's edge and
//! divided by what is left of its integral, so that a constant image stays constant.

use crate::profile::Profile;
use crate::{FilmError, FilmSize, Filter};
use indigo_math::{Real, Vec2};

/// The most pixels along an axis that a filter of [`Filter::MAX_RADIUS`] covers.
const TAPS: usize = 4;
/// Pixels on each side of a film whose filter may be cut off by its edge.
const BORDER: usize = 2;
/// The least integral left at a border by which weights are divided. No filter with parameters in
/// [0, 1] leaves less than 0.5; absurd ones just lose light there instead of exploding.
const LEAST_MASS: f64 = 0.25;

/// A splat filter for films of one size; distances are in internal pixels.
#[derive(Clone, Debug)]
pub struct FilmFilter {
    profile: Profile,
    x: Axis,
    y: Axis,
}

/// A film position drawn for a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmSample {
    /// Position in internal pixels, origin top left, always within the film.
    pub position: Vec2,
    /// Factor for the sample's radiance and alpha: exactly 1 for the box and the Gaussian, of
    /// either sign and constant magnitude (but for the few cells at a sign change) for filters
    /// with negative lobes.
    pub weight: Real,
}

/// The pixels that a splat touches, and with what weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// First column, first row.
    pub origin: [u32; 2],
    /// Columns and rows, at most 4 each; either is 0 where the position lies outside the film.
    pub extent: [usize; 2],
    /// Weights of the columns; a pixel's weight is the product of its column's and its row's.
    pub columns: [f32; TAPS],
    /// Weights of the rows.
    pub rows: [f32; TAPS],
}

impl FilmFilter {
    /// Tabulates `filter` for a film. Errors: unusable parameters ([`Filter::check`]).
    pub fn new(filter: Filter, size: FilmSize) -> Result<Self, FilmError> {
        filter.check()?;
        let profile = Profile::new(filter);
        let x = Axis::new(&profile, size.internal_width() as usize);
        let y = Axis::new(&profile, size.internal_height() as usize);
        Ok(Self { profile, x, y })
    }

    /// Draws a film position for the internal pixel (`x`, `y`) from two numbers in [0, 1). The
    /// map is monotone in each, so stratification survives it.
    pub fn sample(&self, x: u32, y: u32, u: [Real; 2]) -> FilmSample {
        let (px, wx) = self.x.sample(&self.profile, x as usize, f64::from(u[0]));
        let (py, wy) = self.y.sample(&self.profile, y as usize, f64::from(u[1]));
        FilmSample { position: Vec2::new(px as Real, py as Real), weight: (wx * wy) as Real }
    }

    /// The pixels around a film position and their weights. Positions should cover the film
    /// uniformly; one outside it touches no pixel.
    pub fn footprint(&self, position: Vec2) -> Footprint {
        let (x0, nx, columns) = self.x.footprint(&self.profile, f64::from(position.x));
        let (y0, ny, rows) = self.y.footprint(&self.profile, f64::from(position.y));
        Footprint { origin: [x0, y0], extent: [nx, ny], columns, rows }
    }
}

/// What one axis needs to know of its border.
#[derive(Clone, Debug)]
struct Axis {
    len: usize,
    /// The first two pixels, one of the interior, and the last two; all where there are fewer.
    pixels: Vec<AxisPixel>,
}

/// The part of a pixel's filter that lies on the film.
#[derive(Clone, Debug)]
struct AxisPixel {
    /// Integral of the absolute filter where the film begins, and its length on the film.
    start: f64,
    span: f64,
    /// 1 / integral of the filter on the film.
    inverse_mass: f64,
}

impl Axis {
    fn new(profile: &Profile, len: usize) -> Self {
        let kinds = len.min(2 * BORDER + 1);
        let pixels = (0..kinds)
            .map(|kind| {
                let i = if kind <= BORDER { kind } else { len - kinds + kind };
                AxisPixel::new(profile, i, len)
            })
            .collect();
        Self { len, pixels }
    }

    #[inline]
    fn pixel(&self, i: usize) -> &AxisPixel {
        let kinds = self.pixels.len();
        let from_end = self.len - i;
        let kind = if from_end <= BORDER { kinds - from_end } else { i.min(BORDER) };
        &self.pixels[kind]
    }

    fn sample(&self, profile: &Profile, i: usize, u: f64) -> (f64, f64) {
        let pixel = self.pixel(i);
        let (offset, ratio) = profile.invert(pixel.start + u * pixel.span);
        let position = (i as f64 + 0.5 + offset).clamp(0.0, self.len as f64);
        (position, ratio * (pixel.span * pixel.inverse_mass))
    }

    fn footprint(&self, profile: &Profile, p: f64) -> (u32, usize, [f32; TAPS]) {
        let mut weights = [0.0; TAPS];
        if !(p >= 0.0 && p <= self.len as f64) {
            return (0, 0, weights);
        }
        // Pixels i with -r < i + 1/2 - p <= r, so that neighbouring boxes share no position. The
        // film's far edge belongs to its last pixel.
        let p = p.min(self.len as f64 - 1e-9);
        let r = profile.radius();
        let first = ((p - r - 0.5).floor() + 1.0).max(0.0) as usize;
        let last = ((p + r - 0.5).floor().max(0.0) as usize).min(self.len - 1);
        let n = (last + 1).saturating_sub(first).min(TAPS);
        for (k, weight) in weights.iter_mut().enumerate().take(n) {
            let i = first + k;
            let f = profile.eval((i as f64 + 0.5 - p) as f32);
            *weight = f * self.pixel(i).inverse_mass as f32;
        }
        (first as u32, n, weights)
    }
}

impl AxisPixel {
    fn new(profile: &Profile, i: usize, len: usize) -> Self {
        let r = profile.radius();
        let centre = i as f64 + 0.5;
        let (lo, hi) = ((-centre).max(-r), (len as f64 - centre).min(r));
        let start = profile.absolute_to(lo);
        let mass = profile.integral_to(hi) - profile.integral_to(lo);
        Self { start, span: profile.absolute_to(hi) - start, inverse_mass: 1.0 / mass.max(LEAST_MASS) }
    }
}
