//! The opening between the blades of a diaphragm.
//!
//! Each blade's edge is an arc of a circle of radius R whose centre lies R inwards from the edge's nearest
//! point, along the blade's own direction φ_i = start_angle + 2π i / n. A point is open where it lies
//! inside all n circles:
//!
//! ```text
//!            blade 1        φ_i        direction of blade i, counter-clockwise
//!           __-------__                from the right as the camera looks
//!   blade 2/     |     \blade 0
//!          | offset|----+---> φ_0      offset     centre to edge = blade_offset
//!          \    o--c----/              R          edge to c      = blade_curvature_radius
//!           \__ |    __/               c          centre of the edge's circle, at
//!     (further  -------                           offset - R from o along φ_0
//!      blades)
//! ```
//!
//! `docs/manual/generated-aperture.svg` draws it to scale. A large R makes straight edges, R = offset a circle. Where R > offset, c lies behind o, and the edge
//! of blade i bounds the opening for the directions nearest to φ_i. Where R < offset, c lies before o;
//! then the far sides of the circles bound the opening, each in the direction opposite to its blade's.
//! Either way the bounding arc has the distance R - |offset - R| from the centre, and if that is not
//! positive the blades close.

// tidy: load-time mathematics

use super::outline::Outline;

/// A diaphragm of curved blades; lengths in widths of the shape's square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blades {
    count: u32,
    start_angle: f64,
    /// R.
    curvature_radius: f64,
    /// R - |offset - R|.
    nearest: f64,
    /// Whether the far sides of the circles bound the opening.
    is_reversed: bool,
}

/// Why blades make no opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BladesError {
    /// Fewer than three blades, or more than [`Blades::MAX`].
    #[error("a diaphragm has 3 to {max} blades", max = Blades::MAX)]
    Count,
    /// The circles have no common point.
    #[error("the blades leave nothing open: the curvature radius is at most half the offset")]
    Closed,
    /// A number that is not positive, or not finite.
    #[error("offset and curvature radius must be positive and finite")]
    NotPositive,
}

impl Blades {
    /// More blades than this make a circle to the precision of single-precision numbers.
    pub const MAX: u32 = 10_000;

    /// From the parameters of a scene: angles in radians, lengths in widths of the square.
    ///
    /// # Errors
    /// Where they leave nothing open, or there are too few or too many blades.
    pub fn new(
        count: i64,
        start_angle: f64,
        offset: f64,
        curvature_radius: f64,
    ) -> Result<Self, BladesError> {
        let count = u32::try_from(count).ok().filter(|n| (3..=Self::MAX).contains(n));
        let count = count.ok_or(BladesError::Count)?;
        let positive = |v: f64| v > 0.0 && v.is_finite();
        if !(positive(offset) && positive(curvature_radius) && start_angle.is_finite()) {
            return Err(BladesError::NotPositive);
        }
        let is_reversed = curvature_radius < offset;
        let nearest = if is_reversed { 2.0 * curvature_radius - offset } else { offset };
        if nearest <= 0.0 {
            return Err(BladesError::Closed);
        }
        Ok(Self { count, start_angle, curvature_radius, nearest, is_reversed })
    }

    /// Distance of the bounding arc from the centre at an angle from the direction of its nearest point.
    ///
    /// The circle's centre lies D = R - nearest away from that direction. The positive root of
    /// |r (cos α, sin α) + (D, 0)| = R, written without the difference of two large numbers.
    fn radius(&self, alpha: f64) -> f64 {
        let d = 1.0 - self.nearest / self.curvature_radius;
        let (s, c) = alpha.sin_cos();
        self.nearest * (1.0 + d) / ((1.0 - d * d * s * s).sqrt() + d * c)
    }

    /// The edge of the opening within the square [-1, 1]².
    pub(super) fn outline(&self) -> Outline {
        let turn = std::f64::consts::TAU / f64::from(self.count);
        let start = self.start_angle + if self.is_reversed { std::f64::consts::PI } else { 0.0 };
        // From widths of the square to its half sides.
        let steps = Outline::chords(turn, 2.0 * self.curvature_radius, 2.0 * self.radius(0.5 * turn));
        let mut points = Vec::with_capacity(steps * self.count as usize);
        for blade in 0..self.count {
            let middle = start + f64::from(blade) * turn;
            for step in 0..steps {
                let alpha = turn * (step as f64 / steps as f64 - 0.5);
                let (s, c) = (middle + alpha).sin_cos();
                let r = 2.0 * self.radius(alpha);
                points.push([r * c, r * s]);
            }
        }
        Outline::new(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(count: i64, offset: f64, radius: f64) -> Outline {
        Blades::new(count, 0.3, offset, radius).unwrap().outline()
    }

    /// A regular polygon of inradius ρ has the area n ρ² tan(π/n).
    #[test]
    fn straight_blades_make_a_polygon() {
        for n in [3i64, 5, 6, 9] {
            let rho = 2.0 * 0.2;
            let exact = n as f64 * rho * rho * (std::f64::consts::PI / n as f64).tan();
            let area = outline(n, 0.2, 1e9).area();
            assert!((area / exact - 1.0).abs() < 1e-7, "{n}: {area} instead of {exact}");
        }
    }

    #[test]
    fn a_curvature_of_the_offset_makes_a_circle() {
        let exact = std::f64::consts::PI * 0.8f64.powi(2);
        assert!((outline(5, 0.4, 0.4).area() / exact - 1.0).abs() < 1e-6);
    }

    /// A point is open if it lies inside all circles.
    #[test]
    fn the_outline_is_where_the_circles_meet() {
        for (n, offset, radius) in [(6i64, 0.35, 0.9), (5, 0.3, 0.31), (7, 0.3, 0.2), (3, 0.24, 0.5)] {
            let blades = Blades::new(n, 0.3, offset, radius).unwrap();
            let turn = std::f64::consts::TAU / n as f64;
            let deepest = |[x, y]: [f64; 2]| {
                let outside = |i: i64| {
                    let (s, c) = (0.3 + turn * i as f64).sin_cos();
                    let d = 2.0 * (offset - radius);
                    (x - d * c).hypot(y - d * s) - 2.0 * radius
                };
                (0..n).map(outside).fold(f64::MIN, f64::max)
            };
            let outline = blades.outline();
            assert!(outline.points().len() > 100);
            for p in outline.points() {
                let p = p.map(f64::from);
                // On the edge of the innermost circle, unless the square cuts it off.
                let cut = p[0].abs().max(p[1].abs()) > 1.0 - 1e-6;
                let depth = deepest(p);
                assert!(depth.abs() < 1e-6 || (cut && depth < 1e-6), "{n} {offset} {radius}: {depth}");
            }
        }
    }

    #[test]
    fn the_square_cuts_the_corners_off() {
        // A square whose corners stick out, turned by 45 degrees: an octagon.
        let blades = Blades::new(4, std::f64::consts::FRAC_PI_4, 0.45, 1e9).unwrap();
        let corner = 0.9 * std::f64::consts::SQRT_2 - 1.0;
        let exact = 4.0 * 0.81 - 4.0 * corner * corner;
        assert!((blades.outline().area() / exact - 1.0).abs() < 1e-6);
    }

    #[test]
    fn what_leaves_nothing_open_is_refused() {
        assert_eq!(Blades::new(2, 0.0, 0.3, 1.0), Err(BladesError::Count));
        assert_eq!(Blades::new(i64::MAX, 0.0, 0.3, 1.0), Err(BladesError::Count));
        assert_eq!(Blades::new(5, 0.0, 0.3, 0.1), Err(BladesError::Closed));
        assert_eq!(Blades::new(5, 0.0, 0.3, 0.15), Err(BladesError::Closed));
        assert_eq!(Blades::new(5, 0.0, f64::NAN, 0.1), Err(BladesError::NotPositive));
        assert_eq!(Blades::new(5, f64::INFINITY, 0.3, 1.0), Err(BladesError::NotPositive));
    }
}
