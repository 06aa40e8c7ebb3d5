//! The arrays of an embedded mesh.

use super::report::Reporter;
use crate::codes;
use indigo_decl::{EmbeddedMesh, MeshData};
use indigo_diag::{Span, Spanned};
use std::collections::{HashMap, HashSet};

/// Triangles of a smaller area, in m², are left out.
const SMALLEST_AREA: f32 = 1e-20;
/// A normal may be this much longer or shorter than 1 without a word.
const UNIT_TOLERANCE: f32 = 1e-3;

type Written = Option<(String, Span)>;

pub(super) struct MeshBuilder {
    data: MeshData,
    material_spans: Vec<Span>,
    material_ids: HashMap<String, u32>,
    /// How many vertices have a normal; that of the others is zero until the end.
    normals_given: usize,
    not_unit: usize,
    /// Normals that were given, but have no direction.
    no_direction: usize,
    /// How many vertices have each uv set.
    uvs_given: [usize; 4],
    /// Names of uv sets, to be checked when all vertices are known.
    exposed: Vec<(Spanned<u32>, Spanned<String>)>,
    set_start: usize,
    set_material: Option<u32>,
    /// Vertices of which something could not be read.
    spoilt: HashSet<u32>,
}

impl MeshBuilder {
    pub fn new() -> Self {
        Self {
            data: MeshData::default(),
            material_spans: vec![],
            material_ids: HashMap::new(),
            normals_given: 0,
            not_unit: 0,
            no_direction: 0,
            uvs_given: [0; 4],
            exposed: vec![],
            set_start: 0,
            set_material: None,
            spoilt: HashSet::new(),
        }
    }

    pub fn vertex_count(&self) -> usize {
        self.data.positions.len()
    }

    /// Adds a vertex at the origin, to be filled in.
    pub fn begin_vertex(&mut self) {
        self.data.positions.push([0.0; 3]);
    }

    pub fn position(&mut self, p: [f32; 3]) {
        if let Some(last) = self.data.positions.last_mut() {
            *last = p;
        }
    }

    /// Takes note that something of the last vertex could not be read, which was reported.
    pub fn spoil_vertex(&mut self) {
        self.spoilt.insert((self.data.positions.len() - 1) as u32);
    }

    pub fn normal(&mut self, n: [f32; 3]) {
        let length = dot(n, n).sqrt();
        if !(length > 0.0 && length.is_finite()) {
            self.no_direction += 1;
            return;
        }
        if (length - 1.0).abs() > UNIT_TOLERANCE {
            self.not_unit += 1;
        }
        self.normals_given += 1;
        self.data.normals.resize(self.data.positions.len() - 1, [0.0; 3]);
        self.data.normals.push(n.map(|x| x / length));
    }

    pub fn uv(&mut self, set: usize, uv: [f32; 2]) {
        while self.data.uv_sets.len() <= set {
            self.data.uv_sets.push(vec![]);
        }
        let before = self.data.positions.len() - 1;
        if let (Some(values), Some(given)) = (self.data.uv_sets.get_mut(set), self.uvs_given.get_mut(set)) {
            values.resize(before, [0.0; 2]);
            values.push(uv);
            *given += 1;
        }
    }

    pub fn begin_set(&mut self) {
        self.set_start = self.data.triangles.len();
        self.set_material = None;
    }

    pub fn material(&mut self, name: String, span: Span) {
        if name.is_empty() {
            return;
        }
        let id = *self.material_ids.entry(name).or_insert_with_key(|name| {
            self.data.material_names.push(name.clone());
            self.material_spans.push(span);
            (self.material_spans.len() - 1) as u32
        });
        self.set_material = Some(id);
    }

    /// Adds a triangle whose indices were checked.
    pub fn triangle(&mut self, indices: [u32; 3]) {
        let corners = indices.map(|i| self.data.positions.get(i as usize).copied().unwrap_or_default());
        let area = 0.5 * length64(cross64(corners));
        if area < f64::from(SMALLEST_AREA) {
            // Where a vertex could not be read, nobody knows the area.
            let is_spoilt = !self.spoilt.is_empty() && indices.iter().any(|i| self.spoilt.contains(i));
            if !is_spoilt {
                self.data.degenerate.push(indices);
            }
        } else {
            self.data.triangles.push(indices);
        }
    }

    pub fn end_set(&mut self, set: Span, report: &mut Reporter) {
        let count = self.data.triangles.len();
        match self.set_material {
            Some(id) => {
                self.data.triangle_materials.resize(count, id);
                self.data.degenerate_materials.resize(self.data.degenerate.len(), id);
            }
            None => {
                let expected = "expected <material_name> inside, with a name";
                report.error(codes::NO_MATERIAL, set, "<triangle_set> has no material", expected);
                self.data.triangles.truncate(self.set_start);
                self.data.degenerate.truncate(self.data.degenerate_materials.len());
            }
        }
    }

    pub fn expose(&mut self, element: Span, index: Written, name: Written, report: &mut Reporter) {
        let Some((index, index_span)) = index else {
            report.error(codes::BAD_UV_SET, element, "<expose_uv_set> has no <index>", "expected <index>");
            return;
        };
        let Some((name, name_span)) = name.filter(|(name, _)| !name.is_empty()) else {
            report.error(codes::BAD_UV_SET, element, "<expose_uv_set> has no <name>", "expected <name>");
            return;
        };
        match index.parse::<u32>() {
            Ok(i) => self.exposed.push((Spanned::new(i, index_span), Spanned::new(name, name_span))),
            Err(_) => {
                let message = format!("<index> of the uv set {name} is not a whole number");
                report.error(codes::BAD_UV_SET, index_span, message, "expected 0, 1, 2 or 3");
            }
        }
    }

    pub fn finish(mut self, mesh: Span, report: &mut Reporter) -> EmbeddedMesh {
        self.check_uv_sets(report);
        self.complete_uvs(mesh, report);
        self.complete_normals(mesh, report);
        // Where others have one it was told what stands in.
        if self.no_direction > 0 && self.normals_given == 0 {
            let message = format!("normals without a length, which are left out: {}", self.no_direction);
            report.warning(codes::NOT_UNIT, mesh, message);
        }
        if self.not_unit > 0 {
            let message = format!("normals of another length than 1 were normalised: {}", self.not_unit);
            report.warning(codes::NOT_UNIT, mesh, message);
        }
        EmbeddedMesh { data: self.data, material_spans: self.material_spans }
    }

    fn check_uv_sets(&mut self, report: &mut Reporter) {
        let sets = self.data.uv_sets.len();
        let mut known: HashMap<String, u32> = HashMap::new();
        for (index, name) in std::mem::take(&mut self.exposed) {
            let other = known.get(&name.value).copied();
            if let Some(other) = other.filter(|set| *set != index.value) {
                let message = format!("{} is the name of uv set {other} already", name.value);
                let expected = format!("expected another name for uv set {}", index.value);
                report.error(codes::BAD_UV_SET, name.span, message, expected);
            } else if (index.value as usize) < sets {
                known.insert(name.value.clone(), index.value);
                self.data.uv_names.push((name.value, index.value));
            } else {
                let message = format!("there is no uv set {}", index.value);
                let expected = format!("expected a number below {sets}, the number of sets of the vertices");
                report.error(codes::BAD_UV_SET, index.span, message, expected);
            }
        }
    }

    fn complete_uvs(&mut self, mesh: Span, report: &mut Reporter) {
        let vertices = self.data.positions.len();
        for (i, (values, given)) in self.data.uv_sets.iter_mut().zip(self.uvs_given).enumerate() {
            values.resize(vertices, [0.0; 2]);
            if given < vertices {
                let message =
                    format!("vertices without uv{i}, for which (0, 0) is used: {}", vertices - given);
                report.warning(codes::INCOMPLETE_VERTICES, mesh, message);
            }
        }
    }

    /// Vertices without a normal among others that have one get that of their triangles.
    fn complete_normals(&mut self, mesh: Span, report: &mut Reporter) {
        let vertices = self.data.positions.len();
        if self.normals_given == 0 || self.normals_given == vertices {
            return;
        }
        self.data.normals.resize(vertices, [0.0; 3]);
        let mut sums: HashMap<u32, [f64; 3]> = HashMap::new();
        for t in &self.data.triangles {
            let corners = t.map(|i| self.data.positions.get(i as usize).copied().unwrap_or_default());
            let weighted = cross64(corners);
            for &i in t {
                if self.data.normals.get(i as usize).is_some_and(|n| *n == [0.0; 3]) {
                    let sum = sums.entry(i).or_default();
                    for (s, w) in sum.iter_mut().zip(weighted) {
                        *s += w;
                    }
                }
            }
        }
        for (i, n) in self.data.normals.iter_mut().enumerate().filter(|(_, n)| **n == [0.0; 3]) {
            let sum = sums.get(&(i as u32)).copied().unwrap_or_default();
            let length = length64(sum);
            *n = if length > 0.0 { sum.map(|x| (x / length) as f32) } else { [0.0, 0.0, 1.0] };
        }
        let message = format!(
            "vertices without a normal, for which that of their triangles is used: {}",
            vertices - self.normals_given
        );
        report.warning(codes::INCOMPLETE_VERTICES, mesh, message);
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Twice the area of a triangle times its normal, in double precision: with 32 bits the edges of
/// small triangles far from the origin would cancel out.
fn cross64([a, b, c]: [[f32; 3]; 3]) -> [f64; 3] {
    let edge = |p: [f32; 3]| -> [f64; 3] {
        [
            f64::from(p[0]) - f64::from(a[0]),
            f64::from(p[1]) - f64::from(a[1]),
            f64::from(p[2]) - f64::from(a[2]),
        ]
    };
    let (u, v) = (edge(b), edge(c));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn length64(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}
