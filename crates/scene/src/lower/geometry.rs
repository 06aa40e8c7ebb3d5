//! Placed objects: models, spheres and planes, with the materials of their slots.

mod shining;
mod slots;

pub(super) use self::shining::EmittingPart;
use self::slots::slot_names;
use super::emission::warn_of_darkness;
use super::materials::{MaterialTable, UvSets};
use super::meshes::{Mesh, MeshTable, Part};
use super::placement;
use super::{Context, closed};
use crate::codes;
use crate::settings::Settings;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_geom::{Movement, Object};
use indigo_math::{Bounds3, Transform, Vec3d};

/// How far from 1 the length of a plane's normal may be: decimal rounding of exporters.
const UNIT_TOLERANCE: f64 = 1e-3;

/// How far from the camera anything may be, in metres: some times the distance of the sun. Volumes of that size are
/// the largest numbers that come up, and single precision holds them.
pub(super) const FARTHEST: f64 = 1e12;

/// The corners of a cube round the origin, from -`reach` to `reach`, as they are placed.
fn box_corners(transform: &Transform, reach: f64) -> impl Iterator<Item = Vec3d> + '_ {
    (0..8usize).map(move |i| {
        let along = |axis: usize| if i >> axis & 1 == 0 { reach } else { -reach };
        transform.point(Vec3d::new(along(0), along(1), along(2)))
    })
}

/// What a model says of the materials of its mesh.
const OF_MATERIALS: [&str; 3] = ["materials", "emission_scale", "ies_profile"];

/// An instance of a mesh.
pub(super) struct Placed {
    pub(super) mesh: u32,
    transform: Transform,
    /// How it moves, if it does.
    movement: Option<Movement>,
    /// Name of the mesh.
    pub(super) name: String,
    /// Its materials, and what they are called.
    pub(super) slots: Vec<u32>,
    materials: Vec<String>,
    uv_names: Vec<(String, u32)>,
    /// Whether its mesh stands in for one that is missing.
    is_stand_in: bool,
}

impl Placed {
    /// The object of a mesh in its place.
    fn object(&self, mesh: u32) -> Object {
        Object::Mesh { mesh, transform: self.transform }
    }
}

/// All objects in render space.
pub(super) struct Geometry<'a> {
    /// The camera's position: the origin of render space.
    origin: Vec3d,
    objects: Vec<Object>,
    /// How objects move that do, by number.
    movements: Vec<(u32, Movement)>,
    names: Vec<String>,
    first_slot: Vec<u32>,
    slots: Vec<u32>,
    /// For each object the light that it is.
    lights: Vec<Option<u32>>,
    /// Parts of models whose materials emit.
    emitting: Vec<EmittingPart<'a>>,
}

impl<'a> Geometry<'a> {
    pub(super) fn new(origin: Vec3d) -> Self {
        Self {
            origin,
            objects: vec![],
            movements: vec![],
            names: vec![],
            first_slot: vec![],
            slots: vec![],
            lights: vec![],
            emitting: vec![],
        }
    }

    /// Adds an object given in the world, and returns its number.
    pub(super) fn add(
        &mut self,
        object: Object,
        name: &str,
        slots: impl IntoIterator<Item = u32>,
        light: Option<u32>,
    ) -> u32 {
        self.objects.push(self.to_render_space(object));
        self.names.push(name.to_owned());
        self.first_slot.push(self.slots.len() as u32);
        self.slots.extend(slots);
        self.lights.push(light);
        (self.objects.len() - 1) as u32
    }

    /// Whether an object, given in the world, reaches too far. A mesh's coordinates are no larger than `reach`.
    fn is_far(&self, object: &Object, reach: f64) -> bool {
        let largest = |v: Vec3d| v.x.abs().max(v.y.abs()).max(v.z.abs());
        let distance = match self.to_render_space(*object) {
            Object::Mesh { transform, .. } => box_corners(&transform, reach)
                .map(largest)
                .fold(0.0, |most: f64, d| if d > most || d.is_nan() { d } else { most }),
            Object::Sphere { center, radius } => largest(center) + radius,
            Object::Plane { dist, .. } => dist.abs(),
        };
        distance.is_nan() || distance > FARTHEST
    }

    /// Reports an object, given in the world, that reaches too far.
    pub(super) fn refuse_far(&self, object: &Object, reach: f64, span: Span, sink: &mut Sink) {
        if self.is_far(object, reach) {
            sink.push(
                Diagnostic::error(codes::GEOMETRY, span, "this is too large or too far away to be rendered")
                    .expected(format!("expected nothing farther than {FARTHEST:e} m from the camera")),
            );
        }
    }

    /// Warns of a mesh so small for its distance that its vertices, rounded to single precision, move by more than a
    /// sixteenth of its size.
    fn warn_of_rounding(&self, object: &Object, reach: f64, span: Span, sink: &mut Sink) {
        let Object::Mesh { transform, .. } = self.to_render_space(*object) else { return };
        let bounds = Bounds3::of_points(box_corners(&transform, reach));
        let farthest = bounds.lo.abs().max_component().max(bounds.hi.abs().max_component());
        let size = bounds.size().max_component();
        // What is a point by itself loses nothing, and what lies beyond all is refused.
        if size > 0.0 && farthest * f64::from(f32::EPSILON) > size / 8.0 && farthest <= FARTHEST {
            let message =
                "this is too far away for its size: rounding to single precision leaves little of its shape";
            sink.push(
                Diagnostic::warning(codes::ROUNDED, span, message)
                    .note(format!("it is {farthest:.3e} m from the camera")),
            );
        }
    }

    /// An object given in the world.
    pub(super) fn to_render_space(&self, object: Object) -> Object {
        match object {
            Object::Mesh { mesh, transform } => {
                Object::Mesh { mesh, transform: transform.then_translate(-self.origin) }
            }
            Object::Sphere { center, radius } => Object::Sphere { center: center - self.origin, radius },
            Object::Plane { normal, dist, uv_origin } => Object::Plane {
                normal,
                dist: dist - normal.dot(self.origin),
                uv_origin: uv_origin - self.origin,
            },
        }
    }

    pub(super) fn add_objects(
        &mut self,
        root: &'a Node,
        settings: &Settings,
        meshes: &mut MeshTable,
        materials: &mut MaterialTable,
        context: &mut Context,
    ) {
        for model in root.nodes("model") {
            model.disregard_fields(&["name", "uid"]);
            self.add_model(model, meshes, materials, context);
        }
        for sphere in root.nodes("sphere") {
            let object =
                Object::Sphere { center: sphere.vec3("center").into(), radius: sphere.real("radius") };
            self.add_shape(sphere, object, materials, context);
        }
        for plane in root.nodes("plane") {
            if settings.bool("bidirectional") {
                context.sink.push(
                    Diagnostic::error(
                        codes::PLANE_BIDIRECTIONAL,
                        plane.span,
                        "an infinite plane cannot be traced from both ends",
                    )
                    .hint("set <bidirectional> to false, or use a large mesh instead of the plane"),
                );
            }
            self.add_plane(plane, materials, context);
        }
    }

    fn add_plane(&mut self, plane: &Node, materials: &mut MaterialTable, context: &mut Context) {
        let normal = Vec3d::from(plane.vec3("normal"));
        if let Some(unit) = normal.try_normalized() {
            if (normal.length() - 1.0).abs() > UNIT_TOLERANCE {
                context.sink.push(
                    Diagnostic::warning(
                        codes::NOT_UNIT,
                        plane.span_of("normal"),
                        "the normal of the plane is not of length 1; <dist> is taken along the unit normal",
                    )
                    .expected(format!("its length is {}", normal.length())),
                );
            }
            let object = Object::Plane { normal: unit, dist: plane.real("dist"), uv_origin: Vec3d::ZERO };
            self.add_shape(plane, object, materials, context);
        } else {
            plane.disregard();
            context.sink.push(
                Diagnostic::error(
                    codes::SINGULAR,
                    plane.span_of("normal"),
                    "the normal of the plane has no direction",
                )
                .expected("expected a vector of length 1"),
            );
        }
    }

    fn add_shape(
        &mut self,
        node: &Node,
        object: Object,
        materials: &mut MaterialTable,
        context: &mut Context,
    ) {
        self.refuse_far(&object, 0.0, node.span, context.sink);
        let name = node.text("material_name");
        let material = materials.get(&name.value, name.span, UvSets::Natural, context);
        if materials.emission(&name.value, context.sink).is_some() {
            let hint = "only a model shines by its materials: place a mesh instead";
            warn_of_darkness(&format!("a {}", node.block.name), hint, name.span, context);
        }
        self.add(object, node.block.name, [material], None);
    }

    /// Adds a model; the parts of it whose materials emit are objects of their own.
    fn add_model(
        &mut self,
        node: &'a Node,
        meshes: &mut MeshTable,
        materials: &mut MaterialTable,
        context: &mut Context,
    ) {
        let Some(placed) = self.place(node, false, meshes, materials, context) else {
            // The fault of its mesh is told; nothing is wrong with what goes with that mesh.
            node.disregard();
            return;
        };
        closed::warn_if_open(&placed, node.span_of("mesh_name"), meshes, materials, context.sink);
        let count = placed.slots.len() as u32;
        let lit = self.add_shining(node, &placed, meshes, materials, context);
        let rest = match lit.len() as u32 {
            0 => Some(placed.mesh),
            n if n == count => None,
            _ => meshes.part(placed.mesh, Part::Without(lit)),
        };
        if let Some(mesh) = rest {
            let object = self.add(placed.object(mesh), &placed.name, placed.slots.iter().copied(), None);
            // The parts of a model stay together.
            let movement = placed.movement.filter(|_| count > 0 && mesh == placed.mesh);
            self.movements.extend(movement.map(|movement| (object, movement.moved_by(-self.origin))));
        }
    }

    /// Adds a mesh light; the number of the object and of its mesh, or `None` after reporting what is wrong.
    pub(super) fn add_mesh_light(
        &mut self,
        node: &Node,
        light: u32,
        meshes: &mut MeshTable,
        materials: &mut MaterialTable,
        context: &mut Context,
    ) -> Option<(u32, u32)> {
        let placed = self.place(node, true, meshes, materials, context)?;
        if placed.materials.iter().any(|name| materials.emission(name, context.sink).is_some()) {
            let hint = "place a model of that mesh instead";
            let what = "a mesh light, which shines by its own spectrum, the mesh";
            warn_of_darkness(what, hint, node.span, context);
        }
        let object = self.add(placed.object(placed.mesh), &placed.name, placed.slots, Some(light));
        Some((object, placed.mesh))
    }

    /// Where an instance of a mesh stands and what it is made of; `None` after reporting what is wrong.
    fn place(
        &self,
        node: &Node,
        is_lamp: bool,
        meshes: &mut MeshTable,
        materials: &mut MaterialTable,
        context: &mut Context,
    ) -> Option<Placed> {
        let (transform, movement) = placement::placement(node, context.sink);
        let name = node.text("mesh_name");
        let called = meshes.called(&name.value);
        let mesh = meshes.get(&name.value, name.span, context)?;
        let id = mesh.id;
        let (named, slots) = if mesh.is_stand_in {
            if !is_lamp {
                node.disregard_fields(&OF_MATERIALS);
            }
            (vec![(String::new(), name.span)], vec![materials.stand_in()])
        } else {
            let named = slot_names(node, mesh, context.sink);
            let slots =
                named.iter().map(|(name, span)| materials.get(name, *span, mesh.uv(), context)).collect();
            (named, slots)
        };
        let object = Object::Mesh { mesh: id, transform };
        let at = |transform| Object::Mesh { mesh: id, transform };
        let moved = movement.iter().flat_map(|movement| movement.places().map(at));
        // Wherever it comes, it is told once.
        if let Some(far) = std::iter::once(object).chain(moved).find(|place| self.is_far(place, mesh.reach)) {
            self.refuse_far(&far, mesh.reach, node.span, context.sink);
        }
        // Of lamps the triangles are looked at.
        if !is_lamp {
            self.warn_of_rounding(&object, mesh.reach, node.span, context.sink);
        }
        let (uv_names, materials) =
            (mesh.uv_names.clone(), named.into_iter().map(|(name, _)| name).collect());
        let is_stand_in = mesh.is_stand_in;
        Some(Placed { mesh: id, transform, movement, name: called, slots, materials, uv_names, is_stand_in })
    }

    /// The parts of models whose materials emit.
    pub(super) fn take_emitting(&mut self) -> Vec<EmittingPart<'a>> {
        std::mem::take(&mut self.emitting)
    }

    /// Makes an object a light.
    pub(super) fn set_light(&mut self, object: u32, light: u32) {
        self.lights[object as usize] = Some(light);
    }

    /// The objects, for building.
    pub(super) fn objects(&self) -> Vec<Object> {
        self.objects.clone()
    }

    /// How objects move that do, by number.
    pub(super) fn take_movements(&mut self) -> Vec<(u32, Movement)> {
        std::mem::take(&mut self.movements)
    }

    /// An object.
    pub(super) fn object(&self, i: u32) -> &Object {
        &self.objects[i as usize]
    }

    /// For each object the light that it is.
    pub(super) fn lights(&self) -> impl Iterator<Item = Option<u32>> + '_ {
        self.lights.iter().copied()
    }

    /// First slot of each object, the material of each slot, and the objects' names.
    pub(super) fn into_slots(self) -> (Vec<u32>, Vec<u32>, Vec<String>) {
        (self.first_slot, self.slots, self.names)
    }
}
