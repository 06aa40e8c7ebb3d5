//! The sky of L. Hosek and A. Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance" (2012), and
//! the sun of their "Adding a Solar-Radiance Function to the Hosek-Wilkie Skylight Model" (2013).
//!
//! With θ from the zenith and γ from the sun, equation 8 of the former gives for each tabulated
//! wavelength, of which radiance is a linear function between,
//!
//! L = r (1 + p0 e^(p1 / (cos θ + 0.01))) (p2 + p3 e^(p4 γ) + p5 cos² γ + p6 χ + p7 √cos θ),
//! χ = (1 + cos² γ) / (1 + p8² − 2 p8 cos γ)^1.5.
//!
//! The parameters are Bézier curves of degree 5 in the cube root of the sun's elevation, and linear
//! in the turbidity, from 1 to 10. The ground is black, as what lies below the horizon is. Beyond the last
//! wavelength, 720 nm, its radiance is held: the eye sees less than a ten-thousandth there.

use super::{SunDisc, number};
use indigo_math::elementary::{acos, exp};
use indigo_math::{Float, Real};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};
use std::f64::consts::FRAC_PI_2;

/// Wavelengths of the tables: 360 to 720 nm.
const COUNT: usize = 10;
const FIRST_NM: f64 = 360.0;
const STEP_NM: f64 = 40.0;
/// Control points of the curves in the sun's elevation.
const CONTROLS: usize = 6;
/// Segments of the sun's elevation, of equal length in its cube root.
const SEGMENTS: usize = 45;
/// The turbidities of the tables.
pub const TURBIDITY: [f64; 2] = [1.0, 10.0];

static SKY: &[u8] = include_bytes!("../../data/hosek_wilkie_2012_sky.f32");
static SUN: &[u8] = include_bytes!("../../data/hosek_wilkie_2013_sun.f32");
static LIMB: Limb = Limb(include!("../../data/limb_darkening.in"));

/// A sky for one elevation of the sun and one turbidity.
#[derive(Clone, Debug)]
pub struct HosekSky {
    /// For each wavelength p0 to p8 and r, the latter in W m^-3 sr^-1.
    parameters: [[Real; 10]; COUNT],
    /// Luminance (cd/m²) of a radiance of 1 at each tabulated wavelength, linear between and 0 at the others.
    luminances: [f64; COUNT],
}

/// What the formula knows of a direction.
struct Direction {
    cos_theta: Real,
    sqrt_cos_theta: Real,
    gamma: Real,
    cos_gamma: Real,
}

impl HosekSky {
    /// For an elevation of the sun in radians and a turbidity within [`TURBIDITY`].
    pub fn new(elevation: f64, turbidity: f64) -> Self {
        // tidy: load-time mathematics
        let x = (elevation / FRAC_PI_2).cbrt();
        let mut parameters = [[0.0; 10]; COUNT];
        for (i, row) in parameters.iter_mut().enumerate() {
            for (k, p) in row.iter_mut().enumerate() {
                let at = |t: usize, c: usize| number(SKY, ((t * CONTROLS + c) * COUNT + i) * 10 + k);
                let value = by_turbidity(turbidity, |t| bezier(x, |c| at(t, c)));
                // The tables are per nm.
                *p = if k == 9 { value * 1e9 } else { value } as Real;
            }
        }
        Self { parameters, luminances: hat_luminances() }
    }

    /// The same with that many times the radiance.
    #[must_use]
    pub fn scaled(mut self, gain: f64) -> Self {
        for row in &mut self.parameters {
            row[9] = (row[9].to_f64() * gain) as Real;
        }
        self
    }

    /// Radiance from a direction above the horizon, at cosines from zenith and sun.
    #[inline]
    pub fn radiance(&self, cos_theta: Real, cos_gamma: Real, lambda: &SampledWavelengths) -> SampledSpectrum {
        let d = Direction::new(cos_theta, cos_gamma);
        SampledSpectrum(lambda.lambda.map(|l| {
            let (i, s) = locate(l);
            let low = self.at(i, &d);
            low + s * (self.at(i + 1, &d) - low)
        }))
    }

    /// Luminance from a direction above the horizon, cd/m².
    pub fn luminance(&self, cos_theta: f64, cos_gamma: f64) -> f64 {
        let d = Direction::new(cos_theta as Real, cos_gamma as Real);
        (0..COUNT).map(|i| self.at(i, &d).to_f64() * self.luminances[i]).sum()
    }

    /// The formula at a tabulated wavelength. It can fall below 0 at the horizon far from a low sun, where the
    /// fit is poor and the sky nearly black; radiance is not negative.
    #[inline]
    fn at(&self, i: usize, d: &Direction) -> Real {
        let [p0, p1, p2, p3, p4, p5, p6, p7, p8, r] = self.parameters[i];
        let cos2 = d.cos_gamma * d.cos_gamma;
        let base = 1.0 + p8 * p8 - 2.0 * p8 * d.cos_gamma;
        let chi = (1.0 + cos2) / (base * base.sqrt());
        let gradient = 1.0 + p0 * exp(p1 / (d.cos_theta + 0.01));
        let glow = p2 + p3 * exp(p4 * d.gamma) + p5 * cos2 + p6 * chi + p7 * d.sqrt_cos_theta;
        (r * gradient * glow).max(0.0)
    }
}

impl Direction {
    #[inline]
    fn new(cos_theta: Real, cos_gamma: Real) -> Self {
        Self { cos_theta, sqrt_cos_theta: cos_theta.max(0.0).sqrt(), gamma: acos(cos_gamma), cos_gamma }
    }
}

/// The sun's disc at an elevation in radians.
pub fn sun(elevation: f64, turbidity: f64) -> SunDisc {
    // tidy: load-time mathematics
    let segments = SEGMENTS as f64;
    let segment = ((segments * (elevation / FRAC_PI_2).cbrt()) as usize).min(SEGMENTS - 1);
    let u = elevation - FRAC_PI_2 * (segment as f64 / segments).powi(3);
    let values: Vec<f64> = (0..COUNT)
        .map(|i| {
            let cubic = |t: usize| {
                let c = |k: usize| number(SUN, ((t * SEGMENTS + segment) * COUNT + i) * 4 + k);
                c(0) + u * (c(1) + u * (c(2) + u * c(3)))
            };
            (by_turbidity(turbidity, cubic) * 1e9).max(0.0)
        })
        .collect();
    SunDisc { radiance: table(&values), limb: Some(&LIMB) }
}

/// How the sun's disc darkens towards its limb: coefficients u0 to u5 for each tabulated wavelength, of a
/// polynomial in the cosine μ at which its surface is seen.
#[derive(Debug)]
pub struct Limb([[f64; 6]; COUNT]);

impl Limb {
    /// The factor at these wavelengths.
    #[inline]
    pub fn factor(&self, mu: Real, lambda: &SampledWavelengths) -> SampledSpectrum {
        SampledSpectrum(lambda.lambda.map(|l| {
            let (i, s) = locate(l);
            let low = self.polynomial(i, mu);
            low + s * (self.polynomial(i + 1, mu) - low)
        }))
    }

    #[inline]
    fn polynomial(&self, i: usize, mu: Real) -> Real {
        self.0[i].iter().rev().fold(0.0, |sum, &u| sum * mu + u as Real)
    }

    /// The factors as a spectrum, for what is made while loading.
    pub fn spectrum(&self, mu: f64) -> Spectrum {
        let values: Vec<f64> = (0..COUNT).map(|i| self.polynomial(i, mu as Real).to_f64()).collect();
        table(&values)
    }

    /// The disc's mean over its middle: ∫ factor 2μ dμ = Σ 2 u_j / (j + 2).
    pub fn mean(&self) -> Spectrum {
        let mean = |u: &[f64; 6]| u.iter().enumerate().map(|(j, u)| 2.0 * u / (j + 2) as f64).sum();
        table(&self.0.iter().map(mean).collect::<Vec<f64>>())
    }
}

/// The tabulated interval of a wavelength in nm, and how far in it.
#[inline]
fn locate(lambda_nm: Real) -> (usize, Real) {
    let x = ((lambda_nm - FIRST_NM as Real) / STEP_NM as Real).clamp(0.0, (COUNT - 1) as Real);
    let i = (x as usize).min(COUNT - 2);
    (i, x - i as Real)
}

fn table(values: &[f64]) -> Spectrum {
    let last = FIRST_NM + STEP_NM * (COUNT - 1) as f64;
    Spectrum::regular_tabulated(FIRST_NM * 1e-9, last * 1e-9, values)
        .unwrap_or_else(|e| unreachable!("numbers of the tables: {e}"))
}

/// Luminance of each wavelength's share in a radiance that is linear between the tabulated ones.
fn hat_luminances() -> [f64; COUNT] {
    std::array::from_fn(|i| {
        let hat: Vec<f64> = (0..COUNT).map(|k| if k == i { 1.0 } else { 0.0 }).collect();
        table(&hat).luminance()
    })
}

/// Between the two whole turbidities round one; `of` takes the place in the tables.
fn by_turbidity(turbidity: f64, of: impl Fn(usize) -> f64) -> f64 {
    let x = turbidity.clamp(TURBIDITY[0], TURBIDITY[1]) - TURBIDITY[0];
    let low = (x as usize).min(8);
    let s = x - low as f64;
    of(low) * (1.0 - s) + of(low + 1) * s
}

/// A Bézier curve of degree 5.
fn bezier(x: f64, control: impl Fn(usize) -> f64) -> f64 {
    const BINOMIALS: [f64; CONTROLS] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    let term = |(i, b): (usize, &f64)| b * x.powi(i as i32) * (1.0 - x).powi(5 - i as i32) * control(i);
    BINOMIALS.iter().enumerate().map(term).sum()
}
