//! Camera response curves in the text layout of the DoRF database (Grossberg and Nayar, "What is the Space of
//! Camera Response Functions?", CVPR 2003).
//!
//! For each curve: its name, the word `graph`, `I =` and the irradiances, `B =` and as many brightnesses, all
//! in [0, 1]. A file holds one curve for all colours, or three whose names end in `Red`, `Green` and `Blue`
//! (in this order where they do not).

use crate::error::FormatError;
use crate::text::{Text, name};

/// From relative irradiance of the sensor to relative brightness of the picture, which has its display's
/// transfer function in it already.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseCurve {
    /// Name of the curve.
    pub name: String,
    /// Irradiances, never decreasing; at least two, not all the same.
    pub irradiance: Vec<f32>,
    /// The brightness for each.
    pub brightness: Vec<f32>,
    /// What is odd about it, each with its place, but can be shown all the same.
    pub oddities: Vec<FormatError>,
}

/// Reads the curves for red, green and blue.
///
/// # Errors
/// Where a curve is incomplete, has unlike numbers of values or irradiances that decrease, and where the file
/// holds neither one curve nor three.
pub fn read(bytes: &[u8]) -> Result<[ResponseCurve; 3], FormatError> {
    let mut text = Text::new(bytes, 0);
    let mut curves = vec![];
    text.skip_space();
    while text.peek().is_some() {
        curves.push(read_curve(&mut text)?);
    }
    let count = curves.len();
    match <[ResponseCurve; 3]>::try_from(curves) {
        Ok(curves) => Ok(by_colour(curves)),
        Err(mut curves) => match (curves.pop(), curves.is_empty()) {
            (Some(only), true) => Ok([only.clone(), only.clone(), only]),
            _ => Err(text.error_saying(
                text.offset(),
                "one response curve, or three for red, green and blue",
                &format!("{count} of them"),
            )),
        },
    }
}

/// In the order red, green, blue, if their names tell.
fn by_colour(mut curves: [ResponseCurve; 3]) -> [ResponseCurve; 3] {
    const COLOURS: [&str; 3] = ["red", "green", "blue"];
    let place = |curve: &ResponseCurve| {
        let name = curve.name.to_lowercase();
        COLOURS.iter().position(|colour| name.ends_with(colour))
    };
    let mut places: Vec<_> = curves.iter().filter_map(place).collect();
    places.sort_unstable();
    if places == [0, 1, 2] {
        curves.sort_by_key(place);
    }
    curves
}

fn read_curve(text: &mut Text<'_>) -> Result<ResponseCurve, FormatError> {
    let mut words = vec![];
    while !at_list(text, b'I') {
        if text.peek().is_none() {
            return Err(text.error("'I =' and the irradiances of a curve"));
        }
        let word = text.word();
        if word.is_empty() {
            // A control character or a continued line, at which a word ends and no space begins.
            return Err(text.error("the name of a curve, 'graph', or 'I ='"));
        }
        if !word.to_ascii_lowercase().starts_with(b"graph") {
            words.push(name(word));
        }
        text.skip_space();
    }
    let irradiance =
        read_list(text, "an irradiance from 0 to 1, not less than the one before, or 'B ='", true)?;
    if !at_list(text, b'B') {
        return Err(text.error("an irradiance from 0 to 1, not less than the one before, or 'B ='"));
    }
    let start = text.offset();
    let brightness = read_list(text, "a brightness from 0 to 1", false)?;
    let end = |value: Option<&(f32, usize)>| value.map(|(value, _)| *value);
    if brightness.len() != irradiance.len() || end(irradiance.first()) == end(irradiance.last()) {
        return Err(text.error_saying(
            start,
            &format!(
                "as many brightnesses as irradiances, which are {}, two different ones at least",
                irradiance.len()
            ),
            &format!("{} of them", brightness.len()),
        ));
    }
    let oddities = oddities(text, &irradiance, &brightness);
    let values = |list: Vec<(f32, usize)>| list.into_iter().map(|(value, _)| value).collect();
    let name = words.join(" ");
    Ok(ResponseCurve { name, irradiance: values(irradiance), brightness: values(brightness), oddities })
}

/// What no film or sensor does, and its user hardly means; the first of each kind.
fn oddities(text: &Text<'_>, irradiance: &[(f32, usize)], brightness: &[(f32, usize)]) -> Vec<FormatError> {
    let mut found = vec![];
    let mut add = |at: usize, expected: &str, there: &str| found.push(text.error_saying(at, expected, there));
    if let Some((black, at)) = brightness.first().filter(|(black, _)| *black > 0.0) {
        add(*at, "brightnesses that begin at 0", &format!("{black}, which is shown for black"));
    }
    let falls = brightness.array_windows().find(|[(a, _), (b, _)]| b < a);
    if let Some([(before, _), (after, at)]) = falls {
        let there = format!("{after} after {before}, darker for more light");
        add(*at, "brightnesses that do not decrease", &there);
    }
    let pairs = irradiance.array_windows().zip(brightness.array_windows());
    let step = pairs.into_iter().find(|([(i, _), (j, _)], [(a, _), (b, _)])| i == j && a != b);
    if let Some(([_, (twice, at)], _)) = step {
        add(*at, "irradiances that increase", &format!("{twice} twice, with two brightnesses"));
    }
    found
}

/// Whether a list of that letter begins here: `I =` or `I=`.
fn at_list(text: &Text<'_>, letter: u8) -> bool {
    let mut ahead = text.clone();
    if ahead.peek() != Some(letter) {
        return false;
    }
    ahead.advance();
    ahead.skip_blanks();
    ahead.peek() == Some(b'=')
}

/// The numbers of a list, up to what is none, and where each stands.
fn read_list(text: &mut Text<'_>, expected: &str, ascending: bool) -> Result<Vec<(f32, usize)>, FormatError> {
    text.advance();
    text.skip_blanks();
    text.advance();
    text.skip_space();
    let mut values: Vec<(f32, usize)> = vec![];
    while text.peek().is_some_and(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.')) {
        let at = text.offset();
        let value = text.finite(expected)?;
        let falls = ascending && values.last().is_some_and(|(before, _)| *before > value);
        if !(0.0..=1.0).contains(&value) || falls {
            return Err(text.error_at(at, expected));
        }
        values.push((value, at));
        text.skip_space();
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(name: &str, values: &str) -> String {
        format!("{name}\n graph-log\nI =\n 0.0 0.25\n\t1\nB=\n{values}\n")
    }

    #[test]
    fn one_curve_serves_all_colours() {
        let text = curve("camera", "0 5e-1 1.0");
        for text in [text.clone(), text.replace('\n', "\r\n"), text.trim_end().to_owned()] {
            let curves = read(text.as_bytes()).unwrap();
            assert!(curves.iter().all(|c| *c == curves[0]));
            assert_eq!(curves[0].name, "camera");
            assert_eq!(curves[0].irradiance, [0.0, 0.25, 1.0]);
            assert_eq!(curves[0].brightness, [0.0, 0.5, 1.0]);
        }
    }

    #[test]
    fn three_curves_are_told_by_their_names() {
        let [blue, red, green] =
            [("xBlue", "0 .1 1"), ("xRed", "0 .2 1"), ("x Green", "0 .3 1")].map(|(n, v)| curve(n, v));
        let curves = read((blue.clone() + &red + &green).as_bytes()).unwrap();
        assert_eq!(curves.map(|c| c.brightness[1]), [0.2, 0.3, 0.1]);
        let plain = [".1", ".2", ".3"].map(|v| curve("x", &format!("0 {v} 1"))).concat();
        assert_eq!(read(plain.as_bytes()).unwrap().map(|c| c.brightness[1]), [0.1, 0.2, 0.3]);
        assert!(read((blue + &red).as_bytes()).unwrap_err().to_string().contains("2 of them"));
    }

    #[test]
    fn what_no_film_does_is_told_with_its_place() {
        for (values, says) in [
            ("B = 0 .8 .4", "3:10: expected brightnesses that do not decrease, found 0.4 after 0.8"),
            ("B = .3 .4 1", "3:5: expected brightnesses that begin at 0, found 0.3"),
        ] {
            let curves = read(format!("a\nI = 0 .5 1\n{values}").as_bytes()).unwrap();
            let [oddity] = &curves[0].oddities[..] else { panic!("{:?}", curves[0].oddities) };
            assert!(oddity.to_string().starts_with(says), "{oddity}");
        }
        let curves = read(b"a\nI = 0 .5 .5 1\nB = 0 .2 .4 1").unwrap();
        let said: Vec<String> = curves[0].oddities.iter().map(ToString::to_string).collect();
        assert_eq!(
            said,
            ["2:10: expected irradiances that increase, found 0.5 twice, with two brightnesses"]
        );
        assert!(read(curve("a", "0 .5 1").as_bytes()).unwrap()[0].oddities.is_empty());
    }

    #[test]
    fn faults_are_told_with_their_place() {
        for (text, says) in [
            ("", "1:1: expected one response curve"),
            ("a graph I 1 2", "1:14: expected 'I ='"),
            ("a\nI = 0 0.5 0.4 1 B = 0 0 0 1", "2:11: expected an irradiance"),
            ("a\nI = 0 1 x", "2:9: expected an irradiance"),
            ("a\nI = 0 2 B = 0 1", "2:7: expected an irradiance"),
            ("a\nI = 0 1\nB = 0 1 1", "3:1: expected as many brightnesses"),
            ("a\nI = 0 1\nB = 0 -1", "3:7: expected a brightness"),
            ("a\nI = 0.5 0.5\nB = 0 1", "3:1: expected as many"),
            ("a\nI = 0 nan", "2:7: expected"),
            ("a\nI = 0 1e", "2:7: expected"),
            ("a\n\u{1}\n", "2:1: expected the name"),
            ("a \\\n graph", "1:3: expected the name"),
        ] {
            let error = read(text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(says), "{text:?}: {error}");
        }
    }
}
