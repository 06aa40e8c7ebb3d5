//! Changes of elements as changes of bytes.

use super::extent::{self, Extent, Found};
use super::place::{indentation, newline, own_line, reindent, unit};
use super::{Change, EditError};
use crate::text::encode;
use crate::write::{Layout, escape, fragment};
use indigo_decl::Element;
use indigo_diag::SourceId;
use std::collections::BTreeMap;
use std::ops::Range;

/// The comments in a text of elements.
fn comments(text: &[u8]) -> Vec<&[u8]> {
    const BRACKETS: [(&[u8], &[u8], bool); 2] = [(b"<!--", b"-->", true), (b"<![CDATA[", b"]]>", false)];
    let mut found = vec![];
    let mut at = 0;
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let opened = BRACKETS.iter().find(|(open, ..)| rest.starts_with(open));
        let Some((open, close, is_comment)) = opened else {
            at += 1;
            continue;
        };
        let inside = rest.get(open.len()..).unwrap_or_default();
        let Some(end) = inside.windows(close.len()).position(|part| part == *close) else { break };
        let length = open.len() + end + close.len();
        if *is_comment {
            found.extend(rest.get(..length));
        }
        at += length;
    }
    found
}

/// Bytes that stand in the place of others.
struct Splice {
    at: Range<usize>,
    new: Vec<u8>,
}

/// The bytes of a file after its changes, which go by the first bytes of elements.
pub(super) fn apply(
    bytes: &[u8],
    source: SourceId,
    changes: &BTreeMap<usize, &Change>,
) -> Result<Vec<u8>, EditError> {
    let found = extent::find(bytes, source, |at| changes.contains_key(&at))?;
    let mut file = File { bytes, found, splices: vec![] };
    let mut whole_until = 0;
    for (start, change) in changes {
        let extent = file.found.named(bytes, &change.name, *start).cloned();
        let extent =
            extent.ok_or_else(|| EditError::NotThere { name: change.name.to_string(), span: change.span })?;
        let is_whole = change.whole.is_some();
        if *start < whole_until || is_whole && (change.text.is_some() || !change.children.is_empty()) {
            return Err(EditError::Overlap(change.span));
        }
        if is_whole {
            whole_until = extent.end;
        }
        file.change(&extent, change)?;
    }
    Ok(file.spliced())
}

struct File<'a> {
    bytes: &'a [u8],
    found: Found,
    splices: Vec<Splice>,
}

impl File<'_> {
    fn change(&mut self, extent: &Extent, change: &Change) -> Result<(), EditError> {
        match &change.whole {
            Some(text) if text.is_empty() => self.remove(extent),
            Some(text) => self.replace(extent, text)?,
            None if extent.is_empty_tag => self.fill(extent, change),
            None => {
                if let Some(text) = &change.text {
                    self.set_text(extent, text);
                }
                self.append(extent, &change.children);
            }
        }
        Ok(())
    }

    /// Takes a change, its lines still ending by `\n`.
    fn splice(&mut self, at: Range<usize>, new: &str) {
        let new = new.replace('\n', newline(self.bytes));
        self.splices.push(Splice { at, new: encode(&new, self.found.latin1) });
    }

    fn remove(&mut self, extent: &Extent) {
        let (start, end) = (extent.tag.start, extent.end);
        // Line ends are a part of the text that they stand in.
        let line = own_line(self.bytes, start, end).filter(|_| !extent.is_amid_text);
        self.splice(line.unwrap_or(start)..end, "");
    }

    fn replace(&mut self, extent: &Extent, text: &str) -> Result<(), EditError> {
        let absent = text.chars().find(|&c| self.found.latin1 && encode(&c.to_string(), true).len() > 1);
        if let Some(character) = absent {
            return Err(EditError::NotInLatin1 { character });
        }
        let layout = self.layout(indentation(self.bytes, extent.tag.start).0);
        let whole = extent.tag.start..extent.end;
        let old = self.bytes.get(whole.clone()).unwrap_or_default();
        let mut new = text.trim_end().to_owned();
        for comment in comments(old) {
            let comment: String = if self.found.latin1 {
                comment.iter().copied().map(char::from).collect()
            } else {
                String::from_utf8_lossy(comment).into_owned()
            };
            // The text may have it already.
            if !text.contains(&*comment) {
                // Line ends are a part of the text that they stand in.
                new.push_str(if extent.is_amid_text { "" } else { "\n" });
                new.push_str(&comment);
            }
        }
        self.splice(whole, &reindent(&new, &layout.base));
        Ok(())
    }

    /// A new text in the place of the first piece of the old one; the other pieces go.
    fn set_text(&mut self, extent: &Extent, text: &str) {
        let mut new = String::new();
        escape(&mut new, text);
        let start = extent.content.start;
        let (first, others) = match extent.texts.split_first() {
            Some((first, others)) => (first.clone(), others),
            None => (start..start, &[][..]),
        };
        self.splice(first, &new);
        for piece in others {
            self.splice(piece.clone(), "");
        }
    }

    /// New children behind all else that is in an element.
    fn append(&mut self, extent: &Extent, children: &[Element]) {
        if children.is_empty() {
            return;
        }
        let content = self.bytes.get(extent.content.clone()).unwrap_or_default();
        let end = extent.content.start + content.trim_ascii_end().len();
        let tail = self.bytes.get(end..extent.content.end).unwrap_or_default();
        let (own, _) = indentation(self.bytes, extent.tag.start);
        let (layout, close) = match extent.last_child.map(|child| indentation(self.bytes, child)) {
            Some((_, false)) => (inline(), None),
            Some((base, true)) => (self.layout(base), Some(own)),
            None => (self.layout(format!("{own}{}", unit(self.bytes))), Some(own)),
        };
        let mut new = written(children, &layout);
        let mut at = end..end;
        // The end tag gets a line of its own, unless it has one.
        if let Some(own) = close.filter(|_| !tail.iter().any(|b| matches!(b, b'\n' | b'\r'))) {
            new.push('\n');
            new.push_str(&own);
            at.end = extent.content.end;
        }
        self.splice(at, &new);
    }

    /// Text and children of an element that was `<name/>`.
    fn fill(&mut self, extent: &Extent, change: &Change) {
        let text = change.text.as_deref().unwrap_or_default();
        if text.is_empty() && change.children.is_empty() {
            return;
        }
        // Before the `/>`, blanks and all.
        let tag = self.bytes.get(extent.tag.clone()).unwrap_or_default();
        let tag = tag.strip_suffix(b"/>").unwrap_or(tag).trim_ascii_end();
        let mut new = String::from(">");
        escape(&mut new, text);
        if !change.children.is_empty() {
            let (own, _) = indentation(self.bytes, extent.tag.start);
            let layout = self.layout(format!("{own}{}", unit(self.bytes)));
            new.push_str(&written(&change.children, &layout));
            new.push('\n');
            new.push_str(&own);
        }
        new.push_str("</");
        new.push_str(&change.name);
        new.push('>');
        self.splice(extent.tag.start + tag.len()..extent.tag.end, &new);
    }

    fn layout(&self, base: String) -> Layout {
        Layout { newline: "\n".to_owned(), base, unit: unit(self.bytes) }
    }

    fn spliced(mut self) -> Vec<u8> {
        self.splices.sort_by_key(|s| (s.at.start, s.at.end));
        let mut out = Vec::with_capacity(self.bytes.len());
        let mut at = 0;
        for splice in self.splices {
            out.extend_from_slice(self.bytes.get(at..splice.at.start).unwrap_or_default());
            out.extend_from_slice(&splice.new);
            at = at.max(splice.at.end);
        }
        out.extend_from_slice(self.bytes.get(at..).unwrap_or_default());
        out
    }
}

/// All in one line.
fn inline() -> Layout {
    Layout { newline: String::new(), base: String::new(), unit: String::new() }
}

/// Elements, each of them behind a line end and its indentation.
fn written(elements: &[Element], layout: &Layout) -> String {
    let one = |e| [&layout.newline, &layout.base, &fragment(e, layout)].map(String::as_str).concat();
    elements.iter().map(one).collect()
}
