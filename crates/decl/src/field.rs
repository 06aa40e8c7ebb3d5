//! The tables that declare elements.

use crate::canonical::Written;
use crate::parameter::Parameter;

/// An element with children, declared.
#[derive(Debug)]
pub struct Block {
    /// Name of the element.
    pub name: &'static str,
    /// Other spellings found in real files.
    pub aliases: &'static [&'static str],
    /// What it is, in full sentences (Markdown).
    pub doc: &'static str,
    /// The children that it knows by name.
    pub fields: &'static [Field],
    /// Children of which exactly one must be present.
    pub alternatives: Option<Alternatives>,
    /// Groups of fields of which at least one must be given.
    pub needs: &'static [Group],
    /// Parameters that later versions of the format write under one name, be they constants or image maps.
    pub parameters: &'static [Parameter],
    /// Children of later versions of the format: warned of by name and ignored.
    pub later: &'static [Later],
    /// Children of old exporters without meaning any more: warned of and ignored.
    pub ignored: &'static [&'static str],
    /// Children of an element that is not rendered as it is meant: its own warning tells of their loss.
    pub passed_over: &'static [&'static str],
    /// A complete example of the element as it stands in a file; parsed and checked by a test. May be empty.
    pub example: &'static str,
}

impl Block {
    /// A block of a name and fields, to be completed with struct update syntax.
    pub const fn new(name: &'static str, doc: &'static str, fields: &'static [Field]) -> Self {
        Self {
            name,
            aliases: &[],
            doc,
            fields,
            alternatives: None,
            needs: &[],
            parameters: &[],
            later: &[],
            ignored: &[],
            passed_over: &[],
            example: "",
        }
    }

    /// The same block with alternatives.
    #[must_use]
    pub const fn with_alternatives(self, alternatives: Alternatives) -> Self {
        Self { alternatives: Some(alternatives), ..self }
    }

    /// The same block with groups of fields that it needs one of.
    #[must_use]
    pub const fn with_needs(self, needs: &'static [Group]) -> Self {
        Self { needs, ..self }
    }

    /// The same block with parameters as later versions write them.
    #[must_use]
    pub const fn with_parameters(self, parameters: &'static [Parameter]) -> Self {
        Self { parameters, ..self }
    }

    /// The same block with elements of later versions.
    #[must_use]
    pub const fn with_later(self, later: &'static [Later]) -> Self {
        Self { later, ..self }
    }

    /// The same block with an example.
    #[must_use]
    pub const fn with_example(self, example: &'static str) -> Self {
        Self { example, ..self }
    }

    /// The same block with other spellings.
    #[must_use]
    pub const fn with_aliases(self, aliases: &'static [&'static str]) -> Self {
        Self { aliases, ..self }
    }

    /// The same block with elements that are ignored.
    #[must_use]
    pub const fn with_ignored(self, ignored: &'static [&'static str]) -> Self {
        Self { ignored, ..self }
    }

    /// The same block with children that are passed over.
    #[must_use]
    pub const fn with_passed_over(self, passed_over: &'static [&'static str]) -> Self {
        Self { passed_over, ..self }
    }

    /// Whether an element of this name is meant.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.aliases.contains(&name)
    }

    /// Whether it has a field of this name.
    pub fn declares(&self, field: &str) -> bool {
        self.fields.iter().any(|f| f.name == field)
    }

    /// Whether a child of this name has a meaning, by itself or as a later version writes it.
    pub fn knows(&self, name: &str) -> bool {
        self.fields.iter().any(|f| f.is_called(name)) || self.parameters.iter().any(|p| p.name == name)
    }
}

/// Children of which exactly one must be present.
#[derive(Clone, Copy, Debug)]
pub struct Alternatives {
    /// What they are, such as "filter": a noun that takes the article "a".
    pub what: &'static str,
    /// The declarations to choose from.
    pub blocks: &'static [&'static Block],
    /// Whether none may be given.
    pub optional: bool,
    /// The one whose fields may also stand directly in the parent, if any (an old form).
    pub implied: Option<&'static Block>,
    /// Choices of later versions of the format: warned of by name, since something stands in for them.
    pub later: &'static [Later],
    /// What stands in for those, in words; lowering finds no choice then.
    pub stand_in: &'static str,
    /// The same as the element that would be written for it.
    pub written: Option<Written>,
}

impl Alternatives {
    /// Exactly one of some blocks, to be completed with struct update syntax.
    pub const fn new(what: &'static str, blocks: &'static [&'static Block]) -> Self {
        Self { what, blocks, optional: false, implied: None, later: &[], stand_in: "", written: None }
    }
}

/// Fields of a block that can stand for one another.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Names of the fields; at least one of them must be given.
    pub fields: &'static [&'static str],
    /// Whether at most one may be given.
    pub exclusive: bool,
}

impl Group {
    /// At least one of some fields.
    pub const fn any(fields: &'static [&'static str]) -> Self {
        Self { fields, exclusive: false }
    }

    /// Exactly one of some fields.
    pub const fn one(fields: &'static [&'static str]) -> Self {
        Self { fields, exclusive: true }
    }
}

/// An element of a later version of the format.
#[derive(Clone, Copy, Debug)]
pub struct Later {
    /// Name of the element.
    pub name: &'static str,
    /// The version that brought it.
    pub since: &'static str,
    /// What is done in its place, after "and": "is ignored".
    pub instead: &'static str,
    /// The text with which it does nothing, and so is passed over without a word; empty for none.
    pub neutral: &'static str,
}

impl Later {
    /// An element that a version of the format brought.
    pub const fn new(name: &'static str, since: &'static str) -> Self {
        Self { name, since, instead: "is ignored", neutral: "" }
    }

    /// The same element with what is done in its place.
    #[must_use]
    pub const fn instead(self, instead: &'static str) -> Self {
        Self { instead, ..self }
    }

    /// The same element with the text that makes it do nothing.
    #[must_use]
    pub const fn unless(self, neutral: &'static str) -> Self {
        Self { neutral, ..self }
    }

    /// Whether it does nothing with a text: numbers are compared by value.
    pub fn is_neutral(&self, text: &str) -> bool {
        let number = |text: &str| text.trim().parse::<f64>().ok();
        let same_number = number(text).is_some_and(|v| number(self.neutral) == Some(v));
        !self.neutral.is_empty() && (same_number || text.trim().eq_ignore_ascii_case(self.neutral))
    }
}

/// One child of a block, declared.
#[derive(Debug)]
pub struct Field {
    /// Name of the element.
    pub name: &'static str,
    /// Other spellings found in real files.
    pub aliases: &'static [&'static str],
    /// What it is, in full sentences (Markdown).
    pub doc: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// Whether it must be given, and what holds if it is not.
    pub presence: Presence,
    /// Which numbers are allowed.
    pub range: Range,
    /// Unit of the numbers, such as "m"; empty for none.
    pub unit: &'static str,
    /// Why not to use it any more, and what instead; empty if there is no reason.
    pub deprecated: &'static str,
}

impl Field {
    /// A field, to be completed by the methods below.
    pub const fn new(name: &'static str, kind: Kind, presence: Presence, doc: &'static str) -> Self {
        Self { name, aliases: &[], doc, kind, presence, range: Range::Any, unit: "", deprecated: "" }
    }

    /// The number of one of several things, which are counted from 0: the first, where it is missing.
    pub const fn index(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, Kind::Int, Presence::Default("0"), doc).range(Range::AtLeast(0.0))
    }

    /// The same field with a unit.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// The same field with a range.
    #[must_use]
    pub const fn range(self, range: Range) -> Self {
        Self { range, ..self }
    }

    /// The same field with other spellings.
    #[must_use]
    pub const fn aliases(self, aliases: &'static [&'static str]) -> Self {
        Self { aliases, ..self }
    }

    /// The same field, discouraged.
    #[must_use]
    pub const fn deprecated(self, why: &'static str) -> Self {
        Self { deprecated: why, ..self }
    }

    /// Whether an element of this name is meant.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.aliases.contains(&name)
    }
}

/// What an element holds.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Nothing: its presence counts (`<autofocus/>`).
    Flag,
    /// `true` or `false`.
    Bool,
    /// A whole number.
    Int,
    /// A real number.
    Real,
    /// Three real numbers.
    Vec3,
    /// Nine real numbers, row-major; three zeros may follow (as later exporters write).
    Matrix3,
    /// Any number of real numbers.
    Reals,
    /// Free text.
    Text,
    /// Path of a file.
    Path,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// The name that this element defines.
    Name,
    /// The name of something defined elsewhere; the word says what ("material").
    Reference(&'static str),
    /// An element with children.
    Block(&'static Block),
    /// An element whose content is exactly one of several blocks, directly or in a `constant` wrapper.
    OneOf(&'static Alternatives),
    /// The bulk data of an embedded mesh; the block documents its elements.
    EmbeddedMesh(&'static Block),
}

impl Kind {
    /// What is expected, in words: "a number".
    pub fn words(&self) -> String {
        match self {
            Self::Flag => "an empty element".to_owned(),
            Self::Bool => "true or false".to_owned(),
            Self::Int => "a whole number".to_owned(),
            Self::Real => "a number".to_owned(),
            Self::Vec3 => "3 numbers".to_owned(),
            Self::Matrix3 => "9 numbers, after which 3 zeros may follow".to_owned(),
            Self::Reals => "numbers separated by blanks".to_owned(),
            Self::Text => "text".to_owned(),
            Self::Path => "a path".to_owned(),
            Self::Choice(words) => format!("one of {}", words.join(", ")),
            Self::Name => "a name".to_owned(),
            Self::Reference(what) => format!("the name of a {what}"),
            Self::Block(_) => "elements".to_owned(),
            Self::OneOf(a) => format!("a {}", a.what),
            Self::EmbeddedMesh(_) => "vertices and triangles".to_owned(),
        }
    }
}

/// Whether a child must be given, and what holds if it is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// Must be given.
    Required,
    /// May be missing; its absence has a meaning that the documentation gives.
    Optional,
    /// May be missing; this text holds then.
    Default(&'static str),
    /// May be given any number of times.
    Repeated,
}

/// Which numbers are allowed; for several numbers it holds for each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// All that the renderer can hold; see [`LARGEST`](Self::LARGEST).
    Any,
    /// Greater than.
    Above(f64),
    /// At least.
    AtLeast(f64),
    /// Between two, both included.
    Within(f64, f64),
}

impl Range {
    /// The largest number that the renderer can hold, since it computes in single precision.
    pub const LARGEST: f64 = f32::MAX as f64;

    /// The smallest number above 0 that it can tell from 0.
    pub const SMALLEST: f64 = f32::MIN_POSITIVE as f64;

    /// Whether a number is allowed.
    pub fn allows(self, v: f64) -> bool {
        match self {
            Self::Any => v.abs() <= Self::LARGEST,
            Self::Above(lo) => v >= lo + Self::SMALLEST && v > lo && v <= Self::LARGEST,
            Self::AtLeast(lo) => v >= lo && v <= Self::LARGEST,
            Self::Within(lo, hi) => (lo..=hi).contains(&v),
        }
    }

    /// In words: "must be > 0".
    pub fn words(self) -> String {
        match self {
            Self::Any => "must be finite".to_owned(),
            Self::Above(lo) => format!("must be > {lo}"),
            Self::AtLeast(lo) => format!("must be >= {lo}"),
            Self::Within(lo, hi) => format!("must be in [{lo}, {hi}]"),
        }
    }

    /// An allowed number near a forbidden one: the stand-in with which reading goes on.
    pub fn nearest(self, v: f64) -> f64 {
        let v = if v.abs() <= Self::LARGEST { v } else { 0.0 };
        match self {
            Self::Any => v,
            Self::Above(lo) if !self.allows(v) => lo + 1.0,
            Self::Above(_) => v,
            Self::AtLeast(lo) => v.max(lo),
            Self::Within(lo, hi) => v.clamp(lo, hi),
        }
    }
}
