//! Pictures for reports: tone-mapped, and maps of differences in standard errors.

use super::check::Area;
use super::codes;
use super::picture::Picture;
use super::png;
use super::statistics::Estimate;

/// Differences of so many standard errors have the deepest colours.
pub const DEEPEST: f64 = 5.0;

/// The colour of pixels that hold no numbers.
const BROKEN: [u8; 3] = [255, 0, 255];

/// Linear Rec. 709 of XYZ (IEC 61966-2-1).
fn linear([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ]
}

fn code(linear: f64) -> u8 {
    (255.0 * codes::encoded(linear.clamp(0.0, 1.0))).round() as u8
}

fn mean(pictures: &[Picture], i: usize) -> [f64; 3] {
    let sum = pictures.iter().fold([0.0; 3], |sum: [f64; 3], p| [0, 1, 2].map(|c| sum[c] + p.pixels[i][c]));
    sum.map(|s| s / pictures.len() as f64)
}

/// The luminance that is shown as white: three times the mean, or the brightest pixel where that is less.
pub fn white(pictures: &[Picture]) -> f64 {
    let luminance = |i: usize| mean(pictures, i)[1];
    let values: Vec<f64> = (0..pictures[0].pixels.len()).map(luminance).filter(|v| v.is_finite()).collect();
    if values.is_empty() {
        return 1.0;
    }
    let average = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().copied().fold(0.0, f64::max).min(3.0 * average).max(f64::MIN_POSITIVE)
}

/// The mean of pictures, as a data URI.
pub fn tone_mapped(pictures: &[Picture], white: f64) -> String {
    // A flat field is grey rather than white.
    let scale = 0.8 / white;
    encoded(pictures[0].size, |i| {
        let mean = mean(pictures, i);
        if mean.iter().all(|v| v.is_finite()) { linear(mean).map(|v| code(v * scale)) } else { BROKEN }
    })
}

/// How much brighter (warm) or darker (cold) pixels are than a value or than others' pixels, in standard errors.
pub fn difference(own: &[Picture], other: &Other) -> String {
    let luminance = |pictures: &[Picture], i: usize| {
        Estimate::of(&pictures.iter().map(|p| p.pixels[i][1]).collect::<Vec<_>>())
    };
    encoded(own[0].size, |i| {
        let a = luminance(own, i);
        let b = match other {
            Other::Value(value) => Estimate::exact(*value),
            Other::Pictures(pictures) => luminance(pictures, i),
        };
        let error = a.error.hypot(b.error);
        // What rounding alone can make is no difference.
        let excess = ((a.mean - b.mean).abs() - 1e-5 * b.mean.abs()).max(0.0).copysign(a.mean - b.mean);
        match (excess.is_finite() && error.is_finite(), excess == 0.0) {
            (false, _) => BROKEN,
            (_, true) => diverging(0.0),
            (_, false) => diverging(excess / error),
        }
    })
}

/// Areas of a picture in the colours of how many standard errors each deviates by; later ones lie over earlier ones.
pub fn deviations([width, height]: [usize; 2], areas: &[(Area, f64)]) -> String {
    encoded([width, height], |i| {
        let (x, y) = (i % width, i / width);
        let holds = |[x0, x1, y0, y1]: Area| (x0..x1).contains(&x) && (y0..y1).contains(&y);
        let last = areas.iter().rev().find(|(area, _)| holds(*area));
        last.map_or(diverging(0.0), |(_, t)| if t.is_nan() { BROKEN } else { diverging(*t) })
    })
}

/// What a picture is compared with.
pub enum Other<'a> {
    /// One luminance everywhere.
    Value(f64),
    /// Renders by others.
    Pictures(&'a [Picture]),
}

/// White at 0; orange above, blue below.
fn diverging(t: f64) -> [u8; 3] {
    let deep = if t >= 0.0 { [186.0, 72.0, 10.0] } else { [22.0, 92.0, 168.0] };
    let part = (t.abs() / DEEPEST).min(1.0);
    deep.map(|d| (248.0 + (d - 248.0) * part).round() as u8)
}

fn encoded(size: [usize; 2], pixel: impl Fn(usize) -> [u8; 3]) -> String {
    let bytes: Vec<u8> = (0..size[0] * size[1]).flat_map(pixel).collect();
    let rows: Vec<&[u8]> = bytes.chunks(3 * size[0]).collect();
    let mut file = vec![];
    png::write_rgb(size[0], &rows, &mut file).expect("memory takes every byte");
    format!("data:image/png;base64,{}", base64(&file))
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = (0..3).fold(0u32, |word, i| word << 8 | u32::from(chunk.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let letter = char::from(LETTERS[(word >> (18 - 6 * i) & 63) as usize]);
            text.push(if i <= chunk.len() { letter } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_standard_s_examples() {
        for (plain, coded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn what_is_no_number_is_shown() {
        let picture = |v: f64| Picture { size: [1, 1], pixels: vec![[v; 3]] };
        let shown = |v: f64| difference(&[picture(v), picture(v)], &Other::Value(1.0));
        let broken = encoded([1, 1], |_| BROKEN);
        assert_eq!([shown(f64::NAN), shown(f64::INFINITY)], [broken.clone(), broken.clone()]);
        assert_eq!(shown(1.0), encoded([1, 1], |_| [248; 3]));
        assert_eq!(tone_mapped(&[picture(f64::NAN)], white(&[picture(f64::NAN)])), broken);
    }

    #[test]
    fn areas_have_the_colours_of_their_deviations() {
        let shown = deviations([2, 1], &[([0, 2, 0, 1], 4.0), ([1, 2, 0, 1], f64::NAN)]);
        assert_eq!(shown, encoded([2, 1], |i| if i == 0 { diverging(4.0) } else { BROKEN }));
    }

    #[test]
    fn brighter_is_warm_and_darker_is_cold() {
        let [warm, none, cold] = [4.0, 0.0, -4.0].map(diverging);
        assert!(warm[0] > warm[2] && cold[2] > cold[0]);
        assert_eq!(none, [248; 3]);
    }
}
