//! The body of a coat: what becomes of light between the coat's surface and a diffuse ground below it.
//!
//! Light crosses the body along straight lines, refracted, and loses 1 − exp(−τ / cos) of itself on each way, for an optical
//! depth τ along the normal. The ground sends it up diffusely; a part r(τ) is thrown back to the ground by the coat from below,
//! and again, so that under the coat a ground of albedo ρ shows ρ (1 − r(0)) / (1 − ρ r(τ)) of what enters and leaves without
//! loss (Saunderson 1942, "Calculation of the color of pigmented plastics", equation 5, is the clear coat, τ = 0).

use crate::directional_albedo::integral;
use crate::fresnel::{dielectric, diffuse_average};
use crate::immersion::ByIndex;
use indigo_math::elementary::exp;
use indigo_math::{Float, Real};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// Steps of a row: what is let out is linear between them to 2e-5.
const STEPS: usize = 256;

/// What lies between a coat's surface and its ground.
#[derive(Clone, Debug)]
pub struct Body {
    /// The optical depth along the normal of a coat that absorbs.
    depth: Option<Spectrum>,
    /// The part of the ground's light that does not come down to it again, by what lies outside.
    taken: ByIndex<Taken>,
}

impl Body {
    /// Under a surface of an index against vacuum whose reflectance is scaled, for some indices outside.
    pub fn new(eta: Real, scale: Real, depth: Option<Spectrum>, outside: &[Real]) -> Self {
        let steps = if depth.is_some() { STEPS } else { 0 };
        let taken = ByIndex::new(outside, |outside| Taken::new(eta / outside, scale, steps));
        Self { depth, taken }
    }

    /// The same for other indices outside.
    pub fn immersed(&self, eta: Real, scale: Real, outside: &[Real]) -> Self {
        Self::new(eta, scale, self.depth.clone(), outside)
    }

    /// What a ground of an albedo shows under the coat, and the optical depth of the coat.
    #[inline]
    pub fn over(
        &self,
        albedo: SampledSpectrum,
        outside: SampledSpectrum,
        lambda: &SampledWavelengths,
    ) -> (SampledSpectrum, SampledSpectrum) {
        let (low, high, mix) = self.taken.around(outside);
        let clear = SampledSpectrum::splat(low.clear()) + mix * (high.clear() - low.clear());
        let (depth, taken) = match &self.depth {
            None => (SampledSpectrum::ZERO, clear),
            Some(depth) => {
                let depth = depth.eval(lambda);
                let [low, high] = [low, high].map(|row| depth.map(|depth| row.at(depth)));
                (depth, low + (high - low) * mix)
            }
        };
        let shown = SampledSpectrum::from_fn(|lane| {
            let albedo = albedo[lane];
            let rest = (1.0 - albedo) + albedo * taken[lane];
            if rest > 0.0 { albedo * clear[lane] / rest } else { 0.0 }
        });
        (shown, depth)
    }
}

/// The part 1 − r of a diffuse ground's light that is absorbed or let out, by the coat's optical depth: at equal steps of
/// √(τ / (1 + τ)), or of a clear coat alone. It is kept in place of r, of which rounding leaves 1 under the densest coats.
#[derive(Clone, Debug)]
struct Taken(Box<[Real]>);

impl Taken {
    /// Under a surface of a relative index.
    fn new(eta: Real, scale: Real, steps: usize) -> Self {
        let depth = |i: usize| {
            let x = (i as f64 / steps as f64).powi(2);
            x / (1.0 - x)
        };
        let row = (0..=steps).map(|i| match i {
            0 => let_out(eta, scale),
            i if i == steps => 1.0,
            i => 1.0 - thrown_back(eta, scale, depth(i)),
        });
        Self(row.map(Real::from_f64).collect())
    }

    /// In a coat that does not absorb.
    #[inline]
    fn clear(&self) -> Real {
        self.0[0]
    }

    /// In a coat of an optical depth.
    #[inline]
    fn at(&self, depth: Real) -> Real {
        let place = (depth / (1.0 + depth)).sqrt() * STEPS as Real;
        let low = (place as usize).min(STEPS - 1);
        let (a, b) = (self.0[low], self.0[low + 1]);
        a + (b - a) * (place - low as Real)
    }
}

/// The part 1 − r that a clear coat lets out at once.
fn let_out(eta: Real, scale: Real) -> f64 {
    let inside = eta.to_f64();
    if inside <= 1.0 {
        return 1.0 - thrown_back(eta, scale, 0.0);
    }
    // By reciprocity (1 − R̄) / η² for a coat that reflects R̄ of even light from outside.
    let outside = diffuse_average(|cos| dielectric(cos, eta).reflectance * scale);
    (1.0 - outside) / (inside * inside)
}

/// r = 2 ∫ R(μ) exp(−2 τ / μ) μ dμ over the cosines inside: the part of diffuse light that is reflected from below by a surface of a
/// relative index, of which all but total reflection is scaled, and comes down again.
fn thrown_back(eta: Real, scale: Real, depth: f64) -> f64 {
    // tidy: load-time mathematics
    let way = |cos: f64| if depth == 0.0 { 1.0 } else { (-2.0 * depth / cos).exp() };
    if eta <= 1.0 {
        // From below nothing is reflected totally.
        let back =
            |cos: Real| dielectric(cos, 1.0 / eta).reflectance * scale * Real::from_f64(way(cos.to_f64()));
        return diffuse_average(back).clamp(0.0, 1.0);
    }
    let inside = eta.to_f64();
    let critical = (1.0 - 1.0 / (inside * inside)).sqrt();
    let total = integral([0.0, critical], 32, |cos| 2.0 * cos * way(cos));
    // The rest by the cosines outside, where reflectances bend less: by Snell's law μ dμ inside is that outside over η².
    let in_part = diffuse_average(|cos| {
        let light = dielectric(cos, eta);
        light.reflectance * scale * Real::from_f64(way(light.cos_transmitted.to_f64()))
    });
    (total + in_part / (inside * inside)).clamp(0.0, 1.0)
}

/// What is left of light after ways through a coat of a relative index and an optical depth along the normal, by their cosines
/// outside.
#[inline]
pub fn passage(eta: SampledSpectrum, depth: SampledSpectrum, cosines: &[Real]) -> SampledSpectrum {
    SampledSpectrum::from_fn(|lane| {
        // A clear coat takes nothing of light that goes along it, either.
        if depth[lane] == 0.0 {
            return 1.0;
        }
        let way: Real = cosines.iter().map(|&cos| 1.0 / dielectric(cos, eta[lane]).cos_transmitted).sum();
        exp(-depth[lane] * way)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 − (1 − R̄) / η² by reciprocity, R̄ = 0.091778 for 1.5 (Saunderson's correction); for a mirror-like limit of no reflection outside
    /// only total reflection is left.
    #[test]
    fn a_clear_coat_throws_back_what_it_does_not_let_out() {
        for (eta, scale) in [(1.5, 1.0), (1.5, 0.3), (2.4, 1.0), (1.0 / 1.5, 0.5)] {
            let sum = let_out(eta, scale) + thrown_back(eta, scale, 0.0);
            assert!((sum - 1.0).abs() < 1e-6, "{eta} {scale}: {sum}");
        }
        assert!((thrown_back(1.5, 1.0, 0.0) - (1.0 - (1.0 - 0.091_777_959) / 2.25)).abs() < 1e-5);
        assert!((thrown_back(1.5, 0.0, 0.0) - (1.0 - 1.0 / 2.25)).abs() < 1e-9);
        assert!(thrown_back(1.0, 1.0, 0.0).abs() < 1e-9);
    }

    /// In a medium denser than the coat there is no total reflection from below: by reciprocity 1 − (1 − R̄) / η² again, with the
    /// R̄ = 0.596346 of 1 / 1.5.
    #[test]
    fn a_coat_in_a_denser_medium() {
        let expected = 1.0 - (1.0 - 0.596_345_760) * 2.25;
        assert!((thrown_back(1.0 / 1.5, 1.0, 0.0) - expected).abs() < 1e-5);
    }

    /// With total reflection alone it is 2 ∫ exp(−2 τ / μ) μ dμ up to the critical cosine: by the midpoint rule.
    #[test]
    fn rows_are_the_integral() {
        let row = Taken::new(1.5, 0.0, STEPS);
        let critical = (1.0f64 - 1.0 / 2.25).sqrt();
        // Among them the middles of steps near 0, where it bends most.
        let middle = |i: f64| {
            let x = (i / STEPS as f64).powi(2);
            x / (1.0 - x)
        };
        let depths =
            [0.0, middle(0.5), middle(3.5), middle(9.5), 0.002, 0.003, 0.01, 0.1, 0.5, 1.0, 3.0, 50.0, 1e6];
        for depth in depths {
            let n = 20_000;
            let sum: f64 = (0..n)
                .map(|i| {
                    let cos = critical * (f64::from(i) + 0.5) / f64::from(n);
                    2.0 * cos * (-2.0 * depth / cos).exp()
                })
                .sum();
            let expected = sum * critical / f64::from(n);
            let found = 1.0 - row.at(depth as Real).to_f64();
            assert!((found - expected).abs() < 2e-5, "{depth}: {found}, not {expected}");
        }
    }
}
