//! The spectra of a scene: one file for each kind that needs more than a few numbers.

mod blackbody;
mod peak;
mod table;

use indigo_math::{Float, Real};

pub use blackbody::{Blackbody, planck};
pub use peak::Peak;
pub use table::Table;

use crate::error::SpectrumError;
use crate::grid;
use crate::illuminant;
use crate::integrate;
use crate::lanes::SampledSpectrum;
use crate::observer::{self, NITS_PER_UNIT};
use crate::rgb::{self, Reflectance};
use crate::wavelengths::SampledWavelengths;

/// A function of wavelength as a scene gives it: spectral radiance (W m^-3 sr^-1), reflectance
/// (dimensionless) or a coefficient (1/m), according to where it stands. Cheap to clone: tables
/// are shared.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// The same value at every wavelength.
    Uniform(f64),
    /// One value within a band, another outside.
    Peak(Peak),
    /// Planck's law times a gain.
    Blackbody(Blackbody),
    /// A smooth reflectance, from an RGB triple, times a factor.
    Reflectance {
        /// The reflectance.
        shape: Reflectance,
        /// What multiplies it.
        factor: f64,
    },
    /// Values at equal steps, linear between them, the end values held outside.
    Table(Table),
}

impl Spectrum {
    /// Zero at every wavelength.
    pub const BLACK: Self = Self::Uniform(0.0);

    /// The same value at every wavelength.
    pub const fn uniform(value: f64) -> Self {
        Self::Uniform(value)
    }

    /// Planck's law at a temperature in kelvin times a gain, W m^-3 sr^-1. A temperature that is
    /// not above zero radiates nothing.
    pub fn blackbody(temperature: f64, gain: f64) -> Self {
        Self::Blackbody(Blackbody::new(temperature, gain))
    }

    /// `peak` from `min_nm` (included) to `min_nm + width_nm` (excluded), `base` elsewhere.
    pub const fn peak(min_nm: f64, width_nm: f64, base: f64, peak: f64) -> Self {
        Self::Peak(Peak { min_nm, max_nm: min_nm + width_nm, base, peak })
    }

    /// Values at equal steps from `start_m` to `end_m` (metres, as in a scene file), linear
    /// between. Outside the table the end value is held: a spectrum that is measured over part of
    /// the range is better continued than cut to zero, above all a coefficient or a reflectance;
    /// emission that ends within the range says so with zeros of its own.
    ///
    /// # Errors
    /// Fewer than two values, ends that are not finite or not ascending, a step under a millionth
    /// of a nanometre, or a value that the kernel's scalar cannot hold. Negative values are kept:
    /// what they mean depends on the use, and [`Self::clamped`] limits them.
    pub fn regular_tabulated(start_m: f64, end_m: f64, values: &[f64]) -> Result<Self, SpectrumError> {
        Table::new(start_m * 1e9, end_m * 1e9, values).map(Self::Table)
    }

    /// The smooth reflectance that has this linear Rec. 709 colour under D65; each component is
    /// clamped to [0, 1], NaN to 0.
    pub fn rgb_reflectance(rgb: [f64; 3]) -> Self {
        let rgb = rgb.map(rgb::unit);
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            return Self::Uniform(rgb[0]);
        }
        Self::Reflectance { shape: Reflectance::fit(rgb), factor: 1.0 }
    }

    /// Emission of this linear Rec. 709 colour, shaped like D65, W m^-3 sr^-1: `[v, v, v]` has the
    /// luminance of `uniform(v)` and the chromaticity of D65. Negative components and NaN count as
    /// 0; a triple with an infinity radiates nothing.
    pub fn rgb_emission(rgb: [f64; 3]) -> Self {
        let emission = rgb::Emission::fit(rgb);
        Self::Table(Table::on_grid(|lambda| emission.at(lambda)))
    }

    /// A coefficient (1/m, or the mean cosine of a phase function): linear in the triple over the
    /// basis of Mallett & Yuksel 2019, unclamped. A grey stays flat.
    pub fn rgb_coefficient(rgb: [f64; 3]) -> Self {
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            return Self::Uniform(rgb[0]);
        }
        Self::Table(rgb::basis::table(rgb))
    }

    /// The named CIE illuminant (see [`illuminant::find`]), scaled to the luminance of
    /// `uniform(1.0)`; `None` where there is no such name.
    pub fn illuminant(name: &str) -> Option<Self> {
        illuminant::find(name).map(illuminant::Illuminant::spectrum)
    }

    /// The values at these wavelengths.
    #[inline]
    pub fn eval(&self, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Self::Uniform(v) => SampledSpectrum::splat(Real::from_f64(*v)),
            Self::Peak(peak) => {
                SampledSpectrum(wavelengths.lambda.map(|l| Real::from_f64(peak.at(l.to_f64()))))
            }
            Self::Blackbody(body) => SampledSpectrum(wavelengths.lambda.map(|l| body.eval(l))),
            Self::Reflectance { shape, factor } => shape.eval(wavelengths) * Real::from_f64(*factor),
            Self::Table(table) => SampledSpectrum(wavelengths.lambda.map(|l| table.eval(l))),
        }
    }

    /// The value at a wavelength in nm, in double precision.
    pub fn at(&self, lambda_nm: f64) -> f64 {
        match self {
            Self::Uniform(v) => *v,
            Self::Peak(peak) => peak.at(lambda_nm),
            Self::Blackbody(body) => body.at(lambda_nm),
            Self::Reflectance { shape, factor } => shape.at(lambda_nm) * factor,
            Self::Table(table) => table.at(lambda_nm),
        }
    }

    /// Integral over 360 to 830 nm, in the spectrum's unit times nm.
    pub fn integral_nm(&self) -> f64 {
        self.integrate(|_| [1.0])[0]
    }

    /// Tristimulus values, cd/m^2, of this spectral radiance in W m^-3 sr^-1.
    pub fn xyz(&self) -> [f64; 3] {
        self.integrate(observer::cmf).map(|v| v * NITS_PER_UNIT)
    }

    /// Luminance, cd/m^2, of this spectral radiance in W m^-3 sr^-1.
    pub fn luminance(&self) -> f64 {
        self.xyz()[1]
    }

    /// CIE 1931 chromaticity (x, y), or `None` where the spectrum has no colour since it is black.
    pub fn chromaticity(&self) -> Option<[f64; 2]> {
        let [x, y, z] = self.xyz();
        let sum = x + y + z;
        (sum != 0.0).then(|| [x / sum, y / sum])
    }

    /// Smallest and largest value over 360 to 830 nm: exact for uniform, peak and table, over
    /// points half a nanometre apart for the smooth kinds.
    pub fn range(&self) -> (f64, f64) {
        let knots = self.breakpoints();
        let middles = knots.windows(2).map(|w| f64::midpoint(w[0], w[1]));
        knots
            .iter()
            .copied()
            .chain(middles)
            .map(|lambda| self.at(lambda))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
    }

    /// Largest value over 360 to 830 nm; see [`Self::range`].
    pub fn max(&self) -> f64 {
        self.range().1
    }

    /// Whether every value is finite.
    pub fn is_finite(&self) -> bool {
        self.breakpoints().into_iter().all(|lambda| self.at(lambda).is_finite())
    }

    /// The spectrum times a number.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        match self {
            Self::Uniform(v) => Self::Uniform(v * factor),
            Self::Peak(p) => Self::Peak(Peak { base: p.base * factor, peak: p.peak * factor, ..*p }),
            Self::Blackbody(body) => Self::Blackbody(body.scaled(factor)),
            Self::Reflectance { shape, factor: own } => {
                Self::Reflectance { shape: *shape, factor: own * factor }
            }
            Self::Table(table) => Self::Table(table.map(|v| v * factor)),
        }
    }

    /// The product of two spectra, of which one has a unit at most: exact where one is uniform, else at steps of 1 nm.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Uniform(v), spectrum) | (spectrum, Self::Uniform(v)) => spectrum.scaled(*v),
            _ => Self::Table(Table::on_grid(|lambda| self.at(lambda) * other.at(lambda))),
        }
    }

    /// The sum of two spectra; where one of them varies and the other is not black it becomes a table at 1 nm.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Uniform(a), Self::Uniform(b)) => Self::Uniform(a + b),
            (Self::Uniform(0.0), spectrum) | (spectrum, Self::Uniform(0.0)) => spectrum.clone(),
            _ => Self::Table(Table::on_grid(|lambda| self.at(lambda) + other.at(lambda))),
        }
    }

    /// The spectrum with its values limited to `[lo, hi]`: [0, 1] for an albedo, [-0.99, 0.99] for
    /// a mean cosine, from 0 up for a coefficient or emission. A table's knots are clamped; a
    /// smooth kind that goes beyond the limits becomes a table at 1 nm. A NaN becomes `lo`.
    #[must_use]
    pub fn clamped(&self, lo: f64, hi: f64) -> Self {
        let clamp = |v: f64| v.max(lo).min(hi);
        match self {
            Self::Uniform(v) => Self::Uniform(clamp(*v)),
            Self::Peak(p) => Self::Peak(Peak { base: clamp(p.base), peak: clamp(p.peak), ..*p }),
            Self::Table(table) => Self::Table(table.map(clamp)),
            Self::Blackbody(_) | Self::Reflectance { .. } => {
                let (least, most) = self.range();
                if least >= lo && most <= hi {
                    self.clone()
                } else {
                    Self::Table(Table::on_grid(|lambda| clamp(self.at(lambda))))
                }
            }
        }
    }

    /// Integrals of the spectrum times each of the given functions, over 360 to 830 nm.
    fn integrate<const N: usize>(&self, weight: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        integrate::piecewise(&self.breakpoints(), |lambda| {
            let v = self.at(lambda);
            weight(lambda).map(|w| w * v)
        })
    }

    /// Wavelengths between which the spectrum, and the colour matching functions, are smooth.
    fn breakpoints(&self) -> Vec<f64> {
        let own: Vec<f64> = match self {
            Self::Peak(p) => vec![p.min_nm, p.max_nm],
            Self::Table(table) => table.wavelengths().collect(),
            Self::Uniform(_) | Self::Blackbody(_) | Self::Reflectance { .. } => Vec::new(),
        };
        let inside = |lambda: &f64| *lambda > grid::FIRST_NM && *lambda < grid::LAST_NM;
        let mut points: Vec<f64> = grid::wavelengths().chain(own.into_iter().filter(inside)).collect();
        points.sort_by(f64::total_cmp);
        points.dedup();
        points
    }
}
