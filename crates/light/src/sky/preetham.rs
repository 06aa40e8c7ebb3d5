//! The sky and sun of A. J. Preetham, P. Shirley and B. Smits, "A Practical Analytic Model for Daylight"
//! (1999): luminance and chromaticity by the formula of R. Perez (their equation 3 and appendix A.2), made a
//! spectrum of the CIE's phases of daylight (appendix A.5), and the sun dimmed by five constituents of
//! the air (appendix A.1).
//!
//! Known faults: near the zenith it is two to three times too bright, and below a turbidity of 1.2 the
//! horizon diverges (G. Zotti, A. Wilkie and W. Purgathofer, "A Critical Review of the Preetham
//! Skylight Model", 2007); it is used from 1.7 on.

use super::SunDisc;
use indigo_math::elementary::{acos, exp};
use indigo_math::{Float, Real};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};
use std::f64::consts::PI;

/// The turbidities that the sky is used for. The paper's data begin at 2; below it its formulas diverge, and a clearer
/// air would give a brighter sky.
pub const TURBIDITY: [f64; 2] = [2.0, 10.0];

/// For Y, x and y: slope and offset in turbidity of the five coefficients of Perez's formula.
const PEREZ: [[[f64; 2]; 5]; 3] = [
    [[0.17872, -1.46303], [-0.3554, 0.42749], [-0.02266, 5.32505], [0.12064, -2.57705], [-0.06696, 0.37027]],
    [
        [-0.01925, -0.25922],
        [-0.06651, 0.00081],
        [-0.00041, 0.21247],
        [-0.06409, -0.89887],
        [-0.00325, 0.04517],
    ],
    [
        [-0.01669, -0.26078],
        [-0.09495, 0.00921],
        [-0.00792, 0.21023],
        [-0.04405, -1.65369],
        [-0.01092, 0.05291],
    ],
];

/// For x and y of the zenith: rows for T², T and 1, each a cubic in the sun's angle, highest power first.
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [
        [0.00166, -0.00375, 0.00209, 0.0],
        [-0.02903, 0.06377, -0.03202, 0.00394],
        [0.11693, -0.21196, 0.06052, 0.25886],
    ],
    [
        [0.00275, -0.0061, 0.00317, 0.0],
        [-0.04214, 0.0897, -0.04153, 0.00516],
        [0.15346, -0.26756, 0.0667, 0.26688],
    ],
];

/// S0, S1, S2 from 360 to 830 nm at 5 nm.
static DAYLIGHT: [[f64; 3]; 95] = include!("../../data/daylight_basis_5nm.in");
static SUN: [f64; 38] = include!("../../data/preetham_1999_sun.in");
static OZONE: [[f64; 2]; 64] = include!("../../data/preetham_1999_k_o_ozone.in");
static MIXED_GASES: [[f64; 2]; 4] = include!("../../data/preetham_1999_k_g_mixed_gases.in");
static WATER: [[f64; 2]; 13] = include!("../../data/preetham_1999_k_wa_water_vapour.in");

/// A sky for one elevation of the sun and one turbidity.
#[derive(Clone, Debug)]
pub struct PreethamSky {
    /// Coefficients of Y, x and y.
    perez: [[Real; 5]; 3],
    /// Y (cd/m²), x and y of the zenith over the formula's value there.
    scale: [Real; 3],
    /// The phases of daylight, and the luminance of each.
    daylight: [Spectrum; 3],
    luminances: [Real; 3],
}

impl PreethamSky {
    /// For an elevation of the sun in radians and a turbidity within [`TURBIDITY`].
    pub fn new(elevation: f64, turbidity: f64) -> Self {
        // tidy: load-time mathematics
        let t = turbidity.clamp(TURBIDITY[0], TURBIDITY[1]);
        let theta = 0.5 * PI - elevation;
        let perez = PEREZ.map(|c| c.map(|[slope, offset]| (slope * t + offset) as Real));
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * theta);
        let luminance = 1e3 * ((4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192);
        let [x, y] = ZENITH.map(|rows| {
            let [square, linear, constant] =
                rows.map(|row| row.into_iter().fold(0.0, |sum, c| sum * theta + c));
            (square * t + linear) * t + constant
        });
        let zenith = [luminance, x, y];
        let at_zenith = Direction::new(1.0, elevation.sin() as Real);
        let scale = std::array::from_fn(|k| (zenith[k] / at_zenith.perez(&perez[k]).to_f64()) as Real);
        let daylight: [Spectrum; 3] = std::array::from_fn(|k| {
            table(360.0, 830.0, &DAYLIGHT.iter().map(|row| row[k]).collect::<Vec<f64>>())
        });
        let luminances = std::array::from_fn(|k| daylight[k].luminance() as Real);
        Self { perez, scale, daylight, luminances }
    }

    /// The same with that many times the radiance.
    #[must_use]
    pub fn scaled(mut self, gain: f64) -> Self {
        self.scale[0] = (self.scale[0].to_f64() * gain) as Real;
        self
    }

    /// Radiance from a direction above the horizon, at cosines from zenith and sun.
    #[inline]
    pub fn radiance(&self, cos_theta: Real, cos_gamma: Real, lambda: &SampledWavelengths) -> SampledSpectrum {
        let d = Direction::new(cos_theta, cos_gamma);
        let [luminance, x, y] = self.colour(&d);
        let m = 0.0241 + 0.2562 * x - 0.7341 * y;
        let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
        let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
        let [s0, s1, s2] = [0, 1, 2].map(|k: usize| self.daylight[k].eval(lambda));
        let [l0, l1, l2] = self.luminances;
        let shape = s0 + s1 * m1 + s2 * m2;
        // The phases of daylight reach below 0 far from the black body's colours.
        (shape * (luminance / (l0 + m1 * l1 + m2 * l2))).clamp(0.0, Real::INFINITY)
    }

    /// Luminance from a direction above the horizon, cd/m².
    pub fn luminance(&self, cos_theta: f64, cos_gamma: f64) -> f64 {
        self.colour(&Direction::new(cos_theta as Real, cos_gamma as Real))[0].to_f64()
    }

    /// Y (cd/m²), x and y.
    #[inline]
    fn colour(&self, d: &Direction) -> [Real; 3] {
        std::array::from_fn(|k| self.scale[k] * d.perez(&self.perez[k]))
    }
}

/// What the formula knows of a direction.
struct Direction {
    cos_theta: Real,
    gamma: Real,
    cos_gamma: Real,
}

impl Direction {
    #[inline]
    fn new(cos_theta: Real, cos_gamma: Real) -> Self {
        // At the horizon itself 1 / cos θ has no value; the formula is flat long before.
        Self { cos_theta: cos_theta.max(1e-3), gamma: acos(cos_gamma), cos_gamma }
    }

    /// Perez's formula: (1 + A e^(B / cos θ)) (1 + C e^(D γ) + E cos² γ).
    #[inline]
    fn perez(&self, [a, b, c, d, e]: &[Real; 5]) -> Real {
        let glow = 1.0 + c * exp(d * self.gamma) + e * self.cos_gamma * self.cos_gamma;
        (1.0 + a * exp(b / self.cos_theta)) * glow
    }
}

/// The sun's disc at an elevation in radians.
pub fn sun(elevation: f64, turbidity: f64) -> SunDisc {
    // tidy: load-time mathematics
    let zenith_angle = 90.0 - elevation.to_degrees();
    // Relative optical mass, and Ångström's turbidity coefficient.
    let mass = 1.0 / (elevation.sin() + 0.15 * (93.885 - zenith_angle).powf(-1.253));
    let beta = (0.046_083_658_220_50 * turbidity - 0.045_860_259_285_22).max(0.0);
    let values: Vec<f64> = (0..SUN.len())
        .map(|i| {
            let nm = 380.0 + 10.0 * i as f64;
            let um = nm * 1e-3;
            let [ozone, gases, water] = [&OZONE[..], &MIXED_GASES, &WATER].map(|table| between(table, nm));
            let rayleigh = (-0.008735 * mass * um.powf(-4.08)).exp();
            let aerosol = (-beta * mass * um.powf(-1.3)).exp();
            // 0.35 cm of ozone and 2 cm of water.
            let ozone = (-ozone * 0.35 * mass).exp();
            let gases = (-1.41 * gases * mass / (1.0 + 118.93 * gases * mass).powf(0.45)).exp();
            let wet = water * 2.0 * mass;
            let water = (-0.2385 * wet / (1.0 + 20.07 * wet).powf(0.45)).exp();
            SUN[i] * 1e9 * rayleigh * aerosol * ozone * gases * water
        })
        .collect();
    SunDisc { radiance: table(380.0, 750.0, &values), limb: None }
}

fn table(first_nm: f64, last_nm: f64, values: &[f64]) -> Spectrum {
    Spectrum::regular_tabulated(first_nm * 1e-9, last_nm * 1e-9, values)
        .unwrap_or_else(|e| unreachable!("numbers of the tables: {e}"))
}

/// A table of wavelengths and values, linear between and 0 outside.
fn between(table: &[[f64; 2]], nm: f64) -> f64 {
    let inside = |pair: &&[[f64; 2]]| pair[0][0] <= nm && nm <= pair[1][0];
    let Some([[x0, y0], [x1, y1]]) = table.windows(2).map(|w| [w[0], w[1]]).find(|w| inside(&&w[..])) else {
        return 0.0;
    };
    y0 + (y1 - y0) * (nm - x0) / (x1 - x0)
}
