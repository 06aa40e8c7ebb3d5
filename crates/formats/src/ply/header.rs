//! The header: encoding, elements, properties.

use crate::error::FormatError;
use crate::text::{self, Text};

/// How the data after the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The eight number types.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// Bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }
}

/// What a property holds per row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The place of the first property that has one of the names.
    pub(super) fn find(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|property| names.contains(&property.name.as_str()))
    }
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Where the data begin.
    pub(super) body: usize,
}

pub(super) fn read(bytes: &[u8]) -> Result<Header, FormatError> {
    let mut text = Text::new(bytes, 0);
    if text.word() != b"ply" || !text.at_line_end() {
        return Err(text.error_at(0, "'ply' on a line of its own"));
    }
    text.next_line();
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        text.skip_blanks();
        let start = text.offset();
        match text.word() {
            b"format" => encoding = Some(read_encoding(&mut text)?),
            b"element" => elements.push(read_element(&mut text)?),
            b"property" => {
                let property = read_property(&mut text)?;
                let Some(element) = elements.last_mut() else {
                    return Err(text.error_at(start, "'element' before its properties"));
                };
                element.properties.push(property);
            }
            b"comment" | b"obj_info" => {}
            b"end_header" => break,
            b"" if text.remaining() > 0 && text.at_line_end() => {}
            _ => return Err(text.error_at(start, "a header line (element, property, comment, end_header)")),
        }
        text.next_line();
    }
    let end = text.offset();
    text.next_line();
    let Some(encoding) = encoding else {
        return Err(text.error_at(end, "a line 'format' before the header's end"));
    };
    check(&elements, &text, end)?;
    Ok(Header { encoding, elements, body: text.offset() })
}

/// A mesh needs vertices with coordinates, and faces.
fn check(elements: &[Element], text: &Text, end: usize) -> Result<(), FormatError> {
    let find = |name: &str| elements.iter().find(|element| element.name == name);
    let missing = |what: &str, found: &str| Err(text.error_saying(end, what, found));
    let Some(vertex) = find("vertex") else {
        return missing("an element 'vertex' in the header", "none");
    };
    for name in ["x", "y", "z"] {
        let scalar = vertex.properties.iter().any(|p| p.name == name && matches!(p.kind, Kind::Scalar(_)));
        if !scalar {
            return missing(&format!("a number property '{name}' of element 'vertex'"), "none");
        }
    }
    let Some(face) = find("face") else {
        let strips = find("tristrips").is_some();
        let found = if strips { "triangle strips, which are not supported" } else { "points without faces" };
        return missing("an element 'face' in the header", found);
    };
    let indices = face.find(&["vertex_indices", "vertex_index"]).and_then(|i| face.properties.get(i));
    if !indices.is_some_and(|property| matches!(property.kind, Kind::List { .. })) {
        return missing("a list property 'vertex_indices' of element 'face'", "none");
    }
    Ok(())
}

fn read_encoding(text: &mut Text) -> Result<Encoding, FormatError> {
    text.skip_blanks();
    let start = text.offset();
    match text.word() {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::Little),
        b"binary_big_endian" => Ok(Encoding::Big),
        _ => Err(text.error_at(start, "'ascii', 'binary_little_endian' or 'binary_big_endian'")),
    }
}

fn read_element(text: &mut Text) -> Result<Element, FormatError> {
    let name = read_name(text, "an element's name")?;
    text.skip_blanks();
    let count = text.number("the element's count")?;
    Ok(Element { name, count, properties: Vec::new() })
}

fn read_property(text: &mut Text) -> Result<Property, FormatError> {
    text.skip_blanks();
    let mut ahead = text.clone();
    let kind = if ahead.word() == b"list" {
        *text = ahead;
        let count = read_scalar(text)?;
        Kind::List { count, item: read_scalar(text)? }
    } else {
        Kind::Scalar(read_scalar(text)?)
    };
    Ok(Property { name: read_name(text, "a property's name")?, kind })
}

fn read_scalar(text: &mut Text) -> Result<Scalar, FormatError> {
    text.skip_blanks();
    let start = text.offset();
    Scalar::named(text.word()).ok_or_else(|| {
        text.error_at(start, "a number type (char, uchar, short, ushort, int, uint, float, double)")
    })
}

fn read_name(text: &mut Text, expected: &str) -> Result<String, FormatError> {
    text.skip_blanks();
    let start = text.offset();
    let name = text::name(text.word());
    if name.is_empty() { Err(text.error_at(start, expected)) } else { Ok(name) }
}
