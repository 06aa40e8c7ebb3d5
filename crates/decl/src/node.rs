//! Typed values by name: what lowering reads.

use crate::field::{Block, Kind, Presence};
use crate::mesh::EmbeddedMesh;
use crate::value::{self, Value};
use indigo_diag::{Span, Spanned};
use std::cell::Cell;

/// An element that was bound to its declaration.
#[derive(Debug)]
pub struct Node {
    /// The declaration.
    pub block: &'static Block,
    /// The start tag.
    pub span: Span,
    /// One slot per field of the block.
    pub(crate) slots: Vec<Vec<Slot>>,
    /// The alternative that was chosen.
    pub(crate) alternative: Option<Box<Node>>,
    /// Whether its absence was reported already, in better words.
    pub(crate) alternative_reported: bool,
    /// Fields that were given but wrong, which was reported: a stand-in or nothing came of them.
    pub(crate) faulty: Vec<&'static str>,
    /// Whether lowering made use of this element.
    pub(crate) used: Cell<bool>,
}

/// What a field was given.
#[derive(Debug)]
pub struct Slot {
    /// The place of the value (of its text, or of its start tag).
    pub span: Span,
    pub(crate) content: Content,
    pub(crate) read: Cell<bool>,
}

#[derive(Debug)]
pub(crate) enum Content {
    Value(Value),
    Node(Box<Node>),
    Mesh(Box<EmbeddedMesh>),
}

impl Content {
    fn says_the_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Value(a), Self::Value(b)) => a == b,
            (Self::Node(a), Self::Node(b)) => a.says_the_same(b),
            (Self::Mesh(a), Self::Mesh(b)) => a == b,
            _ => false,
        }
    }
}

impl Node {
    pub(crate) fn new(block: &'static Block, span: Span) -> Self {
        Self {
            block,
            span,
            slots: block.fields.iter().map(|_| vec![]).collect(),
            alternative: None,
            alternative_reported: false,
            faulty: vec![],
            used: Cell::new(false),
        }
    }

    fn index(&self, field: &str) -> usize {
        let found = self.block.fields.iter().position(|f| f.name == field);
        found.unwrap_or_else(|| unreachable!("<{}> declares no field {field}", self.block.name))
    }

    fn slots(&self, field: &str) -> &[Slot] {
        self.used.set(true);
        let slots = &self.slots[self.index(field)];
        for slot in slots {
            slot.read.set(true);
        }
        slots
    }

    /// Whether the field was given.
    pub fn has(&self, field: &str) -> bool {
        !self.slots[self.index(field)].is_empty()
    }

    /// Whether what the field was given is wrong, which was reported; its value is but a stand-in.
    pub fn is_faulty(&self, field: &str) -> bool {
        self.faulty.contains(&field)
    }

    /// The place of a field, or of the whole element where the field was not given.
    pub fn span_of(&self, field: &str) -> Span {
        self.slots[self.index(field)].last().map_or(self.span, |s| s.span)
    }

    /// Whether another element says the same, wherever it stands and however it is spelt.
    pub fn says_the_same(&self, other: &Self) -> bool {
        let alike = |(a, b): (&Vec<Slot>, &Vec<Slot>)| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.content.says_the_same(&b.content))
        };
        let chosen = match (&self.alternative, &other.alternative) {
            (Some(a), Some(b)) => a.says_the_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        std::ptr::eq(self.block, other.block)
            && chosen
            && self.faulty == other.faulty
            && self.slots.iter().zip(&other.slots).all(alike)
    }

    /// Says that lowering made use of this element, where its presence alone has a meaning
    /// (`<null_material/>`).
    pub fn mark_used(&self) {
        self.used.set(true);
    }

    /// The chosen alternative.
    pub fn alternative(&self) -> Option<&Node> {
        self.used.set(true);
        self.alternative.as_deref()
    }

    /// The value of a field: given, else its default, else `None`.
    pub fn value(&self, field: &str) -> Option<Spanned<Value>> {
        if let Some(slot) = self.slots(field).last() {
            return match &slot.content {
                Content::Value(v) => Some(Spanned::new(v.clone(), slot.span)),
                Content::Node(_) | Content::Mesh(_) => None,
            };
        }
        let declared = &self.block.fields[self.index(field)];
        let text = match declared.presence {
            Presence::Default(text) => text,
            // Its absence was reported; a stand-in lets reading go on.
            Presence::Required => "",
            Presence::Optional | Presence::Repeated => return None,
        };
        Some(Spanned::new(value::parse(declared, text).0, self.span))
    }

    /// A real number that is required or has a default.
    pub fn real(&self, field: &str) -> f64 {
        self.opt_real(field).map_or(0.0, |v| v.value)
    }

    /// A real number that may be missing.
    pub fn opt_real(&self, field: &str) -> Option<Spanned<f64>> {
        self.value(field).and_then(|v| match v.value {
            Value::Real(x) => Some(Spanned::new(x, v.span)),
            Value::Int(i) => Some(Spanned::new(i as f64, v.span)),
            _ => None,
        })
    }

    /// A whole number that is required or has a default.
    pub fn int(&self, field: &str) -> i64 {
        self.opt_int(field).map_or(0, |v| v.value)
    }

    /// A whole number that may be missing.
    pub fn opt_int(&self, field: &str) -> Option<Spanned<i64>> {
        self.value(field).and_then(|v| match v.value {
            Value::Int(i) => Some(Spanned::new(i, v.span)),
            _ => None,
        })
    }

    /// A truth value that is required or has a default.
    pub fn bool(&self, field: &str) -> bool {
        matches!(self.value(field), Some(Spanned { value: Value::Bool(true), .. }))
    }

    /// Whether a flag element is present.
    pub fn flag(&self, field: &str) -> bool {
        !self.slots(field).is_empty()
    }

    /// Three numbers that may be missing.
    pub fn opt_vec3(&self, field: &str) -> Option<Spanned<[f64; 3]>> {
        self.value(field).and_then(|v| match v.value {
            Value::Vec3(x) => Some(Spanned::new(x, v.span)),
            _ => None,
        })
    }

    /// Three numbers that are required or have a default.
    pub fn vec3(&self, field: &str) -> [f64; 3] {
        self.opt_vec3(field).map_or([0.0; 3], |v| v.value)
    }

    /// A matrix that may be missing.
    pub fn opt_matrix(&self, field: &str) -> Option<Spanned<[f64; 9]>> {
        self.value(field).and_then(|v| match v.value {
            Value::Matrix3(x) => Some(Spanned::new(x, v.span)),
            _ => None,
        })
    }

    /// A list of numbers that is required.
    pub fn reals(&self, field: &str) -> Spanned<Vec<f64>> {
        match self.value(field) {
            Some(Spanned { value: Value::Reals(x), span }) => Spanned::new(x, span),
            _ => Spanned::new(vec![], self.span),
        }
    }

    /// Text (a path, a name, a choice) that may be missing.
    pub fn opt_text(&self, field: &str) -> Option<Spanned<String>> {
        self.value(field).and_then(|v| match v.value {
            Value::Text(x) => Some(Spanned::new(x, v.span)),
            _ => None,
        })
    }

    /// Text that is required or has a default.
    pub fn text(&self, field: &str) -> Spanned<String> {
        self.opt_text(field).unwrap_or_else(|| Spanned::new(String::new(), self.span))
    }

    /// A child block.
    pub fn node(&self, field: &str) -> Option<&Node> {
        self.nodes(field).last()
    }

    /// Takes a child block out, as if it had not been given.
    pub fn take_node(&mut self, field: &str) -> Option<Node> {
        let i = self.index(field);
        self.slots[i].pop().and_then(|s| match s.content {
            Content::Node(n) => Some(*n),
            Content::Value(_) | Content::Mesh(_) => None,
        })
    }

    /// All child blocks of a repeated field, in order.
    pub fn nodes(&self, field: &str) -> impl Iterator<Item = &Node> {
        self.slots(field).iter().filter_map(|s| match &s.content {
            Content::Node(n) => {
                n.used.set(true);
                Some(&**n)
            }
            Content::Value(_) | Content::Mesh(_) => None,
        })
    }

    /// All texts of a repeated field, in order.
    pub fn texts(&self, field: &str) -> impl Iterator<Item = Spanned<&str>> {
        self.slots(field).iter().filter_map(|s| match &s.content {
            Content::Value(Value::Text(t)) => Some(Spanned::new(t.as_str(), s.span)),
            _ => None,
        })
    }

    /// The bulk data of an embedded mesh.
    pub fn mesh(&self, field: &str) -> Option<&EmbeddedMesh> {
        self.slots(field).last().and_then(|s| match &s.content {
            Content::Mesh(m) => Some(&**m),
            Content::Value(_) | Content::Node(_) => None,
        })
    }

    /// Calls `visit` with each reference to something defined elsewhere: what it refers to ("material"), the name,
    /// and where it stands. Nothing counts as read by it.
    pub fn visit_references(&self, visit: &mut impl FnMut(&'static str, &str, Span)) {
        self.visit_texts(&mut |kind, name, span| {
            if let Kind::Reference(what) = kind {
                visit(what, name, span);
            }
        });
    }

    /// Calls `visit` with the path of each file that is named, and where it stands. Nothing counts as read by it.
    pub fn visit_paths(&self, visit: &mut impl FnMut(&str, Span)) {
        self.visit_texts(&mut |kind, path, span| {
            if matches!(kind, Kind::Path) && !path.is_empty() {
                visit(path, span);
            }
        });
    }

    fn visit_texts(&self, visit: &mut impl FnMut(Kind, &str, Span)) {
        for (field, slots) in self.block.fields.iter().zip(&self.slots) {
            for slot in slots {
                match &slot.content {
                    Content::Node(inner) => inner.visit_texts(visit),
                    Content::Value(Value::Text(text)) => visit(field.kind, text, slot.span),
                    _ => {}
                }
            }
        }
        if let Some(alternative) = &self.alternative {
            alternative.visit_texts(visit);
        }
    }

    /// Marks everything in this element as used: lowering knows that none of it has an effect here,
    /// and why (the rule that says so is in the documentation of the element).
    pub fn disregard(&self) {
        self.used.set(true);
        for slot in self.slots.iter().flatten() {
            slot.read.set(true);
            if let Content::Node(n) = &slot.content {
                n.disregard();
            }
        }
        if let Some(a) = &self.alternative {
            a.disregard();
        }
    }

    /// Marks one field as used, though its value has no effect here.
    pub fn disregard_field(&self, field: &str) {
        for slot in self.slots(field) {
            if let Content::Node(n) = &slot.content {
                n.disregard();
            }
        }
    }

    /// Marks several fields as used, though their values have no effect here.
    pub fn disregard_fields(&self, fields: &[&str]) {
        for field in fields {
            self.disregard_field(field);
        }
    }

    /// Whether the kind of a field is a block, for listings.
    pub fn is_block(&self, field: &str) -> bool {
        matches!(self.block.fields[self.index(field)].kind, Kind::Block(_) | Kind::OneOf(_))
    }
}
