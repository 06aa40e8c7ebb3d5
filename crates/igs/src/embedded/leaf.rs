//! The text of an element without children, and what does not belong into a mesh.

use super::Reader;
use crate::codes;
use crate::scan::Token;
use indigo_diag::nearest;
use std::ops::Range;

/// The elements that an `embedded` mesh is in or made of: an end tag of one of them closes whatever
/// is still open inside.
const OUTER: [&str; 7] =
    ["vertex", "triangle_set", "expose_uv_set", "embedded", "mesh", "scene", "scenedata"];

/// Those that an `embedded` mesh is in, and itself.
const AROUND: [&str; 4] = ["embedded", "mesh", "scene", "scenedata"];

/// What an end tag does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// Closes the innermost element.
    Closed,
    /// Closes an element further out, and is left for it.
    Outer,
    /// Closes nothing.
    Nothing,
}

/// The text of an element.
pub(super) struct Leaf {
    /// Where it stands, without blanks around it.
    pub at: Range<usize>,
    /// Whether entities are to be replaced in it.
    pub entities: bool,
    /// The text itself where it is in several pieces.
    pub joined: Option<Vec<u8>>,
}

impl Leaf {
    /// The bytes of the text.
    pub fn bytes<'a>(&'a self, file: &'a [u8]) -> &'a [u8] {
        match &self.joined {
            Some(joined) => joined,
            None => file.get(self.at.clone()).unwrap_or_default(),
        }
    }
}

impl Reader<'_, '_, '_> {
    /// Reads up to the end tag of an element without children; `None` where the file ends.
    pub(super) fn leaf(&mut self, name: &Range<usize>, tag: &Range<usize>, empty: bool) -> Option<Leaf> {
        let element = self.scanner.slice(name);
        let shown = String::from_utf8_lossy(element);
        if !self.scanner.attributes.is_empty() {
            self.unknown_attributes(&shown);
        }
        let mut leaf = Leaf { at: tag.clone(), entities: true, joined: None };
        if empty {
            leaf.joined = Some(vec![]);
            return Some(leaf);
        }
        let mut pieces = 0_usize;
        loop {
            match self.next()? {
                Token::Text(range) => self.add_piece(&mut leaf, range, true, &mut pieces),
                Token::CData(range) => self.add_piece(&mut leaf, range, false, &mut pieces),
                Token::Start { name, tag, empty } => {
                    if self.leaves_open(&name, &tag, element) {
                        break;
                    }
                    if !self.unknown_element(&name, &tag, empty, &shown) {
                        return None;
                    }
                }
                Token::End { name, tag } => {
                    if self.check_end(&name, &tag, element) != End::Nothing {
                        break;
                    }
                }
            }
        }
        if pieces == 0 {
            leaf.joined = Some(vec![]);
        }
        Some(leaf)
    }

    fn add_piece(&mut self, leaf: &mut Leaf, range: Range<usize>, entities: bool, pieces: &mut usize) {
        *pieces += 1;
        let bytes = self.scanner.slice(&range);
        let blank = |b: &&u8| b.is_ascii_whitespace();
        let before = bytes.iter().take_while(blank).count();
        let after = bytes.iter().rev().take_while(blank).count().min(bytes.len() - before);
        let inked = range.start + before..range.end - after;
        if *pieces == 1 {
            leaf.at = inked;
            leaf.entities = entities;
            return;
        }
        // Several pieces, with comments or CDATA between them: rare, so joining may be slow.
        let earlier = leaf.at.clone();
        let mut joined = match leaf.joined.take() {
            Some(joined) => joined,
            None => self.scanner.decode(&earlier, leaf.entities, self.report.sink).into_bytes(),
        };
        if before > 0 {
            joined.push(b' ');
        }
        joined.extend(self.scanner.decode(&range, entities, self.report.sink).into_bytes());
        leaf.joined = Some(joined);
        leaf.at = earlier.start..inked.end.max(earlier.end);
    }

    /// Reads up to the end tag of an element whose content has no meaning; `false` where the file ends.
    pub(super) fn skip(&mut self, name: &Range<usize>, parent: &str) -> bool {
        while let Some(token) = self.next() {
            match token {
                Token::Start { name: inner, tag, empty } => {
                    if self.leaves_open(&inner, &tag, self.scanner.slice(name)) {
                        return true;
                    }
                    if !self.unknown_element(&inner, &tag, empty, parent) {
                        return false;
                    }
                }
                Token::End { name: end, tag } => {
                    if self.check_end(&end, &tag, self.scanner.slice(name)) != End::Nothing {
                        return true;
                    }
                }
                Token::Text(range) | Token::CData(range) => self.stray_text(&range, parent),
            }
        }
        false
    }

    /// Warns of an element that does not belong here and skips it; `false` where the file ends.
    pub(super) fn unknown_element(
        &mut self,
        name: &Range<usize>,
        tag: &Range<usize>,
        empty: bool,
        parent: &str,
    ) -> bool {
        let written = String::from_utf8_lossy(self.scanner.slice(name)).into_owned();
        self.report.unknown_element(&written, parent, self.scanner.span(tag));
        // Inside, only the tags that have the element's own name matter.
        let mut depth = usize::from(!empty);
        while depth > 0 {
            match self.next() {
                Some(Token::Start { name: inner, empty: false, .. })
                    if self.scanner.slice(&inner) == written.as_bytes() =>
                {
                    depth += 1;
                }
                Some(Token::End { name: inner, .. }) if self.scanner.slice(&inner) == written.as_bytes() => {
                    depth -= 1;
                }
                Some(Token::End { name: outer, tag })
                    if AROUND.iter().any(|o| o.as_bytes() == self.scanner.slice(&outer)) =>
                {
                    self.check_end(&outer, &tag, written.as_bytes());
                    return true;
                }
                Some(_) => {}
                None => return false,
            }
        }
        true
    }

    /// Whether a start tag shows that the element before it was not closed: no vertex is inside a
    /// vertex, no triangle in a triangle. It is reported, and the tag is left for whoever it is for.
    fn leaves_open(&mut self, name: &Range<usize>, tag: &Range<usize>, element: &[u8]) -> bool {
        let written = self.scanner.slice(name);
        if written != element && !OUTER.iter().any(|o| o.as_bytes() == written) {
            return false;
        }
        let (written, element) = (String::from_utf8_lossy(written), String::from_utf8_lossy(element));
        let message = format!("<{written}> stands where <{element}> is still open");
        let span = self.scanner.span(tag);
        self.report.error(codes::MISMATCHED_TAGS, span, message, format!("expected </{element}> before it"));
        self.scanner.at = tag.start;
        true
    }

    /// Judges an end tag where one of the `expected` name belongs.
    pub(super) fn check_end(&mut self, name: &Range<usize>, tag: &Range<usize>, expected: &[u8]) -> End {
        let written = self.scanner.slice(name);
        if written == expected {
            return End::Closed;
        }
        let (written, expected) = (String::from_utf8_lossy(written), String::from_utf8_lossy(expected));
        let message = format!("</{written}> stands where <{expected}> is still open");
        let span = self.scanner.span(tag);
        self.report.error(codes::MISMATCHED_TAGS, span, message, format!("expected </{expected}>"));
        if OUTER.contains(&&*written) {
            self.scanner.at = tag.start;
            End::Outer
        } else if nearest(&written, [&*expected]).is_some() {
            End::Closed
        } else {
            End::Nothing
        }
    }

    pub(super) fn unknown_attributes(&mut self, element: &str) {
        let attributes = std::mem::take(&mut self.scanner.attributes);
        for a in &attributes {
            self.unknown_attribute(&a.name, element);
        }
        self.scanner.attributes = attributes;
    }

    pub(super) fn unknown_attribute(&mut self, name: &Range<usize>, element: &str) {
        let written = String::from_utf8_lossy(self.scanner.slice(name)).into_owned();
        self.report.unknown_attribute(&written, element, self.scanner.span(name));
    }

    pub(super) fn stray_text(&mut self, range: &Range<usize>, element: &str) {
        let bytes = self.scanner.slice(range);
        if let Some(first) = bytes.iter().position(|b| !b.is_ascii_whitespace()) {
            let last = bytes.iter().rposition(|b| !b.is_ascii_whitespace()).unwrap_or(first);
            let span = self.scanner.span(&(range.start + first..range.start + last + 1));
            self.report.stray_text(element, span);
        }
    }
}
