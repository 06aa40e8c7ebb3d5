//! What both layers of skin are made of (Donner & Jensen 2006, "A Spectral BSSRDF for Shading Human Skin",
//! section 5). The paper's formulas give 1/mm at wavelengths in nm; here all is in 1/m.
//!
//! The paper's scattering is *reduced*, σs′ = σs (1 − g), as its diffusion theory has it; a medium with
//! that coefficient and an isotropic phase function scatters the same in the diffusive limit.
//!
// tidy: load-time mathematics

use super::{Cauchy, Medium};
use crate::phase::{PhaseFunction, uniform};
use indigo_spectrum::Spectrum;

/// The usual index of refraction of both layers (Donner & Jensen 2005, "Light Diffusion in Multi-Layered
/// Translucent Materials", section 6).
const IOR: f64 = 1.4;

const FIRST_NM: f64 = 360.0;
const STEP_NM: f64 = 2.0;
const COUNT: usize = 236;

/// Molar extinction of oxygenated and deoxygenated haemoglobin, 1/cm per mol/l.
static HAEMOGLOBIN: [[f64; 2]; COUNT] = include!("../../data/haemoglobin_2nm.in");

/// Haemoglobin in whole blood, g/l, and its molar mass, g/mol (Prahl 1999).
const BLOOD_G_PER_L: f64 = 150.0;
const MOLAR_MASS: f64 = 64_500.0;
/// The share of haemoglobin that carries oxygen (Donner & Jensen 2006, section 5).
const OXYGENATION: f64 = 0.75;

/// A medium of an absorption in 1/m, as a function of the wavelength in nm and the number of a row of
/// [`HAEMOGLOBIN`], and of a scattering that is some share of the epidermis'.
pub(super) fn layer(absorption: impl Fn(f64, usize) -> f64, scattering: f64) -> Medium {
    let table = |f: &dyn Fn(f64, usize) -> f64| {
        let values: Vec<f64> = (0..COUNT).map(|i| f(FIRST_NM + i as f64 * STEP_NM, i)).collect();
        let last_nm = FIRST_NM + (COUNT - 1) as f64 * STEP_NM;
        // The table's ends and its number of values are constants of this file, and all values are finite.
        Spectrum::regular_tabulated(FIRST_NM * 1e-9, last_nm * 1e-9, &values).unwrap_or(Spectrum::BLACK)
    };
    Medium {
        ior: Cauchy::constant(IOR),
        absorption: table(&absorption),
        scattering: table(&|nm, _| scattering * epidermis_scattering(nm)),
        phase: PhaseFunction::Uniform(uniform::Uniform),
    }
}

/// Absorption of bloodless and colourless tissue.
pub(super) fn baseline(nm: f64) -> f64 {
    1e3 * (0.0244 + 8.53 * (-(nm - 154.0) / 66.2).exp())
}

/// Absorption of melanin with a share `eumelanin` of the brown kind.
pub(super) fn melanin(nm: f64, eumelanin: f64) -> f64 {
    1e3 * (eumelanin * 6.6e10 * nm.powf(-3.33) + (1.0 - eumelanin) * 2.9e14 * nm.powf(-4.75))
}

/// Absorption of blood at the wavelength of row `i` of the table.
pub(super) fn blood(i: usize) -> f64 {
    let [oxy, deoxy] = HAEMOGLOBIN[i];
    let extinction_per_m = 100.0 * (OXYGENATION * oxy + (1.0 - OXYGENATION) * deoxy);
    std::f64::consts::LN_10 * extinction_per_m * BLOOD_G_PER_L / MOLAR_MASS
}

fn epidermis_scattering(nm: f64) -> f64 {
    1e3 * (14.74 * nm.powf(-0.22) + 2.2e11 * nm.powi(-4))
}

#[cfg(test)]
mod tests {
    use super::super::{dermis, epidermis};

    /// Values computed from the published formulas with another program, 1/m.
    #[test]
    fn absorption_has_its_known_values() {
        for (nm, melanin, blend, haemoglobin, epi, der) in [
            (450.0, 0.01, 0.61, 0.01, 991.399, 511.256),
            (450.0, 0.05, 0.5, 0.02, 4336.9, 900.592),
            (450.0, 0.2, 0.5, 0.05, 16981.8, 2068.6),
            (450.0, 0.5, 0.61, 0.1, 43595.9, 4015.29),
        ] {
            let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-4, "{nm}: {a} instead of {b}");
            near(epidermis::medium(melanin, blend).absorption.at(nm), epi);
            near(dermis::medium(haemoglobin).absorption.at(nm), der);
        }
        let scattering = epidermis::medium(0.1, 0.5).scattering.at(500.0);
        assert!((scattering / 7276.0 - 1.0).abs() < 1e-3, "{scattering}");
        assert!((dermis::medium(0.1).scattering.at(360.0) / 8567.86 - 1.0).abs() < 1e-5);
    }
}
