//! Spectra from RGB triples: reflectance, emission, coefficients.

use indigo_math::Real;
use indigo_spectrum::rgb::{SigmoidCoeffs, basis, fit, fit::rgb_under_d65};
use indigo_spectrum::{LANES, SampledWavelengths, Spectrum, adaptation};

use crate::{assert_near, largest_difference, wavelengths};

/// Linear RGB, at luminance-of-white 1, of an emission's XYZ over that of `uniform` 1.
fn rgb_of(emission: &Spectrum) -> [f64; 3] {
    let white = Spectrum::uniform(1.0).luminance();
    adaptation::rgb_of_xyz(emission.xyz().map(|v| v / white))
}

/// Colour, and coefficients fitted apart from this program.
const FITS: [([f64; 3], [f64; 3]); 13] = [
    ([0.8, 0.3, 0.6], [24.2305, -17.0809, 2.58172]),
    ([0.9, 0.1, 0.1], [39.7058, -23.0358, 1.64053]),
    ([0.1, 0.9, 0.1], [-79.5483, 60.3234, -10.3144]),
    ([0.1, 0.1, 0.9], [33.2879, -31.8533, 6.14362]),
    ([0.63, 0.065, 0.05], [26.0728, -13.6278, -0.206434]),
    ([0.14, 0.45, 0.091], [-33.1963, 25.8692, -5.11545]),
    ([0.725, 0.71, 0.68], [-0.436111, 0.603638, 0.292902]),
    ([0.95, 0.95, 0.05], [-45.491, 44.2466, -8.61588]),
    ([0.05, 0.95, 0.95], [-61.4556, 35.6701, -2.58901]),
    ([0.95, 0.05, 0.95], [115.94, -88.1352, 15.2099]),
    ([1.0, 0.0, 0.0], [144.702, -83.5221, 5.97773]),
    ([0.0, 1.0, 0.0], [-200.0, 152.559, -26.629]),
    ([0.0, 0.0, 1.0], [55.0529, -62.2556, 12.8378]),
];

#[test]
fn fits_match_independent_ones() {
    for (rgb, coeffs) in FITS {
        let found = fit::sigmoid(rgb);
        let reference = SigmoidCoeffs(coeffs.map(|c| c as Real));
        let back = rgb_under_d65(|l| reference.at(l));
        let misses = if coeffs[0] == -200.0 { 5e-4 } else { 2e-5 };
        assert!(largest_difference(back, rgb) < misses, "{rgb:?}: the reference gives {back:?}");
        // Pure green ends at the bound on the coefficients, short of the colour. Beyond these
        // wavelengths the eye hardly tells what the curve does.
        let bound = if coeffs[0] == -200.0 { 2e-3 } else { 1e-4 };
        for lambda in wavelengths().filter(|l| (400.0..=700.0).contains(l)) {
            let error = (found.at(lambda) - reference.at(lambda)).abs();
            assert!(error < bound, "{rgb:?} at {lambda} nm: {error:.1e}, {found:?}");
        }
    }
}

#[test]
fn a_grey_reflectance_is_flat() {
    for v in [0.0, 1e-6, 0.18, 0.5, 1.0] {
        let spectrum = Spectrum::rgb_reflectance([v; 3]);
        assert!(wavelengths().all(|l| (spectrum.at(l) - v).abs() < 1e-12));
    }
}

#[test]
fn reflectance_is_clamped_silently() {
    assert_eq!(Spectrum::rgb_reflectance([2.0, 0.5, -1.0]), Spectrum::rgb_reflectance([1.0, 0.5, 0.0]));
    assert_eq!(Spectrum::rgb_reflectance([f64::NAN, 0.5, 0.5]), Spectrum::rgb_reflectance([0.0, 0.5, 0.5]));
}

#[test]
fn more_of_a_channel_reflects_more_in_its_band() {
    let bands = [(600.0, 700.0), (520.0, 570.0), (420.0, 480.0)];
    let mean = |rgb: [f64; 3], (from, to): (f64, f64)| {
        let spectrum = Spectrum::rgb_reflectance(rgb);
        wavelengths().filter(|l| (from..=to).contains(l)).map(|l| spectrum.at(l)).sum::<f64>()
    };
    for (channel, band) in bands.into_iter().enumerate() {
        let values: Vec<f64> = (0..=10)
            .map(|step| {
                let mut rgb = [0.35, 0.4, 0.3];
                rgb[channel] = f64::from(step) / 10.0;
                mean(rgb, band)
            })
            .collect();
        assert!(values.windows(2).all(|w| w[0] < w[1]), "channel {channel}: {values:?}");
    }
}

#[test]
fn white_emission_is_d65_as_bright_as_uniform() {
    for v in [1.0, 2.5e9] {
        let emission = Spectrum::rgb_emission([v; 3]);
        assert_near(emission.luminance(), Spectrum::uniform(v).luminance(), 1e-5);
        let [x, y] = emission.chromaticity().unwrap();
        assert!((x - 0.3127).abs() < 1e-4 && (y - 0.3290).abs() < 1e-4);
    }
    assert_eq!(Spectrum::rgb_emission([0.0; 3]).max(), 0.0);
}

#[test]
fn emission_has_the_colour_of_its_triple() {
    for rgb in [[3.0, 0.5, 0.1], [0.2, 7.0, 1.0], [0.0, 0.0, 40.0], [1.0, 0.9, 0.8], [1e-3, 0.0, 2e-3]] {
        let found = rgb_of(&Spectrum::rgb_emission(rgb));
        let most = rgb.into_iter().fold(0.0, f64::max);
        assert!(largest_difference(found, rgb) < 2e-3 * most, "{rgb:?}: {found:?}");
    }
}

#[test]
fn doubled_emission_is_twice_the_spectrum() {
    let (one, two) = (Spectrum::rgb_emission([3.0, 0.5, 0.1]), Spectrum::rgb_emission([6.0, 1.0, 0.2]));
    assert!(wavelengths().all(|l| two.at(l) == 2.0 * one.at(l)));
}

#[test]
fn impossible_emission_radiates_nothing() {
    for rgb in [[f64::INFINITY, 0.0, 0.0], [f64::NAN, -1.0, 0.0]] {
        assert_eq!(Spectrum::rgb_emission(rgb).max(), 0.0);
    }
}

#[test]
fn the_coefficient_basis_returns_colours_and_is_held_beyond_its_ends() {
    for rgb in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.7, 0.4]] {
        let spectrum = Spectrum::rgb_coefficient(rgb);
        let back = rgb_under_d65(|l| spectrum.at(l));
        assert!(largest_difference(back, rgb) < 2e-3, "{rgb:?}: {back:?}");
        assert_eq!(spectrum.at(360.0), spectrum.at(380.0));
        assert_eq!(spectrum.at(830.0), spectrum.at(780.0));
    }
    let grey = Spectrum::rgb_coefficient([1e4; 3]);
    assert!(wavelengths().all(|l| grey.at(l) == 1e4));
}

#[test]
fn the_curves_of_the_basis_make_the_coefficient() {
    let (rgb, sampled) = ([30.0, 2.0, 500.0], SampledWavelengths::sample(0.123));
    let [r, g, b] = basis::curves(&sampled);
    let mixed = r * 30.0 + g * 2.0 + b * 500.0;
    let expected = Spectrum::rgb_coefficient(rgb).eval(&sampled);
    for lane in 0..LANES {
        assert_near(mixed[lane] as f64, expected[lane] as f64, 1e-5);
        // The published curves sum to 1 within 1.0e-5.
        assert!(((r + g + b)[lane] - 1.0).abs() < 1.1e-5);
    }
}
