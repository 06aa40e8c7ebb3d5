//! What the declarations say of an element where it stands, as it was written: for who shows a scene and changes it.
//!
//! [`bind()`](crate::bind()) turns elements into something else and tells of every fault; here they stay what they are, and one is
//! looked up at a time, by the same rules.

use crate::bind::{CONSTANT, PATH, UNIFORM, VALUE};
use crate::element::Element;
use crate::field::{Alternatives, Block, Field, Kind, Later, Presence};
use crate::parameter::{Parameter, TEXTURE};
use crate::value::{self, ValueError};

/// What an element is.
#[derive(Clone, Copy, Debug)]
pub enum Meaning {
    /// It holds elements.
    Block(&'static Block, Option<&'static Field>),
    /// It holds one of several blocks.
    OneOf(&'static Alternatives, &'static Field),
    /// It holds a value.
    Value(&'static Field),
    /// A parameter as later versions write it: what a constant in it is, and what an image map.
    Parameter(Option<&'static Field>, Option<&'static Field>),
    /// It is of a later version of the format.
    Later(&'static Later),
    /// Nothing is said of it.
    Unknown,
}

impl Meaning {
    /// Of what a field holds.
    pub fn of(field: &'static Field) -> Self {
        match field.kind {
            Kind::Block(block) | Kind::EmbeddedMesh(block) => Self::Block(block, Some(field)),
            Kind::OneOf(alternatives) => Self::OneOf(alternatives, field),
            _ => Self::Value(field),
        }
    }

    /// Of a child, by its name.
    #[must_use]
    pub fn child(self, name: &str) -> Self {
        match self {
            Self::Block(block, _) => in_block(block, name),
            Self::OneOf(..) if name == CONSTANT => self,
            Self::OneOf(alternatives, _) => one_of(alternatives, name).unwrap_or(Self::Unknown),
            Self::Value(_) if name == CONSTANT => self,
            Self::Value(field) if [UNIFORM, VALUE].contains(&name) && matches!(field.kind, Kind::Real) => {
                self
            }
            Self::Value(field) if name == PATH && matches!(field.kind, Kind::Path) => self,
            Self::Parameter(_, Some(texture)) if name == TEXTURE => Self::of(texture),
            Self::Parameter(Some(constant), _) => Self::of(constant).child(name),
            _ => Self::Unknown,
        }
    }

    /// The field whose value its text is, if it is one.
    pub fn value(self) -> Option<&'static Field> {
        match self {
            Self::Value(field) => Some(field),
            Self::Parameter(Some(constant), _) => Self::of(constant).value(),
            _ => None,
        }
    }

    /// What it is in full sentences (Markdown), the more particular first; empty where nothing is said.
    pub fn docs(self) -> [&'static str; 2] {
        match self {
            Self::Block(block, field) => [field.map_or("", |field| field.doc), block.doc],
            Self::OneOf(_, field) | Self::Value(field) => [field.doc, ""],
            Self::Parameter(constant, texture) => {
                [constant, texture].map(|field| field.map_or("", |field| field.doc))
            }
            Self::Later(_) | Self::Unknown => [""; 2],
        }
    }

    /// The fields that an element does not give, and for which a text is declared that holds then.
    pub fn defaults(self, element: &Element) -> Vec<(&'static Field, &'static str)> {
        let Self::Block(block, _) = self else { return vec![] };
        let is_given = |field: &Field| element.children.iter().any(|child| field.is_called(&child.name));
        let named = |name: &str| block.fields.iter().find(|field| field.name == name);
        // One of several that stand for one another is enough, and a parameter of a later version overrides its field.
        let is_settled = |field: &Field| {
            let stands_in = |name: &&&str| **name != field.name && named(name).is_some_and(is_given);
            let groups =
                block.needs.iter().filter(|group| group.exclusive && group.fields.contains(&field.name));
            let overrides = |p: &Parameter| p.constant == field.name && element.child(p.name).is_some();
            groups.flat_map(|group| group.fields.iter()).any(|name| stands_in(&name))
                || block.parameters.iter().any(overrides)
        };
        let wanted = |field: &&Field| field.deprecated.is_empty() && !is_given(field) && !is_settled(field);
        let default = |field: &'static Field| match field.presence {
            Presence::Default(text) => Some((field, text)),
            _ => None,
        };
        block.fields.iter().filter(wanted).filter_map(default).collect()
    }
}

/// Of a child of a block.
fn in_block(block: &'static Block, name: &str) -> Meaning {
    let field = |name: &str| block.fields.iter().find(|field| field.is_called(name));
    if let Some(parameter) = block.parameters.iter().find(|parameter| parameter.name == name) {
        return Meaning::Parameter(field(parameter.constant), field(parameter.texture));
    }
    if let Some(field) = field(name) {
        return Meaning::of(field);
    }
    if let Some(alternatives) = &block.alternatives {
        if let Some(chosen) = one_of(alternatives, name) {
            return chosen;
        }
        if let Some(implied) = alternatives.implied.filter(|implied| implied.knows(name)) {
            return in_block(implied, name);
        }
    }
    if let Some(later) = block.later.iter().find(|later| later.name == name) {
        return Meaning::Later(later);
    }
    let listed = block.parameters.iter().find_map(|parameter| field(parameter.texture));
    listed.filter(|_| name == TEXTURE).map_or(Meaning::Unknown, Meaning::of)
}

/// One of several blocks, by its name.
fn one_of(alternatives: &Alternatives, name: &str) -> Option<Meaning> {
    let chosen = alternatives.blocks.iter().copied().find(|block| block.is_called(name));
    let later = || alternatives.later.iter().find(|later| later.name == name).map(Meaning::Later);
    chosen.map(|block| Meaning::Block(block, None)).or_else(later)
}

/// What is wrong with a text as the value of a field, in words: "must be > 0 (m)".
pub fn fault(field: &Field, text: &str) -> Option<String> {
    let unit = if field.unit.is_empty() { String::new() } else { format!(" ({})", field.unit) };
    value::parse(field, text).1.map(|error| match error {
        ValueError::Type(expected) => format!("expected {expected}{unit}"),
        ValueError::Range(words) => format!("{words}{unit}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Group, Range};
    use crate::parameter::StandIn;
    use indigo_diag::{SourceId, Span};

    static TEXTURE_BLOCK: Block = Block::new(
        "texture",
        "An image map.",
        &[
            Field::new("path", Kind::Path, Presence::Required, "Its file."),
            Field::new("exponent", Kind::Real, Presence::Default("2.2"), "Its exponent."),
        ],
    );
    static UNIFORM: Block = Block::new(
        "uniform",
        "The same everywhere.",
        &[Field::new("value", Kind::Real, Presence::Required, "The value.").range(Range::AtLeast(0.0))],
    );
    static SPECTRUM: Alternatives = Alternatives::new("spectrum", &[&UNIFORM]);
    static THING: Block = Block::new(
        "thing",
        "A thing.",
        &[
            Field::new("albedo_spectrum", Kind::OneOf(&SPECTRUM), Presence::Optional, "Its albedo."),
            Field::new("albedo_texture", Kind::Block(&TEXTURE_BLOCK), Presence::Optional, "Its map."),
            Field::new("size", Kind::Real, Presence::Default("1"), "Its size.")
                .unit("m")
                .range(Range::Above(0.0))
                .aliases(&["extent"]),
            Field::new("ior", Kind::Real, Presence::Default("1.5"), "Its index."),
            Field::new("a", Kind::Int, Presence::Default("1"), "One."),
            Field::new("b", Kind::Int, Presence::Default("2"), "Or the other."),
        ],
    )
    .with_needs(&[Group::one(&["a", "b"])])
    .with_parameters(&[
        Parameter {
            name: "albedo",
            since: "2.0",
            constant: "albedo_spectrum",
            texture: "albedo_texture",
            stand_in: StandIn::Nothing,
        },
        Parameter { name: "index", since: "2.0", constant: "ior", texture: "", stand_in: StandIn::Nothing },
    ])
    .with_later(&[Later::new("halo", "3.0")]);

    fn at(way: &[&str]) -> Meaning {
        way.iter().fold(Meaning::Block(&THING, None), |meaning, name| meaning.child(name))
    }

    fn name_of(way: &[&str]) -> Option<&'static str> {
        at(way).value().map(|field| field.name)
    }

    #[test]
    fn values_are_found_in_every_form_that_they_can_be_written_in() {
        for way in [
            &["albedo_spectrum", "uniform", "value"][..],
            &["albedo_spectrum", "constant", "uniform", "value"],
            &["albedo", "constant", "uniform", "value"],
            &["albedo_spectrum", "uniform", "value", "constant"],
        ] {
            assert_eq!(name_of(way), Some("value"), "{way:?}");
        }
        for way in [
            &["albedo_texture", "exponent"][..],
            &["albedo", "texture", "exponent"],
            &["texture", "exponent"],
        ] {
            assert_eq!(name_of(way), Some("exponent"), "{way:?}");
        }
        assert_eq!(name_of(&["albedo_texture", "path", "path"]), Some("path"));
        assert_eq!((name_of(&["extent"]), name_of(&["index"])), (Some("size"), Some("ior")));
        assert!(matches!(at(&["halo"]), Meaning::Later(later) if later.since == "3.0"));
        assert!(matches!(at(&["albedo_spectrum", "peak"]), Meaning::Unknown));
        assert_eq!(at(&["albedo_texture"]).docs(), ["Its map.", "An image map."]);
    }

    #[test]
    fn a_fault_is_told_with_the_unit() {
        let size = at(&["size"]).value().expect("it is a value");
        assert_eq!(fault(size, " 0.5 "), None);
        assert_eq!(fault(size, "0").as_deref(), Some("must be > 0 (m)"));
        assert_eq!(fault(size, "wide").as_deref(), Some("expected a number (m)"));
    }

    #[test]
    fn defaults_are_of_what_is_neither_given_nor_settled_otherwise() {
        let span = Span::new(SourceId(0), 0, 0);
        let mut element = Element::new("thing", span);
        let names = |element: &Element| {
            let defaults = Meaning::Block(&THING, None).defaults(element);
            defaults.iter().map(|(field, text)| (field.name, *text)).collect::<Vec<_>>()
        };
        assert_eq!(names(&element), [("size", "1"), ("ior", "1.5"), ("a", "1"), ("b", "2")]);
        element.children = ["extent", "index", "b"].map(|name| Element::new(name, span)).into();
        assert_eq!(names(&element), [], "one is called otherwise, one overridden, and one of two is there");
    }
}
