//! Meshes by name, read when they are first used.

use super::Context;
use super::closed::open_edges;
use super::materials::UvSets;
use super::names::Names;
use crate::codes;
use indigo_decl::{MeshData, Node, Resolved};
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
    /// For each slot its number in the list of the mesh's file; empty where they are in that order.
    pub(super) slot_numbers: Vec<u32>,
    /// Names of its uv sets.
    pub(super) uv_names: Vec<(String, u32)>,
    /// The largest coordinate of its vertices, of either sign.
    pub(super) reach: f64,
    /// Whether it stands in for one whose file is missing; then it has one slot, without a name, and one uv set that
    /// answers to all names.
    pub(super) is_stand_in: bool,
}

impl Mesh {
    /// The uv sets that it offers to materials.
    pub(super) fn uv(&self) -> UvSets<'_> {
        if self.is_stand_in { UvSets::Natural } else { UvSets::Named(&self.uv_names) }
    }
}

/// All meshes of a scene.
pub(super) struct MeshTable<'a> {
    names: Names<'a>,
    read: HashMap<String, Option<Mesh>>,
    triangles: Vec<TriangleMesh>,
    /// Parts of meshes by what they are of: `None` where that is no triangle.
    parts: HashMap<(u32, Part), Option<u32>>,
    /// Triangles of meshes that were left out, and their slots: without them a mesh would seem to have gaps.
    degenerate: HashMap<u32, Vec<([u32; 3], u32)>>,
    /// Open edges of some slots of meshes that were asked for.
    open_edges: HashMap<(u32, Vec<u32>), usize>,
}

/// Which triangles of a mesh are meant.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) enum Part {
    /// Those of some material slots, which all become slot 0.
    Of(Vec<u32>),
    /// Those of all slots but some.
    Without(Vec<u32>),
}

impl Part {
    fn holds(&self, slot: u32) -> bool {
        match self {
            Self::Of(own) => own.contains(&slot),
            Self::Without(others) => !others.contains(&slot),
        }
    }
}

impl<'a> MeshTable<'a> {
    pub(super) fn new(root: &'a Node, sink: &mut Sink) -> Self {
        Self {
            names: Names::new(root, "mesh", sink),
            read: HashMap::new(),
            triangles: vec![],
            parts: HashMap::new(),
            degenerate: HashMap::new(),
            open_edges: HashMap::new(),
        }
    }

    /// The mesh of a name, read if it has not been yet; `None` after reporting why there is none.
    pub(super) fn get(&mut self, name: &str, span: Span, context: &mut Context) -> Option<&Mesh> {
        let name = &*self.meant(name);
        if !self.read.contains_key(name) {
            let mesh =
                self.names.find(name, span, context.sink).and_then(|node| self.read_mesh(node, context));
            self.read.insert(name.to_owned(), mesh);
        }
        self.read.get(name)?.as_ref()
    }

    /// The mesh of a name, if it has been read.
    pub(super) fn known(&self, name: &str) -> Option<&Mesh> {
        self.read.get(&self.meant(name))?.as_ref()
    }

    /// The key of the mesh that a reference means, which may refer by uid.
    fn meant(&self, reference: &str) -> String {
        self.names.meant(reference).to_owned()
    }

    /// What a mesh is called that a reference means.
    pub(super) fn called(&self, reference: &str) -> String {
        let name = self.names.get(reference).map(|node| node.text("name").value);
        name.unwrap_or_else(|| reference.to_owned())
    }

    /// Reports a name that no mesh has.
    pub(super) fn check_name(&mut self, name: &str, span: Span, sink: &mut Sink) {
        self.names.find(name, span, sink);
    }

    /// The triangles of a mesh.
    pub(super) fn triangles(&self, id: u32) -> &TriangleMesh {
        &self.triangles[id as usize]
    }

    /// How many edges of some slots of a mesh are open; looked at once.
    pub(super) fn open_edges(&mut self, id: u32, slots: Vec<u32>) -> usize {
        let triangles = &self.triangles[id as usize];
        let key = (id, slots);
        if let Some(open) = self.open_edges.get(&key) {
            return *open;
        }
        let degenerate = self.degenerate.get(&id).map_or(&[][..], Vec::as_slice);
        let open = open_edges(triangles, degenerate, &key.1);
        self.open_edges.insert(key, open);
        open
    }

    /// Adds a mesh that the scene does not name.
    pub(super) fn add(&mut self, mesh: TriangleMesh) -> u32 {
        self.triangles.push(mesh);
        (self.triangles.len() - 1) as u32
    }

    /// A part of a mesh as a mesh of its own, with the vertices that it uses; `None` where nothing is of it.
    pub(super) fn part(&mut self, id: u32, part: Part) -> Option<u32> {
        let key = (id, part);
        if let Some(known) = self.parts.get(&key) {
            return *known;
        }
        let mesh = part_of(&self.triangles[id as usize], &key.1);
        let number = mesh.map(|mesh| self.add(mesh));
        self.parts.insert(key, number);
        number
    }

    fn read_mesh(&mut self, node: &Node, context: &mut Context) -> Option<Mesh> {
        let scale = node.real("scale") as f32;
        let smooth = node.bool("normal_smoothing");
        let (data, material_spans, place) = if let Some(embedded) = node.mesh("embedded") {
            (embedded.data.clone(), embedded.material_spans.clone(), node.span)
        } else {
            let path = node.node("external").map_or_else(|| node.opt_text("path"), |e| e.opt_text("path"))?;
            let stand_in = "a cube of a metre";
            let Some(file) = context.read_or_stand_in(&path.value, path.span, stand_in) else {
                return if context.placeholders { self.stand_in() } else { None };
            };
            (read_file(&file, path.span, context.sink)?, vec![], path.span)
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
        let (slots, uv_names) = (slots.collect(), names_of_all_sets(&data));
        let slot_numbers = data.material_numbers.clone();
        let degenerate = degenerate_by_slot(&data);
        let triangles = to_triangles(data, scale, smooth, place, context.sink)?;
        let reach = triangles.positions().iter().flatten().fold(0.0_f32, |most, x| most.max(x.abs()));
        let id = self.add(triangles);
        self.degenerate.insert(id, degenerate);
        Some(Mesh { id, slots, slot_numbers, uv_names, reach: reach.into(), is_stand_in: false })
    }

    /// A cube round the origin, a metre wide whatever the scale of the mesh: files have all units.
    fn stand_in(&mut self) -> Option<Mesh> {
        let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -0.5 } else { 0.5 });
        // Two triangles a side, counter-clockwise from outside.
        let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let buffers = MeshBuffers {
            positions: (0..8).map(corner).collect(),
            triangles: sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
            uv_sets: vec![(0..8).map(|i| [corner(i)[0] + 0.5, corner(i)[2] + 0.5]).collect()],
            ..MeshBuffers::default()
        };
        // What was made here is sound.
        let id = self.add(TriangleMesh::new(buffers).ok()?);
        Some(Mesh {
            id,
            slots: vec![],
            slot_numbers: vec![],
            uv_names: vec![],
            reach: 0.5,
            is_stand_in: true,
        })
    }

    /// Meshes that nothing places have no effect, whatever they hold.
    pub(super) fn disregard_unused(&self) {
        self.names.entries().for_each(|(_, node)| node.disregard());
    }

    /// All meshes in the order of their numbers.
    pub(super) fn into_triangles(self) -> Vec<TriangleMesh> {
        self.triangles
    }
}

fn part_of(mesh: &TriangleMesh, part: &Part) -> Option<TriangleMesh> {
    let mut part_buffers = MeshBuffers { smooth: mesh.is_smooth(), ..MeshBuffers::default() };
    part_buffers.uv_sets = vec![vec![]; mesh.uv_sets().len()];
    let mut numbers: HashMap<u32, u32> = HashMap::new();
    for (i, corners) in mesh.triangles().iter().enumerate() {
        let slot = mesh.material_slot(i as u32);
        if !part.holds(slot) {
            continue;
        }
        part_buffers.triangles.push(corners.map(|vertex| {
            *numbers.entry(vertex).or_insert_with(|| {
                let v = vertex as usize;
                part_buffers.positions.push(mesh.positions()[v]);
                part_buffers.normals.extend(mesh.normals().get(v));
                for (set, values) in part_buffers.uv_sets.iter_mut().zip(mesh.uv_sets()) {
                    set.push(values[v]);
                }
                (part_buffers.positions.len() - 1) as u32
            })
        }));
        if matches!(part, Part::Without(_)) {
            part_buffers.triangle_materials.push(slot);
        }
    }
    // What was taken from a sound mesh makes one.
    if part_buffers.triangles.is_empty() { None } else { TriangleMesh::new(part_buffers).ok() }
}

/// The names of the uv sets; sets that the source does not name can be found by their number, and have one of it.
fn names_of_all_sets(data: &MeshData) -> Vec<(String, u32)> {
    let mut names = data.uv_names.clone();
    for set in 0..data.uv_sets.len() as u32 {
        if names.iter().all(|(_, named)| *named != set) {
            names.push((format!("uv{set}"), set));
        }
    }
    names
}

/// Triangles that were left out, with the slots that they would have.
fn degenerate_by_slot(data: &MeshData) -> Vec<([u32; 3], u32)> {
    let has_slots = data.material_names.len() > 1;
    let slots = data.degenerate_materials.iter().map(|material| if has_slots { *material } else { 0 });
    data.degenerate.iter().copied().zip(slots).collect()
}

fn read_file(file: &Resolved, span: Span, sink: &mut Sink) -> Option<MeshData> {
    match read_mesh(&file.path, &file.bytes) {
        Ok(data) => Some(data),
        Err(error) => {
            sink.push(
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
    let n = data.degenerate.len();
    if n > 0 {
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
