//! Wavefront .obj: `v`, `vt`, `vn`, `f` and `usemtl`, after Wavefront's "Object Files (.obj)" specification, version
//! 3.0, Appendix B1.
//!
//! - Faces of any number of corners; indices from 1, or negative from the end. A corner is `v`, `v/vt`, `v//vn` or
//!   `v/vt/vn`.
//! - `usemtl` names the material of what follows; faces before the first have the material "default".
//! - Texture coordinates are exposed as "default".
//! - Groups, smoothing groups, material libraries, lines, points and curves are ignored.
//! - A file without any `vn` gives a mesh without normals. Where only some corners have one, the others get their
//!   face's normal.

use std::collections::HashMap;

use indigo_decl::mesh::MeshData;

use crate::builder::{MeshBuilder, area_normal};
use crate::error::FormatError;
use crate::text::{self, Text};
use crate::vec3::unit;
use crate::weld::{Corner, NONE, Welder};

/// Statements that say nothing about the triangles or their materials.
const IGNORED: [&[u8]; 34] = [
    b"mtllib",
    b"g",
    b"s",
    b"o",
    b"l",
    b"p",
    b"vp",
    b"mg",
    b"deg",
    b"bmat",
    b"step",
    b"cstype",
    b"curv",
    b"curv2",
    b"surf",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"maplib",
    b"usemap",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"call",
    b"csh",
];

/// Reads a mesh from the bytes of an .obj file.
///
/// # Errors
/// At the line and column of the first number, index or corner that makes no sense, and for a file without faces.
pub fn read(bytes: &[u8]) -> Result<MeshData, FormatError> {
    let mut text = Text::new(bytes, if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 });
    let mut reader = Reader::new();
    while text.remaining() > 0 {
        reader.line(&mut text)?;
        text.next_line();
    }
    if reader.faces == 0 {
        return Err(text.error("at least one face (f)"));
    }
    Ok(reader.finish())
}

struct Reader {
    positions: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    welder: Welder,
    builder: MeshBuilder,
    /// The material's name by the last `usemtl`, and its index once a face has used it.
    material: (String, Option<u32>),
    faces: usize,
    unknown: usize,
    /// Corners of the face being read, as vertices.
    face: Vec<u32>,
}

impl Reader {
    fn new() -> Self {
        Self {
            positions: Vec::new(),
            uvs: Vec::new(),
            normals: Vec::new(),
            welder: Welder::new(),
            builder: MeshBuilder::new(),
            material: (String::new(), None),
            faces: 0,
            unknown: 0,
            face: Vec::new(),
        }
    }

    /// One statement, up to but not with its line end.
    fn line(&mut self, text: &mut Text) -> Result<(), FormatError> {
        text.skip_blanks();
        let start = text.offset();
        match text.word() {
            b"v" => self.positions.push(numbers(text, "a coordinate of a vertex")?),
            b"vn" => self.normals.push(normal(text)?),
            b"vt" => self.uvs.push(texture_coordinates(text)?),
            b"f" => self.face(text)?,
            b"usemtl" => self.material = (text::name(text.rest_of_line()), None),
            word if word.is_empty() || word.starts_with(b"#") || IGNORED.contains(&word) => {}
            _ => {
                if self.unknown == 0 {
                    let error = text.error_at(start, "a statement of the .obj format");
                    self.builder.note(format!("{error}; it was ignored, as are any others unknown"));
                }
                self.unknown += 1;
            }
        }
        Ok(())
    }

    fn face(&mut self, text: &mut Text) -> Result<(), FormatError> {
        self.face.clear();
        text.skip_blanks();
        while !text.at_line_end() && text.peek() != Some(b'#') {
            let corner = self.corner(text)?;
            let (vertex, is_new) = self.welder.vertex(corner);
            if is_new {
                let position = self.positions.get(corner[0] as usize);
                self.builder.mesh.positions.push(position.copied().unwrap_or_default());
            }
            self.face.push(vertex);
            text.skip_blanks();
        }
        let material = self.material_id();
        self.builder.polygon(&self.face, material);
        self.faces += 1;
        Ok(())
    }

    fn material_id(&mut self) -> u32 {
        if let (_, Some(id)) = self.material {
            return id;
        }
        if self.material.0.is_empty() {
            self.builder
                .note("there are faces without a material (usemtl); they have the material 'default'");
            "default".clone_into(&mut self.material.0);
        }
        let id = self.builder.material(&self.material.0);
        self.material.1 = Some(id);
        id
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, text: &mut Text) -> Result<Corner, FormatError> {
        let start = text.offset();
        let position = index(text, self.positions.len(), "vertices (v)")?;
        let mut corner = [position, NONE, NONE];
        if text.peek() == Some(b'/') {
            text.advance();
            if text.peek() != Some(b'/') {
                corner[1] = index(text, self.uvs.len(), "texture coordinates (vt)")?;
            }
            if text.peek() == Some(b'/') {
                text.advance();
                corner[2] = index(text, self.normals.len(), "normals (vn)")?;
            }
        }
        if text.word().is_empty() {
            Ok(corner)
        } else {
            Err(text.error_at(start, "a corner such as 1, 1/2, 1//3 or 1/2/3"))
        }
    }

    fn finish(mut self) -> MeshData {
        if self.welder.vertices.iter().any(|corner| corner[1] != NONE) {
            let uv = |corner: &Corner| self.uvs.get(corner[1] as usize).copied().unwrap_or_default();
            self.builder.mesh.uv_sets = vec![self.welder.vertices.iter().map(uv).collect()];
            self.builder.mesh.uv_names = vec![("default".to_owned(), 0)];
            let without = self.welder.vertices.iter().filter(|corner| corner[1] == NONE).count();
            self.builder.note_count(without, "vertices without texture coordinates, given 0 0");
        }
        if self.welder.vertices.iter().any(|corner| corner[2] != NONE) {
            let normal = |corner: &Corner| self.normals.get(corner[2] as usize).copied().unwrap_or_default();
            self.builder.mesh.normals = self.welder.vertices.iter().map(normal).collect();
            let bare: Vec<bool> = self.welder.vertices.iter().map(|corner| corner[2] == NONE).collect();
            fill_bare_corners(&mut self.builder, &bare);
        }
        if self.unknown > 1 {
            self.builder.note_count(self.unknown, "lines with statements that are not of the .obj format");
        }
        self.builder.finish()
    }
}

/// Gives each corner of a `bare` vertex (one without a normal) the normal of its face, splitting the vertex where faces
/// differ.
fn fill_bare_corners(builder: &mut MeshBuilder, bare: &[bool]) {
    let count = bare.iter().filter(|bare| **bare).count();
    if count == 0 {
        return;
    }
    builder.note_count(count, "vertices without a normal, given those of their faces");
    let mesh = &mut builder.mesh;
    let mut split: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    let mut taken = vec![false; bare.len()];
    for t in 0..mesh.triangles.len() {
        let Some(&triangle) = mesh.triangles.get(t) else { break };
        let Some(normal) = unit(area_normal(mesh, triangle)) else { continue };
        let corners = triangle.map(|vertex| {
            let v = vertex as usize;
            if !bare.get(v).copied().unwrap_or(false) {
                return vertex;
            }
            *split.entry((vertex, normal.map(f32::to_bits))).or_insert_with(|| {
                let first_use = taken.get_mut(v).is_some_and(|taken| !std::mem::replace(taken, true));
                if first_use { set_normal(mesh, v, normal) } else { duplicate(mesh, v, normal) }
            })
        });
        if let Some(slot) = mesh.triangles.get_mut(t) {
            *slot = corners;
        }
    }
}

fn set_normal(mesh: &mut MeshData, vertex: usize, normal: [f32; 3]) -> u32 {
    if let Some(slot) = mesh.normals.get_mut(vertex) {
        *slot = normal;
    }
    vertex as u32
}

/// Appends a copy of a vertex with another normal.
fn duplicate(mesh: &mut MeshData, vertex: usize, normal: [f32; 3]) -> u32 {
    let copy = mesh.positions.len() as u32;
    mesh.positions.extend(mesh.positions.get(vertex).copied());
    mesh.normals.push(normal);
    for set in &mut mesh.uv_sets {
        set.extend(set.get(vertex).copied());
    }
    copy
}

fn numbers<const N: usize>(text: &mut Text, expected: &str) -> Result<[f32; N], FormatError> {
    let mut values = [0.0; N];
    for value in &mut values {
        text.skip_blanks();
        *value = text.finite(expected)?;
    }
    Ok(values)
}

/// A normal may be not-a-number, as careless exporters write for slivers: it is mended later.
fn normal(text: &mut Text) -> Result<[f32; 3], FormatError> {
    let mut values = [0.0; 3];
    for value in &mut values {
        text.skip_blanks();
        *value = text.number("a component of a normal")?;
    }
    Ok(values)
}

/// One number at least; the second is 0 if left out, the third says nothing of a surface.
fn texture_coordinates(text: &mut Text) -> Result<[f32; 2], FormatError> {
    let [u] = numbers(text, "a texture coordinate")?;
    text.skip_blanks();
    if text.at_line_end() || text.peek() == Some(b'#') {
        return Ok([u, 0.0]);
    }
    let [v] = numbers(text, "a texture coordinate")?;
    Ok([u, v])
}

/// An index from 1, or from -1 backwards, as one from 0 below `count`.
fn index(text: &mut Text, count: usize, of: &str) -> Result<u32, FormatError> {
    let start = text.offset();
    let negative = text.peek() == Some(b'-');
    if negative {
        text.advance();
    }
    let mut value: u64 = 0;
    let digits_start = text.offset();
    while let Some(digit @ b'0'..=b'9') = text.peek() {
        value = value.saturating_mul(10).saturating_add(u64::from(digit - b'0'));
        text.advance();
    }
    if text.offset() == digits_start {
        return Err(text.error_at(start, &format!("an index of {of}")));
    }
    let from_zero = if negative { (count as u64).checked_sub(value) } else { value.checked_sub(1) };
    match from_zero {
        // `value` 0 with a sign would be `count` itself.
        Some(i) if i < count as u64 && i < u64::from(NONE) => Ok(i as u32),
        _ => Err(text.error_at(start, &format!("an index of {of}, of which there are {count} so far"))),
    }
}

#[cfg(test)]
mod tests;
