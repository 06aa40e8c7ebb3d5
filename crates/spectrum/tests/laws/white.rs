//! Illuminants and white balance.

use indigo_math::{Mat3, Vec3d};
use indigo_spectrum::{Spectrum, adaptation, illuminant};

use crate::{assert_near, largest_difference};

#[test]
fn white_points_follow_from_the_spectra() {
    for light in illuminant::ALL {
        let [x, y] = light.spectrum().chromaticity().unwrap();
        // The published pair of F10 differs from its published spectrum.
        let bound = if light.name == "F10" { 1e-3 } else { 1e-4 };
        let error = (x - light.white_xy[0]).abs().max((y - light.white_xy[1]).abs());
        assert!(error < bound, "{}: {error:.1e}", light.name);
        assert_near(light.spectrum().luminance(), Spectrum::uniform(1.0).luminance(), 1e-7);
    }
}

#[test]
fn white_points_are_found_by_name_or_number() {
    assert_eq!(illuminant::ALL.len(), 20);
    assert_eq!(illuminant::white_point(" d65 "), Some([0.31271, 0.32902]));
    assert_eq!(illuminant::white_point("f10"), Some([0.34609, 0.35986]));
    assert_eq!(illuminant::white_point("0.3 0.31"), Some([0.3, 0.31]));
    for bad in ["", "D60", "F13", "0.3", "0.3 0.3 0.3", "0.3 0", "0.7 0.4", "nan nan", "-0.1 0.5"] {
        assert_eq!(illuminant::white_point(bad), None, "{bad}");
    }
    assert!(Spectrum::illuminant("e").is_some() && Spectrum::illuminant("G").is_none());
}

/// Linear RGB at Y = 1 after adaptation from a named white.
fn balanced(spectrum: &Spectrum, white: &str) -> [f64; 3] {
    let from = illuminant::white_point(white).unwrap();
    let [x, y, z] = spectrum.xyz();
    let adapted = adaptation::bradford_to_d65(from).unwrap() * Vec3d::new(x / y, 1.0, z / y);
    (Mat3::from_rows(adaptation::XYZ_TO_RGB) * adapted).to_array()
}

#[test]
fn light_of_an_illuminant_balanced_for_it_is_neutral() {
    for light in illuminant::ALL {
        let rgb = balanced(&light.spectrum(), light.name);
        // F10's published white differs from its published spectrum by 1e-3 in x and y.
        let bound = if light.name == "F10" { 1e-2 } else { 5e-3 };
        assert!(largest_difference(rgb, [1.0; 3]) < bound, "{}: {rgb:?}", light.name);
    }
    // To four digits for D65 itself.
    assert!(
        largest_difference(balanced(&Spectrum::illuminant("D65").unwrap(), "D65"), [1.0002, 0.9999, 0.9999])
            < 1e-4
    );
}

#[test]
fn a_black_body_of_5000_k_is_near_neutral_under_d50_and_orange_under_d65() {
    let body = Spectrum::blackbody(5000.0, 1.0);
    assert!(largest_difference(balanced(&body, "D50"), [1.036, 0.984, 1.054]) < 1e-3);
    assert!(largest_difference(balanced(&body, "D65"), [1.213, 0.960, 0.762]) < 1e-3);
}
