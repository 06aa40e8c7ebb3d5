//! Microfacets of Trowbridge and Reitz's distribution with Smith's masking.
//!
//! The distribution is that of Walter et al. 2007 ("Microfacet Models for Refraction through Rough Surfaces"),
//! section 5.2. An exponent n of a scene is that of a Phong lobe of normals, D ∝ cosⁿ (equation 30 there); here it
//! sets the width α = √(2 / (n + 2)) by which the distribution has the same density along the normal,
//! (n + 2) / 2π. Its tails are longer, as those of measured surfaces are, its masking function is exact in closed
//! form, and visible normals can be drawn directly, which a Phong lobe of normals allows neither of.
//!
//! All directions are unit vectors on the upper side of the local frame.

use indigo_math::elementary::sin_cos_turns;
use indigo_math::warp::INV_PI;
use indigo_math::{Real, Vec3};

/// The smoothest surface: an exponent of 2e8. Single precision cannot place a normal more exactly.
const LEAST_WIDTH: Real = 1e-4;

/// A rough surface of one width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacets {
    /// α, from nearly 0 (smooth) to 1 (the exponent 0).
    width: Real,
}

impl Microfacets {
    /// Of a width α, limited to what can be told from a mirror.
    #[inline]
    pub fn of_width(width: Real) -> Self {
        Self { width: width.clamp(LEAST_WIDTH, 1.0) }
    }

    /// Of the exponent of a Phong lobe of normals; one that is not above 0 counts as 0.
    #[inline]
    pub fn of_exponent(exponent: Real) -> Self {
        Self::of_width((2.0 / (exponent.max(0.0) + 2.0)).sqrt())
    }

    /// α.
    #[inline]
    pub fn width(self) -> Real {
        self.width
    }

    /// Density D of normals, 1/sr: their projected area over the surface's own area.
    #[inline]
    pub fn density(self, h: Vec3) -> Real {
        // cos⁴ (α² + tan²)² = (α² cos² + sin²)², and sin² from x and y so that it is exact near the normal.
        let a2 = self.width * self.width;
        let spread = a2 * h.z * h.z + h.x * h.x + h.y * h.y;
        a2 * INV_PI / (spread * spread)
    }

    /// √(α² sin² + cos²) of a direction: Smith's Λ is (this / cos − 1) / 2.
    #[inline]
    fn stretch(self, d: Vec3) -> Real {
        let a2 = self.width * self.width;
        (d.z * d.z + a2 * (d.x * d.x + d.y * d.y)).sqrt()
    }

    /// G1(d) / cos d: the share of facets seen from `d`, over its cosine.
    #[inline]
    pub fn seen_over_cos(self, d: Vec3) -> Real {
        2.0 / (d.z + self.stretch(d))
    }

    /// G2 / (4 cos o cos i) for reflection, where what is high is seen by both: 1 / (1 + Λo + Λi) (Heitz 2014,
    /// "Understanding the Masking-Shadowing Function", equation 99).
    #[inline]
    pub fn shared_over_cosines(self, o: Vec3, i: Vec3) -> Real {
        0.5 / (i.z * self.stretch(o) + o.z * self.stretch(i))
    }

    /// Draws a normal as seen from `o`, with density D(h) G1(o) (o·h) / cos o (Dupuy & Benyoub 2023, "Sampling
    /// Visible GGX Normals with Spherical Caps").
    #[inline]
    pub fn sample(self, o: Vec3, u: [Real; 2]) -> Vec3 {
        let a = self.width;
        let stretched = Vec3::new(a * o.x, a * o.y, o.z).normalized();
        // A cap of the sphere, of those directions that reflect into the hemisphere.
        let z = 1.0 - u[1] * (1.0 + stretched.z);
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (s, c) = sin_cos_turns(u[0]);
        let h = Vec3::new(r * c, r * s, z) + stretched;
        let flat = Vec3::new(a * h.x, a * h.y, h.z.max(0.0));
        // Nothing is left of it where the view lies in the surface and the draw is its opposite.
        flat.try_normalized().unwrap_or(Vec3::new(0.0, 0.0, 1.0))
    }

    /// Density of [`sample`](Self::sample) over (o·h).
    #[inline]
    pub fn pdf_over_dot(self, o: Vec3, h: Vec3) -> Real {
        self.density(h) * self.seen_over_cos(o)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_testkit::quadrature::hemisphere;

    fn vec(d: [f64; 3]) -> Vec3 {
        Vec3::new(d[0] as Real, d[1] as Real, d[2] as Real)
    }

    const EXPONENTS: [Real; 4] = [0.0, 1.0, 20.0, 300.0];

    #[test]
    fn the_peak_is_that_of_the_phong_lobe() {
        for n in EXPONENTS {
            let peak = Microfacets::of_exponent(n).density(Vec3::new(0.0, 0.0, 1.0));
            assert!((peak / ((n + 2.0) * 0.5 * INV_PI) - 1.0).abs() < 1e-5, "{n}: {peak}");
        }
        assert_eq!(Microfacets::of_exponent(1e12).width(), LEAST_WIDTH);
        assert_eq!(Microfacets::of_exponent(-5.0).width(), 1.0);
    }

    /// The facets' projected areas add up to the surface's, and the facets seen from anywhere add up to what is
    /// seen of the surface (Heitz 2014, equations 2 and 16).
    #[test]
    fn areas_add_up() {
        for n in EXPONENTS {
            let facets = Microfacets::of_exponent(n);
            let all = hemisphere(1e-6, |h| facets.density(vec(h)) as f64 * h[2]).value;
            assert!((all - 1.0).abs() < 1e-4, "{n}: {all}");
            for cos in [1.0f64, 0.5, 0.05] {
                let o = vec([(1.0 - cos * cos).sqrt(), 0.0, cos]);
                let seen =
                    hemisphere(1e-6, |h| (facets.pdf_over_dot(o, vec(h)) * o.dot(vec(h)).max(0.0)) as f64);
                assert!((seen.value - 1.0).abs() < 1e-3, "{n}, {cos}: {seen:?}");
            }
        }
    }
}
