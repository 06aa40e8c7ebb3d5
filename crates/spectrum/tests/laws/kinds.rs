//! Luminance, black bodies, peaks, tables and photometric scales.

use indigo_math::Real;
use indigo_spectrum::kinds::planck;
use indigo_spectrum::{LANES, SampledWavelengths, Spectrum, observer, photometry};

use crate::{assert_near, wavelengths};

#[test]
fn a_uniform_spectrum_has_the_stated_luminance() {
    for v in [1.0, 0.1, 2e9] {
        assert_near(Spectrum::uniform(v).luminance(), v * 7.298_348_81e-5, 1e-7);
    }
    assert_near(Spectrum::uniform(1.0).integral_nm(), 470.0, 1e-12);
}

#[test]
fn one_watt_at_555_nm_is_683_candela() {
    // 1 W m^-2 sr^-1 in a hundredth of a nanometre.
    let line = Spectrum::peak(554.995, 0.01, 0.0, 1e9 / 0.01);
    assert_near(line.luminance(), 683.002, 1e-5);
    assert_near(line.integral_nm() * 1e-9, 1.0, 1e-9);
}

/// Temperature in K, luminance in cd/m^2, chromaticity: computed apart from this program from the SI constants.
const BLACKBODIES: [(f64, f64, f64, f64); 16] = [
    (1000.0, 2.68697, 0.65275, 0.34446),
    (1500.0, 7740.31, 0.58572, 0.39312),
    (2000.0, 463765.0, 0.52668, 0.41330),
    (2042.0, 598592.0, 0.52213, 0.41394),
    (2500.0, 5.62378e6, 0.47699, 0.41368),
    (2700.0, 1.18518e7, 0.45986, 0.41060),
    (2856.0, 1.97498e7, 0.44754, 0.40743),
    (3000.0, 3.02182e7, 0.43693, 0.40407),
    (4000.0, 2.52807e8, 0.38044, 0.37675),
    (5000.0, 9.18111e8, 0.34510, 0.35161),
    (5500.0, 1.47363e9, 0.33243, 0.34104),
    (6000.0, 2.19131e9, 0.32208, 0.33175),
    (6500.0, 3.07253e9, 0.31353, 0.32363),
    (7000.0, 4.11383e9, 0.30637, 0.31651),
    (10000.0, 1.32605e10, 0.28063, 0.28829),
    (20000.0, 6.25462e10, 0.25646, 0.25763),
];

#[test]
fn black_bodies_match_the_table() {
    for (temperature, luminance, x, y) in BLACKBODIES {
        let body = Spectrum::blackbody(temperature, 1.0);
        // The table has six digits, five of chromaticity, and is a sum over whole nanometres.
        let sum: f64 = wavelengths().map(|l| observer::cmf(l)[1] * planck(l, temperature)).sum();
        assert_near(sum * observer::NITS_PER_UNIT, luminance, 5e-6);
        // An integral takes the colour matching functions as linear between nanometres, so it lies
        // a little higher where they fall off exponentially, which is what a dim red body shows.
        assert_near(body.luminance(), luminance, 1e-4);
        let found = body.chromaticity().unwrap();
        assert!((found[0] - x).abs() < 6e-6 && (found[1] - y).abs() < 6e-6, "{temperature} K: {found:?}");
        assert_near(body.scaled(2.0).luminance(), 2.0 * body.luminance(), 1e-12);
    }
}

#[test]
fn a_body_without_heat_is_black() {
    for temperature in [0.0, -5.0, f64::NAN, 1e-300] {
        let body = Spectrum::blackbody(temperature, 1.0);
        assert_eq!(body.luminance(), 0.0);
        assert!(body.eval(&SampledWavelengths::sample(0.3)).is_black());
    }
}

#[test]
fn blackbody_table_follows_the_law() {
    for temperature in [500.0, 1000.0, 2856.0, 6500.0, 25000.0] {
        let body = Spectrum::blackbody(temperature, 3.0);
        let bound = if temperature < 1000.0 { 1e-5 } else { 1e-6 };
        for k in 0..20_000 {
            let sampled = SampledWavelengths::sample(k as Real / 20_000.0);
            let found = body.eval(&sampled);
            for lane in 0..LANES {
                let exact = 3.0 * planck(sampled.lambda[lane] as f64, temperature);
                let error = (found[lane] as f64 - exact).abs() / exact;
                assert!(error < bound, "{temperature} K, {} nm: {error:.1e}", sampled.lambda[lane]);
            }
        }
    }
}

#[test]
fn the_edges_of_a_peak_are_exact() {
    let band = Spectrum::peak(550.0, 50.0, 0.25, 2.0);
    assert_eq!([549.999_999, 550.0, 599.999_999, 600.0].map(|l| band.at(l)), [0.25, 2.0, 2.0, 0.25]);
    assert_near(band.integral_nm(), 0.25 * 420.0 + 2.0 * 50.0, 1e-12);
    assert_eq!(band.range(), (0.25, 2.0));
    // Edges between the points of the grid.
    assert_near(Spectrum::peak(500.3, 0.4, 0.0, 1.0).integral_nm(), 0.4, 1e-12);
    // Partly outside the visible range.
    assert_near(Spectrum::peak(300.0, 70.0, 0.0, 1.0).integral_nm(), 10.0, 1e-12);
}

#[test]
fn a_table_is_linear_between_values_and_held_beyond() {
    let table = Spectrum::regular_tabulated(400e-9, 600e-9, &[1.0, 3.0, 2.0]).unwrap();
    for (lambda, v) in
        [(360.0, 1.0), (400.0, 1.0), (450.0, 2.0), (500.0, 3.0), (550.0, 2.5), (600.0, 2.0), (800.0, 2.0)]
    {
        assert!((table.at(lambda) - v).abs() < 1e-9, "{lambda}: {}", table.at(lambda));
    }
    assert_near(table.integral_nm(), 40.0 + 200.0 + 250.0 + 460.0, 1e-9);
    assert!((table.max() - 3.0).abs() < 1e-6);
    let clamped = table.clamped(1.5, 2.5);
    assert_eq!(clamped.range(), (1.5, 2.5));
}

#[test]
fn a_bad_table_is_an_error() {
    for (start, end, values) in [
        (400e-9, 600e-9, &[1.0][..]),
        (400e-9, 600e-9, &[]),
        (600e-9, 400e-9, &[1.0, 2.0]),
        (400e-9, 400e-9, &[1.0, 2.0]),
        (f64::NAN, 400e-9, &[1.0, 2.0]),
        (0.0, f64::INFINITY, &[1.0, 2.0]),
        (400e-9, 600e-9, &[1.0, f64::NAN]),
        (400e-9, 600e-9, &[1.0, f64::INFINITY]),
    ] {
        assert!(Spectrum::regular_tabulated(start, end, values).is_err(), "{start} {end} {values:?}");
    }
}

#[test]
fn clamping_keeps_every_kind_within_the_limits() {
    let kinds = [
        Spectrum::uniform(2.0),
        Spectrum::peak(500.0, 20.0, -1.0, 3.0),
        Spectrum::blackbody(5000.0, 1e-13),
        Spectrum::rgb_reflectance([0.9, 0.2, 0.1]).scaled(1.5),
        Spectrum::rgb_coefficient([3.0, -1.0, 0.2]),
    ];
    for spectrum in kinds {
        assert!(spectrum.max() > 1.0);
        let clamped = spectrum.clamped(0.0, 1.0);
        let (least, most) = clamped.range();
        assert!(least >= 0.0 && (most - 1.0).abs() < 1e-6, "{least} {most}");
    }
    assert_eq!(Spectrum::uniform(f64::NAN).clamped(0.0, 1.0), Spectrum::uniform(0.0));
}

#[test]
fn a_lamp_of_known_efficacy_has_its_luminance() {
    // 0.2 x 0.2 m, 100 W at 17.5 lm/W.
    for shape in
        [Spectrum::uniform(7.0), Spectrum::blackbody(2700.0, 1e-3), Spectrum::rgb_emission([1.0, 0.5, 0.2])]
    {
        let lamp = photometry::with_efficacy(&shape, 100.0, 17.5, 0.04).unwrap();
        assert_near(lamp.luminance(), 13_926.057_521, 1e-6);
    }
    assert!(photometry::with_efficacy(&Spectrum::BLACK, 100.0, 17.5, 0.04).is_none());
    assert!(photometry::with_efficacy(&Spectrum::uniform(1.0), 100.0, 17.5, 0.0).is_none());
}

#[test]
fn sums_have_the_light_of_both() {
    let [even, body] = [Spectrum::Uniform(3.0), Spectrum::blackbody(3000.0, 1e-3)];
    assert_eq!(even.plus(&Spectrum::Uniform(0.5)), Spectrum::Uniform(3.5));
    assert_eq!(body.plus(&Spectrum::Uniform(0.0)), body);
    let sum = body.plus(&even);
    for lambda in [400.0, 555.0, 700.0] {
        assert!((sum.at(lambda) / (body.at(lambda) + 3.0) - 1.0).abs() < 1e-6, "{lambda}");
    }
    let parts = body.luminance() + even.luminance();
    assert!((sum.luminance() / parts - 1.0).abs() < 1e-6, "{} {parts}", sum.luminance());
}
