//! Colours and photometry.

use super::super::check::{Check, PATH, Quantity, Target};
use super::super::hung;
use super::super::picture::RGB_TO_XYZ;
use super::super::shapes::model;
use super::super::text::{background, diffuse};
use super::{AROUND, AROUND_NITS, integral, looking};

const GROUP: &str = "Colour";

/// Colour matching functions of the observer of 1931 at each whole nanometre from 360, between which they run straight.
const OBSERVER: &[[f64; 3]] = &include!("../../../../spectrum/data/cie1931_2deg_xyz_1nm.in");
const FIRST_NM: f64 = 360.0;
/// Lumens of a watt at 555 nm, where the observer's y is 1: 683 by definition at 540 THz, which is 555.017 nm in air.
const EFFICACY: f64 = 683.002;
/// What colours are granted that become spectra under D65: of its x and y the standard has four digits, and half of the last one is
/// this part of them.
const WHITE_DIGITS: f64 = 1.5e-4;

/// X, Y and Z of a radiance in W m⁻² sr⁻¹ nm⁻¹ from one wavelength to another, in cd/m².
pub fn tristimulus(from: f64, to: f64, radiance: impl Fn(f64) -> f64) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let weighted = |nm: f64| {
            let place = nm - FIRST_NM;
            let [below, above] = [0, 1].map(|i| OBSERVER[(place as usize + i).min(OBSERVER.len() - 1)][k]);
            radiance(nm) * (below + place.fract() * (above - below))
        };
        // A number of steps in each nanometre: none crosses a bend.
        EFFICACY * integral(from, to, 40 * (to - from) as u32, weighted)
    })
}

/// Planck's law, in W m⁻² sr⁻¹ nm⁻¹, with the constants of the SI of 2019.
fn planck(nm: f64, kelvin: f64) -> f64 {
    const H: f64 = 6.626_070_15e-34;
    const C: f64 = 299_792_458.0;
    const K: f64 = 1.380_649e-23;
    let m = nm * 1e-9;
    2.0 * H * C * C / m.powi(5) / (H * C / (m * K * kelvin)).exp_m1() * 1e-9
}

fn seen(name: &str, about: &str, spectrum: &str) -> Check {
    let scene = looking([0.0; 3], [0.0, 1.0, 0.0], 0.1, "", &[background(spectrum)]);
    Check::new(GROUP, name, about, scene).by(PATH).effort(128, 5e-3).in_full(512, 5e-3)
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let mut checks = vec![];
    let last_nm = FIRST_NM + (OBSERVER.len() - 1) as f64;
    for temperature in [2000.0, 2856.0, 4000.0, 6500.0, 20_000.0] {
        let spectrum =
            format!("<blackbody><temperature>{temperature}</temperature><gain>1</gain></blackbody>");
        let about = "Planck's law under the CIE observer of 1931, whose table of whole nanometres runs straight between them, by quadrature.";
        let [x, y, z] = tristimulus(FIRST_NM, last_nm, |nm| planck(nm, temperature));
        let exactly = |value: f64| Target::Value(value, 1e-6 * value);
        let check = seen(&format!("black body of {temperature} K"), about, &spectrum);
        let check = check.row("luminance", Quantity::Y, None, exactly(y));
        let check = check.row("x / y", Quantity::XOverY, None, exactly(x / y));
        checks.push(check.row("z / y", Quantity::ZOverY, None, exactly(z / y)));
    }
    let band = "<peak><peak_min>554.5</peak_min><peak_width>1</peak_width><base_value>0</base_value><peak_value>1e9</peak_value></peak>";
    let about = "1 W m⁻² sr⁻¹ in a band of 1 nm at 555 nm has 683 cd/m² (by definition 683 lm/W at 540 THz), less a twenty-thousandth at the band's edges.";
    let [_, luminance, _] = tristimulus(554.5, 555.5, |_| 1.0);
    checks.push(
        seen("555 nm", about, band).is(luminance, 1e-6 * luminance).effort(128, 2e-2).in_full(4096, 2e-2),
    );
    let white = "<rgb><rgb>1e5 1e5 1e5</rgb></rgb>";
    let about = "An `rgb` spectrum of equal values is light of D65: the CIE's table of 5 nm, straight between, under the observer.";
    let [x, y, z] = tristimulus(FIRST_NM, last_nm, daylight);
    let check =
        seen("white of sRGB", about, white).row("x / y", Quantity::XOverY, None, Target::Value(x / y, 0.0));
    checks.push(check.row("z / y", Quantity::ZOverY, None, Target::Value(z / y, 0.0)));
    checks.extend(
        [("orange", [0.8, 0.3, 0.1]), ("blue", [0.1, 0.25, 0.7]), ("leaf", [0.15, 0.4, 0.08])]
            .map(|(name, rgb)| [coloured_sheet(name, rgb), coloured_light(name, rgb)])
            .concat(),
    );
    checks
}

/// X, Y and Z of linear Rec. 709 (IEC 61966-2-1), as sums over Y of white, which is 1.
fn xyz_of(rgb: [f64; 3]) -> [f64; 3] {
    RGB_TO_XYZ.map(|row| (0..3).map(|c| row[c] * rgb[c]).sum())
}

/// `<rgb>`, times a factor.
fn rgb_spectrum(rgb: [f64; 3], factor: f64) -> String {
    let [r, g, b] = rgb.map(|v| v * factor);
    format!("<rgb><rgb>{r} {g} {b}</rgb></rgb>")
}

/// A check of three numbers, beside those of a colour.
fn of_colour(check: Check, rgb: [f64; 3]) -> Check {
    let [x, y, z] = xyz_of(rgb);
    check
        .row("luminance", Quantity::Y, None, Target::Value(y, WHITE_DIGITS * y))
        .row("x / y", Quantity::XOverY, None, Target::Value(x / y, WHITE_DIGITS * x / y))
        .row("z / y", Quantity::ZOverY, None, Target::Value(z / y, WHITE_DIGITS * z / y))
}

/// A matt sheet of a colour in light of D65 shows that colour.
fn coloured_sheet(name: &str, rgb: [f64; 3]) -> Check {
    let sheet = hung::mesh("sheet", "m", hung::corners([0.0, 5.0, 0.0], [0.0, -1.0, 0.0], 50.0), 1.0);
    let white = rgb_spectrum([1.0; 3], AROUND);
    let parts = [diffuse("m", &rgb_spectrum(rgb, 1.0)), sheet + &model("sheet"), background(&white)];
    let about = format!(
        "A reflectance by `rgb` {rgb:?} has under D65 the X, Y and Z of that colour of Rec. 709 (IEC 61966-2-1)."
    );
    let scene = looking([0.0; 3], [0.0, 1.0, 0.0], 0.1, "", &parts);
    of_colour(Check::new(GROUP, format!("{name} reflectance"), about, scene).by(PATH).unit(AROUND_NITS), rgb)
        .effort(32, 5e-3)
}

/// Light of a colour.
fn coloured_light(name: &str, rgb: [f64; 3]) -> Check {
    let about = format!(
        "Light by `rgb` {rgb:?} has the X, Y and Z of that colour, where white of the same numbers is D65."
    );
    of_colour(seen(&format!("{name} light"), &about, &rgb_spectrum(rgb, AROUND)).unit(AROUND_NITS), rgb)
}

/// An illuminant as the table holds it.
struct Illuminant {
    name: &'static str,
    #[allow(dead_code, reason = "the table has it")]
    white_xy: [f64; 2],
    first_nm: f64,
    spd_5nm: &'static [f64],
}

/// Relative power of D65 at a wavelength in nm.
fn daylight(nm: f64) -> f64 {
    #[allow(clippy::approx_constant, reason = "powers of lamps that happen to look like π and its double")]
    const ILLUMINANTS: &[Illuminant] = include!("../../../../spectrum/data/illuminant_spds_5nm.in");
    let d65 = ILLUMINANTS.iter().find(|illuminant| illuminant.name == "D65").expect("the table has it");
    let place = (nm - d65.first_nm) / 5.0;
    let [below, above] = [0, 1].map(|i| d65.spd_5nm.get(place as usize + i).copied().unwrap_or(0.0));
    below + place.fract() * (above - below)
}

#[cfg(test)]
mod tests {
    use super::super::super::oracles::{EVEN_LIGHT, NITS_PER_UNIFORM};
    use super::*;

    /// What other chapters know of the observer.
    #[test]
    fn even_light_is_that_of_the_table() {
        let [x, y, z] = tristimulus(360.0, 830.0, |_| 1e-9);
        assert!((y / NITS_PER_UNIFORM - 1.0).abs() < 1e-7);
        assert!((x / y - EVEN_LIGHT[0]).abs() < 1e-8 && (z / y - EVEN_LIGHT[2]).abs() < 1e-8, "{x} {y} {z}");
    }

    /// x = 0.3127 and y = 0.3290 by the standard.
    #[test]
    fn daylight_is_d65() {
        let seen = tristimulus(360.0, 830.0, daylight);
        let sum: f64 = seen.iter().sum();
        assert!((seen[0] / sum - 0.3127).abs() < 1e-4 && (seen[1] / sum - 0.3290).abs() < 1e-4, "{seen:?}");
    }

    /// Against a table of six digits of luminance and five of chromaticity, made independently, by sums over whole nanometres.
    #[test]
    fn black_bodies_are_those_of_a_table() {
        for (temperature, luminance, x, y) in [
            (2000.0, 463_765.0, 0.526_68, 0.413_30),
            (2856.0, 1.974_98e7, 0.447_54, 0.407_43),
            (6500.0, 3.072_53e9, 0.313_53, 0.323_63),
            (20_000.0, 6.254_62e10, 0.256_46, 0.257_63),
        ] {
            let seen = tristimulus(360.0, 830.0, |nm| planck(nm, temperature));
            let sum: f64 = seen.iter().sum();
            assert!((seen[1] / luminance - 1.0).abs() < 1e-5, "{temperature} K: {seen:?}");
            assert!((seen[0] / sum - x).abs() < 1e-5 && (seen[1] / sum - y).abs() < 1e-5, "{seen:?}");
        }
    }
}
