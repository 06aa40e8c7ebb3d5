//! Lamps: what the triangles of a mesh light or of a rectangle emit.

use super::Context;
use super::emission::Emission;
use super::geometry::EmittingPart;
use super::light_layers::Layer;
use super::materials::{MaterialTable, UvSets};
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_formats::ies;
use indigo_geom::{Object, TriangleMesh};
use indigo_light::{AreaLight, Profile};
use indigo_math::{Vec2, Vec3d};
use indigo_spectrum::observer::LUMENS_PER_WATT;
use indigo_spectrum::{Spectrum, read};
use indigo_texture::{Mapping, Texture};
use std::f64::consts::PI;

/// The part of its area that a lamp or portal may lose or gain by rounding, without a word: what can hardly be seen.
const MOST_ROUNDING: f64 = 0.01;

/// The triangles of a placed mesh.
pub(super) struct Shape<'a> {
    /// Corners in render space.
    corners: Vec<[Vec3d; 3]>,
    /// Whether they run clockwise seen from the front, since the mesh is mirrored.
    is_mirrored: bool,
    /// Where the mesh's x axis points.
    x_axis: Vec3d,
    mesh: &'a TriangleMesh,
}

impl<'a> Shape<'a> {
    pub(super) fn new(object: &Object, mesh: &'a TriangleMesh) -> Self {
        let Object::Mesh { transform, .. } = object else {
            return Self { corners: vec![], is_mirrored: false, x_axis: Vec3d::new(1.0, 0.0, 0.0), mesh };
        };
        let place = |i: u32| transform.point(Vec3d::from(mesh.positions()[i as usize].map(f64::from)));
        Self {
            corners: mesh.triangles().iter().map(|t| t.map(place)).collect(),
            is_mirrored: transform.is_reflection(),
            x_axis: transform.vector(Vec3d::new(1.0, 0.0, 0.0)),
            mesh,
        }
    }

    /// Corners of the triangles, counter-clockwise seen from the front.
    pub(super) fn fronts(&self) -> impl Iterator<Item = [Vec3d; 3]> + '_ {
        self.corners.iter().map(|&[a, b, c]| if self.is_mirrored { [a, c, b] } else { [a, b, c] })
    }

    /// Reports what rounding to single precision makes of it, as the scene is traced.
    pub(super) fn report_rounding(&self, span: Span, sink: &mut Sink) {
        let area = |corners: [Vec3d; 3]| {
            let [a, b, c] = corners;
            0.5 * (b - a).cross(c - a).length()
        };
        let rounded = |corner: Vec3d| corner.cast::<f32>().cast::<f64>();
        let total: f64 = self.corners.iter().map(|&corners| area(corners)).sum();
        let kept: f64 = self.corners.iter().map(|&corners| area(corners.map(rounded))).sum();
        if total > 0.0 && kept == 0.0 {
            let message = "this is too far away for its size: rounded to single precision it has no area";
            sink.push(
                Diagnostic::error(codes::GEOMETRY, span, message)
                    .hint("make it larger, or place it nearer to the camera"),
            );
        } else if (kept - total).abs() > MOST_ROUNDING * total {
            let message = format!(
                "this is far away for its size: rounding to single precision changes its area from {total} to {kept} m²"
            );
            sink.push(Diagnostic::warning(codes::ROUNDED, span, message));
        }
    }

    /// How far, in degrees, its triangles face away from their common direction: the angle of the mean cosine.
    fn bend_deg(&self) -> f64 {
        let areas = self.corners.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a));
        let (sum, total) = areas.fold((Vec3d::ZERO, 0.0), |(sum, total), n| (sum + n, total + n.length()));
        if total > 0.0 { (sum.length() / total).min(1.0).acos().to_degrees() } else { 0.0 }
    }

    fn light(&self, radiance: Spectrum) -> AreaLight {
        let light = AreaLight::new(radiance, &self.corners);
        if self.is_mirrored { light.turned_over() } else { light }
    }
}

/// A `rectanglelight`.
pub(super) fn rectangle_light(node: &Node, shape: &Shape, sink: &mut Sink) -> AreaLight {
    let errors_before = sink.error_count();
    let spectrum = node.node("spectrum").map_or(Spectrum::BLACK, |s| read::emission(s, sink));
    scaled(node, shape.light(spectrum), errors_before, sink)
}

/// A `meshlight`, whose mesh has certain uv sets.
pub(super) fn mesh_light(
    node: &Node,
    shape: &Shape,
    uv: UvSets,
    materials: &mut MaterialTable,
    context: &mut Context,
) -> AreaLight {
    let errors_before = context.sink.error_count();
    let spectrum = node.node("spectrum").map_or(Spectrum::BLACK, |s| read::emission(s, context.sink));
    let mut lamp = shape.light(spectrum);
    if let Some(texture) = node.node("texture") {
        let texture = materials.lamp_texture(texture, node.span, uv, context);
        lamp = with_texture(lamp, texture, shape);
    }
    let Some(profile) = node.node("ies_profile") else {
        return scaled(node, lamp, errors_before, context.sink);
    };
    if let Some(scale) = node.node("efficacy_scale") {
        scale.disregard();
        context.sink.push(
            Diagnostic::warning(
                codes::FLUX_TWICE,
                scale.span,
                "<efficacy_scale> has no effect beside <ies_profile>: the flux is that of the file",
            )
            .hint("take one of them out"),
        );
    }
    with_profile(node.span, (profile, None), lamp, shape, errors_before, context)
}

/// The lamp with an image map; where the mesh lacks the uv set, which was reported, it shows the texel at (0, 0).
fn with_texture(lamp: AreaLight, texture: Texture, shape: &Shape) -> AreaLight {
    let uvs = shape.mesh.uv_sets().get(texture.uv_set as usize);
    let pair = |i: u32| uvs.map_or([0.0; 2], |uvs| uvs[i as usize]);
    // The lamp looks its triangles up in the map, and so is given where they lie there.
    let mapping = texture.mapping();
    let corner = |i: u32| mapping.of(Vec2::from(pair(i).map(f64::from)));
    let uvs: Vec<[Vec2<f64>; 3]> = shape.mesh.triangles().iter().map(|t| t.map(corner)).collect();
    lamp.with_texture(texture.with_mapping(Mapping::IDENTITY), &uvs)
}

/// A part of a model whose material emits.
pub(super) fn emitting_part(
    part: &EmittingPart,
    emission: &Emission,
    shape: &Shape,
    materials: &mut MaterialTable,
    context: &mut Context,
) -> AreaLight {
    let errors_before = context.sink.error_count();
    let mut lamp = shape.light(emission.radiance.clone());
    if let Some(texture) = emission.texture {
        let uv = UvSets::Named(&part.uv_names);
        let texture = materials.lamp_texture(texture, part.model.span, uv, context);
        lamp = with_texture(lamp, texture, shape);
    }
    let is_of_part = |n: &&Node| materials.is_same(&n.text("material_name").value, &part.material);
    let scale = last_of(part.model.nodes("emission_scale").filter(is_of_part), context.sink);
    let flux = scale.map(|scale| flux_lm(scale, lamp.area()));
    let profile = last_of(part.model.nodes("ies_profile").filter(is_of_part), context.sink);
    let lamp = match (profile, scale.zip(flux)) {
        (Some(profile), _) => {
            with_profile(part.model.span, (profile, flux), lamp, shape, errors_before, context)
        }
        (None, Some((scale, flux))) => to_flux(scale, flux, lamp, errors_before, context.sink),
        (None, None) => lamp,
    };
    in_layer(lamp, &emission.layer)
}

/// The last of some elements for one thing, which counts; those before it are told.
fn last_of<'a>(nodes: impl Iterator<Item = &'a Node>, sink: &mut Sink) -> Option<&'a Node> {
    nodes.fold(None, |before: Option<&Node>, node| {
        if let Some(before) = before {
            before.disregard();
            let message = format!(
                "<{}> is given more than once for one material; the last one counts",
                node.block.name
            );
            sink.push(Diagnostic::warning(indigo_decl::codes::DUPLICATE_ELEMENT, before.span, message));
        }
        Some(node)
    })
}

/// A lamp as its layer has it.
pub(super) fn in_layer(lamp: AreaLight, layer: &Layer) -> AreaLight {
    let lamp = lamp.in_group(layer.group);
    match &layer.colour {
        Some(colour) => lamp.times(colour),
        None => lamp,
    }
}

/// The luminous flux in lm that an `emission_scale` asks for, of an area in m².
fn flux_lm(scale: &Node, area_m2: f64) -> f64 {
    let value = scale.real("value");
    match scale.text("measure").value.as_str() {
        // An even lamp of luminance L and area A has I = L A straight ahead, and the flux π L A.
        "luminous_intensity" => PI * value,
        "luminance" => PI * area_m2 * value,
        "luminous_emittance" => area_m2 * value,
        _ => value,
    }
}

/// The lamp with the flux that its `efficacy_scale` asks for.
fn scaled(node: &Node, lamp: AreaLight, errors_before: usize, sink: &mut Sink) -> AreaLight {
    let Some(scale) = node.node("efficacy_scale") else { return lamp };
    let efficacy = scale.real("overall_luminous_efficacy");
    if efficacy > LUMENS_PER_WATT {
        let most = format!("{LUMENS_PER_WATT:.0} lm/W is that of light of 555 nm, made without loss");
        sink.push(
            Diagnostic::warning(
                codes::EFFICACY,
                scale.span_of("overall_luminous_efficacy"),
                "no lamp has such an efficacy",
            )
            .expected(format!("expected at most 683, found {efficacy}"))
            .note(most),
        );
    }
    let flux = scale.real("power_drawn") * efficacy;
    to_flux(scale, flux, lamp, errors_before, sink)
}

/// The lamp with a luminous flux in lm that an element asks for.
fn to_flux(scale: &Node, flux: f64, lamp: AreaLight, errors_before: usize, sink: &mut Sink) -> AreaLight {
    if let Some(scaled) = lamp.clone().with_flux(flux) {
        read::refuse_excess(scaled.radiance(), scale.span, sink);
        return scaled;
    }
    // What is wrong by itself needs no second complaint.
    if sink.error_count() == errors_before {
        sink.push(no_flux(scale, "a lamp without luminance or area cannot be scaled to a power"));
    }
    lamp
}

/// How far the triangles of a photometric lamp may face apart, in degrees. An even lamp loses the cosine of it straight
/// ahead, here a thousandth.
const MOST_BEND_DEG: f64 = 2.56;

/// The lamp with the directions of a file, and its flux unless another, in lm, is given.
fn with_profile(
    span: Span,
    (profile, flux): (&Node, Option<f64>),
    lamp: AreaLight,
    shape: &Shape,
    errors_before: usize,
    context: &mut Context,
) -> AreaLight {
    let bend_deg = shape.bend_deg();
    if bend_deg > MOST_BEND_DEG {
        let message = format!(
            "the mesh of a photometric lamp is not flat: its triangles, each of which emits about its own normal, \
             face {bend_deg:.1} degrees away from their common direction"
        );
        context.sink.push(Diagnostic::warning(codes::NOT_FLAT, span, message));
    }
    let Some((photometry, largest_cd)) = read_profile(profile, flux, context) else { return lamp };
    if let Some(lamp) = lamp.clone().with_profile(photometry, shape.x_axis) {
        let largest = lamp.radiance().scaled(largest_cd / lamp.area());
        read::refuse_excess(&largest, profile.span, context.sink);
        return lamp;
    }
    if context.sink.error_count() == errors_before {
        let message = "a lamp without luminance or area cannot be scaled to the flux of a file";
        context.sink.push(no_flux(profile, message));
    }
    lamp
}

/// The profile of a file, scaled to a flux in lm if one is given, and its largest intensity in cd.
fn read_profile(node: &Node, flux: Option<f64>, context: &mut Context) -> Option<(Profile, f64)> {
    let path = node.text("path");
    let file = context.read(&path.value, path.span)?;
    match ies::decode(&file.bytes) {
        Ok(p) => {
            for (position, note) in &p.notes {
                let note = format!("{}:{position}: {note}", file.path);
                context.sink.push(Diagnostic::warning(codes::FILE_NOTE, path.span, note));
            }
            let profile = |candela: &[f64]| Profile::new(&p.vertical_deg, &p.horizontal_deg, candela);
            let own = profile(&p.candela).flux();
            // A file without light was an error.
            let scale = flux.map_or(1.0, |flux| flux / own);
            let candela: Vec<f64> = p.candela.iter().map(|cd| cd * scale).collect();
            let largest = candela.iter().copied().fold(0.0, f64::max);
            Some((profile(&candela), largest))
        }
        Err(error) => {
            context.sink.push(
                Diagnostic::error(
                    codes::BAD_FILE,
                    path.span,
                    format!("{}:{}: bad photometric file", file.path, error.position),
                )
                .expected(format!("expected {}, found {}", error.expected, error.found)),
            );
            None
        }
    }
}

fn no_flux(node: &Node, message: &str) -> Diagnostic {
    Diagnostic::error(codes::NO_FLUX, node.span, message)
        .expected("expected a spectrum with visible light on a mesh with area")
}
