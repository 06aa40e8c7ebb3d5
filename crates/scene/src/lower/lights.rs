//! Lights.

use super::geometry::Geometry;
use super::materials::MaterialTable;
use super::meshes::MeshTable;
use super::{Context, environment};
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};
use indigo_geom::{Accel, MeshBuffers, Object, TriangleMesh};
use indigo_light::{AreaLight, DistantLight, LightTable};
use indigo_math::{Transform, Vec3d};
use indigo_spectrum::{Spectrum, photometry, read};

/// Lights found so far.
#[derive(Default)]
pub(super) struct Lights {
    lamps: Vec<AreaLight>,
    distant: Vec<DistantLight>,
}

impl Lights {
    pub(super) fn add_environment(&mut self, root: &Node, context: &mut Context) {
        self.distant = environment::distant_lights(root, context);
    }

    pub(super) fn add_mesh_lights(
        &mut self,
        root: &Node,
        geometry: &mut Geometry,
        meshes: &mut MeshTable,
        materials: &mut MaterialTable,
        context: &mut Context,
    ) {
        for node in root.nodes("meshlight") {
            let light = self.lamps.len() as u32;
            let placed = geometry.add_instance(node, Some(light), meshes, materials, context);
            let Some((object, mesh)) = placed else {
                node.disregard();
                continue;
            };
            let corners = world_corners(geometry.object(object), meshes.triangles(mesh));
            self.add_area(node, &corners, context.sink);
        }
    }

    pub(super) fn add_rectangles(
        &mut self,
        root: &Node,
        geometry: &mut Geometry,
        meshes: &mut MeshTable,
        materials: &mut MaterialTable,
        sink: &mut Sink,
    ) {
        for node in root.nodes("rectanglelight") {
            let light = self.lamps.len() as u32;
            let Some(mesh) = rectangle(node, sink) else { continue };
            let mesh = meshes.add(mesh);
            let transform = Transform::translation(node.vec3("pos").into());
            let placed = Object::Mesh { mesh, transform };
            geometry.refuse_far(&placed, node.real("width").max(node.real("height")) / 2.0, node.span, sink);
            let object = geometry.add(placed, [materials.black()], Some(light));
            let corners = world_corners(geometry.object(object), meshes.triangles(mesh));
            self.add_area(node, &corners, sink);
        }
    }

    fn add_area(&mut self, node: &Node, corners: &[[Vec3d; 3]], sink: &mut Sink) {
        let errors_before = sink.error_count();
        let spectrum = node.node("spectrum").map_or(Spectrum::BLACK, |s| read::emission(s, sink));
        let mut light = AreaLight::new(spectrum, corners);
        if let Some(scale) = node.node("efficacy_scale") {
            let (power, efficacy) = (scale.real("power_drawn"), scale.real("overall_luminous_efficacy"));
            match photometry::with_efficacy(&light.radiance, power, efficacy, light.area()) {
                Some(scaled) => {
                    read::refuse_excess(&scaled, scale.span, sink);
                    light.radiance = scaled;
                }
                // A spectrum that is wrong by itself needs no second complaint.
                None if sink.error_count() > errors_before => {}
                None => sink.push(
                    Diagnostic::error(
                        codes::NO_FLUX,
                        scale.span,
                        "a lamp without luminance or area cannot be scaled to a power",
                    )
                    .expected("expected a spectrum with visible light on a mesh with area"),
                ),
            }
        }
        self.lamps.push(light);
    }

    /// The table of all lights.
    pub(super) fn into_table(self, geometry: &Geometry, accel: &Accel) -> LightTable {
        let bounds = accel.bounds();
        let (center, size) = (bounds.center().cast::<f64>(), bounds.size().cast::<f64>());
        // The sphere is a little larger than the box's, so that rounding keeps everything inside.
        let sphere = if size.is_finite() { (center, 0.5001 * size.length()) } else { (Vec3d::ZERO, 1.0) };
        LightTable::new(self.lamps, self.distant, geometry.lights(), sphere)
    }
}

/// The triangles of a mesh object in render space. Under a reflection the order of the corners is
/// turned, so that the front stays the front.
fn world_corners(object: &Object, mesh: &TriangleMesh) -> Vec<[Vec3d; 3]> {
    let Object::Mesh { transform, .. } = object else { return vec![] };
    let place = |i: u32| transform.point(Vec3d::from(mesh.positions()[i as usize].map(f64::from)));
    let flip = transform.is_reflection();
    mesh.triangles().iter().map(|&[a, b, c]| if flip { [a, c, b] } else { [a, b, c] }.map(place)).collect()
}

/// A horizontal rectangle round the origin whose front looks down.
fn rectangle(node: &Node, sink: &mut Sink) -> Option<TriangleMesh> {
    let (x, y) = ((node.real("width") / 2.0) as f32, (node.real("height") / 2.0) as f32);
    let buffers = MeshBuffers {
        positions: vec![[-x, -y, 0.0], [-x, y, 0.0], [x, y, 0.0], [x, -y, 0.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..MeshBuffers::default()
    };
    TriangleMesh::new(buffers)
        .map_err(|e| sink.push(Diagnostic::error(codes::GEOMETRY, node.span, e.to_string())))
        .ok()
}
