//! `henyey_greenstein`: scattering forwards or backwards (Henyey & Greenstein 1941, "Diffuse Radiation in the
//! Galaxy", equation 2).

use super::Phase;
use indigo_decl::{Block, Field, Kind, Node, Parameter, Presence, StandIn};
use indigo_diag::Sink;
use indigo_math::elementary::sin_cos_turns;
use indigo_math::warp::INV_PI;
use indigo_math::{Frame, Real, Vec3};
use indigo_spectrum::declare::SPECTRUM;
use indigo_spectrum::{LanePdf, SampledSpectrum, SampledWavelengths, Spectrum, read};

/// The declaration of `henyey_greenstein`.
pub static BLOCK: Block = Block::new(
    "henyey_greenstein",
    "Light is scattered forwards or backwards, after L. G. Henyey and J. L. Greenstein, Diffuse Radiation \
     in the Galaxy (1941).",
    &[Field::new(
        "g_spectrum",
        Kind::OneOf(&SPECTRUM),
        Presence::Required,
        "Mean cosine of the scattering angle: -1 straight back, 0 into all directions alike, 1 straight on. \
         Values are silently clamped to [-0.99, 0.99].",
    )],
)
.with_parameters(&[Parameter {
    name: "g",
    since: "1.1",
    constant: "g_spectrum",
    texture: "",
    stand_in: StandIn::Uniform("0"),
}])
.with_example(
    "<henyey_greenstein>
    <g_spectrum><uniform><value>0.9</value></uniform></g_spectrum>
</henyey_greenstein>",
);

/// Scattering with a mean cosine.
#[derive(Clone, Debug)]
pub struct HenyeyGreenstein {
    g: Spectrum,
}

impl HenyeyGreenstein {
    /// From its element.
    pub fn build(node: &Node, sink: &mut Sink) -> Self {
        Self { g: node.node("g_spectrum").map_or(Spectrum::BLACK, |s| read::mean_cosine(s, sink)) }
    }

    /// g.
    pub fn mean_cosine(&self, nm: f64) -> f64 {
        self.g.at(nm)
    }

    /// The phase function at some wavelengths.
    #[inline]
    pub fn at(&self, lambda: &SampledWavelengths) -> HenyeyGreensteinLobe {
        HenyeyGreensteinLobe { g: self.g.eval(lambda) }
    }
}

/// p(cos θ) = (1 − g²) / 4π (1 + g² − 2 g cos θ)^(3/2), with θ between the old and the new way of the light.
#[derive(Clone, Copy, Debug)]
pub struct HenyeyGreensteinLobe {
    g: SampledSpectrum,
}

impl Phase for HenyeyGreensteinLobe {
    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> LanePdf {
        // 1 + g² - 2 g cos θ from the half angle to the side on which it is small: near the peak the cosine itself
        // has no digits left.
        let (ahead, back) = ((wo + wi).length2(), (wo - wi).length2());
        LanePdf(self.g.0.map(|g| {
            let q =
                if g >= 0.0 { (1.0 - g) * (1.0 - g) + g * ahead } else { (1.0 + g) * (1.0 + g) - g * back };
            (0.25 * INV_PI) * (1.0 - g * g) / (q * q.sqrt())
        }))
    }

    #[inline]
    fn sample(&self, wo: Vec3, [u, v]: [Real; 2]) -> Vec3 {
        let cos = cosine(self.g.hero(), u).clamp(-1.0, 1.0);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let (s, c) = sin_cos_turns(v);
        // Hundreds of draws follow on one another: their roundings must not add up to another length.
        Frame::from_normal(-wo).to_world(Vec3::new(sin * c, sin * s, cos)).normalized()
    }
}

/// The cosine below which a share `u` of the light is scattered.
///
/// With q = 1 + g s, s = 2u − 1 it is (1 + g² − ((1 − g²) / q)²) / 2g. Near g = 0 that divides one rounding
/// error by another; with the difference multiplied out, g cancels.
#[inline]
fn cosine(g: Real, u: Real) -> Real {
    let s = 2.0 * u - 1.0;
    let q = 1.0 + g * s;
    // Where both forms lose about as little: a few roundings divided by 2g.
    if g.abs() < 0.1 {
        (s + g * (1.5 + g * s + 0.5 * s * s * (1.0 + g * g) - 0.5 * g * g)) / (q * q)
    } else {
        let r = (1.0 - g * g) / q;
        (1.0 + g * g - r * r) / (2.0 * g)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drawn_cosine_inverts_the_distribution() {
        // The distribution by integrating p over the sphere: (1 − g²)/2g · (1/√(1 + g² − 2gμ) − 1/(1 + g)).
        for g in [-0.99f64, -0.5, -0.1001, 0.0999, 0.3, 0.9, 0.99] {
            for i in 0..=100 {
                let u = f64::from(i) / 100.0;
                let mu = cosine(g as Real, u as Real) as f64;
                let below =
                    (1.0 - g * g) / (2.0 * g) * (1.0 / (1.0 + g * g - 2.0 * g * mu).sqrt() - 1.0 / (1.0 + g));
                // Some roundings of the cosine, which is near 1, times its density.
                let density = 0.5 * (1.0 - g * g) / (1.0 + g * g - 2.0 * g * mu).powf(1.5);
                let tolerance = 5.0 * f64::from(f32::EPSILON) * (1.0 + density);
                assert!((below - u).abs() < tolerance, "g {g}, u {u}: {mu} has {below} below it");
            }
        }
        assert_eq!(cosine(0.0, 0.25), -0.5);
    }

    /// Values of the reference table of exact answers.
    #[test]
    fn the_phase_function_has_its_known_values() {
        let wo = Vec3::new(0.0, 0.0, -1.0);
        let along = |cos: Real| Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        for (g, values) in [
            (0.9, [15.1197196, 0.00620906026, 0.00220436209]),
            (-0.3, [0.0329610829, 0.0636343748, 0.211123904]),
        ] {
            let lobe = HenyeyGreensteinLobe { g: SampledSpectrum::splat(g) };
            for (cos, value) in [1.0, 0.0, -1.0].into_iter().zip(values) {
                let p = lobe.pdf(wo, along(cos)).hero() as f64;
                assert!((p / value - 1.0).abs() < 1e-5, "g {g}, cos {cos}: {p} instead of {value}");
            }
        }
    }
}
