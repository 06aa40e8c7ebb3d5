//! Complex indices of refraction: `.nk` files as SOPRA's collection has them.
//!
//! The first line has four numbers: the unit (1: electron volts, 2: micrometres, 3: reciprocal centimetres, 4:
//! nanometres), start and end of the range, and how many steps it has. Then n and k follow in pairs, at equal steps of
//! the unit. Blanks, commas and semicolons stand between numbers. Files count intervals or points: with N pairs, a
//! count of N − 1 or of N is taken. Text behind the last pair is left out, and told; so is
//! a byte order mark, in silence.

use crate::error::{FormatError, Position};
use crate::text::Text;

/// hc in eV nm (exact in the SI of 2019, here to 1e-9).
const EV_NM: f64 = 1_239.841_984;
/// The largest n or k that is believed: those of metals are below 100 far into the infrared.
const LARGEST: f64 = 1e6;
/// The wavelengths that are believed, in nm: from gamma rays to metres. Far inside what a number can tell apart.
const RANGE_NM: std::ops::RangeInclusive<f64> = 1e-3..=1e9;

/// What editors of some systems begin a text in UTF-8 with.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// Index of refraction n and extinction coefficient k by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct ComplexIndex {
    /// Wavelength in nm, ascending, n and k; at least one.
    samples: Vec<[f64; 3]>,
    /// Where text behind the last pair begins, if there is any.
    pub left_out: Option<Position>,
}

impl ComplexIndex {
    /// n and k at a wavelength in nm: linear between the samples, the end values held outside.
    pub fn at(&self, lambda_nm: f64) -> [f64; 2] {
        let above = self.samples.partition_point(|s| s[0] <= lambda_nm);
        let sample = |i: usize| self.samples.get(i).copied();
        match (above.checked_sub(1).and_then(sample), sample(above)) {
            (Some([_, n, k]), None) | (None, Some([_, n, k])) => [n, k],
            (Some(a), Some(b)) => {
                let part = (lambda_nm - a[0]) / (b[0] - a[0]);
                [a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])]
            }
            (None, None) => [1.0, 0.0],
        }
    }

    /// First and last wavelength, nm.
    pub fn range_nm(&self) -> [f64; 2] {
        let ends = [self.samples.first(), self.samples.last()];
        ends.map(|s| s.map_or(0.0, |s| s[0]))
    }
}

/// Reads a file.
///
/// # Errors
/// For an unknown unit, a range that is empty or not positive, numbers that are not finite or absurdly large or
/// negative, and a number of pairs that does not fit the first line.
pub fn read(bytes: &[u8]) -> Result<ComplexIndex, FormatError> {
    let mark = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
    let mut text = Text::new(bytes, mark);
    let unit = text.offset();
    let to_nm = match next(&mut text, "a unit: 1 (eV), 2 (micrometres), 3 (1/cm) or 4 (nm)")? {
        1.0 => |e: f64| EV_NM / e,
        2.0 => |um: f64| um * 1e3,
        3.0 => |per_cm: f64| 1e7 / per_cm,
        4.0 => |nm: f64| nm,
        _ => return Err(text.error_at(unit, "a unit: 1 (eV), 2 (micrometres), 3 (1/cm) or 4 (nm)")),
    };
    let at_range = text.offset();
    let start = next(&mut text, "the start of the range")?;
    let end = next(&mut text, "the end of the range")?;
    if start == end || ![start, end].iter().all(|&x| x > 0.0 && RANGE_NM.contains(&to_nm(x))) {
        return Err(text.error_saying(
            at_range,
            "two different ends of a range between 0.001 nm and 1 m",
            &format!("{start} and {end}"),
        ));
    }
    let at_count = text.offset();
    let count = next(&mut text, "the number of steps")?;
    let mut pairs = Vec::new();
    while let Some(n) = number(&mut text) {
        let at_k = text.offset();
        let k = next(&mut text, "k, the second number of a pair")?;
        if !(0.0..=LARGEST).contains(&n) || !(0.0..=LARGEST).contains(&k) {
            return Err(text.error_saying(at_k, "n and k from 0 to 1000000", &format!("{n} and {k}")));
        }
        pairs.push([n, k]);
    }
    let steps = pairs.len().saturating_sub(1);
    if steps == 0 || !(count == steps as f64 || count == pairs.len() as f64) {
        let found = format!("{count} and {} pairs", pairs.len());
        return Err(text.error_saying(at_count, "as many pairs as the first line says, or one more", &found));
    }
    let position = |i: usize| start + (end - start) * i as f64 / steps as f64;
    let mut samples: Vec<[f64; 3]> =
        pairs.iter().enumerate().map(|(i, &[n, k])| [to_nm(position(i)), n, k]).collect();
    samples.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let left_out = text.peek().map(|_| text.error("").position);
    Ok(ComplexIndex { samples, left_out })
}

/// The next number; `None` where none stands.
fn number(text: &mut Text) -> Option<f64> {
    while text.peek().is_some_and(|b| b.is_ascii_whitespace() || b == b';' || b == b',') {
        text.advance();
    }
    let mut ahead = text.clone();
    let start = ahead.offset();
    while ahead.peek().is_some_and(|b| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'+' | b'-')) {
        ahead.advance();
    }
    let value: f64 = text.between(start, ahead.offset()).parse().ok()?;
    value.is_finite().then(|| {
        *text = ahead;
        value
    })
}

fn next(text: &mut Text, expected: &str) -> Result<f64, FormatError> {
    number(text).ok_or_else(|| text.error(expected))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-9 * b.abs().max(1.0), "{a} instead of {b}");
    }

    #[test]
    fn every_unit() {
        for (text, range) in [
            ("4 400 800 4\n1 10\n2 20\n3 30\n4 40\n5 50\n", [400.0, 800.0]),
            ("2 0.4 0.8 5\r\n1 10\r\n2 20\r\n3 30\r\n4 40\r\n5 50", [400.0, 800.0]),
            // From short to long energies: from long to short wavelengths.
            ("1; 1.549802480; 3.09960496; 4\n5;50\n4;40\n3;30\n2;20\n1;10\nend", [400.0, 800.0]),
            ("3 12500 25000 4\n5 50 4 40 3 30 2 20 1 10", [400.0, 800.0]),
        ] {
            let index = read(text.as_bytes()).expect(text);
            near(index.range_nm()[0], range[0]);
            near(index.range_nm()[1], range[1]);
            assert_eq!(index.at(399.0), [1.0, 10.0], "{text}");
            assert_eq!(index.at(900.0), [5.0, 50.0], "{text}");
        }
    }

    #[test]
    fn a_byte_order_mark_is_no_number() {
        let index = read("\u{feff}4 400 800 1\n1 10\n2 20".as_bytes()).unwrap();
        assert_eq!(index.at(800.0), [2.0, 20.0]);
    }

    #[test]
    fn values_are_linear_in_wavelength_between_samples() {
        let index = read(b"4 400 800 2\n1 10\n2 20\n4 80").unwrap();
        let [n, k] = index.at(650.0);
        near(n, 2.5);
        near(k, 35.0);
        // In energy the middle one lies at 533.3 nm.
        let index = read(b"1 1.549802480 3.09960496 2\n3 3\n2 2\n1 1").unwrap();
        let [n, _] = index.at(1600.0 / 3.0);
        near(n, 2.0);
    }

    #[test]
    fn what_is_wrong_has_a_place() {
        for (text, place, what) in [
            ("5 400 800 2\n1 1", "1:1", "a unit"),
            ("", "1:1", "a unit"),
            ("4 400 400 2\n1 1", "1:2", "two different ends"),
            ("4 -1 400 2\n1 1", "1:2", "two different ends"),
            ("4 400 800 7\n1 1\n2 2\n", "1:10", "as many pairs"),
            ("4 400 800 1\n1 1\n2", "3:2", "k, the second"),
            ("4 400 800 1\n1 1\n2 -2", "3:2", "n and k from 0"),
            ("4 400 800 0\n1 1", "1:10", "as many pairs"),
            ("4 400 inf 2\n1 1", "1:7", "the end of the range"),
        ] {
            let error = read(text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(place) && error.contains(what), "{text}: {error}");
        }
    }
}
