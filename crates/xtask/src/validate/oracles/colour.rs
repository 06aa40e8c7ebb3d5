//! Colours and photometry.

use super::super::check::{Check, PATH, Quantity, Target};
use super::super::text::background;
use super::looking;

const GROUP: &str = "Colour";

/// Temperature; luminance (cd/m²) and chromaticity by Planck's law and the observer of 1931, 360 to 830 nm.
const BLACK_BODIES: [(f64, f64, f64, f64); 5] = [
    (2000.0, 463_765.0, 0.526_68, 0.413_30),
    (2856.0, 1.974_98e7, 0.447_54, 0.407_43),
    (4000.0, 2.528_07e8, 0.380_44, 0.376_75),
    (6500.0, 3.072_53e9, 0.313_53, 0.323_63),
    (20_000.0, 6.254_62e10, 0.256_46, 0.257_63),
];

fn seen(name: &str, about: &str, spectrum: &str) -> Check {
    let scene = looking([0.0; 3], [0.0, 1.0, 0.0], 0.1, "", &[background(spectrum)]);
    Check::new(GROUP, name, about, scene).by(PATH).effort(512, 5e-3)
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let mut checks = vec![];
    for (temperature, luminance, x, y) in BLACK_BODIES {
        let spectrum =
            format!("<blackbody><temperature>{temperature}</temperature><gain>1</gain></blackbody>");
        let about =
            "Planck's law under the CIE observer of 1931; six digits of luminance, five of chromaticity.";
        // Half a unit of the last digit of x and y.
        let ratio = |over: f64| Target::Value(over / y, (5e-6 + 5e-6 * over / y) / y);
        let check = seen(&format!("black body of {temperature} K"), about, &spectrum);
        let luminance = Target::Value(luminance, 3e-6 * luminance);
        let check = check.row("luminance", Quantity::Y, None, luminance);
        let check = check.row("x / y", Quantity::XOverY, None, ratio(x));
        checks.push(check.row("z / y", Quantity::ZOverY, None, ratio(1.0 - x - y)));
    }
    let band = "<peak><peak_min>554.5</peak_min><peak_width>1</peak_width><base_value>0</base_value><peak_value>1e9</peak_value></peak>";
    let about = "1 W m⁻² sr⁻¹ in a band of 1 nm at 555 nm has 683 cd/m² (by definition 683 lm/W at 540 THz).";
    checks.push(seen("555 nm", about, band).is(683.0, 0.02).effort(4096, 2e-2));
    let white = "<rgb><rgb>1e5 1e5 1e5</rgb></rgb>";
    let about = "An `rgb` spectrum of equal values is light of D65: x = 0.31272, y = 0.32903.";
    let (x, y) = (0.312_72, 0.329_03);
    let near = 2e-4;
    let check =
        seen("white of sRGB", about, white).row("x / y", Quantity::XOverY, None, Target::Value(x / y, near));
    checks.push(check.row("z / y", Quantity::ZOverY, None, Target::Value((1.0 - x - y) / y, near)));
    checks
}
