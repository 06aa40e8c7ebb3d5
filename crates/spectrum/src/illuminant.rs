//! CIE illuminants by name: relative spectra and white points.

use indigo_math::Real;

use crate::grid::{self, COUNT};
use crate::kinds::{Spectrum, Table};
use crate::lanes::SampledSpectrum;
use crate::observer::CMF;
use crate::wavelengths::SampledWavelengths;

/// Step of the published spectra, nm.
const STEP_NM: usize = 5;

/// A CIE illuminant.
#[derive(Debug, PartialEq)]
pub struct Illuminant {
    /// Its name: A, B, C, D50, D55, D65, D75, E, F1 to F12.
    pub name: &'static str,
    /// Chromaticity (x, y) of its white for the 2-degree observer, as published.
    pub white_xy: [f64; 2],
    /// Wavelength of the first value of `spd_5nm`, nm.
    pub first_nm: f64,
    /// Relative spectral power at 5 nm, as far as it is published within 360 to 830 nm.
    pub spd_5nm: &'static [f64],
}

/// Every illuminant of the list.
#[allow(clippy::approx_constant, reason = "measured powers that happen to lie near pi")]
pub static ALL: &[Illuminant] = include!("../data/illuminant_spds_5nm.in");

/// The illuminant of this name, in capitals or not.
pub fn find(name: &str) -> Option<&'static Illuminant> {
    ALL.iter().find(|illuminant| illuminant.name.eq_ignore_ascii_case(name))
}

/// The chromaticity (x, y) that a scene means: an illuminant's name, or two numbers `x y` that are
/// a real colour's (both above 0, their sum below 1). `None` where it is neither.
pub fn white_point(text: &str) -> Option<[f64; 2]> {
    let text = text.trim();
    if let Some(illuminant) = find(text) {
        return Some(illuminant.white_xy);
    }
    let mut numbers = text.split_whitespace().map(str::parse::<f64>);
    let (Some(Ok(x)), Some(Ok(y)), None) = (numbers.next(), numbers.next(), numbers.next()) else {
        return None;
    };
    (x > 0.0 && y > 0.0 && x + y < 1.0).then_some([x, y])
}

impl Illuminant {
    /// Relative power on the 1 nm grid, scaled to the luminance of the uniform spectrum 1: linear
    /// between the published values, the end values held beyond them.
    const fn on_grid(&self) -> [f64; COUNT] {
        let last = self.spd_5nm.len() - 1;
        let first = self.first_nm as usize;
        let mut values = [0.0; COUNT];
        let (mut power, mut equal) = (0.0, 0.0);
        let mut i = 0;
        while i < COUNT {
            let lambda = grid::FIRST_NM as usize + i;
            let offset = lambda.saturating_sub(first);
            let cell = offset / STEP_NM;
            values[i] = if cell >= last {
                self.spd_5nm[last]
            } else {
                let s = (offset % STEP_NM) as f64 / STEP_NM as f64;
                self.spd_5nm[cell] * (1.0 - s) + self.spd_5nm[cell + 1] * s
            };
            if i > 0 {
                // The integral of the product of two linear functions over one cell.
                let (a, b) = (CMF[i - 1][1], CMF[i][1]);
                power +=
                    (2.0 * (a * values[i - 1] + b * values[i]) + a * values[i] + b * values[i - 1]) / 6.0;
                equal += 0.5 * (a + b);
            }
            i += 1;
        }
        i = 0;
        while i < COUNT {
            values[i] *= equal / power;
            i += 1;
        }
        values
    }

    /// The illuminant's spectrum, scaled to the luminance of `uniform(1.0)`.
    pub fn spectrum(&self) -> Spectrum {
        Spectrum::Table(Table::of(grid::FIRST_NM, 1.0, self.on_grid().into_iter()))
    }
}

/// D65 on the 1 nm grid with the luminance of the uniform spectrum 1.
pub(crate) static D65: [f64; COUNT] = ALL[D65_INDEX].on_grid();

/// Where D65 stands in [`ALL`].
const D65_INDEX: usize = 5;

/// [`D65`] in the kernel's precision.
static D65_TABLE: [Real; COUNT] = {
    let mut table = [0.0; COUNT];
    let mut i = 0;
    while i < COUNT {
        table[i] = D65[i] as Real;
        i += 1;
    }
    table
};

/// D65 at these wavelengths, with the luminance of the uniform spectrum 1: what gives an RGB
/// emission its shape.
#[inline]
pub fn d65(wavelengths: &SampledWavelengths) -> SampledSpectrum {
    SampledSpectrum(wavelengths.lambda.map(|lambda| grid::lerp(&D65_TABLE, lambda)))
}
