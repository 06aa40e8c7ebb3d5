//! Lights.

use super::geometry::Geometry;
use super::lamps::{self, Shape};
use super::light_layers::Layers;
use super::materials::{MaterialTable, UvSets};
use super::meshes::{Mesh, MeshTable};
use super::{Context, environment, placement};
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};
use indigo_film::{LightGroup, LightMix};
use indigo_geom::{Accel, MeshBuffers, Object, TriangleMesh};
use indigo_light::{AreaLight, DistantLight, LightTable, Portals};
use indigo_math::{Transform, Vec3d};

/// Lights found so far.
#[derive(Default)]
pub(super) struct Lights {
    lamps: Vec<AreaLight>,
    /// Each with the layer that it belongs to.
    distant: Vec<(DistantLight, u16)>,
    /// Corners of the portals' triangles in render space, counter-clockwise seen from the interior.
    portals: Vec<[Vec3d; 3]>,
}

impl Lights {
    pub(super) fn add_environment(&mut self, root: &Node, materials: &MaterialTable, context: &mut Context) {
        self.distant = environment::distant_lights(root, materials, context);
    }

    /// Adds the parts of models whose materials emit.
    pub(super) fn add_emitting_parts(
        &mut self,
        geometry: &mut Geometry,
        meshes: &MeshTable,
        materials: &mut MaterialTable,
        context: &mut Context,
    ) {
        for part in geometry.take_emitting() {
            let Some(emission) = materials.emission(&part.material, context.sink).cloned() else { continue };
            geometry.set_light(part.object, self.lamps.len() as u32);
            let shape = Shape::new(geometry.object(part.object), meshes.triangles(part.mesh));
            shape.report_rounding(part.model.span, context.sink);
            self.lamps.push(lamps::emitting_part(&part, &emission, &shape, materials, context));
        }
    }

    /// Whether there is any light.
    pub(super) fn is_empty(&self) -> bool {
        self.lamps.is_empty() && self.distant.is_empty()
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
            let placed = geometry.add_mesh_light(node, light, meshes, materials, context);
            let Some((object, mesh)) = placed else {
                node.disregard();
                continue;
            };
            let name = node.text("mesh_name");
            let shape = Shape::new(geometry.object(object), meshes.triangles(mesh));
            shape.report_rounding(node.span, context.sink);
            let uv = meshes.known(&name.value).map_or(UvSets::Named(&[]), Mesh::uv);
            let lamp = lamps::mesh_light(node, &shape, uv, materials, context);
            self.lamps.push(lamps::in_layer(lamp, &materials.layer(node.int("layer"))));
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
            let object = geometry.add(placed, node.block.name, [materials.black()], Some(light));
            let shape = Shape::new(geometry.object(object), meshes.triangles(mesh));
            shape.report_rounding(node.span, sink);
            let lamp = lamps::rectangle_light(node, &shape, sink);
            self.lamps.push(lamps::in_layer(lamp, &materials.layer(node.int("layer"))));
        }
    }

    pub(super) fn add_portals(
        &mut self,
        root: &Node,
        geometry: &Geometry,
        meshes: &mut MeshTable,
        context: &mut Context,
    ) {
        let mut first = None;
        for node in root.nodes("exit_portal") {
            first = first.or(Some(node.span));
            let (transform, _) = placement::placement(node, context.sink);
            let name = node.text("mesh_name");
            let mesh = meshes.get(&name.value, name.span, context).filter(|mesh| !mesh.is_stand_in);
            // No cube lets in light as an opening does.
            let Some((mesh, reach)) = mesh.map(|m| (m.id, m.reach)) else { continue };
            let object = Object::Mesh { mesh, transform };
            geometry.refuse_far(&object, reach, node.span, context.sink);
            let object = geometry.to_render_space(object);
            let shape = Shape::new(&object, meshes.triangles(mesh));
            shape.report_rounding(node.span, context.sink);
            self.portals.extend(shape.fronts());
        }
        let Some(span) = first.filter(|_| self.distant.is_empty()) else { return };
        context.sink.push(
            Diagnostic::warning(
                codes::IDLE_PORTALS,
                span,
                "exit portals have no effect: there is no light outside",
            )
            .hint("add a <skylight>, an <env_map> or a <background>"),
        );
    }

    /// The table of all lights, and how bright their groups are in the picture.
    pub(super) fn into_table(
        self,
        geometry: &Geometry,
        accel: &Accel,
        layers: &Layers,
    ) -> (LightTable, LightMix) {
        let bounds = accel.bounds();
        let (center, size) = (bounds.center().cast::<f64>(), bounds.size().cast::<f64>());
        // The sphere is a little larger than the box's, so that rounding keeps everything inside.
        let sphere = if size.is_finite() { (center, 0.5001 * size.length()) } else { (Vec3d::ZERO, 1.0) };
        let portals = Portals::new(&self.portals);
        let of_lamps = self.lamps.iter().map(AreaLight::group);
        let (mix, numbers) = layers.mix(of_lamps.chain(self.distant.iter().map(|(_, group)| *group)));
        let number = |group: u16| numbers[usize::from(group)];
        let mut objects = vec![u32::MAX; self.lamps.len()];
        for (object, lamp) in (0..).zip(geometry.lights()) {
            if let Some(lamp) = lamp {
                objects[lamp as usize] = object;
            }
        }
        let in_order = |(lamp, object): (AreaLight, u32)| {
            let group = number(lamp.group());
            let lamp = lamp.with_test_errors(|triangle| accel.test_error(object, triangle));
            lamp.in_group(group).with_attention(attention(&mix, group))
        };
        let lamps = self.lamps.into_iter().zip(objects).map(in_order).collect();
        let (distant, groups): (Vec<_>, Vec<_>) = self.distant.into_iter().unzip();
        let table = LightTable::with_portals(lamps, distant, geometry.lights(), sphere, portals);
        (table.with_distant_groups(groups.into_iter().map(number).collect()), mix)
    }
}

/// How often lamps of a group are drawn, over how often they would be by their light as it is rendered: by their light in the
/// picture, as the scene has it, but for a hundredth at least, since they may be turned up later.
fn attention(mix: &LightMix, group: u16) -> f64 {
    const LEAST: f64 = 0.01;
    let most = mix.0.iter().map(LightGroup::shown).fold(0.0, f64::max);
    let Some(own) = mix.0.get(usize::from(group)).filter(|_| most > 0.0) else { return 1.0 };
    (own.shown() / most).max(LEAST)
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
