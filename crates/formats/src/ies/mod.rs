//! Photometric data of lamps: IES LM-63 of 1986, 1991, 1995, 2002 and 2019.
//!
//! A file is lines of text up to `TILT=`, and from there numbers, apart by blanks, commas or line ends:
//!
//! 1. after `TILT=INCLUDE`, the lamp's position, how many angles there are, the angles, and a factor for each;
//! 2. number of lamps, lumens of each (-1: absolute photometry), multiplier, how many vertical and how many
//!    horizontal angles there are, photometric type (1: C), unit (1: feet, 2: metres), width, length and
//!    height of the opening;
//! 3. ballast factor, ballast-lamp factor (in the edition of 2019 the file generation type), watts;
//! 4. the vertical angles, the horizontal angles, and for each of the latter the candelas at all of the former.
//!
//! and nothing behind them: a count that does not come out says that the numbers are not what they seem.
//!
//! The intensity is candela · multiplier · both ballast factors. The file generation type is no factor, though it
//! looks like one: 1.1 says that the data were measured by an accredited laboratory. Factors for tilt are for lamps
//! that are tilted by their mounting, which a fixed lamp in a scene is not: they are read and left out, and where they
//! stand in another file that is not asked for. Lumens do not scale anything.

mod words;

use crate::error::{FormatError, Position};
use words::{Tilt, Words};

/// How the intensity of a lamp depends on the direction, by photometry of type C.
#[derive(Clone, Debug, PartialEq)]
pub struct Photometry {
    /// Angles from the axis of the lamp in degrees, ascending, from 0 to 90 or 180.
    pub vertical_deg: Vec<f64>,
    /// Angles round it in degrees: one alone, or ascending from 0 to 90, 180 or 360 or from 90 to 270.
    pub horizontal_deg: Vec<f64>,
    /// Luminous intensity, all factors in, in cd: for each horizontal angle in turn one for each vertical.
    pub candela: Vec<f64>,
    /// What the user of the file should know, and where it stands.
    pub notes: Vec<(Position, String)>,
}

/// How far an angle that must be 0, 90, 180 or 360 degrees may be off: the rounding of a file's decimals.
const ANGLE_ROUNDING: f64 = 1e-3;

/// The largest intensity that a lamp may have, cd: lighthouses have some millions.
const MOST_CANDELA: f64 = 1e12;

/// How far, as a part of the largest of all, intensities at 0 and at 360 degrees may be apart: what the measurement of
/// a lamp is good to.
const SEAM: f64 = 1e-3;

/// Decodes a file.
///
/// # Errors
/// With line and column of what is not as the format asks, or is not of the kinds above.
pub fn decode(bytes: &[u8]) -> Result<Photometry, FormatError> {
    let (header, mut words) = Words::after_header(bytes)?;
    let mut notes = vec![];
    match header.tilt {
        Tilt::None => {}
        Tilt::Included => skip_tilt(&mut words)?,
        Tilt::File(name) => {
            let note =
                format!("the factors for tilt in '{name}' are left out: they do not apply to a fixed lamp");
            notes.push((header.tilt_place, note));
        }
    }
    words.number("the number of lamps", "above 0", |v| v > 0.0)?;
    words.number("lumens of a lamp", "0 or more, or -1", |v| v >= 0.0 || v == -1.0)?;
    let multiplier = words.number("the multiplier", "above 0", |v| v > 0.0)?;
    let verticals = words.count("the number of vertical angles", 2)?;
    let horizontals = words.count("the number of horizontal angles", 1)?;
    words.number("the photometric type", "1 (type C; A and B are not supported)", |v| v == 1.0)?;
    words.number("the unit", "1 (feet) or 2 (metres)", |v| v == 1.0 || v == 2.0)?;
    for side in ["the width", "the length", "the height"] {
        words.number(side, "a finite number", |_| true)?;
    }
    let ballast = words.number("the ballast factor", "above 0", |v| v > 0.0)?;
    let lamp = if header.is_of_2019 {
        words.number("the file generation type", "above 0", |v| v > 0.0)?;
        1.0
    } else {
        words.number("the ballast-lamp factor", "above 0", |v| v > 0.0)?
    };
    words.number("the input watts", "0 or more", |v| v >= 0.0)?;
    let vertical_deg = vertical_angles(&mut words, verticals)?;
    let horizontal_deg = horizontal_angles(&mut words, horizontals)?;
    let mut columns = vec![];
    for _ in 0..horizontals {
        columns.push(column(&mut words, verticals, multiplier * ballast * lamp)?);
    }
    words.end(&format!("{verticals} x {horizontals} candelas"))?;
    notes.extend(odd(&columns, &horizontal_deg));
    let candela = columns.into_iter().flat_map(|(_, candela)| candela).collect();
    Ok(Photometry { vertical_deg, horizontal_deg, candela, notes })
}

/// The intensities at one horizontal angle, and where the first of them stands.
fn column(words: &mut Words, verticals: usize, factor: f64) -> Result<(Position, Vec<f64>), FormatError> {
    let mut candela = vec![];
    let mut place = words.place;
    for i in 0..verticals {
        let expected = "0 or more, and with all factors 1e12 at most";
        let value = words.number("candelas", expected, |v| v >= 0.0 && v * factor <= MOST_CANDELA)?;
        candela.push(value * factor);
        if i == 0 {
            place = words.place;
        }
    }
    Ok((place, candela))
}

/// Intensities that are as the format asks, but hardly what their author meant.
fn odd(columns: &[(Position, Vec<f64>)], horizontal_deg: &[f64]) -> Option<(Position, String)> {
    let ((first_place, first), (last_place, last)) = (columns.first()?, columns.last()?);
    let largest = columns.iter().flat_map(|(_, candela)| candela).copied().fold(0.0, f64::max);
    if largest == 0.0 {
        return Some((*first_place, "all candelas are 0: the lamp gives no light".to_owned()));
    }
    let is_round = horizontal_deg.len() > 1 && horizontal_deg.last().is_some_and(|&a| is_angle(a, &[360.0]));
    let apart = first.iter().zip(last).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (is_round && apart > SEAM * largest).then(|| {
        let note = format!(
            "the candelas at 360 degrees are not those at 0, which is the same direction, but up to {apart} cd off: \
             the light has an edge there"
        );
        (*last_place, note)
    })
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
