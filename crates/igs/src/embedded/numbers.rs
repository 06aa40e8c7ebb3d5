//! Short lists of numbers, read from bytes.

/// Exactly `N` finite numbers separated by blanks.
pub(super) fn reals<const N: usize>(bytes: &[u8]) -> Option<[f32; N]> {
    let mut words = words(bytes);
    let mut out = [0.0; N];
    for v in &mut out {
        let word = std::str::from_utf8(words.next()?).ok()?;
        // Rust also reads "inf" and "nan", and a number too large becomes infinite.
        *v = word.parse::<f32>().ok().filter(|v| v.is_finite())?;
    }
    words.next().is_none().then_some(out)
}

/// Exactly three whole numbers separated by blanks.
pub(super) fn indices(bytes: &[u8]) -> Option<[u64; 3]> {
    let mut words = words(bytes);
    let mut out = [0; 3];
    for v in &mut out {
        *v = whole(words.next()?)?;
    }
    words.next().is_none().then_some(out)
}

fn words(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty())
}

fn whole(word: &[u8]) -> Option<u64> {
    // More digits than any index has could overflow.
    if word.is_empty() || word.len() > 18 {
        return None;
    }
    word.iter().try_fold(0_u64, |n, b| b.is_ascii_digit().then(|| n * 10 + u64::from(b - b'0')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_right_number_of_finite_numbers() {
        assert_eq!(reals::<3>(b" 1 -2.5\t4e-007 "), Some([1.0, -2.5, 4e-7]));
        for bad in ["", "1 2", "1 2 3 4", "1 2 x", "1 2 inf", "1 2 nan", "1 2 1e39", "1,2,3"] {
            assert_eq!(reals::<3>(bad.as_bytes()), None, "{bad}");
        }
        assert_eq!(reals::<2>(b"0 1\xFF"), None);
    }

    #[test]
    fn only_three_whole_numbers() {
        assert_eq!(indices(b"\n0 12\t345 "), Some([0, 12, 345]));
        for bad in ["", "0 1", "0 1 2 3", "0 1 -2", "0 1 2.0", "0 1 99999999999999999999"] {
            assert_eq!(indices(bad.as_bytes()), None, "{bad}");
        }
    }
}
