//! The smallest PNG writer: 8-bit RGB, not compressed. For difference maps, not for pictures.

use std::io::{self, Write};

/// A stored deflate block holds at most this many bytes (RFC 1951, 3.2.4).
const STORED_MAX: usize = 65_535;

/// Writes rows of interleaved RGB bytes, each `width` pixels, as a PNG (ISO/IEC 15948).
pub fn write_rgb(width: usize, rows: &[&[u8]], sink: &mut dyn Write) -> io::Result<()> {
    let size = |n: usize| u32::try_from(n).map_err(|_| io::Error::from(io::ErrorKind::InvalidInput));
    let mut header = Vec::with_capacity(13);
    header.extend(size(width)?.to_be_bytes());
    header.extend(size(rows.len())?.to_be_bytes());
    // Bit depth 8, colour type 2 (RGB), deflate, adaptive filters, no interlace.
    header.extend([8, 2, 0, 0, 0]);
    let mut raw = Vec::with_capacity(rows.len() * (3 * width + 1));
    for row in rows {
        raw.push(0); // filter: none
        raw.extend_from_slice(row);
        // A ragged last row is filled with white.
        raw.resize(raw.len() + (3 * width).saturating_sub(row.len()), 255);
    }
    sink.write_all(b"\x89PNG\r\n\x1a\n")?;
    write_chunk(*b"IHDR", &header, sink)?;
    write_chunk(*b"IDAT", &zlib_stored(&raw), sink)?;
    write_chunk(*b"IEND", &[], sink)
}

fn write_chunk(kind: [u8; 4], data: &[u8], sink: &mut dyn Write) -> io::Result<()> {
    let length = u32::try_from(data.len()).map_err(|_| io::Error::from(io::ErrorKind::InvalidInput))?;
    sink.write_all(&length.to_be_bytes())?;
    sink.write_all(&kind)?;
    sink.write_all(data)?;
    sink.write_all(&crc32(kind.iter().chain(data)).to_be_bytes())
}

/// A zlib stream (RFC 1950) of stored blocks.
fn zlib_stored(raw: &[u8]) -> Vec<u8> {
    let mut out = vec![0x78, 0x01];
    let last = raw.len().div_ceil(STORED_MAX).saturating_sub(1);
    for (i, block) in raw.chunks(STORED_MAX).enumerate() {
        let length = block.len() as u16;
        out.push(u8::from(i == last));
        out.extend(length.to_le_bytes());
        out.extend((!length).to_le_bytes());
        out.extend_from_slice(block);
    }
    out.extend(adler32(raw).to_be_bytes());
    out
}

fn adler32(data: &[u8]) -> u32 {
    let (mut a, mut b) = (1u32, 0u32);
    for &byte in data {
        a = (a + u32::from(byte)) % 65_521;
        b = (b + a) % 65_521;
    }
    b << 16 | a
}

/// The CRC of ISO 3309, bit by bit: slow, and fast enough for maps.
fn crc32<'a>(data: impl Iterator<Item = &'a u8>) -> u32 {
    let mut crc = u32::MAX;
    for &byte in data {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ (0xedb8_8320 & 0u32.wrapping_sub(crc & 1));
        }
    }
    !crc
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_of_the_standards() {
        assert_eq!(crc32(b"123456789".iter()), 0xcbf4_3926);
        assert_eq!(adler32(b"Wikipedia"), 0x11e6_0398);
    }

    #[test]
    fn stored_blocks_hold_every_byte() {
        let raw: Vec<u8> = (0..150_000u32).map(|i| i as u8).collect();
        let stream = zlib_stored(&raw);
        // Three blocks of five header bytes each, two of zlib's and four of its checksum.
        assert_eq!(stream.len(), raw.len() + 3 * 5 + 6);
        assert_eq!(stream[2], 0);
        assert_eq!(stream[2 + 2 * (STORED_MAX + 5)], 1);
    }
}
