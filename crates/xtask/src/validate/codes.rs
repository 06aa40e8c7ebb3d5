//! The codes of a picture for screens, beside the luminances that it was made of.

use std::path::Path;

use super::picture::read_rgb;

/// How far from a code a number may be and still be rounded to it: half, and what single precision may make of it.
const NEAREST: f64 = 0.5 + 0.005;

/// How many codes of a PNG are not the nearest to the transfer function of sRGB of the luminances in an EXR, times a scale.
///
/// # Errors
/// Files that cannot be read, or are of different sizes.
pub fn wrong(linear: &Path, screen: &Path, scale: f64) -> Result<usize, String> {
    let (size, pixels) = read_rgb(linear)?;
    let (shown, codes) = read(screen)?;
    if shown != size {
        return Err(format!("{}: {shown:?} pixels, of which there are {size:?}", screen.display()));
    }
    let numbers = pixels.iter().flatten().map(|v| v * scale);
    Ok(numbers.zip(codes).filter(|(number, code)| !is_nearest(*number, *code)).count())
}

fn is_nearest(number: f64, code: u8) -> bool {
    (255.0 * encoded(number.clamp(0.0, 1.0)) - f64::from(code)).abs() <= NEAREST
}

/// The transfer function of sRGB (IEC 61966-2-1).
pub fn encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Columns and rows, and red, green and blue of each pixel, of a PNG of eight bits.
fn read(path: &Path) -> Result<([usize; 2], Vec<u8>), String> {
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let file = std::fs::File::open(path).map_err(|error| fault(&error))?;
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(file)).read_info().map_err(|error| fault(&error))?;
    let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(|| fault(&"too large"))?];
    let info = reader.next_frame(&mut bytes).map_err(|error| fault(&error))?;
    let samples = match (info.color_type, info.bit_depth) {
        (png::ColorType::Rgb, png::BitDepth::Eight) => 3,
        (png::ColorType::Rgba, png::BitDepth::Eight) => 4,
        (kind, depth) => return Err(fault(&format!("{kind:?} of {depth:?} bits"))),
    };
    let pixels = bytes[..info.buffer_size()].chunks_exact(samples);
    Ok(([info.width as usize, info.height as usize], pixels.flat_map(|pixel| pixel[..3].to_vec()).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Middle grey of 0.2140 is the code 127.5, and a code off by one is told.
    #[test]
    fn codes_are_the_nearest() {
        assert!((255.0 * encoded(0.214_041) - 127.5).abs() < 1e-3);
        assert_eq!([0, 255].map(|code| is_nearest(f64::from(code) / 255.0, code)), [true, true]);
        assert!(is_nearest(2.0, 255) && is_nearest(-1.0, 0));
        let code = (255.0 * encoded(0.18)).round() as u8;
        assert!(is_nearest(0.18, code) && !is_nearest(0.18, code + 1) && !is_nearest(0.18, code - 1));
        // A power of 2.2 in its place is another code.
        assert!(!is_nearest(0.05, (255.0 * 0.05f64.powf(1.0 / 2.2)).round() as u8));
    }
}
