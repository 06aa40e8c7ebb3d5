//! Where the elements that are to be changed begin and end in the text of their file.

use super::EditError;
use crate::codes;
use crate::scan::{Scanner, Token};
use crate::text;
use indigo_diag::{Sink, SourceId, Span};
use std::collections::BTreeMap;
use std::ops::Range;

/// The parts of an element in the text of its file.
#[derive(Clone, Debug)]
pub(super) struct Extent {
    /// Its name, in the start tag.
    pub name: Range<usize>,
    /// The start tag.
    pub tag: Range<usize>,
    /// Whether the start tag is all: `<name/>`.
    pub is_empty_tag: bool,
    /// What stands between start tag and end tag.
    pub content: Range<usize>,
    /// Behind the end tag.
    pub end: usize,
    /// The pieces of its text, without blanks around them.
    pub texts: Vec<Range<usize>>,
    /// Where its last child begins.
    pub last_child: Option<usize>,
    /// Whether its parent has text of its own.
    pub is_amid_text: bool,
}

/// What one pass over a file finds.
pub(super) struct Found {
    /// The elements asked for, by their first bytes.
    pub extents: BTreeMap<usize, Extent>,
    /// Whether bytes above 127 are Latin-1.
    pub latin1: bool,
}

impl Found {
    /// An element that begins at an offset, if it has this name.
    pub fn named(&self, bytes: &[u8], name: &str, start: usize) -> Option<&Extent> {
        let name = text::encode(name, self.latin1);
        self.extents.get(&start).filter(|e| bytes.get(e.name.clone()) == Some(&name[..]))
    }
}

/// An element that is open, and those of its children that are asked for.
struct Open {
    extent: Extent,
    wanted_children: Vec<usize>,
}

/// Finds the elements that begin at some offsets.
///
/// # Errors
/// Tags that do not match, or that are damaged: nothing in such a file can be changed safely.
pub(super) fn find(
    bytes: &[u8],
    source: SourceId,
    wanted: impl Fn(usize) -> bool,
) -> Result<Found, EditError> {
    if text::is_wide(bytes) {
        return Err(EditError::Encoding(Span::new(source, 0, 0)));
    }
    let mut pass =
        Pass { scanner: Scanner::new(bytes, source), wanted, open: vec![], found: BTreeMap::new() };
    let mut sink = Sink::new();
    while let Some(token) = pass.scanner.next(&mut sink) {
        match token {
            Token::Start { name, tag, empty } => pass.start(name, tag, empty),
            Token::End { name, tag } => pass.end(&name, &tag)?,
            Token::Text(range) => pass.text(&range, range.clone()),
            Token::CData(range) => pass.text(&range, range.start - CDATA_OPEN..range.end + CDATA_CLOSE),
        }
    }
    if let Some(open) = pass.open.last() {
        return Err(EditError::Malformed(pass.scanner.span(&open.extent.tag)));
    }
    let structural = sink.diagnostics().iter().find(|d| d.code != codes::STRAY_LESS_THAN);
    if let Some(d) = structural {
        return Err(EditError::Malformed(d.span.unwrap_or(Span::new(source, 0, 0))));
    }
    Ok(Found { extents: pass.found, latin1: pass.scanner.encoding.is_latin1() })
}

/// Bytes of `<![CDATA[`.
const CDATA_OPEN: usize = 9;
/// Bytes of `]]>`.
const CDATA_CLOSE: usize = 3;

struct Pass<'a, W> {
    scanner: Scanner<'a>,
    wanted: W,
    open: Vec<Open>,
    found: BTreeMap<usize, Extent>,
}

impl<W: Fn(usize) -> bool> Pass<'_, W> {
    fn start(&mut self, name: Range<usize>, tag: Range<usize>, empty: bool) {
        let start = tag.start;
        if let Some(parent) = self.open.last_mut() {
            parent.extent.last_child = Some(start);
            if (self.wanted)(start) {
                parent.wanted_children.push(start);
            }
        }
        let (content, end) = (tag.end..tag.end, tag.end);
        let extent = Extent {
            name,
            tag,
            is_empty_tag: empty,
            content,
            end,
            texts: vec![],
            last_child: None,
            is_amid_text: false,
        };
        let open = Open { extent, wanted_children: vec![] };
        if empty { self.keep(open) } else { self.open.push(open) }
    }

    fn end(&mut self, name: &Range<usize>, tag: &Range<usize>) -> Result<(), EditError> {
        let fault = EditError::Malformed(self.scanner.span(tag));
        let Some(mut open) = self.open.pop() else { return Err(fault) };
        if self.scanner.slice(&open.extent.name) != self.scanner.slice(name) {
            return Err(fault);
        }
        open.extent.content.end = tag.start;
        open.extent.end = tag.end;
        self.keep(open);
        Ok(())
    }

    /// Takes note of text of which `written` is all that stands in the file.
    fn text(&mut self, range: &Range<usize>, written: Range<usize>) {
        let bytes = self.scanner.slice(range);
        let ink = bytes.trim_ascii();
        let Some(open) = self.open.last_mut().filter(|_| !ink.is_empty()) else { return };
        let before = bytes.len() - bytes.trim_ascii_start().len();
        let inked = range.start + before..range.start + before + ink.len();
        open.extent.texts.push(if *range == written { inked } else { written });
    }

    /// Keeps a finished element if it is asked for, and tells its children whether they stand amid text.
    fn keep(&mut self, open: Open) {
        if !open.extent.texts.is_empty() {
            for child in open.wanted_children {
                if let Some(found) = self.found.get_mut(&child) {
                    found.is_amid_text = true;
                }
            }
        }
        if (self.wanted)(open.extent.tag.start) {
            self.found.insert(open.extent.tag.start, open.extent);
        }
    }
}
