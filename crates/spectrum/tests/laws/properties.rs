//! Properties of random spectra.

use indigo_math::Real;
use indigo_spectrum::rgb::{RgbTable, fit::rgb_under_d65};
use indigo_spectrum::{LANES, SampledWavelengths, Spectrum};
use proptest::prelude::*;

use crate::{largest_difference, wavelengths};

fn unit_triple() -> impl Strategy<Value = [f64; 3]> {
    [0.0..=1.0, 0.0..=1.0, 0.0..=1.0]
}

fn any_spectrum() -> impl Strategy<Value = Spectrum> {
    prop_oneof![
        (-1e3..1e3_f64).prop_map(Spectrum::uniform),
        (300.0..900.0, 1.0..200.0, 0.0..1.0, 0.0..9.0_f64)
            .prop_map(|(min, width, base, peak)| Spectrum::peak(min, width, base, peak)),
        (800.0..2e4, 0.1..10.0_f64).prop_map(|(t, gain)| Spectrum::blackbody(t, gain)),
        unit_triple().prop_map(Spectrum::rgb_reflectance),
        unit_triple().prop_map(Spectrum::rgb_emission),
        unit_triple().prop_map(Spectrum::rgb_coefficient),
        proptest::collection::vec(-5.0..5.0, 2..60)
            .prop_map(|values| Spectrum::regular_tabulated(390e-9, 710e-9, &values).unwrap()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn reflectance_stays_within_bounds_and_returns_its_colour(rgb in unit_triple()) {
        let spectrum = Spectrum::rgb_reflectance(rgb);
        for lambda in wavelengths() {
            prop_assert!((0.0..=1.0).contains(&spectrum.at(lambda)));
        }
        prop_assert!(largest_difference(rgb_under_d65(|l| spectrum.at(l)), rgb) < 1e-3);
        let looked_up = RgbTable::get().lookup(rgb.map(|v| v as Real));
        prop_assert!(largest_difference(rgb_under_d65(|l| looked_up.at(l)), rgb) < 2e-3);
    }

    #[test]
    fn coefficients_are_linear(rgb in unit_triple(), factor in 1.0..1e6_f64, lambda in 360.0..830.0) {
        let one = Spectrum::rgb_coefficient(rgb).at(lambda);
        let many = Spectrum::rgb_coefficient(rgb.map(|v| v * factor)).at(lambda);
        prop_assert!((many - factor * one).abs() <= 1e-6 * many.abs());
        prop_assert!(one >= 0.0);
    }

    #[test]
    fn the_two_precisions_agree(spectrum in any_spectrum(), u in 0.0..1.0_f64) {
        let sampled = SampledWavelengths::sample((u as Real).min(1.0 - Real::EPSILON));
        let (least, most) = spectrum.range();
        let scale = least.abs().max(most.abs());
        let found = spectrum.eval(&sampled);
        for lane in 0..LANES {
            let exact = spectrum.at(sampled.lambda[lane] as f64);
            prop_assert!((found[lane] as f64 - exact).abs() <= 2e-5 * scale, "{} {exact}", found[lane]);
        }
    }

    #[test]
    fn integrals_are_linear(spectrum in any_spectrum(), factor in 0.5..2.0_f64) {
        let (one, many) = (spectrum.xyz(), spectrum.scaled(factor).xyz());
        let size = spectrum.range().1.abs().max(spectrum.range().0.abs()) * 7.3e-5;
        prop_assert!(largest_difference(one.map(|v| v * factor), many) <= 1e-6 * size);
    }
}
