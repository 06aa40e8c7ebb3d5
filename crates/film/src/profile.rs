//! A filter along one axis as a piecewise linear table, with its integrals.
//!
//! The film's filter *is* this table: evaluation, integrals and the inversion that draws samples
//! all belong to the same piecewise linear function, so that splatting and sampling expect the
//! same image exactly. The table differs from the filter's closed form by less than 1e-5.

use crate::Filter;

/// Table cells per pixel: linear interpolation then errs by at most h²/8 · max|f″| ≈ 5e-6.
const CELLS_PER_PIXEL: f64 = 512.0;

/// A symmetric piecewise linear function on [-radius, radius] of integral 1.
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    radius: f64,
    cell: f64,
    cells_per_pixel: f64,
    /// Values at the ends of the cells.
    values: Vec<f32>,
    /// Integral of the function from -radius to the ends of the cells.
    integral: Vec<f64>,
    /// Integral of the interpolated absolute values from -radius to the ends of the cells.
    absolute: Vec<f64>,
    /// The cell in which `absolute` passes each of as many equal steps as there are cells: where
    /// an inversion begins to look.
    guide: Vec<u16>,
}

impl Profile {
    /// The table of a filter whose parameters have been checked.
    pub(crate) fn new(filter: Filter) -> Self {
        let radius = filter.radius();
        // Linear pieces describe the box exactly with a single cell.
        let cells = match filter {
            Filter::Box => 1,
            _ => (2.0 * radius * CELLS_PER_PIXEL).ceil() as usize,
        };
        let cell = 2.0 * radius / cells as f64;
        let values: Vec<f64> =
            (0..=cells).map(|k| filter.eval((k as f64 * cell - radius).clamp(-radius, radius))).collect();
        let raw = cumulative(&values, cell)[cells];
        // Integrals of the rounded values, since those are what is evaluated.
        let values: Vec<f32> = values.into_iter().map(|v| (v / raw) as f32).collect();
        let exact: Vec<f64> = values.iter().map(|&v| f64::from(v)).collect();
        let magnitudes: Vec<f64> = exact.iter().map(|v| v.abs()).collect();
        let absolute = cumulative(&magnitudes, cell);
        Self {
            guide: guide(&absolute),
            radius,
            cell,
            cells_per_pixel: cell.recip(),
            integral: cumulative(&exact, cell),
            absolute,
            values,
        }
    }

    /// Beyond this distance the function is zero.
    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }

    /// The function at `x`; the end value just outside the radius.
    #[inline]
    pub(crate) fn eval(&self, x: f32) -> f32 {
        let (k, t) = self.locate(f64::from(x));
        let t = t as f32;
        self.values[k] + t * (self.values[k + 1] - self.values[k])
    }

    /// Integral of the function from -radius to `x`.
    pub(crate) fn integral_to(&self, x: f64) -> f64 {
        self.partial(&self.integral, x, |v| v)
    }

    /// Integral of the interpolated absolute values from -radius to `x`: what [`Self::invert`]
    /// inverts.
    pub(crate) fn absolute_to(&self, x: f64) -> f64 {
        self.partial(&self.absolute, x, f64::abs)
    }

    /// The position up to which the absolute values integrate to `target`, and the ratio of the
    /// function to its interpolated absolute value there: ±1 except in a cell where the sign
    /// changes.
    pub(crate) fn invert(&self, target: f64) -> (f64, f64) {
        let last = self.values.len() - 2;
        let step = target / self.absolute[last + 1] * self.guide.len() as f64;
        let mut k = usize::from(self.guide[(step as usize).min(last)]);
        while k < last && self.absolute[k + 1] <= target {
            k += 1;
        }
        let (a, b) = (f64::from(self.values[k]), f64::from(self.values[k + 1]));
        let t = invert_linear(a.abs(), b.abs(), (target - self.absolute[k]) * self.cells_per_pixel);
        let density = a.abs() + t * (b.abs() - a.abs());
        // At an end where the function vanishes its sign is the cell's.
        let ratio = if density > 0.0 { (a + t * (b - a)) / density } else { (a + b).signum() };
        ((k as f64 + t) * self.cell - self.radius, ratio)
    }

    /// The cell that holds `x` and the position in it, from 0 to 1.
    #[inline]
    fn locate(&self, x: f64) -> (usize, f64) {
        let s = ((x + self.radius) * self.cells_per_pixel).clamp(0.0, (self.values.len() - 1) as f64);
        let k = (s as usize).min(self.values.len() - 2);
        (k, s - k as f64)
    }

    /// A cumulative table at `x`, exact within its cell.
    fn partial(&self, table: &[f64], x: f64, map: impl Fn(f64) -> f64) -> f64 {
        let (k, t) = self.locate(x);
        let (a, b) = (map(f64::from(self.values[k])), map(f64::from(self.values[k + 1])));
        table[k] + self.cell * t * (a + 0.5 * t * (b - a))
    }
}

/// Running integral of a piecewise linear function with the given values at the cells' ends.
fn cumulative(values: &[f64], cell: f64) -> Vec<f64> {
    let mut sum = 0.0;
    std::iter::once(0.0)
        .chain(values.windows(2).map(|pair| {
            sum += 0.5 * cell * (pair[0] + pair[1]);
            sum
        }))
        .collect()
}

/// For each of as many equal steps of the last value as there are cells, the cell in which the
/// cumulative table passes it, or one before.
fn guide(cumulative: &[f64]) -> Vec<u16> {
    let cells = cumulative.len() - 1;
    let total = cumulative[cells];
    (0..cells)
        .map(|step| {
            // Half a step early, so that rounding never leads beyond the target's cell.
            let target = total * (step as f64 - 0.5) / cells as f64;
            cumulative.partition_point(|&a| a <= target).saturating_sub(1) as u16
        })
        .collect()
}

/// Solves ∫₀ᵗ (a + s(b − a)) ds = `area` for t in [0, 1], with a, b ≥ 0.
fn invert_linear(a: f64, b: f64, area: f64) -> f64 {
    // The root of ½(b − a)t² + at = area in the form that does not cancel.
    let root = (a * a + 2.0 * (b - a) * area).max(0.0).sqrt();
    let t = if a + root > 0.0 { 2.0 * area / (a + root) } else { 0.0 };
    t.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILTERS: [Filter; 4] = [
        Filter::Box,
        Filter::Gaussian,
        Filter::MN_DEFAULT,
        Filter::MitchellNetravali { blur: 0.0, ring: 1.0 },
    ];

    #[test]
    fn table_is_the_closed_form() {
        for filter in FILTERS {
            let profile = Profile::new(filter);
            for i in 0..=10_000 {
                let x = (f64::from(i) / 5000.0 - 1.0) * filter.radius() * (1.0 - 1e-7);
                let error = f64::from(profile.eval(x as f32)) - filter.eval(x);
                assert!(error.abs() < 1e-5, "{filter:?} at {x}: {error:e}");
            }
        }
    }

    #[test]
    fn integral_is_one() {
        for filter in FILTERS {
            let profile = Profile::new(filter);
            assert!((profile.integral_to(filter.radius()) - 1.0).abs() < 1e-7);
            assert!((profile.integral_to(0.0) - 0.5).abs() < 1e-7);
            assert_eq!(profile.integral_to(-9.0), 0.0);
        }
    }

    #[test]
    fn inversion_undoes_integration() {
        for filter in FILTERS {
            let profile = Profile::new(filter);
            let all = profile.absolute_to(filter.radius());
            for i in 0..=1000 {
                let target = all * f64::from(i) / 1000.0;
                let (x, ratio) = profile.invert(target);
                assert!((profile.absolute_to(x) - target).abs() < 1e-12, "{filter:?} at {target}");
                assert!(ratio.abs() <= 1.0 + 1e-12);
            }
        }
    }

    #[test]
    fn non_negative_filters_have_ratio_one() {
        for filter in [Filter::Box, Filter::Gaussian] {
            let profile = Profile::new(filter);
            for i in 0..1000 {
                assert_eq!(profile.invert(f64::from(i) / 1000.0).1, 1.0);
            }
        }
    }
}
