//! Meshes by name, read when they are first used.

use super::Context;
use super::names::Names;
use crate::codes;
use indigo_decl::{MeshData, Node};
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_formats::read_mesh;
use indigo_geom::{MeshBuffers, TriangleMesh};
use std::collections::HashMap;

/// A mesh that was read.
pub(super) struct Mesh {
    /// Its number among the meshes of the scene.
    pub(super) id: u32,
    /// For each slot the name of its material and where it is named.
    pub(super) slots: Vec<(String, Span)>,
    /// Names of its uv sets.
    pub(super) uv_names: Vec<(String, u32)>,
    /// The largest coordinate of its vertices, of either sign.
    pub(super) reach: f64,
}

/// All meshes of a scene.
pub(super) struct MeshTable<'a> {
    names: Names<'a>,
    read: HashMap<String, Option<Mesh>>,
    triangles: Vec<TriangleMesh>,
}

impl<'a> MeshTable<'a> {
    pub(super) fn new(root: &'a Node, sink: &mut Sink) -> Self {
        Self { names: Names::new(root, "mesh", sink), read: HashMap::new(), triangles: vec![] }
    }

    /// The mesh of a name, read if it has not been yet; `None` after reporting why there is none.
    pub(super) fn get(&mut self, name: &str, span: Span, context: &mut Context) -> Option<&Mesh> {
        if !self.read.contains_key(name) {
            let mesh =
                self.names.find(name, span, context.sink).and_then(|node| self.read_mesh(node, context));
            self.read.insert(name.to_owned(), mesh);
        }
        self.read.get(name)?.as_ref()
    }

    /// Reports a name that no mesh has.
    pub(super) fn check_name(&mut self, name: &str, span: Span, sink: &mut Sink) {
        self.names.find(name, span, sink);
    }

    /// The triangles of a mesh.
    pub(super) fn triangles(&self, id: u32) -> &TriangleMesh {
        &self.triangles[id as usize]
    }

    /// Adds a mesh that the scene does not name.
    pub(super) fn add(&mut self, mesh: TriangleMesh) -> u32 {
        self.triangles.push(mesh);
        (self.triangles.len() - 1) as u32
    }

    fn read_mesh(&mut self, node: &Node, context: &mut Context) -> Option<Mesh> {
        let scale = node.real("scale") as f32;
        let smooth = node.bool("normal_smoothing");
        let (data, material_spans, place) = if let Some(embedded) = node.mesh("embedded") {
            (embedded.data.clone(), embedded.material_spans.clone(), node.span)
        } else {
            let path = node.node("external").map_or_else(|| node.opt_text("path"), |e| e.opt_text("path"))?;
            let data = read_file(&path.value, path.span, context)?;
            (data, vec![], path.span)
        };
        report_notes(&data, place, context.sink);
        // A reader of files says it itself. Where something is wrong the triangles may be there, but could not be read.
        let is_embedded = node.mesh("embedded").is_some();
        if is_embedded && data.triangles.is_empty() && !context.sink.has_errors() {
            context.sink.push(Diagnostic::warning(codes::FILE_NOTE, place, "the mesh has no triangles"));
        }
        let slots = data
            .material_names
            .iter()
            .enumerate()
            .map(|(i, name)| (name.clone(), material_spans.get(i).copied().unwrap_or(place)));
        let (slots, uv_names) = (slots.collect(), data.uv_names.clone());
        let triangles = to_triangles(data, scale, smooth, place, context.sink)?;
        let reach = triangles.positions().iter().flatten().fold(0.0_f32, |most, x| most.max(x.abs()));
        Some(Mesh { id: self.add(triangles), slots, uv_names, reach: reach.into() })
    }

    /// Meshes that nothing places have no effect, whatever they hold.
    pub(super) fn disregard_unused(&self) {
        self.names.nodes().for_each(Node::disregard);
    }

    /// All meshes in the order of their numbers.
    pub(super) fn into_triangles(self) -> Vec<TriangleMesh> {
        self.triangles
    }
}

fn read_file(path: &str, span: Span, context: &mut Context) -> Option<MeshData> {
    let file = context.read(path, span)?;
    match read_mesh(&file.path, &file.bytes) {
        Ok(data) => Some(data),
        Err(error) => {
            context.sink.push(
                Diagnostic::error(
                    codes::BAD_FILE,
                    span,
                    format!("{}:{}: bad mesh file", file.path, error.position),
                )
                .expected(format!("expected {}, found {}", error.expected, error.found)),
            );
            None
        }
    }
}

fn report_notes(data: &MeshData, span: Span, sink: &mut Sink) {
    for note in &data.notes {
        sink.push(Diagnostic::warning(codes::FILE_NOTE, span, note.clone()));
    }
    if data.degenerate_dropped > 0 {
        let n = data.degenerate_dropped;
        let what = if n == 1 {
            "1 triangle has no area and is left out".to_owned()
        } else {
            format!("{n} triangles have no area and are left out")
        };
        sink.push(Diagnostic::warning(codes::FILE_NOTE, span, what));
    }
}

fn to_triangles(
    data: MeshData,
    scale: f32,
    smooth: bool,
    span: Span,
    sink: &mut Sink,
) -> Option<TriangleMesh> {
    let mut positions = data.positions;
    if scale != 1.0 {
        positions.iter_mut().flatten().for_each(|x| *x *= scale);
    }
    let buffers = MeshBuffers {
        positions,
        triangles: data.triangles,
        normals: data.normals,
        uv_sets: data.uv_sets,
        triangle_materials: if data.material_names.len() > 1 { data.triangle_materials } else { vec![] },
        smooth,
    };
    TriangleMesh::new(buffers)
        .map_err(|e| sink.push(Diagnostic::error(codes::GEOMETRY, span, e.to_string())))
        .ok()
}
