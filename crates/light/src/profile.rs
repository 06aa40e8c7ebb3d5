//! How a photometric lamp's intensity depends on the direction (IES LM-63, type C).
//!
//! Vertical angles count from the axis along which the lamp shines. Horizontal ones count round it from
//! the x axis of the lamp's mesh, counter-clockwise seen from behind the lamp, that is from above where
//! it shines down. Candelas are bilinear in both angles.

use indigo_math::angle::atan2_turns;
use indigo_math::elementary::sin_cos_turns;
use indigo_math::grid_distribution::{GridDistribution, cell_means};
use indigo_math::warp::PI;
use indigo_math::{Float, Real, Vec2, Vec3};

/// Cells of the grid by which directions are drawn: 5° of the horizontal and half a degree (a whole one
/// where the lamp shines to both sides) of the vertical angle.
const COLUMNS: usize = 72;
const ROWS: usize = 180;
/// Points of a cell along each side.
const POINTS: usize = 2;

/// Luminous intensity by direction.
#[derive(Clone, Debug)]
pub struct Profile {
    /// In degrees, ascending, from 0 to 90 or 180.
    vertical: Vec<Real>,
    /// In degrees, ascending, from 0 to 360; one alone where the intensity does not depend on it.
    horizontal: Vec<Real>,
    /// cd, the vertical angles of each horizontal one in turn.
    candela: Vec<Real>,
    /// Half a turn, or a quarter: the last vertical angle in turns.
    reach_turns: Real,
    directions: GridDistribution,
    flux_lm: f64,
}

impl Profile {
    /// From ascending angles in degrees and the intensities (cd) of each horizontal angle in turn. Vertical
    /// angles run from 0 to 90 or 180. Horizontal ones are one alone, or run from 0 to 90 or 180 or
    /// from 90 to 270, of which the rest is the mirror image, or from 0 to 360.
    ///
    /// # Panics
    /// If there are not as many intensities as pairs of angles, or none.
    pub fn new(vertical_deg: &[f64], horizontal_deg: &[f64], candela: &[f64]) -> Self {
        let n = vertical_deg.len();
        assert!(n > 1 && !horizontal_deg.is_empty() && candela.len() == n * horizontal_deg.len());
        let columns: Vec<&[f64]> = candela.chunks_exact(n).collect();
        let (horizontal, unfolded) = unfold(horizontal_deg, &columns);
        let to_real = |v: &[f64]| v.iter().map(|&x| x as Real).collect();
        let last = vertical_deg[n - 1];
        let mut profile = Self {
            vertical: to_real(vertical_deg),
            horizontal: to_real(&horizontal),
            candela: to_real(&unfolded),
            reach_turns: (last / 360.0) as Real,
            directions: GridDistribution::new(1, 1, &[1.0]),
            flux_lm: flux(vertical_deg, &horizontal, &unfolded),
        };
        let cells = cell_means([COLUMNS, ROWS], POINTS, |[turn, reach]| {
            let theta = reach as Real * profile.reach_turns;
            (profile.at(theta * 360.0, turn as Real * 360.0) * sin_cos_turns(theta).0).to_f64()
        });
        profile.directions = GridDistribution::new(COLUMNS, ROWS, &cells);
        profile
    }

    /// Luminous flux, lm: the integral of the intensity.
    pub fn flux(&self) -> f64 {
        self.flux_lm
    }

    /// The vertical angle in radians within which all light leaves.
    pub fn widest_angle(&self) -> f64 {
        let n = self.vertical.len();
        let is_lit = |i: usize| self.candela.chunks_exact(n).any(|column| column[i] > 0.0);
        let last_lit = (0..n).rposition(is_lit).unwrap_or(n - 1);
        self.vertical[(last_lit + 1).min(n - 1)].to_f64().to_radians()
    }

    /// Whether light leaves both sides of the lamp.
    #[inline]
    pub fn is_two_sided(&self) -> bool {
        self.reach_turns > 0.26
    }

    /// Luminous intensity (cd) in a direction, of which x, y and z are those of the profile.
    #[inline]
    pub fn intensity(&self, local: Vec3) -> Real {
        let (theta, phi) = angles(local);
        self.at(theta * 360.0, phi * 360.0)
    }

    /// A direction, with density [`pdf`](Self::pdf).
    #[inline]
    pub fn sample(&self, u: [Real; 2]) -> Vec3 {
        let (at, _) = self.directions.sample(u);
        let (sin_phi, cos_phi) = sin_cos_turns(at.x);
        let (sin, cos) = sin_cos_turns(at.y * self.reach_turns);
        Vec3::new(sin * cos_phi, sin * sin_phi, cos)
    }

    /// Density (1/sr) of [`sample`](Self::sample).
    #[inline]
    pub fn pdf(&self, local: Vec3) -> Real {
        let (theta, phi) = angles(local);
        let sin = (local.x * local.x + local.y * local.y).sqrt();
        if theta > self.reach_turns || sin <= 0.0 {
            return 0.0;
        }
        // dω = sin θ dθ dφ, where the square's sides are the last vertical angle and a full turn.
        let stretch = sin * self.reach_turns * (4.0 * PI * PI);
        self.directions.pdf(Vec2::new(phi, theta / self.reach_turns)) / stretch
    }

    /// Intensity (cd) at angles in degrees.
    #[inline]
    fn at(&self, vertical: Real, horizontal: Real) -> Real {
        let n = self.vertical.len();
        if vertical > self.vertical[n - 1] {
            return 0.0;
        }
        let (row, fy) = locate(&self.vertical, vertical);
        let along = |column: usize| {
            let values = &self.candela[column * n..(column + 1) * n];
            values[row] + fy * (values[row + 1] - values[row])
        };
        if self.horizontal.len() == 1 {
            return along(0);
        }
        let (column, fx) = locate(&self.horizontal, horizontal);
        let (low, high) = (along(column), along(column + 1));
        low + fx * (high - low)
    }
}

/// Vertical and horizontal angle in turns.
#[inline]
fn angles(local: Vec3) -> (Real, Real) {
    let across = (local.x * local.x + local.y * local.y).sqrt();
    (atan2_turns(across, local.z), atan2_turns(local.y, local.x))
}

/// The interval of an ascending list in which a number lies, and how far in it.
#[inline]
fn locate(list: &[Real], x: Real) -> (usize, Real) {
    let end = list.partition_point(|&a| a <= x).clamp(1, list.len() - 1);
    let (low, high) = (list[end - 1], list[end]);
    (end - 1, ((x - low) / (high - low)).clamp(0.0, 1.0))
}

/// The horizontal angles all round, from 0 to 360, and the intensities of each in turn, from those of the given: what
/// these leave out is their mirror image.
fn unfold(horizontal_deg: &[f64], columns: &[&[f64]]) -> (Vec<f64>, Vec<f64>) {
    let n = horizontal_deg.len();
    let (first, last) = (horizontal_deg[0], horizontal_deg[n - 1]);
    if n == 1 {
        return (vec![0.0], columns[0].to_vec());
    }
    let mut all: Vec<(f64, usize)> = horizontal_deg.iter().copied().zip(0..).collect();
    let mut mirror = |about: f64| {
        let images: Vec<(f64, usize)> = all.iter().map(|&(a, i)| (2.0 * about - a, i)).collect();
        all.extend(images);
    };
    if first > 45.0 {
        // From 90 to 270: about 90, which reaches down to -90; beyond 270 by a full turn.
        mirror(90.0);
        let turned: Vec<(f64, usize)> = all.iter().map(|&(a, i)| (a + 360.0, i)).collect();
        all.extend(turned);
    } else if last < 135.0 {
        mirror(90.0);
        mirror(180.0);
    } else if last < 270.0 {
        mirror(180.0);
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.dedup_by(|a, b| a.0 == b.0);
    // From 90 to 270 there may be no angle whose image is 0: its intensities lie between those beside it.
    let at = |angle: f64| -> Vec<f64> {
        let end = all.partition_point(|&(a, _)| a <= angle).clamp(1, all.len() - 1);
        let ((low, i), (high, j)) = (all[end - 1], all[end]);
        let part = ((angle - low) / (high - low)).clamp(0.0, 1.0);
        columns[i].iter().zip(columns[j]).map(|(a, b)| a + part * (b - a)).collect()
    };
    let between = all.iter().map(|&(a, _)| a).filter(|a| *a > 0.0 && *a < 360.0);
    let angles: Vec<f64> = std::iter::once(0.0).chain(between).chain([360.0]).collect();
    let intensities = angles.iter().flat_map(|&a| at(a)).collect();
    (angles, intensities)
}

/// ∫ I sin θ dθ dφ of the bilinear intensity: with I = k + mθ between two vertical angles the integral is
/// [−(k + mθ) cos θ + m sin θ], and linear in the horizontal angle, so that trapezia are exact.
fn flux(vertical_deg: &[f64], horizontal_deg: &[f64], candela: &[f64]) -> f64 {
    // tidy: load-time mathematics
    let n = vertical_deg.len();
    let along = |column: &[f64]| -> f64 {
        let interval = |i: usize| {
            let (t0, t1) = (vertical_deg[i].to_radians(), vertical_deg[i + 1].to_radians());
            let slope = (column[i + 1] - column[i]) / (t1 - t0);
            let end = |t: f64, value: f64| slope * t.sin() - value * t.cos();
            end(t1, column[i + 1]) - end(t0, column[i])
        };
        (0..n - 1).map(interval).sum()
    };
    let columns: Vec<f64> = candela.chunks_exact(n).map(along).collect();
    if columns.len() == 1 {
        return columns[0] * std::f64::consts::TAU;
    }
    let strips = horizontal_deg.windows(2).zip(columns.windows(2));
    strips.map(|(a, c)| (a[1] - a[0]).to_radians() * 0.5 * (c[0] + c[1])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verticals(last: f64) -> Vec<f64> {
        (0..=36).map(|i| last * f64::from(i) / 36.0).collect()
    }

    /// Intensity that is given at some horizontal angles by a function of both angles in degrees.
    fn profile(horizontals: &[f64], f: impl Fn(f64, f64) -> f64) -> Profile {
        let vertical = verticals(90.0);
        let candela: Vec<f64> = horizontals
            .iter()
            .flat_map(|&h| vertical.iter().map(move |&v| (h, v)))
            .map(|(h, v)| f(v, h))
            .collect();
        Profile::new(&vertical, horizontals, &candela)
    }

    #[test]
    fn an_even_hemisphere_has_its_flux() {
        let even = profile(&[0.0], |_, _| 500.0);
        assert!((even.flux() - 1000.0 * std::f64::consts::PI).abs() < 1e-9);
        let vertical = verticals(180.0);
        let ball = Profile::new(&vertical, &[0.0], &vec![2.0; vertical.len()]);
        assert!((ball.flux() - 8.0 * std::f64::consts::PI).abs() < 1e-9);
        assert!(ball.is_two_sided() && !even.is_two_sided());
    }

    /// What each range of horizontal angles leaves out is the mirror image of what it gives.
    #[test]
    fn symmetries_are_mirror_images() {
        let direction = |h: f64| {
            let (s, c) = h.to_radians().sin_cos();
            Vec3::new((0.6 * c) as Real, (0.6 * s) as Real, 0.8)
        };
        let value = |p: &Profile, h: f64| p.intensity(direction(h)) as f64;
        // Linear in the horizontal angle, so that interpolation is exact.
        let quadrant = profile(&[0.0, 30.0, 90.0], |_, h| 1.0 + h);
        let half = profile(&[0.0, 90.0, 180.0], |_, h| 1.0 + h);
        let other_half = profile(&[90.0, 180.0, 270.0], |_, h| 1.0 + h);
        let all = profile(&[0.0, 90.0, 180.0, 270.0, 360.0], |_, h| if h == 360.0 { 1.0 } else { 1.0 + h });
        for (h, q, b, o, a) in [
            (20.0, 21.0, 21.0, 161.0, 21.0),
            (80.0, 81.0, 81.0, 101.0, 81.0),
            (100.0, 81.0, 101.0, 101.0, 101.0),
            (200.0, 21.0, 161.0, 201.0, 201.0),
            (250.0, 71.0, 111.0, 251.0, 251.0),
            (315.0, 46.0, 46.0, 226.0, 136.0),
        ] {
            for (p, expected) in [(&quadrant, q), (&half, b), (&other_half, o), (&all, a)] {
                assert!((value(p, h) - expected).abs() < 1e-3, "{h}: {} {expected}", value(p, h));
            }
        }
        // Angles whose mirror images leave 0 out: it lies between 30, the image of 150, and -30, that of 210.
        let gap = profile(&[90.0, 150.0, 210.0, 270.0], |_, h| 1.0 + h);
        for (h, expected) in
            [(0.0, 181.0), (15.0, 166.0), (345.0, 196.0), (30.0, 151.0), (120.0, 121.0), (330.0, 211.0)]
        {
            assert!((value(&gap, h) - expected).abs() < 1e-3, "{h}: {} {expected}", value(&gap, h));
        }
        let two = profile(&[90.0, 270.0], |_, _| 500.0);
        assert!((two.flux() - 1000.0 * std::f64::consts::PI).abs() < 1e-9, "{}", two.flux());
        let round = profile(&[0.0], |_, _| 7.0);
        assert!((value(&round, 123.0) - 7.0).abs() < 1e-6);
    }

    #[test]
    fn intensity_is_linear_between_the_angles_and_nothing_beyond() {
        let p = profile(&[0.0], |v, _| v * v);
        let at = |v: f64| {
            let (s, c) = v.to_radians().sin_cos();
            p.intensity(Vec3::new(s as Real, 0.0, c as Real)) as f64
        };
        assert!((at(30.0) - 900.0).abs() < 0.01);
        assert!((at(31.25) - f64::midpoint(900.0, 1056.25)).abs() < 0.01);
        assert_eq!(at(95.0), 0.0);
    }
}
