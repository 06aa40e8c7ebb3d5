//! Photometric data of lamps: IES LM-63 of 1986, 1991, 1995 and 2002.
//!
//! A file is lines of text up to `TILT=`, and from there numbers, apart by blanks, commas or line ends:
//!
//! 1. after `TILT=INCLUDE` the lamp's position, how many angles there are, the angles, and a factor for each;
//! 2. number of lamps, lumens of each (-1: absolute photometry), multiplier, how many vertical and how many
//!    horizontal angles there are, photometric type (1: C), unit (1: feet, 2: metres), width, length and
//!    height of the opening;
//! 3. ballast factor, ballast-lamp factor, watts;
//! 4. the vertical angles, the horizontal angles, and for each of the latter the candelas at all of the former.
//!
//! The intensity is candela · multiplier · both ballast factors. Factors for tilt are for lamps that are
//! tilted by their mounting, which a fixed lamp in a scene is not: they are read and left out. Lumens do not
//! scale anything.

mod words;

use crate::error::FormatError;
use words::Words;

/// How the intensity of a lamp depends on the direction, by photometry of type C.
#[derive(Clone, Debug, PartialEq)]
pub struct Photometry {
    /// Angles from the axis of the lamp in degrees, ascending, from 0 to 90 or 180.
    pub vertical_deg: Vec<f64>,
    /// Angles round it in degrees: one alone, or ascending from 0 to 90, 180 or 360 or from 90 to 270.
    pub horizontal_deg: Vec<f64>,
    /// Luminous intensity, all factors in, in cd: for each horizontal angle in turn one for each vertical.
    pub candela: Vec<f64>,
}

/// How far an angle that must be 0, 90, 180 or 360 degrees may be off: the rounding of a file's decimals.
const ANGLE_ROUNDING: f64 = 1e-3;

/// The largest intensity that a lamp may have, cd: lighthouses have some millions.
const MOST_CANDELA: f64 = 1e12;

/// Decodes a file.
///
/// # Errors
/// With line and column of what is not as the format asks, or is not of the kinds above.
pub fn decode(bytes: &[u8]) -> Result<Photometry, FormatError> {
    let mut words = Words::after_header(bytes)?;
    if words.is_tilt_included {
        skip_tilt(&mut words)?;
    }
    words.number("the number of lamps", "above 0", |v| v > 0.0)?;
    words.number("lumens of a lamp", "above 0, or -1", |v| v > 0.0 || v == -1.0)?;
    let multiplier = words.number("the multiplier", "above 0", |v| v > 0.0)?;
    let verticals = words.count("the number of vertical angles", 2)?;
    let horizontals = words.count("the number of horizontal angles", 1)?;
    words.number("the photometric type", "1 (type C; A and B are not supported)", |v| v == 1.0)?;
    words.number("the unit", "1 (feet) or 2 (metres)", |v| v == 1.0 || v == 2.0)?;
    for side in ["the width", "the length", "the height"] {
        words.number(side, "a finite number", |_| true)?;
    }
    let ballast = words.number("the ballast factor", "above 0", |v| v > 0.0)?;
    let lamp = words.number("the ballast-lamp factor", "above 0", |v| v > 0.0)?;
    words.number("the input watts", "0 or more", |v| v >= 0.0)?;
    let vertical_deg = vertical_angles(&mut words, verticals)?;
    let horizontal_deg = horizontal_angles(&mut words, horizontals)?;
    let factor = multiplier * ballast * lamp;
    let mut candela = vec![];
    for _ in 0..verticals.saturating_mul(horizontals) {
        let expected = "0 or more, and with all factors 1e12 at most";
        candela
            .push(words.number("candelas", expected, |v| v >= 0.0 && v * factor <= MOST_CANDELA)? * factor);
    }
    Ok(Photometry { vertical_deg, horizontal_deg, candela })
}

fn skip_tilt(words: &mut Words) -> Result<(), FormatError> {
    words.number("the lamp's position to the luminaire", "1, 2 or 3", |v| [1.0, 2.0, 3.0].contains(&v))?;
    let pairs = words.count("the number of tilt angles", 1)?;
    for _ in 0..pairs {
        words.number("a tilt angle", "a finite number", |_| true)?;
    }
    for _ in 0..pairs {
        words.number("a tilt factor", "0 or more", |v| v >= 0.0)?;
    }
    Ok(())
}

fn is_angle(v: f64, angles: &[f64]) -> bool {
    angles.iter().any(|a| (v - a).abs() <= ANGLE_ROUNDING)
}

fn vertical_angles(words: &mut Words, count: usize) -> Result<Vec<f64>, FormatError> {
    let mut angles = vec![];
    for i in 0..count {
        let before = angles.last().copied();
        let angle = if i == 0 {
            words.number("the first vertical angle", "0", |v| is_angle(v, &[0.0]))?
        } else if i + 1 == count {
            words.number("the last vertical angle", "90 or 180", |v| {
                is_angle(v, &[90.0, 180.0]) && Some(v) > before
            })?
        } else {
            words.number("a vertical angle", "larger than the one before", |v| Some(v) > before)?
        };
        angles.push(angle);
    }
    Ok(angles)
}

fn horizontal_angles(words: &mut Words, count: usize) -> Result<Vec<f64>, FormatError> {
    if count == 1 {
        return Ok(vec![words.number("the horizontal angle", "a finite number", |_| true)?]);
    }
    let mut angles: Vec<f64> = vec![];
    for i in 0..count {
        let before = angles.last().copied();
        let from_90 = angles.first().is_some_and(|&a| a > 45.0);
        let angle = if i == 0 {
            words.number("the first horizontal angle", "0 or 90", |v| is_angle(v, &[0.0, 90.0]))?
        } else if i + 1 < count {
            words.number("a horizontal angle", "larger than the one before", |v| Some(v) > before)?
        } else if from_90 {
            words.number("the last horizontal angle", "270, after a first of 90", |v| {
                is_angle(v, &[270.0]) && Some(v) > before
            })?
        } else {
            words.number("the last horizontal angle", "90, 180 or 360", |v| {
                is_angle(v, &[90.0, 180.0, 360.0]) && Some(v) > before
            })?
        };
        angles.push(angle);
    }
    Ok(angles)
}

#[cfg(test)]
mod tests;
