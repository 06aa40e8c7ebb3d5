//! Embedded meshes: vertices and triangles straight into arrays, with no element for each.

mod build;
mod declare;
mod leaf;
mod numbers;
mod report;

use crate::codes;
use crate::scan::{Scanner, Token};
use build::MeshBuilder;
pub use declare::{EMBEDDED, EXPOSE_UV_SET, TRIANGLE_SET, VERTEX};
use indigo_decl::EmbeddedMesh;
use indigo_diag::Sink;
use leaf::{End, Leaf};
use report::Reporter;
use std::ops::Range;

/// Reads what stands inside `<embedded>`, whose start tag the scanner has just passed.
///
/// The second part says whether its end tag was found (or reported); if not, the file ended.
pub(crate) fn read(
    scanner: &mut Scanner,
    tag: &Range<usize>,
    empty: bool,
    sink: &mut Sink,
) -> (EmbeddedMesh, bool) {
    let start = scanner.span(tag);
    let mut reader = Reader { scanner, report: Reporter::new(sink), mesh: MeshBuilder::new() };
    reader.unknown_attributes("embedded");
    let closed = empty || reader.content();
    let Reader { mut report, mesh, .. } = reader;
    let mesh = mesh.finish(start, &mut report);
    report.finish(start);
    (mesh, closed)
}

struct Reader<'a, 'r, 's> {
    scanner: &'r mut Scanner<'a>,
    report: Reporter<'s>,
    mesh: MeshBuilder,
}

impl Reader<'_, '_, '_> {
    fn next(&mut self) -> Option<Token> {
        self.scanner.next(self.report.sink)
    }

    /// The children of `embedded`; `false` where the file ends.
    fn content(&mut self) -> bool {
        while let Some(token) = self.next() {
            match token {
                Token::Start { name, tag, empty } => {
                    let read = match self.scanner.slice(&name) {
                        b"vertex" => self.vertex(&name, &tag, empty),
                        b"triangle_set" => self.triangle_set(&tag, empty),
                        b"expose_uv_set" => self.expose_uv_set(&tag, empty),
                        _ => self.unknown_element(&name, &tag, empty, "embedded"),
                    };
                    if !read {
                        return false;
                    }
                }
                Token::End { name, tag } => {
                    if self.check_end(&name, &tag, b"embedded") != End::Nothing {
                        return true;
                    }
                }
                Token::Text(range) | Token::CData(range) => self.stray_text(&range, "embedded"),
            }
        }
        false
    }

    fn vertex(&mut self, name: &Range<usize>, tag: &Range<usize>, empty: bool) -> bool {
        let attributes = std::mem::take(&mut self.scanner.attributes);
        self.mesh.begin_vertex();
        let mut has_position = false;
        for a in &attributes {
            let raw = self.scanner.slice(&a.value);
            let decoded = raw.contains(&b'&').then(|| self.scanner.decode(&a.value, true, self.report.sink));
            let value = decoded.as_ref().map_or(raw, |text| text.as_bytes());
            let read = match self.scanner.slice(&a.name) {
                b"pos" => {
                    has_position = true;
                    numbers::reals(value).map(|v| self.mesh.position(v))
                }
                b"normal" => numbers::reals(value).map(|v| self.mesh.normal(v)),
                b"uv0" => numbers::reals(value).map(|v| self.mesh.uv(0, v)),
                b"uv1" => numbers::reals(value).map(|v| self.mesh.uv(1, v)),
                b"uv2" => numbers::reals(value).map(|v| self.mesh.uv(2, v)),
                b"uv3" => numbers::reals(value).map(|v| self.mesh.uv(3, v)),
                _ => {
                    self.unknown_attribute(&a.name, "vertex");
                    Some(())
                }
            };
            if read.is_none() {
                self.bad_attribute(&a.name, &a.value);
                self.mesh.spoil_vertex();
            }
        }
        self.scanner.attributes = attributes;
        if !has_position {
            let span = self.scanner.span(tag);
            self.report.error(codes::BAD_VERTEX, span, "<vertex> has no pos", "expected pos=\"x y z\"");
            self.mesh.spoil_vertex();
        }
        empty || self.skip(name, "vertex")
    }

    fn bad_attribute(&mut self, name: &Range<usize>, value: &Range<usize>) {
        let span = self.scanner.span(value);
        let attribute = String::from_utf8_lossy(self.scanner.slice(name)).into_owned();
        let expected = if attribute.starts_with("uv") { "2 numbers" } else { "3 numbers" };
        let message = format!("{attribute} is not {expected}");
        self.report.error(codes::BAD_VERTEX, span, message, format!("expected {expected}"));
    }

    fn triangle_set(&mut self, tag: &Range<usize>, empty: bool) -> bool {
        let set = self.scanner.span(tag);
        self.unknown_attributes("triangle_set");
        self.mesh.begin_set();
        let mut more = !empty;
        while more {
            let Some(token) = self.next() else {
                self.mesh.end_set(set, &mut self.report);
                return false;
            };
            match token {
                Token::Start { name, tag, empty } => {
                    let read = match self.scanner.slice(&name) {
                        b"tri" => self.triangle(&name, &tag, empty),
                        b"material_name" => self.material_name(&name, &tag, empty),
                        _ => self.unknown_element(&name, &tag, empty, "triangle_set"),
                    };
                    if !read {
                        self.mesh.end_set(set, &mut self.report);
                        return false;
                    }
                }
                Token::End { name, tag } => {
                    more = self.check_end(&name, &tag, b"triangle_set") == End::Nothing;
                }
                Token::Text(range) | Token::CData(range) => self.stray_text(&range, "triangle_set"),
            }
        }
        self.mesh.end_set(set, &mut self.report);
        true
    }

    fn triangle(&mut self, name: &Range<usize>, tag: &Range<usize>, empty: bool) -> bool {
        let Some(leaf) = self.leaf(name, tag, empty) else { return false };
        let span = self.scanner.span(&leaf.at);
        let text = leaf.bytes(self.scanner.bytes);
        let indices = if text.contains(&b'&') {
            numbers::indices(self.leaf_text(&leaf).as_bytes())
        } else {
            numbers::indices(text)
        };
        let Some(indices) = indices else {
            let expected = "expected 3 whole numbers, the indices of vertices";
            self.report.error(codes::BAD_TRIANGLE, span, "<tri> is not 3 indices", expected);
            return true;
        };
        let count = self.mesh.vertex_count();
        match indices.iter().find(|&&i| i >= count as u64) {
            Some(i) => {
                let message = format!("there is no vertex {i}");
                let expected = format!("expected indices below {count}, the number of vertices so far");
                self.report.error(codes::BAD_INDEX, span, message, expected);
            }
            None => self.mesh.triangle(indices.map(|i| i as u32)),
        }
        true
    }

    fn material_name(&mut self, name: &Range<usize>, tag: &Range<usize>, empty: bool) -> bool {
        let Some(leaf) = self.leaf(name, tag, empty) else { return false };
        let text = self.leaf_text(&leaf);
        self.mesh.material(text, self.scanner.span(&leaf.at));
        true
    }

    fn expose_uv_set(&mut self, tag: &Range<usize>, empty: bool) -> bool {
        let start = self.scanner.span(tag);
        self.unknown_attributes("expose_uv_set");
        let (mut index, mut exposed) = (None, None);
        let mut more = !empty;
        while more {
            let Some(token) = self.next() else { return false };
            match token {
                Token::Start { name, tag, empty } => {
                    let written = self.scanner.slice(&name);
                    if written != b"index" && written != b"name" {
                        if !self.unknown_element(&name, &tag, empty, "expose_uv_set") {
                            return false;
                        }
                        continue;
                    }
                    let Some(leaf) = self.leaf(&name, &tag, empty) else { return false };
                    let text = self.leaf_text(&leaf);
                    let span = self.scanner.span(&leaf.at);
                    if written == b"index" {
                        index = Some((text, span));
                    } else {
                        exposed = Some((text, span));
                    }
                }
                Token::End { name, tag } => {
                    more = self.check_end(&name, &tag, b"expose_uv_set") == End::Nothing;
                }
                Token::Text(range) | Token::CData(range) => self.stray_text(&range, "expose_uv_set"),
            }
        }
        self.mesh.expose(start, index, exposed, &mut self.report);
        true
    }

    /// The text of a leaf, entities replaced.
    fn leaf_text(&mut self, leaf: &Leaf) -> String {
        match &leaf.joined {
            Some(bytes) => String::from_utf8_lossy(bytes).trim_ascii().to_owned(),
            None => self.scanner.decode(&leaf.at, leaf.entities, self.report.sink).trim_ascii().to_owned(),
        }
    }
}
