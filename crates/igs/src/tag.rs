//! Tags and their attributes.

use crate::codes;
use crate::scan::{RawAttribute, Scanner, Token};
use indigo_diag::{Diagnostic, Sink};
use std::ops::Range;

/// More attributes than any element has.
const MOST_ATTRIBUTES: usize = 64;

/// Whether a byte may begin a name.
pub(crate) fn starts_name(b: u8) -> bool {
    b.is_ascii_alphabetic() || b == b'_' || b == b':' || b >= 0x80
}

/// Whether a text is a name that any encoding can hold.
pub(crate) fn is_plain_name(name: &str) -> bool {
    let (first, rest) = (name.bytes().next(), name.bytes().skip(1));
    name.is_ascii() && first.is_some_and(starts_name) && rest.into_iter().all(continues_name)
}

fn continues_name(b: u8) -> bool {
    starts_name(b) || b.is_ascii_digit() || b == b'-' || b == b'.'
}

/// Why a tag is not well formed; only the first fault of a tag is reported.
struct Fault {
    at: Range<usize>,
    message: String,
    hint: Option<String>,
}

impl Fault {
    fn new(at: Range<usize>, message: impl Into<String>) -> Self {
        Self { at, message: message.into(), hint: None }
    }

    fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

fn report(scanner: &Scanner, fault: Fault, sink: &mut Sink) {
    let mut d = Diagnostic::error(codes::BAD_TAG, scanner.span(&fault.at), fault.message);
    d.hint = fault.hint;
    sink.push(d);
}

/// Reads `</name>`.
pub(crate) fn end(scanner: &mut Scanner, sink: &mut Sink) -> Option<Token> {
    let open = scanner.at;
    let name = name_at(scanner, open + 2);
    let after = skip_blanks(scanner, name.end);
    match scanner.byte(after) {
        Some(b'>') => scanner.at = after + 1,
        None => {
            scanner.report_cut_off(&(open..name.end), "an end tag", ">", sink);
            return None;
        }
        Some(_) => {
            // Up to the `>`, unless another tag begins first.
            let close = scanner.find(after, |b| b == b'>' || b == b'<');
            report(scanner, Fault::new(after..close, "an end tag holds nothing but a name"), sink);
            scanner.at = if scanner.byte(close) == Some(b'>') { close + 1 } else { close };
        }
    }
    Some(Token::End { name, tag: open..scanner.at })
}

/// Reads `<name attribute="value" ...>`.
pub(crate) fn start(scanner: &mut Scanner, sink: &mut Sink) -> Option<Token> {
    let open = scanner.at;
    let name = name_at(scanner, open + 1);
    scanner.attributes.clear();
    scanner.at = name.end;
    let mut fault: Option<Fault> = None;
    let empty = loop {
        let blank = skip_blanks(scanner, scanner.at);
        let separated = blank > scanner.at;
        scanner.at = blank;
        match scanner.byte(blank) {
            None => {
                scanner.report_cut_off(&(open..name.end), "a tag", ">", sink);
                return None;
            }
            Some(b'>') => {
                scanner.at += 1;
                break false;
            }
            Some(b'/') if scanner.byte(blank + 1) == Some(b'>') => {
                scanner.at += 2;
                break true;
            }
            Some(b'<') => {
                fault.get_or_insert(
                    Fault::new(open..blank, "this tag is not closed").hint("write > at its end"),
                );
                break false;
            }
            Some(b) if starts_name(b) && separated => {
                if let Err(f) = attribute(scanner, &name, sink) {
                    fault.get_or_insert(f);
                }
            }
            Some(_) => {
                let mut junk = scanner.find(blank + 1, |b| b.is_ascii_whitespace() || b == b'>' || b == b'<');
                if junk > blank + 1
                    && scanner.byte(junk) == Some(b'>')
                    && scanner.byte(junk - 1) == Some(b'/')
                {
                    junk -= 1;
                }
                fault.get_or_insert(Fault::new(blank..junk, "expected an attribute or the end of the tag"));
                scanner.at = junk;
            }
        }
    };
    if let Some(fault) = fault {
        report(scanner, fault, sink);
    }
    Some(Token::Start { name, tag: open..scanner.at, empty })
}

/// Reads `name="value"` and moves past it, however far it is well formed.
fn attribute(scanner: &mut Scanner, element: &Range<usize>, sink: &mut Sink) -> Result<(), Fault> {
    let name = name_at(scanner, scanner.at);
    let equals = skip_blanks(scanner, name.end);
    if scanner.byte(equals) != Some(b'=') {
        scanner.at = name.end;
        let (first, second) = (scanner.name(element, sink), scanner.name(&name, sink));
        return Err(Fault::new(name, format!("attribute {second} has no value"))
            .hint(format!("names are written with underscores: <{first}_{second}>")));
    }
    let quote_at = skip_blanks(scanner, equals + 1);
    let quote = scanner.byte(quote_at);
    if !matches!(quote, Some(b'"' | b'\'')) {
        scanner.at =
            scanner.find(quote_at, |b| b.is_ascii_whitespace() || b == b'>' || b == b'<' || b == b'/');
        let value = quote_at..scanner.at.max(quote_at);
        return Err(Fault::new(value, "the value of an attribute stands in quotes"));
    }
    let value_at = quote_at + 1;
    let close = scanner.find(value_at, |b| Some(b) == quote || b == b'<');
    if scanner.byte(close) != quote {
        // The quote was forgotten: the value ends with the tag, if it does.
        scanner.at = scanner.find(value_at, |b| b == b'>' || b == b'<');
        return Err(Fault::new(quote_at..scanner.at, "the value of this attribute has no closing quote"));
    }
    scanner.at = close + 1;
    if scanner.attributes.len() >= MOST_ATTRIBUTES {
        return Err(Fault::new(name, format!("a tag has at most {MOST_ATTRIBUTES} attributes")));
    }
    let written = scanner.slice(&name);
    if scanner.attributes.iter().any(|a| scanner.slice(&a.name) == written) {
        return Err(Fault::new(name, "this attribute is given twice"));
    }
    scanner.attributes.push(RawAttribute { name, value: value_at..close });
    Ok(())
}

fn name_at(scanner: &Scanner, at: usize) -> Range<usize> {
    at..scanner.find(at, |b| !continues_name(b))
}

fn skip_blanks(scanner: &Scanner, at: usize) -> usize {
    scanner.find(at, |b| !b.is_ascii_whitespace())
}
