//! Fresnel's equations for unpolarised light.

use indigo_math::Real;

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
    let eta_cos = eta_cos2.sqrt();
    let cos_transmitted = (eta_cos / eta).min(1.0);
    let parallel = (eta * cos - cos_transmitted) / (eta * cos + cos_transmitted);
    let perpendicular = (cos - eta_cos) / (cos + eta_cos);
    Dielectric {
        reflectance: (0.5 * (parallel * parallel + perpendicular * perpendicular)).min(1.0),
        cos_transmitted,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
