//! Bytes to text: encodings, line ends, entities.

use crate::codes;
use indigo_diag::{Diagnostic, Sink, SourceId, Span};

/// How bytes above 127 are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Encoding {
    /// Whether the file says that it is Latin-1.
    latin1: bool,
    /// Whether a byte that is not UTF-8 was warned of.
    warned: bool,
}

impl Encoding {
    /// Takes note of the `encoding` in `<?xml ...?>`.
    pub fn declare(&mut self, declaration: &[u8], span: Span, sink: &mut Sink) {
        let text = String::from_utf8_lossy(declaration).to_ascii_lowercase();
        let Some((_, rest)) = text.split_once("encoding") else { return };
        let name = rest.split(['"', '\'']).nth(1).unwrap_or_default();
        match name {
            "utf-8" | "utf8" | "us-ascii" | "ascii" => {}
            "iso-8859-1" | "latin1" | "latin-1" | "windows-1252" => self.latin1 = true,
            _ => sink.push(
                Diagnostic::error(codes::ENCODING, span, format!("the encoding {name} is not read"))
                    .hint("save the file as UTF-8"),
            ),
        }
    }

    /// Whether the file says that it is Latin-1.
    pub fn is_latin1(self) -> bool {
        self.latin1
    }
}

/// Some text as bytes of a file; characters that Latin-1 lacks become entities. Those from 128 to 159 too, which
/// mean something else in Windows-1252.
pub(crate) fn encode(text: &str, latin1: bool) -> Vec<u8> {
    if !latin1 {
        return text.as_bytes().to_vec();
    }
    let mut bytes = Vec::with_capacity(text.len());
    for c in text.chars() {
        match u8::try_from(c) {
            Ok(b) if !(0x80..0xA0).contains(&b) => bytes.push(b),
            _ => bytes.extend(format!("&#{};", u32::from(c)).bytes()),
        }
    }
    bytes
}

/// Whether a file is in UTF-16 or UTF-32, of which nothing can be read: by its mark, or the `<` it begins with.
pub(crate) fn is_wide(bytes: &[u8]) -> bool {
    matches!(bytes, [0xFE, 0xFF, ..] | [0xFF, 0xFE, ..] | [0, b'<', ..] | [b'<', 0, ..] | [0, 0, 0, b'<', ..])
}

/// How much of a file is looked at to see whether it is text.
const LOOKED_AT: usize = 4096;

/// Whether a file is no text at all but a picture, say: it does not begin like a scene, and holds bytes that no text
/// has.
pub(crate) fn is_binary(bytes: &[u8]) -> bool {
    let ink = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start();
    let control = |b: &u8| b.is_ascii_control() && !b.is_ascii_whitespace();
    !ink.starts_with(b"<") && !is_wide(bytes) && bytes.iter().take(LOOKED_AT).any(control)
}

/// Text of some bytes that begin at `offset` of a file. Line ends become `\n`; bytes that are not
/// UTF-8 are read as Latin-1, with one warning per file; entities are replaced if asked for.
pub(crate) fn decode(
    bytes: &[u8],
    source: SourceId,
    offset: usize,
    encoding: &mut Encoding,
    entities: bool,
    sink: &mut Sink,
) -> String {
    let mut text = characters(bytes, source, offset, encoding, sink);
    if text.contains('\r') {
        text = text.replace("\r\n", "\n").replace('\r', "\n");
    }
    if entities && bytes.contains(&b'&') {
        report_entities(bytes, source, offset, sink);
        text = replace_entities(&text);
    }
    text
}

fn characters(
    bytes: &[u8],
    source: SourceId,
    offset: usize,
    encoding: &mut Encoding,
    sink: &mut Sink,
) -> String {
    if encoding.latin1 {
        return bytes.iter().map(|&b| char::from(b)).collect();
    }
    let mut text = String::with_capacity(bytes.len());
    let mut at = offset;
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        at += chunk.valid().len();
        if !chunk.invalid().is_empty() && !encoding.warned {
            encoding.warned = true;
            let span = Span::new(source, at, at + chunk.invalid().len());
            sink.push(
                Diagnostic::warning(
                    codes::NOT_UTF8,
                    span,
                    "this is not UTF-8; such bytes of this file are read as Latin-1",
                )
                .hint("save the file as UTF-8"),
            );
        }
        text.extend(chunk.invalid().iter().map(|&b| char::from(b)));
        at += chunk.invalid().len();
    }
    text
}

/// The character that an entity stands for; `None` for an unknown one.
fn entity(name: &str) -> Option<char> {
    match name {
        "lt" => Some('<'),
        "gt" => Some('>'),
        "amp" => Some('&'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        _ => {
            let number = name.strip_prefix('#')?;
            let code = match number.strip_prefix(['x', 'X']) {
                Some(hex) => u32::from_str_radix(hex, 16).ok()?,
                None => number.parse().ok()?,
            };
            char::from_u32(code).filter(|&c| c >= ' ' || matches!(c, '\t' | '\n' | '\r'))
        }
    }
}

/// The name between `&` and `;` at the start of a text that follows a `&`, if it looks like one.
fn entity_name(after: &str) -> Option<&str> {
    let end = after.char_indices().take(12).find(|&(_, c)| c == ';')?.0;
    after.get(..end)
}

fn replace_entities(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('&') {
        out.push_str(before);
        match entity_name(after).and_then(|n| Some((n.len(), entity(n)?))) {
            Some((length, c)) => {
                out.push(c);
                rest = after.get(length + 1..).unwrap_or_default();
            }
            None => {
                out.push('&');
                rest = after;
            }
        }
    }
    out.push_str(rest);
    out
}

fn report_entities(bytes: &[u8], source: SourceId, offset: usize, sink: &mut Sink) {
    for (i, _) in bytes.iter().enumerate().filter(|&(_, &b)| b == b'&') {
        let window = bytes.get(i + 1..bytes.len().min(i + 14)).unwrap_or_default();
        let after = String::from_utf8_lossy(window);
        let name = entity_name(&after);
        if name.and_then(entity).is_some() {
            continue;
        }
        let shown = name.filter(|n| n.chars().all(|c| c.is_alphanumeric() || c == '#'));
        let length = shown.map_or(1, |n| n.len() + 2);
        let message = match shown {
            Some(n) => format!("unknown entity &{n};"),
            None => "this & begins no entity".to_owned(),
        };
        sink.push(
            Diagnostic::error(codes::BAD_ENTITY, Span::new(source, offset + i, offset + i + length), message)
                .hint("write &amp; for a & in a text"),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> (String, usize) {
        let mut sink = Sink::new();
        let text = decode(bytes, SourceId(0), 0, &mut Encoding::default(), true, &mut sink);
        (text, sink.diagnostics().len())
    }

    #[test]
    fn entities() {
        assert_eq!(read(b"a &lt;&amp;&#65;&#x42;&gt; b"), ("a <&AB> b".to_owned(), 0));
        assert_eq!(read(b"&&lt;"), ("&<".to_owned(), 1));
        assert_eq!(read(b"&lol; &#0; &#xD800; &#; &"), ("&lol; &#0; &#xD800; &#; &".to_owned(), 5));
    }

    #[test]
    fn pictures_are_not_text() {
        for bytes in
            [&b"\x89PNG\r\n\x1A\n\0\0\0\rIHDR"[..], b"\xFF\xD8\xFF\xE0\0\x10JFIF", b"PK\x03\x04\x14\0"]
        {
            assert!(is_binary(bytes) && !is_wide(bytes), "{bytes:?}");
        }
        for bytes in
            [&b"<scene>\0</scene>"[..], b" \n<scene/>", b"\xEF\xBB\xBF<scene/>", b"scene", b"", b"<\0s\0"]
        {
            assert!(!is_binary(bytes), "{bytes:?}");
        }
    }

    #[test]
    fn encodings_and_line_ends() {
        assert_eq!(read("größe\r\n1\r2".as_bytes()), ("größe\n1\n2".to_owned(), 0));
        assert_eq!(read(b"gr\xF6\xDFe \xE4"), ("größe ä".to_owned(), 1));
    }
}
