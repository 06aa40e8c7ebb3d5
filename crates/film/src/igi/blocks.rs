//! Many numbers in little room: in blocks, the bytes of each block ordered by significance, then LZ4.
//!
//! Sums of neighbouring pixels share sign and exponent, and the last bits of sums of `f32` are zero for
//! long: ordered so, what is alike lies together. Nothing is lost, but for what single precision cannot hold where
//! that is asked for.

use super::IgiError;
use super::bytes::Bytes;
use rayon::prelude::*;
use std::io::{self, Write};

/// Numbers of a block: half a mebibyte, which stays in a processor's cache.
pub(super) const BLOCK: usize = 1 << 16;
/// How numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Precision {
    /// As `f32`.
    Single,
    /// As `f64`.
    Double,
}

impl Precision {
    /// Bytes of a number.
    const fn width(self) -> usize {
        match self {
            Self::Single => 4,
            Self::Double => 8,
        }
    }
}

/// A block that is none.
const CANNOT_UNPACK: IgiError = IgiError::Malformed("a block cannot be unpacked");

/// Writes numbers; how many is the reader's to know.
pub(super) fn write(
    out: &mut impl Write,
    precision: Precision,
    mut values: impl ExactSizeIterator<Item = f64>,
) -> io::Result<()> {
    let (mut planes, mut packed) = (Vec::new(), Vec::new());
    while values.len() > 0 {
        let n = values.len().min(BLOCK);
        planes.resize(n * precision.width(), 0);
        let block = values.by_ref().take(n);
        match precision {
            Precision::Single => fill(&mut planes, n, block.map(|v| (v as f32).to_le_bytes())),
            Precision::Double => fill(&mut planes, n, block.map(f64::to_le_bytes)),
        }
        packed.resize(lz4_flex::block::get_maximum_output_size(planes.len()), 0);
        let length = lz4_flex::block::compress_into(&planes, &mut packed).map_err(io::Error::other)?;
        out.write_all(&(length as u32).to_le_bytes())?;
        out.write_all(&packed[..length])?;
    }
    Ok(())
}

/// Orders the bytes of `n` numbers by significance.
fn fill<const WIDTH: usize>(planes: &mut [u8], n: usize, numbers: impl Iterator<Item = [u8; WIDTH]>) {
    for (i, bytes) in numbers.enumerate() {
        for (plane, byte) in bytes.into_iter().enumerate() {
            planes[plane * n + i] = byte;
        }
    }
}

/// Blocks of a file, not unpacked yet.
pub(super) struct Packed<'a> {
    blocks: Vec<&'a [u8]>,
    precision: Precision,
}

impl<'a> Packed<'a> {
    /// The next blocks, of `n` numbers in all.
    pub fn take(bytes: &mut Bytes<'a>, precision: Precision, n: usize) -> Result<Self, IgiError> {
        const WHAT: &str = "a block of sums";
        let mut block = || {
            let length = bytes.u32(WHAT)? as usize;
            bytes.take(length, WHAT)
        };
        let blocks = (0..n.div_ceil(BLOCK)).map(|_| block()).collect::<Result<_, _>>()?;
        Ok(Self { blocks, precision })
    }

    /// Unpacks as many numbers as were asked for, all of which must be finite, on the caller's rayon pool.
    pub fn unpack(self, values: &mut [f64]) -> Result<(), IgiError> {
        let Self { blocks, precision } = self;
        let blocks = values.par_chunks_mut(BLOCK).zip(blocks);
        blocks
            .try_for_each_init(Vec::new, |planes, (values, packed)| unpack(packed, precision, planes, values))
    }

    /// Unpacks block `i`, which has as many numbers as are asked for; `planes` is room for its bytes.
    pub fn unpack_block(&self, i: usize, planes: &mut Vec<u8>, values: &mut [f64]) -> Result<(), IgiError> {
        unpack(self.blocks.get(i).copied().unwrap_or_default(), self.precision, planes, values)
    }
}

/// Unpacks a block; `planes` is room for its bytes.
fn unpack(
    packed: &[u8],
    precision: Precision,
    planes: &mut Vec<u8>,
    values: &mut [f64],
) -> Result<(), IgiError> {
    planes.resize(values.len() * precision.width(), 0);
    if lz4_flex::block::decompress_into(packed, planes).ok() != Some(planes.len()) {
        return Err(CANNOT_UNPACK);
    }
    match precision {
        Precision::Single => join(planes, values, |bytes| f32::from_le_bytes(bytes).into()),
        Precision::Double => join(planes, values, f64::from_le_bytes),
    }
    if values.iter().all(|v| v.is_finite()) {
        Ok(())
    } else {
        Err(IgiError::Malformed("a sum is not finite"))
    }
}

/// Makes numbers of bytes that are ordered by significance.
fn join<const WIDTH: usize>(planes: &[u8], values: &mut [f64], number: impl Fn([u8; WIDTH]) -> f64) {
    let n = values.len();
    // Equal lengths, seen by the compiler: no check for each byte.
    let planes: [&[u8]; WIDTH] = std::array::from_fn(|plane| &planes[plane * n..][..n]);
    for (i, value) in values.iter_mut().enumerate() {
        *value = number(planes.map(|plane| plane[i]));
    }
}

#[cfg(test)]
mod tests {
    use super::Precision::{Double, Single};
    use super::*;

    #[test]
    fn numbers_come_back_bit_for_bit() {
        for n in [0, 1, 7, BLOCK - 1, BLOCK, BLOCK + 5, 2 * BLOCK] {
            let values: Vec<f64> = (0..n).map(|i| (i as f64 * 0.37).sin() * 1e3 - 0.0).collect();
            let mut file = Vec::new();
            write(&mut file, Double, values.iter().copied()).unwrap();
            let (mut bytes, mut back) = (Bytes(&file), vec![0.0; n]);
            Packed::take(&mut bytes, Double, n).unwrap().unpack(&mut back).unwrap();
            assert_eq!(values, back);
            assert!(bytes.0.is_empty());
        }
    }

    #[test]
    fn what_is_not_a_number_is_refused() {
        let mut file = Vec::new();
        // Beyond single precision is infinity there.
        for (precision, bad) in [(Double, f64::NAN), (Single, f64::NAN), (Single, 1e39)] {
            file.clear();
            write(&mut file, precision, [1.0, bad].into_iter()).unwrap();
            let read = Packed::take(&mut Bytes(&file), precision, 2).unwrap().unpack(&mut [0.0; 2]);
            assert_eq!(read, Err(IgiError::Malformed("a sum is not finite")));
        }
    }

    #[test]
    fn missing_and_broken_blocks_are_refused() {
        let mut file = Vec::new();
        write(&mut file, Double, vec![1.5; BLOCK + 3].into_iter()).unwrap();
        let short = &file[..file.len() - 1];
        assert!(matches!(Packed::take(&mut Bytes(short), Double, BLOCK + 3), Err(IgiError::Truncated(_))));
        // One number fewer or more than the last block holds.
        for n in [BLOCK + 2, BLOCK + 4] {
            let packed = Packed::take(&mut Bytes(&file), Double, n).unwrap();
            assert_eq!(packed.unpack(&mut vec![0.0; n]), Err(CANNOT_UNPACK));
        }
    }
}
