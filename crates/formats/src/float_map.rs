//! `.float` pictures of HDR Shop: three little-endian 32-bit floats a texel and nothing else, rows from
//! the top. The file does not tell its size; whoever reads it must know.

use crate::error::{FormatError, Position};
use crate::image::{Image, Pixels};

/// Decodes a square picture of a known width.
///
/// # Errors
/// For a file of another size, or a width beyond what memory can hold.
pub fn decode(bytes: &[u8], width: u32) -> Result<Image, FormatError> {
    let expected = u128::from(width) * u128::from(width) * 12;
    if bytes.len() as u128 != expected || width == 0 {
        let side = (bytes.len() as f64 / 12.0).sqrt();
        let found = if side >= 1.0 && side.fract() == 0.0 {
            format!("{} bytes, which is a width of {side}", bytes.len())
        } else {
            format!("{} bytes", bytes.len())
        };
        return Err(FormatError::new(
            Position::Byte(0),
            format!("{expected} bytes: {width} x {width} texels of three 32-bit floats"),
            found,
        ));
    }
    let values = bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    Ok(Image {
        width,
        height: width,
        channels: 3,
        pixels: Pixels::F32(values),
        primaries: None,
        notes: vec![],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_come_in_order_and_the_size_must_fit() {
        let values: Vec<f32> = (0..12).map(|i| i as f32 * 0.5).collect();
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let image = decode(&bytes, 2).unwrap();
        assert_eq!((image.width, image.height, image.channels), (2, 2, 3));
        assert_eq!(image.pixels, Pixels::F32(values));
        let error = decode(&bytes, 3).unwrap_err();
        assert_eq!(
            error.to_string(),
            "byte 0: expected 108 bytes: 3 x 3 texels of three 32-bit floats, found 48 bytes, which is a width of 2"
        );
        assert!(decode(&bytes[..47], 2).is_err());
        assert!(decode(&[], 0).is_err());
        assert!(decode(&bytes, u32::MAX).is_err());
    }
}
