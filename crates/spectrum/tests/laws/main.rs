//! The laws that a spectrum of each kind keeps, and its agreement with published numbers.

mod kinds;
mod properties;
mod rgb;
mod sampling;
mod white;

/// A tolerance relative to the expected value.
pub fn assert_near(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} is not {expected}");
}

pub(crate) fn wavelengths() -> impl Iterator<Item = f64> {
    (0..471).map(|i| 360.0 + f64::from(i))
}

pub(crate) fn largest_difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}
