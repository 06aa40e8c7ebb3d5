//! Elements as they were written: names, text and children, each with its place.

use crate::mesh::EmbeddedMesh;
use indigo_diag::{Span, Spanned};

/// An attribute of an element.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Name.
    pub name: Spanned<Box<str>>,
    /// Value with entities replaced.
    pub value: Spanned<Box<str>>,
}

/// An element of a scene file, or of anything that can be written as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Name of the element.
    pub name: Box<str>,
    /// The start tag.
    pub span: Span,
    /// Attributes in order.
    pub attributes: Vec<Attribute>,
    /// Child elements in order.
    pub children: Vec<Element>,
    /// All text directly inside, trimmed; empty where there is none.
    pub text: Spanned<Box<str>>,
    /// The bulk data of an `embedded` mesh, which has no child elements for its vertices and triangles.
    pub mesh: Option<Box<EmbeddedMesh>>,
}

impl Element {
    /// An element without content.
    pub fn new(name: &str, span: Span) -> Self {
        Self {
            name: name.into(),
            span,
            attributes: vec![],
            children: vec![],
            text: Spanned::new("".into(), span),
            mesh: None,
        }
    }

    /// The first child of a name.
    pub fn child(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|c| &*c.name == name)
    }
}
