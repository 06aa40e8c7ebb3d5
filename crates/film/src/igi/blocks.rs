//! Many numbers in little room: `f64` in blocks, the bytes of each block ordered by significance, then LZ4.
//!
//! Sums of neighbouring pixels share sign and exponent, and the last bits of sums of `f32` are zero for
//! long: ordered so, what is alike lies together. Nothing is lost.

use super::IgiError;
use super::bytes::Bytes;
use std::io::{self, Write};

/// Numbers of a block: half a mebibyte, which stays in a processor's cache.
const BLOCK: usize = 1 << 16;
/// Bytes of a number.
const WIDTH: usize = 8;

/// Writes numbers; how many is the reader's to know.
pub(super) fn write(out: &mut impl Write, mut values: impl ExactSizeIterator<Item = f64>) -> io::Result<()> {
    let (mut planes, mut packed) = (Vec::new(), Vec::new());
    while values.len() > 0 {
        let n = values.len().min(BLOCK);
        planes.resize(n * WIDTH, 0);
        for (i, value) in values.by_ref().take(n).enumerate() {
            for (plane, byte) in value.to_le_bytes().into_iter().enumerate() {
                planes[plane * n + i] = byte;
            }
        }
        packed.resize(lz4_flex::block::get_maximum_output_size(planes.len()), 0);
        let length = lz4_flex::block::compress_into(&planes, &mut packed).map_err(io::Error::other)?;
        out.write_all(&(length as u32).to_le_bytes())?;
        out.write_all(&packed[..length])?;
    }
    Ok(())
}

/// Reads `n` numbers, all of which must be finite, in groups for `put`.
pub(super) fn read(
    bytes: &mut Bytes<'_>,
    n: usize,
    mut put: impl FnMut(&mut dyn Iterator<Item = f64>),
) -> Result<(), IgiError> {
    const WHAT: &str = "a block of sums";
    let mut planes = Vec::new();
    let mut left = n;
    while left > 0 {
        let n = left.min(BLOCK);
        let length = bytes.u32(WHAT)? as usize;
        let packed = bytes.take(length, WHAT)?;
        planes.resize(n * WIDTH, 0);
        let unpacked = lz4_flex::block::decompress_into(packed, &mut planes);
        if unpacked.ok() != Some(planes.len()) {
            return Err(IgiError::Malformed("a block cannot be unpacked"));
        }
        let value = |i: usize| f64::from_le_bytes(std::array::from_fn(|plane| planes[plane * n + i]));
        if !(0..n).all(|i| value(i).is_finite()) {
            return Err(IgiError::Malformed("a sum is not finite"));
        }
        put(&mut (0..n).map(value));
        left -= n;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_bit_for_bit() {
        for n in [0, 1, 7, BLOCK - 1, BLOCK, BLOCK + 5, 2 * BLOCK] {
            let values: Vec<f64> = (0..n).map(|i| (i as f64 * 0.37).sin() * 1e3 - 0.0).collect();
            let mut file = Vec::new();
            write(&mut file, values.iter().copied()).unwrap();
            let mut back = Vec::new();
            let mut bytes = Bytes(&file);
            read(&mut bytes, n, |block| back.extend(block)).unwrap();
            assert_eq!(values, back);
            assert!(bytes.0.is_empty());
        }
    }

    #[test]
    fn what_is_not_a_number_is_refused() {
        let mut file = Vec::new();
        write(&mut file, [1.0, f64::NAN].into_iter()).unwrap();
        let read = read(&mut Bytes(&file), 2, |_| {});
        assert_eq!(read, Err(IgiError::Malformed("a sum is not finite")));
    }
}
