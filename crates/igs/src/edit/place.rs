//! How a text is laid out, so that what is put into it looks like its neighbours.

use crate::scan::{Scanner, Token};
use indigo_diag::{Sink, SourceId};

fn is_blank(b: u8) -> bool {
    matches!(b, b' ' | b'\t')
}

fn ends_line(b: u8) -> bool {
    matches!(b, b'\n' | b'\r')
}

/// The blanks that the line of a byte begins with, and whether nothing else stands before the byte.
pub(super) fn indentation(bytes: &[u8], at: usize) -> (String, bool) {
    let before = bytes.get(..at).unwrap_or_default();
    let line = before.rsplit(|&b| ends_line(b)).next().unwrap_or_default();
    let line = line.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(line);
    let blanks: String = line.iter().take_while(|&&b| is_blank(b)).map(|&b| char::from(b)).collect();
    let is_first = blanks.len() == line.len();
    (blanks, is_first)
}

/// What ends the lines of a file: what ends its first.
pub(super) fn newline(bytes: &[u8]) -> &'static str {
    let first = bytes.iter().position(|&b| ends_line(b));
    match first.and_then(|i| bytes.get(i..)) {
        Some([b'\r', b'\n', ..]) => "\r\n",
        Some([b'\r', ..]) => "\r",
        _ => "\n",
    }
}

/// What children are indented by: what the first indented tag is, or a tab.
pub(super) fn unit(bytes: &[u8]) -> String {
    let indents = bytes.split(|&b| ends_line(b)).filter_map(|line| {
        let blanks = line.iter().take_while(|&&b| is_blank(b)).count();
        let tagged = matches!(line.get(blanks..), Some([b'<', b, ..]) if b.is_ascii_alphabetic());
        line.get(..blanks).filter(|indent| tagged && !indent.is_empty())
    });
    let first = indents.map(String::from_utf8_lossy).next();
    first.map_or_else(|| "\t".to_owned(), std::borrow::Cow::into_owned)
}

/// Bytes before the byte `at` that are the line end and the indentation of an element alone in its line,
/// which ends at `end`; `None` where it is not alone.
pub(super) fn own_line(bytes: &[u8], at: usize, end: usize) -> Option<usize> {
    let (indent, is_first) = indentation(bytes, at);
    let after = bytes.get(end..)?.iter().find(|&&b| !is_blank(b))?;
    let line = at.checked_sub(indent.len()).filter(|&line| is_first && line > 0 && ends_line(*after))?;
    let is_pair = line >= 2 && bytes.get(line - 2..line) == Some(b"\r\n");
    Some(line - if is_pair { 2 } else { 1 })
}

/// The text of an element with `\n` for all line ends, and with its lines indented as that of an element that
/// begins behind `base`. Only blanks between tags change.
pub(super) fn reindent(text: &str, base: &str) -> String {
    let text = text.trim_ascii().replace("\r\n", "\n").replace('\r', "\n");
    let gaps = gaps(&text);
    let indent_of = |gap: &str| gap.rsplit('\n').next().unwrap_or_default().to_owned();
    let indents: Vec<String> = gaps.iter().filter_map(|g| text.get(g.clone())).map(indent_of).collect();
    let common = indents.iter().map(String::len).min().unwrap_or(0);
    let mut out = String::new();
    let mut at = 0;
    for (gap, indent) in gaps.into_iter().zip(&indents) {
        let lines = text.get(gap.clone()).unwrap_or_default().matches('\n').count();
        out.push_str(text.get(at..gap.start).unwrap_or_default());
        out.extend(std::iter::repeat_n('\n', lines));
        out.push_str(base);
        out.push_str(indent.get(common..).unwrap_or_default());
        at = gap.end;
    }
    out.push_str(text.get(at..).unwrap_or_default());
    out
}

/// The runs of blanks between tags in which a line ends.
fn gaps(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut scanner = Scanner::new(text.as_bytes(), SourceId(0));
    let mut sink = Sink::new();
    let mut gaps = vec![];
    while let Some(token) = scanner.next(&mut sink) {
        if let Token::Text(range) = token {
            let run = text.get(range.clone()).unwrap_or_default();
            if run.trim_ascii().is_empty() && run.contains('\n') {
                gaps.push(range);
            }
        }
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layout_is_seen() {
        let text = b"<scene>\r\n  <a/> <b/>\r\n</scene>";
        assert_eq!((newline(text), unit(text)), ("\r\n", "  ".to_owned()));
        assert_eq!(indentation(text, 11), ("  ".to_owned(), true));
        assert_eq!(indentation(text, 16), ("  ".to_owned(), false));
        assert_eq!((newline(b"<a/>"), unit(b"<a>\n\t\n<b/></a>")), ("\n", "\t".to_owned()));
        assert_eq!(newline(b"<a>\r<b/></a>"), "\r");
    }

    #[test]
    fn an_element_alone_in_its_line_is_known() {
        let text = b"<a>\r\n\t<b/> \r\n\t<c/><d/>\r\n</a>";
        assert_eq!(own_line(text, 6, 10), Some(3));
        assert_eq!(own_line(text, 14, 18), None);
        assert_eq!(own_line(text, 18, 22), None);
    }

    #[test]
    fn only_blanks_between_tags_are_indented_anew() {
        let text = "<a>\r\n    <b>x\n    y</b>\n    <!-- 1\n  2 -->\n  </a>\n";
        assert_eq!(reindent(text, "\t"), "<a>\n\t  <b>x\n    y</b>\n\t  <!-- 1\n  2 -->\n\t</a>");
    }
}
