//! Warps of the unit square to the shapes that sampling needs, with their densities and inverses.

use crate::elementary::sin_cos_turns;
use crate::{Real, Vec2, Vec3};

/// π in the kernel's precision.
pub const PI: Real = std::f64::consts::PI as Real;
/// 1/π in the kernel's precision.
pub const INV_PI: Real = std::f64::consts::FRAC_1_PI as Real;

/// The unit disk, area to area, keeping neighbourhoods (Shirley & Chiu 1997).
#[inline]
pub fn concentric_disk(u: Vec2) -> Vec2 {
    let (a, b) = (2.0 * u.x - 1.0, 2.0 * u.y - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::new(0.0, 0.0);
    }
    let (r, turns) = if a * a > b * b { (a, b / a * 0.125) } else { (b, 0.25 - a / b * 0.125) };
    let (s, c) = sin_cos_turns(turns);
    Vec2::new(r * c, r * s)
}

/// A direction of the upper hemisphere with density cos θ / π.
#[inline]
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = concentric_disk(u);
    Vec3::new(d.x, d.y, (1.0 - d.x * d.x - d.y * d.y).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] in solid angle.
#[inline(always)]
pub fn cosine_hemisphere_pdf(cos_theta: Real) -> Real {
    cos_theta.max(0.0) * INV_PI
}

/// A direction of the upper hemisphere with density 1 / 2π.
#[inline]
pub fn uniform_hemisphere(u: Vec2) -> Vec3 {
    let z = 1.0 - u.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (s, c) = sin_cos_turns(u.y);
    Vec3::new(r * c, r * s, z)
}

/// A direction of the whole sphere with density 1 / 4π.
#[inline]
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (s, c) = sin_cos_turns(u.y);
    Vec3::new(r * c, r * s, z)
}

/// Barycentric coordinates of vertices 1 and 2 of a triangle, uniform over its area, with little
/// distortion of the square (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
#[inline]
pub fn uniform_triangle(u: Vec2) -> (Real, Real) {
    if u.y > u.x {
        let b1 = u.x * 0.5;
        (b1, u.y - b1)
    } else {
        let b2 = u.y * 0.5;
        (u.x - b2, b2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// Means over n points against exact moments; false-alarm rate 1e-5 each (4.4 standard errors).
    fn mean(n: usize, f: impl Fn(Vec2) -> f64) -> (f64, f64) {
        let mut rng = Rng::new(11);
        let (mut s, mut s2) = (0.0, 0.0);
        for _ in 0..n {
            let v = f(Vec2::new(rng.next_real(), rng.next_real()));
            s += v;
            s2 += v * v;
        }
        let m = s / n as f64;
        (m, ((s2 / n as f64 - m * m) / n as f64).sqrt())
    }

    fn expect(f: impl Fn(Vec2) -> f64, exact: f64) {
        let (m, se) = mean(200_000, f);
        assert!((m - exact).abs() < 4.4 * se + 1e-12, "{m} against {exact} ± {se}");
    }

    #[test]
    fn disk_is_uniform() {
        expect(|u| concentric_disk(u).x as f64, 0.0);
        expect(|u| (concentric_disk(u).x as f64).powi(2), 0.25);
        expect(|u| f64::from(u8::from(concentric_disk(u).y > 0.5)), 0.195_501_109_477_885);
    }

    #[test]
    fn cosine_hemisphere_has_its_moments() {
        expect(|u| cosine_hemisphere(u).z as f64, 2.0 / 3.0);
        expect(|u| (cosine_hemisphere(u).z as f64).powi(2), 0.5);
        for i in 0..1000 {
            let d = cosine_hemisphere(Vec2::new((i % 32) as Real / 32.0, (i / 32) as Real / 32.0));
            assert!((d.length() - 1.0).abs() < 1e-6 && d.z >= 0.0);
        }
    }

    #[test]
    fn sphere_and_triangle_are_uniform() {
        expect(|u| (uniform_hemisphere(u).x as f64).powi(2), 1.0 / 3.0);
        expect(|u| uniform_hemisphere(u).z as f64, 0.5);
        expect(|u| (uniform_sphere(u).x as f64).powi(2), 1.0 / 3.0);
        expect(|u| (uniform_sphere(u).z as f64).powi(4), 0.2);
        expect(|u| uniform_triangle(u).0 as f64, 1.0 / 3.0);
        expect(|u| (uniform_triangle(u).1 as f64).powi(2), 1.0 / 6.0);
        expect(|u| f64::from(u8::from(uniform_triangle(u).0 + uniform_triangle(u).1 > 1.0)), 0.0);
    }
}
