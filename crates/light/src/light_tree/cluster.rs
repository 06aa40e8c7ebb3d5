//! Bounds of some lamps, or parts of them: where they are, where they shine, and how brightly.
// tidy: load-time mathematics

use indigo_math::{Bounds3, Vec3d};
use std::f64::consts::{FRAC_PI_2, PI};

/// Directions in which light leaves: all normals lie within `spread` of an axis, and light within `reach` of a
/// normal, with an intensity that falls as the cosine to it does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lobe {
    /// Unit vector.
    pub axis: Vec3d,
    /// Radians, 0 to π.
    pub spread: f64,
    /// Radians, 0 to π/2.
    pub reach: f64,
}

/// What is known of some lamps' triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster {
    pub bounds: Bounds3<f64>,
    pub lobe: Lobe,
    /// Along the normals, cd.
    pub intensity: f64,
}

impl Lobe {
    /// Of a surface that is as bright from all sides.
    pub fn lambertian(normal: Vec3d) -> Self {
        Self { axis: normal, spread: 0.0, reach: FRAC_PI_2 }
    }

    /// The same intensity everywhere within an angle of an axis.
    pub fn even(axis: Vec3d, within: f64) -> Self {
        Self { axis, spread: within, reach: 0.0 }
    }

    /// Intensity along the normals by the flux (cd/lm).
    pub fn intensity_of_flux(&self) -> f64 {
        if self.reach > 0.0 { 1.0 / PI } else { 1.0 / (2.0 * PI * (1.0 - self.spread.cos())) }
    }

    /// Sine and cosine of the spread.
    pub fn sin_cos_spread(&self) -> (f64, f64) {
        self.spread.sin_cos()
    }

    /// Solid angle of the directions, those beyond the normals' weighed by the cosine: the measure M_Ω of Conty
    /// Estevez & Kulla 2018, section 4.4, integrated.
    fn measure(&self) -> f64 {
        let (spread, last) = (self.spread, (self.spread + self.reach).min(PI));
        let (s, c) = spread.sin_cos();
        let beyond = 2.0 * last * s - (spread - 2.0 * last).cos() - 2.0 * spread * s + c;
        2.0 * PI * (1.0 - c) + FRAC_PI_2 * beyond
    }

    /// The lobe round two others, for which the narrower is turned into the wider as far as need be (section 4.3).
    fn union(self, other: Self) -> Self {
        let (wide, narrow) = if self.spread >= other.spread { (self, other) } else { (other, self) };
        let reach = wide.reach.max(narrow.reach);
        // By the half of the angle between: its cosine alone would not tell small ones from none.
        let apart = 2.0 * (0.5 * (wide.axis - narrow.axis).length()).min(1.0).asin();
        if (apart + narrow.spread).min(PI) <= wide.spread {
            return Self { reach, ..wide };
        }
        let spread = 0.5 * (wide.spread + apart + narrow.spread);
        let across = narrow.axis - wide.axis * wide.axis.dot(narrow.axis);
        // Opposite normals have no plane in common: all directions.
        let (Some(across), true) = (across.try_normalized(), spread < PI) else {
            return Self { axis: wide.axis, spread: PI, reach };
        };
        let (s, c) = (spread - wide.spread).sin_cos();
        Self { axis: (wide.axis * c + across * s).normalized(), spread, reach }
    }
}

impl Cluster {
    /// Both together.
    pub fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            lobe: self.lobe.union(other.lobe),
            intensity: self.intensity + other.intensity,
        }
    }

    /// What a split into this and another part costs for this one: the less, the nearer its lamps are to one another
    /// and the more they shine into the same directions (section 4.4, the surface area orientation heuristic).
    pub fn cost(&self) -> f64 {
        self.intensity * self.lobe.measure() * self.bounds.half_area()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_math::Vec3;
    use indigo_testkit::rng::Rng;

    fn any_direction(rng: &mut Rng) -> Vec3d {
        let mut number = || 2.0 * rng.uniform() - 1.0;
        Vec3::new(number(), number(), number()).normalized()
    }

    #[test]
    fn measures_are_those_of_simple_lobes() {
        let up = Vec3d::new(0.0, 0.0, 1.0);
        // ∫ cos over a hemisphere; a hemisphere; everything.
        assert!((Lobe::lambertian(up).measure() - PI).abs() < 1e-12);
        assert!((Lobe::even(up, FRAC_PI_2).measure() - 2.0 * PI).abs() < 1e-12);
        let all = Lobe { spread: PI, ..Lobe::lambertian(up) };
        assert!((all.measure() - 4.0 * PI).abs() < 1e-12);
    }

    /// A union holds all normals of both, and is not wider than it must.
    #[test]
    fn unions_hold_both() {
        let mut rng = Rng::new(12);
        for _ in 0..2000 {
            let [a, b] = [(); 2].map(|()| {
                let spread = rng.uniform() * rng.uniform() * 2.0;
                Lobe { spread, ..Lobe::lambertian(any_direction(&mut rng)) }
            });
            let both = a.union(b);
            let angle = |x: Vec3d, y: Vec3d| x.dot(y).clamp(-1.0, 1.0).acos();
            for lobe in [a, b] {
                assert!(angle(lobe.axis, both.axis) + lobe.spread <= both.spread.max(PI * 0.999_999) + 1e-6);
            }
            let must = 0.5 * (a.spread + b.spread + angle(a.axis, b.axis));
            assert!(both.spread <= must.max(a.spread).max(b.spread).min(PI) + 1e-6, "{a:?} {b:?} {both:?}");
        }
    }
}
