//! Fresnel's equations for unpolarised light.

use indigo_math::{Float, Real};

/// Light that meets the smooth surface of a dielectric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// The share that is reflected.
    pub reflectance: Real,
    /// Cosine of the refracted ray to the normal on its own side; 0 where all is reflected.
    pub cos_transmitted: Real,
}

/// At cosine `cos` in [0, 1] to the normal, towards an index of refraction `eta` times that where the light
/// comes from (Born & Wolf, "Principles of Optics", section 1.5.2).
#[inline]
pub fn dielectric(cos: Real, eta: Real) -> Dielectric {
    let cos = cos.min(1.0);
    // η² cos²t = η² - sin²; written so that it is cos² to the last bit where η = 1.
    let eta_cos2 = (eta - 1.0) * (eta + 1.0) + cos * cos;
    // Total reflection, and light along the surface.
    if eta_cos2 <= 0.0 || cos <= 0.0 {
        return Dielectric { reflectance: 1.0, cos_transmitted: 0.0 };
    }
    let cos_transmitted = (eta_cos2.sqrt() / eta).min(1.0);
    Dielectric { reflectance: reflectance(cos, cos_transmitted, eta), cos_transmitted }
}

/// The reflectance of an interface by the cosines on both its sides, the second towards `eta` times the index.
/// Where both are known it is the same to the last bits from either side, also near the angle of total reflection.
#[inline]
pub fn reflectance(cos: Real, cos_transmitted: Real, eta: Real) -> Real {
    let parallel = (eta * cos - cos_transmitted) / (eta * cos + cos_transmitted);
    let perpendicular = (cos - eta * cos_transmitted) / (cos + eta * cos_transmitted);
    (0.5 * (parallel * parallel + perpendicular * perpendicular)).min(1.0)
}

/// Reflectance of a conductor of complex index n + ik (over the index of what lies outside) at cosine `cos` in
/// [0, 1] to the normal (Born & Wolf, "Principles of Optics", section 14.2, squared amplitudes written out).
#[inline]
pub fn conductor(cos: Real, n: Real, k: Real) -> Real {
    let cos2 = (cos * cos).min(1.0);
    let sin2 = 1.0 - cos2;
    let difference = n * n - k * k - sin2;
    // a² + b² of the complex cosine inside, a + ib = √((n + ik)² - sin²).
    let modulus = (difference * difference + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (modulus + difference)).max(0.0).sqrt();
    let (sum, cross) = (modulus + cos2, 2.0 * a * cos);
    // Both vanish together only along an interface of index 1, which is none.
    let perpendicular = if sum + cross > 0.0 { (sum - cross) / (sum + cross) } else { 0.0 };
    let (sum, cross) = (cos2 * modulus + sin2 * sin2, cross * sin2);
    // At grazing incidence both parts of the quotient vanish together for an index of 1.
    let parallel = if sum + cross > 0.0 { (sum - cross) / (sum + cross) } else { 1.0 };
    (0.5 * perpendicular * (1.0 + parallel)).clamp(0.0, 1.0)
}

/// Schlick's approximation for a surface that reflects `r0` along its normal (Schlick 1994, "An Inexpensive BRDF
/// Model for Physically-Based Rendering", equation 15).
#[inline]
pub fn schlick(cos: Real, r0: Real) -> Real {
    let x = 1.0 - cos.min(1.0);
    let x2 = x * x;
    r0 + (1.0 - r0) * x2 * x2 * x
}

/// What a reflectance by cosine reflects of even light from everywhere: 2 ∫ R(μ) μ dμ.
pub fn diffuse_average(reflectance: impl Fn(Real) -> Real) -> f64 {
    // μ = s² spreads the nodes towards grazing angles, where reflectances bend.
    crate::directional_albedo::integral([0.0, 1.0], 8, |s| {
        4.0 * s * s * s * reflectance(Real::from_f64(s * s)).to_f64()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Degrees and reflectance of n = 0.4241, k = 2.4721.
    const GOLD: [(f64, f64); 4] =
        [(0.0, 0.791_580_133), (60.0, 0.792_297_929), (85.0, 0.920_843_746), (89.0, 0.982_726_481)];

    /// Gold at some wavelength, by complex arithmetic; and an index without absorption, as the dielectric's.
    #[test]
    fn metals_reflect_as_tabulated() {
        for (degrees, exact) in GOLD {
            near(conductor(f64::to_radians(degrees).cos() as Real, 0.4241, 2.4721), exact, 2e-6);
        }
        for degrees in [0.0, 30.0, 56.31, 80.0, 89.9] {
            let cos = f64::to_radians(degrees).cos() as Real;
            near(conductor(cos, 1.5, 0.0), dielectric(cos, 1.5).reflectance as f64, 2e-6);
        }
        assert_eq!(conductor(0.0, 0.2, 3.0), 1.0);
        // No interface at all, also along it.
        assert!(conductor(0.7, 1.0, 0.0).abs() < 1e-6 && conductor(0.0, 1.0, 0.0).is_finite());
    }

    #[test]
    fn schlick_rises_from_its_base_to_one_and_averages_to_its_closed_form() {
        assert_eq!((schlick(1.0, 0.3), schlick(0.0, 0.3)), (0.3, 1.0));
        // 2 ∫ (1 - μ)⁵ μ dμ = 1/21.
        assert!((diffuse_average(|mu| schlick(mu, 0.3)) - (0.3 + 0.7 / 21.0)).abs() < 1e-6);
        assert!((diffuse_average(|mu| dielectric(mu, 1.5).reflectance) - 0.091_777_959).abs() < 1e-5);
    }

    fn at(degrees: f64, eta: Real) -> Dielectric {
        dielectric(degrees.to_radians().cos() as Real, eta)
    }

    fn near(a: Real, b: f64, tolerance: f64) {
        assert!((a as f64 - b).abs() < tolerance, "{a} instead of {b}");
    }

    #[test]
    fn known_angles() {
        near(at(0.0, 1.5).reflectance, 0.04, 1e-6);
        near(at(0.0, 1.0 / 1.5).reflectance, 0.04, 1e-6);
        // Brewster's angle: only one polarisation is reflected, ((1 - η²)/(1 + η²))² of it.
        let ratio = (1.0f64 - 2.25) / (1.0 + 2.25);
        near(at(56.309_932, 1.5).reflectance, 0.5 * ratio * ratio, 1e-6);
        // The critical angle and beyond, and grazing light.
        assert!(at(41.80, 1.0 / 1.5).reflectance < 1.0);
        assert_eq!(at(41.82, 1.0 / 1.5), Dielectric { reflectance: 1.0, cos_transmitted: 0.0 });
        assert_eq!(dielectric(0.0, 1.5).reflectance, 1.0);
        assert!(dielectric(1e-4, 1.5).reflectance > 0.999);
    }

    #[test]
    fn the_way_back_reflects_as_much_and_snell_holds() {
        for i in 1..100 {
            let cos = i as Real / 100.0;
            let there = dielectric(cos, 1.5);
            let back = dielectric(there.cos_transmitted, 1.0 / 1.5);
            // A rounding of cos² is this much of cos, of which the reflectance is at most six times as much.
            let tolerance = 1e-7 / cos as f64;
            near(back.reflectance, there.reflectance as f64, 6.0 * tolerance + 1e-6);
            near(back.cos_transmitted, cos as f64, tolerance + 1e-6);
            let sin = |c: Real| (1.0 - c as f64 * c as f64).sqrt();
            near(sin(cos) as Real, 1.5 * sin(there.cos_transmitted), 1e-6);
        }
    }

    #[test]
    fn nothing_is_reflected_where_indices_are_equal() {
        for cos in [1.0, 0.7, 0.1, 1e-3] {
            let same = dielectric(cos, 1.0);
            assert_eq!((same.reflectance, same.cos_transmitted), (0.0, cos));
        }
    }

    /// The mean over a hemisphere of light, by the midpoint rule, against the reference's closed form.
    #[test]
    fn diffuse_reflectance() {
        let mean = |eta: Real| {
            let n = 100_000;
            let f = |i: u32| {
                let cos = (f64::from(i) + 0.5) / f64::from(n);
                2.0 * cos * dielectric(cos as Real, eta).reflectance as f64
            };
            (0..n).map(f).sum::<f64>() / f64::from(n)
        };
        assert!((mean(1.5) - 0.091_777_959).abs() < 2e-6);
        assert!((mean(1.0 / 1.5) - 0.596_345_760).abs() < 2e-5);
    }
}
