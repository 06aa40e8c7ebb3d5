//! Changes in the text of scenes that keep everything else in it: comments, layout, encoding and line ends.
//!
//! Changes are gathered in [`Edits`], by the elements of the tree that was read, and worked into the text all at once.
//! What comes of it reads as the same tree but for the changes. An element that came from an included file is
//! changed in that file. Writing files is left to the caller, who also knows whether a file has changed since.
//!
//! ```
//! # use indigo_decl::{ResolveError, Resolved, Resolver};
//! # struct Memory;
//! # impl Resolver for Memory {
//! #     fn read(&self, path: &str, _: &str) -> Result<Resolved, ResolveError> {
//! #         let text = "<scene>\n  <camera><width>2</width></camera> <!-- mine -->\n</scene>\n";
//! #         Ok(Resolved { path: path.to_owned(), bytes: text.as_bytes().into() })
//! #     }
//! # }
//! # let (mut sources, mut sink) = (indigo_diag::SourceMap::default(), indigo_diag::Sink::new());
//! # let limits = indigo_igs::Limits::default();
//! let scene = indigo_igs::read_scene("a.igs", &Memory, &mut sources, &mut sink, &limits).unwrap();
//! let mut edits = indigo_igs::edit::Edits::default();
//! edits.set_child(&scene, "camera/width", "3")?;
//! edits.set_child(&scene, "tonemapping/linear/scale", "0.5")?;
//! let files = edits.apply(&sources)?;
//! assert_eq!(
//!     String::from_utf8_lossy(&files[0].bytes),
//!     "<scene>
//!   <camera><width>3</width></camera> <!-- mine -->
//!   <tonemapping>
//!     <linear>
//!       <scale>0.5</scale>
//!     </linear>
//!   </tonemapping>
//! </scene>
//! "
//! );
//! # Ok::<(), indigo_igs::edit::EditError>(())
//! ```

mod extent;
mod place;
mod splice;

use crate::{Limits, tag, tree};
use indigo_decl::Element;
use indigo_diag::{Severity, Sink, SourceId, SourceMap, Span};
use std::collections::BTreeMap;
use std::ops::Range;
use thiserror::Error;

/// Why a text was not changed.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum EditError {
    /// A place that is no element of the files that were read: expected is one of the tree.
    #[error("there is no <{name}> in the file here; expected an element as it was read")]
    NotThere {
        /// The element that was expected.
        name: String,
        /// Where it should stand.
        span: Span,
    },
    /// A file whose tags cannot be told.
    #[error("this keeps the file from being changed; expected tags that match")]
    Malformed(Span),
    /// A file in UTF-16.
    #[error("this file cannot be changed; expected UTF-8 or Latin-1")]
    Encoding(Span),
    /// Changes of which one undoes the other.
    #[error("this is changed, and so is something that holds it; expected one of both")]
    Overlap(Span),
    /// A name that no element can have.
    #[error("`{0}` is no name of an element; expected letters, digits, `_`, `-` and `.`")]
    BadName(String),
    /// A replacement that cannot stand for an element.
    #[error("the new text: {message}; expected one whole element")]
    BadText {
        /// What is wrong with it.
        message: String,
        /// Where in it, in bytes.
        at: usize,
    },
    /// A replacement that the file's encoding cannot hold.
    #[error("the file is in Latin-1, which has no `{character}`; expected &#{};", u32::from(*.character))]
    NotInLatin1 {
        /// The first character of that kind.
        character: char,
    },
}

impl EditError {
    /// The place in the files that were read, if it has one.
    pub fn span(&self) -> Option<Span> {
        match self {
            Self::NotThere { span, .. }
            | Self::Malformed(span)
            | Self::Encoding(span)
            | Self::Overlap(span) => Some(*span),
            Self::BadName(_) | Self::BadText { .. } | Self::NotInLatin1 { .. } => None,
        }
    }
}

/// What becomes of one element.
#[derive(Clone, Debug, PartialEq)]
struct Change {
    /// Its name, by which its place is checked.
    name: Box<str>,
    span: Span,
    /// What stands in its place; nothing if that is empty.
    whole: Option<String>,
    /// Its new text.
    text: Option<String>,
    /// New children, behind those that there are.
    children: Vec<Element>,
}

/// A file after its changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EditedFile {
    /// The name under which it was read.
    pub path: String,
    /// The file as it was read: whoever writes it finds out by [`SourceMap::text`] whether it has changed since.
    pub source: SourceId,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// Changes to come.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edits {
    changes: BTreeMap<(SourceId, u32), Change>,
}

impl Edits {
    /// Whether nothing is to be changed.
    pub fn is_empty(&self) -> bool {
        self.changes.is_empty()
    }

    /// Gives an element another text; comments between pieces of the old one stay. Blanks around a text are no
    /// part of it, as in all scenes.
    pub fn set_text(&mut self, element: &Element, text: &str) {
        self.of(element).text = Some(text.trim_ascii().to_owned());
    }

    /// Gives a descendant, whose path holds names and slashes, another text. Of elements that are not there one is
    /// made, behind the other children. Of several with one name the first is meant.
    ///
    /// # Errors
    /// [`EditError::BadName`]
    pub fn set_child(&mut self, parent: &Element, path: &str, text: &str) -> Result<(), EditError> {
        let names: Vec<&str> = path.split('/').collect();
        if let Some(name) = names.iter().find(|name| !tag::is_plain_name(name)) {
            return Err(EditError::BadName((*name).to_owned()));
        }
        let mut at = parent;
        let mut missing = names.as_slice();
        while let Some((child, rest)) = missing.split_first().and_then(|(n, rest)| Some((at.child(n)?, rest)))
        {
            (at, missing) = (child, rest);
        }
        if missing.is_empty() {
            self.set_text(at, text);
        } else {
            let span = at.span;
            let made = make(&mut self.of(at).children, missing, span);
            if let Some(made) = made {
                made.text.value = text.trim_ascii().into();
            }
        }
        Ok(())
    }

    /// Puts a text that is one whole element in the place of one, indented as that was, and the comments that were in it
    /// behind it.
    ///
    /// # Errors
    /// [`EditError::BadText`]
    pub fn replace(&mut self, element: &Element, text: &str) -> Result<(), EditError> {
        let text = text.trim_start_matches('\u{FEFF}');
        check(text)?;
        self.of(element).whole = Some(text.to_owned());
        Ok(())
    }

    /// Takes an element out, with its line if it has one of its own.
    pub fn remove(&mut self, element: &Element) {
        self.of(element).whole = Some(String::new());
    }

    /// The files after the changes, without those in which nothing changed.
    ///
    /// # Errors
    /// All but those above; then nothing is changed.
    pub fn apply(&self, sources: &SourceMap) -> Result<Vec<EditedFile>, EditError> {
        let mut files: BTreeMap<&str, (SourceId, BTreeMap<usize, &Change>)> = BTreeMap::new();
        for (&(source, start), change) in &self.changes {
            // A file that is included twice is one file.
            let (_, of_file) = files.entry(sources.name(source)).or_insert_with(|| (source, BTreeMap::new()));
            let twin = of_file.insert(start as usize, change);
            if twin.is_some_and(|twin| Change { span: change.span, ..twin.clone() } != *change) {
                return Err(EditError::Overlap(change.span));
            }
        }
        let mut edited = vec![];
        for (path, (source, changes)) in files {
            let before = sources.text(source);
            let bytes = splice::apply(before, source, &changes)?;
            if bytes != before {
                edited.push(EditedFile { path: path.to_owned(), source, bytes });
            }
        }
        Ok(edited)
    }

    fn of(&mut self, element: &Element) -> &mut Change {
        let span = element.span;
        self.changes.entry((span.source, span.start)).or_insert_with(|| Change {
            name: element.name.clone(),
            span,
            whole: None,
            text: None,
            children: vec![],
        })
    }
}

/// The bytes of a file that an element takes, from its start tag to behind its end tag.
///
/// # Errors
/// Where the file holds no such element, or tags that do not match.
pub fn range_of(element: &Element, sources: &SourceMap) -> Result<Range<usize>, EditError> {
    let span = element.span;
    let start = span.start as usize;
    let bytes = sources.text(span.source);
    let found = extent::find(bytes, span.source, |at| at == start)?;
    let extent = found.named(bytes, &element.name, start);
    extent
        .map(|e| e.tag.start..e.end)
        .ok_or_else(|| EditError::NotThere { name: element.name.to_string(), span })
}

/// The last element of a path below some elements; what is missing is made.
fn make<'e>(elements: &'e mut Vec<Element>, names: &[&str], span: Span) -> Option<&'e mut Element> {
    let (name, rest) = names.split_first()?;
    let at = elements.iter().position(|e| &*e.name == *name).unwrap_or_else(|| {
        elements.push(Element::new(name, span));
        elements.len() - 1
    });
    let element = elements.get_mut(at)?;
    if rest.is_empty() { Some(element) } else { make(&mut element.children, rest, span) }
}

/// Whether a text is one whole element, and nothing but comments beside it.
fn check(text: &str) -> Result<(), EditError> {
    if let Some(at) = text.find("<?xml") {
        return Err(EditError::BadText { message: "it holds an XML declaration".to_owned(), at });
    }
    let mut sink = Sink::new();
    let limits = Limits::default();
    let root =
        tree::parse(text.as_bytes(), SourceId(0), &limits, &mut { limits.elements }, &mut sink, &|| false);
    let fault = sink.diagnostics().iter().find(|d| d.severity == Severity::Error);
    match (fault, root) {
        (None, Some(_)) => Ok(()),
        (Some(d), _) => Err(EditError::BadText {
            message: d.message.clone(),
            at: d.span.map_or(0, |span| span.start as usize),
        }),
        (None, None) => Err(EditError::BadText { message: "it holds no element".to_owned(), at: 0 }),
    }
}
