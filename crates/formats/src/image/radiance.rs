//! Radiance pictures (`.hdr`, `.pic`), as G. Ward's "Radiance File Formats" has them: lines of text up to an empty one,
//! a line with the sides, and the texels, which the crate `image` decodes.
//!
//! The header counts: values were multiplied by all numbers behind `EXPOSURE=` and `COLORCORR=`, and divided by them
//! are radiance again. `PRIMARIES=` tells the chromaticities of red, green, blue and white. Only what stands at the
//! beginning of a line counts: the headers of pictures that a picture was made of stand indented in its own.

use std::io::Read;

use ::image::DynamicImage;
use ::image::codecs::hdr::HdrDecoder;

use super::{Image, Pixels, Primaries, check_memory, check_sides, decoder_error};
use crate::error::{FormatError, Position};

/// How every Radiance picture begins; the name of a program follows.
pub(super) const MAGIC: &[u8] = b"#?";

/// What the lines of text say.
#[derive(Debug)]
struct Header {
    /// What the values were multiplied by, for each channel.
    factors: [f64; 3],
    primaries: Option<Primaries>,
    scan: Scan,
}

/// The order of the texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Scan {
    /// How many scanlines there are, and texels in each.
    lines: u32,
    length: u32,
    /// Whether scanlines are columns of the picture.
    is_upright: bool,
    /// Whether x runs to the left, and y upwards.
    is_turned: [bool; 2],
}

pub(super) fn decode(bytes: &[u8], most_bytes: u64) -> Result<Image, FormatError> {
    let (header, texels) = read_header(bytes)?;
    let Scan { lines, length, .. } = header.scan;
    check_sides(length.into(), lines.into())?;
    // Three floats a texel, and what is turned is copied.
    let texel_bytes = if header.scan.is_usual() { 12 } else { 24 };
    check_memory(u64::from(length) * u64::from(lines) * texel_bytes, most_bytes)?;
    // The decoder knows one magic, and pictures that lie as most do.
    let head = format!("#?RADIANCE\n\n-Y {lines} +X {length}\n");
    let complaint = |error: ::image::ImageError| decoder_error("HDR", &error);
    let decoder = HdrDecoder::new(head.as_bytes().chain(texels)).map_err(complaint)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(complaint)?;
    let mut values = header.scan.in_rows(picture.into_rgb32f().into_raw());
    if header.factors != [1.0; 3] {
        for (value, factor) in values.iter_mut().zip(header.factors.iter().cycle()) {
            *value = (f64::from(*value) / factor) as f32;
        }
    }
    let (width, height) = if header.scan.is_upright { (lines, length) } else { (length, lines) };
    let primaries = header.primaries;
    Ok(Image { width, height, channels: 3, pixels: Pixels::F32(values), primaries, notes: vec![] })
}

/// The header, and what follows it.
fn read_header(bytes: &[u8]) -> Result<(Header, &[u8]), FormatError> {
    let (mut factors, mut primaries) = ([1.0; 3], None);
    let mut rest = bytes;
    for number in 1.. {
        let line = take_line(&mut rest).ok_or_else(|| error(number, "an empty line after the header", ""))?;
        if number == 1 && !line.starts_with("#?") {
            return Err(error(number, "#?RADIANCE", &line));
        }
        if line.is_empty() {
            let line = take_line(&mut rest).unwrap_or_default();
            let scan = Scan::read(&line).ok_or_else(|| {
                error(number + 1, "the sides of the picture, such as -Y 512 +X 1024", &line)
            })?;
            return Ok((Header { factors, primaries, scan }, rest));
        }
        let Some((key, value)) = line.split_once('=') else { continue };
        match key {
            "FORMAT" if value.trim() != "32-bit_rle_rgbe" => {
                return Err(error(number, "FORMAT=32-bit_rle_rgbe (others are not supported)", &line));
            }
            "EXPOSURE" => {
                let by = numbers::<1>(value).filter(|by| are_factors(by));
                let [by] = by.ok_or_else(|| error(number, "EXPOSURE= and a number above 0", &line))?;
                factors = factors.map(|f| f * by);
            }
            "COLORCORR" => {
                let by = numbers::<3>(value).filter(|by| are_factors(by));
                let [r, g, b] =
                    by.ok_or_else(|| error(number, "COLORCORR= and three numbers above 0", &line))?;
                let [red, green, blue] = factors;
                factors = [red * r, green * g, blue * b];
            }
            "PRIMARIES" => {
                let of = numbers::<8>(value).map(|[a, b, c, d, e, f, g, h]| [[a, b], [c, d], [e, f], [g, h]]);
                primaries = Some(of.ok_or_else(|| error(number, "PRIMARIES= and eight numbers", &line))?);
            }
            _ => {}
        }
        if !are_factors(&factors) {
            return Err(error(number, "exposures whose product is a number above 0", &line));
        }
    }
    Err(error(1, "a header that ends", ""))
}

/// The next line without its end; `None` where there is none.
fn take_line(rest: &mut &[u8]) -> Option<String> {
    let end = rest.iter().position(|&b| b == b'\n')?;
    let (line, behind) = rest.split_at(end);
    *rest = behind.get(1..).unwrap_or_default();
    Some(String::from_utf8_lossy(line).trim_end_matches('\r').to_owned())
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let all: Option<Vec<f64>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    all?.try_into().ok()
}

/// Whether values can be divided by these in double precision and remain what they are.
fn are_factors(by: &[f64]) -> bool {
    by.iter().all(|f| (1e-30..=1e30).contains(f))
}

fn error(line: usize, expected: &str, found: &str) -> FormatError {
    const MOST: usize = 40;
    let found = if found.is_empty() {
        "the end of it".to_owned()
    } else {
        format!("'{}'", found.chars().take(MOST).collect::<String>())
    };
    FormatError::new(Position::Text { line, column: 1 }, expected, found)
}

impl Scan {
    /// From a line such as `-Y 512 +X 1024`: scanlines from the top, and texels from the left.
    fn read(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let &[first, lines, second, length] = words.as_slice() else { return None };
        let is_upright = first.ends_with('X');
        let (x, y) = if is_upright { (first, second) } else { (second, first) };
        let is_turned = [
            match x {
                "+X" => false,
                "-X" => true,
                _ => return None,
            },
            match y {
                "-Y" => false,
                "+Y" => true,
                _ => return None,
            },
        ];
        Some(Self { lines: lines.parse().ok()?, length: length.parse().ok()?, is_upright, is_turned })
    }

    /// Whether scanlines are rows from the top, and texels run from the left.
    fn is_usual(self) -> bool {
        !self.is_upright && self.is_turned == [false; 2]
    }

    /// The values of scanlines in rows from the top.
    fn in_rows(self, scanlines: Vec<f32>) -> Vec<f32> {
        if self.is_usual() {
            return scanlines;
        }
        let (lines, length) = (self.lines as usize, self.length as usize);
        let (width, height) = if self.is_upright { (lines, length) } else { (length, lines) };
        let texels = scanlines.as_chunks::<3>().0;
        let [is_left, is_up] = self.is_turned;
        let place = |k: usize| {
            let (x, y) = (k % width, k / width);
            let x = if is_left { width - 1 - x } else { x };
            let y = if is_up { height - 1 - y } else { y };
            if self.is_upright { x * length + y } else { y * length + x }
        };
        let mut rows = Vec::with_capacity(scanlines.len());
        rows.extend((0..width * height).flat_map(|k| texels.get(place(k)).copied().unwrap_or_default()));
        rows
    }
}
