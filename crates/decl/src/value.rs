//! Text to typed values.

use crate::field::{Field, Kind, Presence, Range};

/// A value without children, read from text.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// The element was there.
    Flag,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A real number.
    Real(f64),
    /// Three real numbers.
    Vec3([f64; 3]),
    /// A row-major 3×3 matrix.
    Matrix3([f64; 9]),
    /// Any number of real numbers.
    Reals(Vec<f64>),
    /// Text, a path, a name, a reference or a choice.
    Text(String),
}

/// Why a text is not a value: what was expected instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ValueError {
    /// Not of the type; the words name what was expected.
    Type(String),
    /// Of the type but outside the range; the words name the range.
    Range(String),
}

/// Reads the text of a field without children.
///
/// On an error the second part is a harmless stand-in of the right type, with which reading goes on.
pub fn parse(field: &Field, text: &str) -> (Value, Option<ValueError>) {
    let text = text.trim();
    match field.kind {
        Kind::Flag => (Value::Flag, (!text.is_empty()).then(|| wrong_type(field))),
        Kind::Bool => match parse_bool(text) {
            Some(b) => (Value::Bool(b), None),
            None => (Value::Bool(false), Some(wrong_type(field))),
        },
        Kind::Int => parse_int(field, text),
        Kind::Real => match numbers(text, 1) {
            Ok(v) => ranged(field, Value::Real(field.range.nearest(v[0])), &v),
            Err(e) => (Value::Real(field.range.nearest(1.0)), Some(e)),
        },
        Kind::Vec3 => match numbers(text, 3) {
            Ok(v) => ranged(field, Value::Vec3([v[0], v[1], v[2]].map(|x| field.range.nearest(x))), &v),
            Err(e) => (Value::Vec3([field.range.nearest(1.0); 3]), Some(e)),
        },
        Kind::Matrix3 => parse_matrix(text),
        Kind::Reals => match text.split_whitespace().map(parse_real).collect::<Option<Vec<f64>>>() {
            Some(v) => ranged(field, Value::Reals(v.clone()), &v),
            None => (Value::Reals(vec![]), Some(wrong_type(field))),
        },
        Kind::Choice(words) => match words.iter().find(|w| w.eq_ignore_ascii_case(text)) {
            Some(w) => (Value::Text((*w).to_owned()), None),
            None => {
                let first = words.first().copied().unwrap_or_default();
                (Value::Text(first.to_owned()), Some(wrong_type(field)))
            }
        },
        Kind::Name | Kind::Reference(_) if text.is_empty() => {
            (Value::Text(String::new()), Some(wrong_type(field)))
        }
        // A path that may be missing may also be empty: exporters write `<nk_data/>` for none.
        Kind::Path if text.is_empty() && field.presence == Presence::Required => {
            (Value::Text(String::new()), Some(wrong_type(field)))
        }
        Kind::Text | Kind::Path | Kind::Name | Kind::Reference(_) => (Value::Text(text.to_owned()), None),
        Kind::Block(_) | Kind::OneOf(_) | Kind::EmbeddedMesh(_) => {
            (Value::Flag, Some(ValueError::Type("elements, not text".to_owned())))
        }
    }
}

fn wrong_type(field: &Field) -> ValueError {
    ValueError::Type(field.kind.words())
}

fn parse_bool(text: &str) -> Option<bool> {
    match text {
        "1" => Some(true),
        "0" => Some(false),
        t if t.eq_ignore_ascii_case("true") => Some(true),
        t if t.eq_ignore_ascii_case("false") => Some(false),
        _ => None,
    }
}

fn parse_real(text: &str) -> Option<f64> {
    // Rust also reads "inf" and "nan"; a scene has no use for them.
    text.parse::<f64>().ok().filter(|v| v.is_finite())
}

fn numbers(text: &str, count: usize) -> Result<Vec<f64>, ValueError> {
    let found: Option<Vec<f64>> = text.split_whitespace().map(parse_real).collect();
    match found {
        Some(v) if v.len() == count => Ok(v),
        _ => {
            Err(ValueError::Type(if count == 1 { "a number".to_owned() } else { format!("{count} numbers") }))
        }
    }
}

fn ranged(field: &Field, value: Value, numbers: &[f64]) -> (Value, Option<ValueError>) {
    if let Some(error) = too_large(numbers) {
        return (value, Some(error));
    }
    let ok = numbers.iter().all(|&v| field.range.allows(v));
    (value, (!ok).then(|| ValueError::Range(field.range.words())))
}

/// What the range of a field need not say.
fn too_large(numbers: &[f64]) -> Option<ValueError> {
    let words = format!("must be at most {:.1e} in size", Range::LARGEST);
    numbers.iter().any(|v| v.abs() > Range::LARGEST).then_some(ValueError::Range(words))
}

fn parse_int(field: &Field, text: &str) -> (Value, Option<ValueError>) {
    // Exporters that know no integers write "600.0".
    let whole = parse_real(text).filter(|v| v.fract() == 0.0 && v.abs() <= 9.0e15);
    match whole {
        Some(v) => ranged(field, Value::Int(field.range.nearest(v) as i64), &[v]),
        None => (Value::Int(field.range.nearest(1.0) as i64), Some(wrong_type(field))),
    }
}

fn parse_matrix(text: &str) -> (Value, Option<ValueError>) {
    const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let v = numbers(text, 9).or_else(|e| match numbers(text, 12) {
        // Later exporters append a translation of zero.
        Ok(v) if v[9..] == [0.0; 3] => Ok(v),
        _ => Err(e),
    });
    match v {
        Ok(v) => match too_large(&v) {
            None => (Value::Matrix3(std::array::from_fn(|i| v[i])), None),
            error => (Value::Matrix3(IDENTITY), error),
        },
        Err(e) => (Value::Matrix3(IDENTITY), Some(e)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSITIVE: Field = Field::new("x", Kind::Real, Presence::Required, "").range(Range::Above(0.0));

    #[test]
    fn numbers_as_exporters_write_them() {
        for (text, value) in [("4e-007", 4e-7), (" 1.5 ", 1.5), ("7.5e-09", 7.5e-9), (".5", 0.5)] {
            assert_eq!(parse(&POSITIVE, text), (Value::Real(value), None));
        }
        let int = Field::new("n", Kind::Int, Presence::Required, "");
        assert_eq!(parse(&int, "600.0"), (Value::Int(600), None));
        assert!(parse(&int, "600.5").1.is_some());
    }

    #[test]
    fn a_bad_number_gets_a_stand_in_that_is_allowed() {
        for text in ["-3", "nan", "inf", "", "1 2", "abc", "0", "1e-46"] {
            let (value, error) = parse(&POSITIVE, text);
            assert!(error.is_some(), "{text}");
            assert!(matches!(value, Value::Real(v) if v > 0.0), "{text}");
        }
    }

    #[test]
    fn what_single_precision_cannot_hold_is_out_of_range() {
        let any = Field::new("v", Kind::Vec3, Presence::Required, "");
        assert_eq!(parse(&any, "0 -3.4e38 0").1, None);
        let (value, error) = parse(&any, "1e40 0 0");
        assert_eq!(value, Value::Vec3([0.0; 3]));
        assert_eq!(error, Some(ValueError::Range("must be at most 3.4e38 in size".to_owned())));
        for (field, text) in [(&POSITIVE, "1e300"), (&POSITIVE, "-1e39")] {
            assert!(
                matches!(parse(field, text), (Value::Real(v), Some(ValueError::Range(_))) if v == 1.0),
                "{text}"
            );
        }
        let matrix = Field::new("m", Kind::Matrix3, Presence::Required, "");
        assert!(parse(&matrix, "1e39 0 0 0 1 0 0 0 1").1.is_some());
    }

    #[test]
    fn booleans_and_matrices() {
        let b = Field::new("b", Kind::Bool, Presence::Required, "");
        for (text, value) in [("true", true), ("False", false), ("1", true), ("0", false)] {
            assert_eq!(parse(&b, text), (Value::Bool(value), None));
        }
        let m = Field::new("m", Kind::Matrix3, Presence::Required, "");
        assert!(parse(&m, "1 0 0 0 1 0 0 0 1 0 0 0").1.is_none());
        assert!(parse(&m, "1 0 0 0 1 0 0 0 1 0 0 5").1.is_some());
        assert!(parse(&m, "1 0 0").1.is_some());
    }
}
