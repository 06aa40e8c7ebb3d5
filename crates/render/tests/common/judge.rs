//! Verdicts on measured means.

use super::again::replay;
use indigo_testkit::sidak;
use indigo_testkit::stats::Moments;
use indigo_testkit::ztest::welch;

/// Probability of any false alarm among all means that the tests of this crate judge.
const FAMILY: f64 = 1e-4;
/// More means than are judged anywhere here.
const TESTS: usize = 500;
/// Relative difference that the sums of single-precision numbers may make.
const ROUNDING: f64 = 1e-5;

/// Luminance of spectral radiance 1 W m^-3 sr^-1 at all wavelengths, cd/m²: 683.002 · 1e-9 · ∫ȳ dλ,
/// with ∫ȳ = 106.85692 nm over 360 to 830 nm (CIE 1931, 1 nm table).
pub const NITS_PER_UNIFORM: f64 = 683.002e-9 * 106.85692;

/// Says that measured means have an expectation within a relative tolerance, as far as both the
/// tolerance and their own scatter can tell.
///
/// The scatter must be small enough to see a deviation of the tolerance: a quarter of it. It is itself estimated, from
/// 8 to 24 batches, so a scatter at that limit raises a false alarm as Student's t does beyond 4: with 5e-3 for 8
/// batches, 1e-3 for 16, 6e-4 for 24; and where the true scatter is at the limit the test says half of the time that it
/// cannot tell. Most scatter is far smaller. Seeds are fixed: a test that passed goes on to, until something changes.
#[track_caller]
pub fn assert_is(what: &str, measured: &Moments, expected: f64, tolerance: f64) {
    assert_near(what, measured, expected, tolerance);
    assert_agrees(what, measured, expected);
}

/// [`assert_is`] where the expectation itself is known to the tolerance only.
#[track_caller]
pub fn assert_near(what: &str, measured: &Moments, expected: f64, tolerance: f64) {
    let relative_error = measured.std_error() / expected.abs();
    assert!(
        relative_error <= 0.25 * tolerance,
        "{what}: standard error {relative_error:.2e} of the mean cannot tell a deviation of {tolerance:.0e}"
    );
    let deviation = measured.mean() / expected - 1.0;
    assert!(
        deviation.abs() <= tolerance,
        "{what}: {} instead of {expected}: off by {deviation:+.2e} (standard error {relative_error:.1e})\nagain: {}",
        measured.mean(),
        replay()
    );
}

/// Says that measured means deviate from an exact value no more than chance explains.
#[track_caller]
pub fn assert_agrees(what: &str, measured: &Moments, expected: f64) {
    assert_same(what, measured, &Moments::exact(expected));
}

/// Says that two sets of measured means have one expectation.
#[track_caller]
pub fn assert_same(what: &str, a: &Moments, b: &Moments) {
    let rounding = ROUNDING * a.mean().abs().max(b.mean().abs());
    let test = welch(a, b, rounding).at(sidak(FAMILY, TESTS));
    assert!(test.passed(), "{what}: {test}\nagain: {}", replay());
}
