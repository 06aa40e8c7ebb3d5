//! Bound elements as elements again, in the form of version 1.0 in which they were declared: whatever spelling, order or
//! version of the format they were written in.

use crate::bind::UID;
use crate::element::Element;
use crate::field::{Field, Kind};
use crate::node::{Content, Node, Slot};
use crate::value::Value;
use indigo_diag::{Span, Spanned};

impl Node {
    /// The element that says what this one says: fields in the order of their declaration, by their first names. What was
    /// passed over when this one was bound is not there. `rewrite` gives what stands in place of a path, with the place
    /// where it was written. Nothing counts as read by it.
    pub fn to_element(&self, rewrite: &dyn Fn(&str, Span) -> String) -> Element {
        self.called(self.block.name, rewrite)
    }

    fn called(&self, name: &str, rewrite: &dyn Fn(&str, Span) -> String) -> Element {
        let mut element = Element::new(name, self.span);
        for (field, slots) in self.block.fields.iter().zip(&self.slots) {
            element.children.extend(slots.iter().map(|slot| slot.to_element(field, rewrite)));
        }
        element.children.extend(self.alternative.iter().map(|chosen| chosen.to_element(rewrite)));
        if self.alternative.is_none() && self.alternative_reported {
            // Without it nothing would be there to be read.
            let stand_in = self.block.alternatives.and_then(|alternatives| alternatives.written);
            element.children.extend(stand_in.map(|stand_in| stand_in.to_element(self.span)));
        }
        element
    }
}

/// An element to be written, as it is declared.
#[derive(Clone, Copy, Debug)]
pub struct Written {
    /// Name of the element.
    pub name: &'static str,
    /// Its text; empty for none.
    pub text: &'static str,
    /// The elements inside.
    pub children: &'static [Written],
}

impl Written {
    /// An element of a text, such as that of a number.
    pub const fn text(name: &'static str, text: &'static str) -> Self {
        Self { name, text, children: &[] }
    }

    /// An element of others.
    pub const fn of(name: &'static str, children: &'static [Self]) -> Self {
        Self { name, text: "", children }
    }

    fn to_element(self, span: Span) -> Element {
        let mut element = Element::new(self.name, span);
        element.text = Spanned::new(self.text.into(), span);
        element.children = self.children.iter().map(|child| child.to_element(span)).collect();
        element
    }
}

impl Slot {
    fn to_element(&self, field: &Field, rewrite: &dyn Fn(&str, Span) -> String) -> Element {
        let mut element = Element::new(field.name, self.span);
        match &self.content {
            Content::Node(node) if matches!(field.kind, Kind::OneOf(_)) => {
                element.children.push(node.to_element(rewrite));
            }
            Content::Node(node) => return node.called(field.name, rewrite),
            Content::Mesh(mesh) => element.mesh = Some(mesh.clone()),
            Content::Value(Value::Text(text)) => {
                let (name, text) = match (field.kind, text.strip_prefix(UID)) {
                    (Kind::Path, _) if !text.is_empty() => (field.name, rewrite(text, self.span)),
                    (Kind::Reference(_), Some(uid)) => (uid_name(field), uid.to_owned()),
                    _ => (field.name, text.clone()),
                };
                element.name = name.into();
                element.text = Spanned::new(text.into(), self.span);
            }
            Content::Value(value) => element.text = Spanned::new(words(value).into(), self.span),
        }
        element
    }
}

/// What a reference is called that is by uid.
fn uid_name(field: &Field) -> &'static str {
    field.aliases.iter().find(|alias| alias.ends_with("_uid")).copied().unwrap_or(field.name)
}

fn words(value: &Value) -> String {
    match value {
        Value::Flag => String::new(),
        Value::Bool(v) => v.to_string(),
        Value::Int(v) => v.to_string(),
        Value::Real(v) => number(*v),
        Value::Vec3(v) => numbers(v),
        Value::Matrix3(v) => numbers(v),
        Value::Reals(v) => numbers(v),
        Value::Text(v) => v.clone(),
    }
}

fn numbers(values: &[f64]) -> String {
    let words: Vec<String> = values.iter().map(|v| number(*v)).collect();
    words.join(" ")
}

/// The shortest text that is read as the same number, with an exponent where there would be many zeros.
fn number(v: f64) -> String {
    if v == 0.0 || (1e-4..1e9).contains(&v.abs()) { v.to_string() } else { format!("{v:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back() {
        for v in [0.0, -0.0, 0.1, 1.0, -2.5, 1e-7, 3.3e-40, 1e300, 123_456_789.123, 1e9, f64::MIN_POSITIVE] {
            assert_eq!(number(v).parse::<f64>().map(f64::to_bits), Ok(v.to_bits()), "{}", number(v));
        }
        assert_eq!(
            (number(1e-7), number(550e-9), number(0.25)),
            ("1e-7".into(), "5.5e-7".into(), "0.25".into())
        );
    }
}
