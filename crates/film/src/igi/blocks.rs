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
/// Components of a pixel's sum.
const COMPONENTS: usize = 4;
/// Bytes of a pixel's sum in single precision.
const PIXEL: usize = COMPONENTS * size_of::<f32>();

/// How numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Precision {
    /// As `f32`, of whole pixels of four components. Each byte of each component is a piece for itself, and is left as it is
    /// where LZ4 gains nothing, as with most bytes of random sums: these need not be unpacked.
    Single,
    /// As `f64`, all bytes of a block in one piece.
    Double,
}

impl Precision {
    /// Pieces of a block.
    const fn pieces(self) -> usize {
        match self {
            Self::Single => PIXEL,
            Self::Double => 1,
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
        let block = values.by_ref().take(n);
        match precision {
            Precision::Single => {
                planes.resize(n * size_of::<f32>(), 0);
                fill_by_component(&mut planes, n, block);
                for plane in planes.chunks(n / COMPONENTS) {
                    let packed = pack(plane, &mut packed)?;
                    write_piece(out, if packed.len() < plane.len() { packed } else { plane })?;
                }
            }
            Precision::Double => {
                planes.resize(n * size_of::<f64>(), 0);
                fill(&mut planes, n, block);
                write_piece(out, pack(&planes, &mut packed)?)?;
            }
        }
    }
    Ok(())
}

/// Packs bytes; `room` is for what comes of it.
fn pack<'a>(bytes: &[u8], room: &'a mut Vec<u8>) -> io::Result<&'a [u8]> {
    room.resize(lz4_flex::block::get_maximum_output_size(bytes.len()), 0);
    let length = lz4_flex::block::compress_into(bytes, room).map_err(io::Error::other)?;
    Ok(&room[..length])
}

fn write_piece(out: &mut impl Write, piece: &[u8]) -> io::Result<()> {
    out.write_all(&(piece.len() as u32).to_le_bytes())?;
    out.write_all(piece)
}

/// Orders the bytes of `n` numbers by significance.
fn fill(planes: &mut [u8], n: usize, numbers: impl Iterator<Item = f64>) {
    for (i, number) in numbers.enumerate() {
        for (plane, byte) in number.to_le_bytes().into_iter().enumerate() {
            planes[plane * n + i] = byte;
        }
    }
}

/// The same of `n` numbers as `f32`, component by component.
fn fill_by_component(planes: &mut [u8], n: usize, numbers: impl Iterator<Item = f64>) {
    let pixels = n / COMPONENTS;
    for (i, number) in numbers.enumerate() {
        let (pixel, component) = (i / COMPONENTS, i % COMPONENTS);
        for (plane, byte) in (number as f32).to_le_bytes().into_iter().enumerate() {
            planes[(component * size_of::<f32>() + plane) * pixels + pixel] = byte;
        }
    }
}

/// Room for a block on its way.
#[derive(Default)]
pub(super) struct Scratch {
    planes: Vec<u8>,
    singles: Vec<f32>,
}

/// Blocks of a file, not unpacked yet.
pub(super) struct Packed<'a> {
    /// Of all blocks.
    pieces: Vec<&'a [u8]>,
    precision: Precision,
}

impl<'a> Packed<'a> {
    /// The next blocks, of `n` numbers in all.
    pub fn take(bytes: &mut Bytes<'a>, precision: Precision, n: usize) -> Result<Self, IgiError> {
        const WHAT: &str = "a block of sums";
        let mut piece = || {
            let length = bytes.u32(WHAT)? as usize;
            bytes.take(length, WHAT)
        };
        let pieces = n.div_ceil(BLOCK) * precision.pieces();
        Ok(Self { pieces: (0..pieces).map(|_| piece()).collect::<Result<_, _>>()?, precision })
    }

    /// Unpacks as many numbers as were asked for, all of which must be finite, on the caller's rayon pool.
    pub fn unpack(self, values: &mut [f64]) -> Result<(), IgiError> {
        let blocks = values.par_chunks_mut(BLOCK).enumerate();
        blocks
            .try_for_each_init(Scratch::default, |scratch, (i, values)| self.unpack_block(i, scratch, values))
    }

    /// Sees that block `i` holds `n` finite numbers.
    pub fn check_block(&self, i: usize, scratch: &mut Scratch, n: usize) -> Result<(), IgiError> {
        match self.precision {
            Precision::Single => single_planes(self.block(i), &mut scratch.planes, n).map(drop),
            Precision::Double => double_planes(self.block(i), &mut scratch.planes, n).map(drop),
        }
    }

    /// Unpacks block `i`, which has as many numbers as are asked for.
    pub fn unpack_block(&self, i: usize, scratch: &mut Scratch, values: &mut [f64]) -> Result<(), IgiError> {
        self.put_block(i, scratch, values, |old, value| *old = value)
    }

    /// Adds block `i` to as many sums.
    pub fn add_block(&self, i: usize, scratch: &mut Scratch, sums: &mut [f64]) -> Result<(), IgiError> {
        self.put_block(i, scratch, sums, |sum, value| *sum += value)
    }

    /// Does something with what is there and each number of block `i`.
    fn put_block(
        &self,
        i: usize,
        scratch: &mut Scratch,
        values: &mut [f64],
        put: impl Fn(&mut f64, f64),
    ) -> Result<(), IgiError> {
        let Scratch { planes, singles } = scratch;
        match self.precision {
            Precision::Single => {
                let planes = single_planes(self.block(i), planes, values.len())?;
                join_components(planes, singles, values, put);
            }
            Precision::Double => {
                let planes = double_planes(self.block(i), planes, values.len())?;
                join(planes, values, |value, bytes| put(value, f64::from_le_bytes(bytes)));
            }
        }
        Ok(())
    }

    /// The pieces of block `i`.
    fn block(&self, i: usize) -> &[&'a [u8]] {
        let pieces = self.precision.pieces();
        self.pieces.chunks_exact(pieces).nth(i).unwrap_or_default()
    }
}

/// The bytes of a block of `n` numbers of double precision, by significance; all numbers are finite.
fn double_planes<'a>(
    pieces: &[&[u8]],
    room: &'a mut Vec<u8>,
    n: usize,
) -> Result<[&'a [u8]; size_of::<f64>()], IgiError> {
    room.resize(n * size_of::<f64>(), 0);
    unpack(pieces.first().copied().unwrap_or_default(), room)?;
    let room: &[u8] = room;
    let planes: [&[u8]; _] = std::array::from_fn(|plane| &room[plane * n..][..n]);
    check_finite(planes[6], planes[7], 0xf0)?;
    Ok(planes)
}

/// The bytes of a block of `n` numbers of single precision, by component and significance; all numbers are finite.
fn single_planes<'a>(
    pieces: &[&'a [u8]],
    room: &'a mut Vec<u8>,
    n: usize,
) -> Result<[&'a [u8]; PIXEL], IgiError> {
    let pixels = n / COMPONENTS;
    room.resize(n * size_of::<f32>(), 0);
    let mut planes: [&[u8]; PIXEL] = [&[]; PIXEL];
    let rooms = room.chunks_exact_mut(pixels.max(1));
    for ((plane, piece), room) in planes.iter_mut().zip(pieces).zip(rooms) {
        *plane = if piece.len() == pixels {
            piece
        } else {
            unpack(piece, room)?;
            room
        };
    }
    if planes.iter().any(|plane| plane.len() != pixels) {
        return Err(CANNOT_UNPACK);
    }
    for component in planes.chunks_exact(size_of::<f32>()) {
        check_finite(component[2], component[3], 0x80)?;
    }
    Ok(planes)
}

/// Unpacks a piece that fills all of `room`.
fn unpack(piece: &[u8], room: &mut [u8]) -> Result<(), IgiError> {
    if lz4_flex::block::decompress_into(piece, room).ok() == Some(room.len()) {
        Ok(())
    } else {
        Err(CANNOT_UNPACK)
    }
}

/// Whether numbers are finite by their two most significant bytes, the last but one of which has these bits of the exponent.
fn check_finite(next: &[u8], last: &[u8], low: u8) -> Result<(), IgiError> {
    let bad = |(next, last): (&u8, &u8)| u8::from(last & 0x7f == 0x7f) & u8::from(next & low == low);
    // Without an early end, so that it is done for many at a time.
    if next.iter().zip(last).fold(0, |any, pair| any | bad(pair)) == 0 {
        Ok(())
    } else {
        Err(IgiError::Malformed("a sum is not finite"))
    }
}

/// Makes numbers of bytes that are ordered by significance, and puts them where they belong.
fn join<const WIDTH: usize, T>(planes: [&[u8]; WIDTH], values: &mut [T], put: impl Fn(&mut T, [u8; WIDTH])) {
    let n = values.len();
    // Equal lengths, seen by the compiler: no check for each byte.
    let planes = planes.map(|plane| &plane[..n]);
    for (i, value) in values.iter_mut().enumerate() {
        put(value, planes.map(|plane| plane[i]));
    }
}

/// Makes pixels of what [`fill_by_component`] has written. In two steps, each of which is done for many at a time.
fn join_components(
    planes: [&[u8]; PIXEL],
    singles: &mut Vec<f32>,
    values: &mut [f64],
    put: impl Fn(&mut f64, f64),
) {
    let (pixels, _) = values.as_chunks_mut::<COMPONENTS>();
    let n = pixels.len();
    singles.resize(n * COMPONENTS, 0.0);
    let (components, _) = planes.as_chunks::<{ size_of::<f32>() }>();
    for (planes, singles) in components.iter().zip(singles.chunks_exact_mut(n.max(1))) {
        join(*planes, singles, |single, bytes| *single = f32::from_le_bytes(bytes));
    }
    let components: [&[f32]; COMPONENTS] = std::array::from_fn(|component| &singles[component * n..][..n]);
    for (i, pixel) in pixels.iter_mut().enumerate() {
        for (value, component) in pixel.iter_mut().zip(&components) {
            put(value, component[i].into());
        }
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
    fn pixels_come_back_in_single_precision() {
        for pixels in [1, 7, BLOCK / 4, BLOCK / 4 + 3] {
            // A component that is alike for all, which is packed, and others that are not.
            let values: Vec<f64> = (0..4 * pixels)
                .map(|i| if i % 4 == 3 { 2.0 } else { f64::from(((i as f64 * 0.37).sin() * 1e3) as f32) })
                .collect();
            let mut file = Vec::new();
            write(&mut file, Single, values.iter().copied()).unwrap();
            assert!(pixels < 7 || file.len() < 15 * pixels + 1000, "{pixels}: {}", file.len());
            let packed = Packed::take(&mut Bytes(&file), Single, 4 * pixels).unwrap();
            let mut sums = vec![1.0; 4 * pixels];
            let mut scratch = Scratch::default();
            for (i, sums) in sums.chunks_mut(BLOCK).enumerate() {
                packed.check_block(i, &mut scratch, sums.len()).unwrap();
                packed.add_block(i, &mut scratch, sums).unwrap();
            }
            assert!(sums.iter().zip(&values).all(|(sum, value)| *sum == 1.0 + value));
            let mut back = vec![0.0; 4 * pixels];
            packed.unpack(&mut back).unwrap();
            assert_eq!(values, back);
        }
    }

    #[test]
    fn what_is_not_a_number_is_refused() {
        let mut file = Vec::new();
        // Beyond single precision is infinity there.
        for (precision, bad) in [(Double, f64::NAN), (Single, f64::NAN), (Single, 1e39)] {
            file.clear();
            write(&mut file, precision, [1.0, 2.0, bad, -0.5].into_iter()).unwrap();
            let read = Packed::take(&mut Bytes(&file), precision, 4).unwrap().unpack(&mut [0.0; 4]);
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
