//! `background_settings`: the surroundings as a material that emits.

use super::Context;
use super::emission;
use super::environment::{self, Surroundings};
use super::materials::MaterialTable;
use crate::codes;
use indigo_decl::{Kind, Node};
use indigo_diag::Diagnostic;
use indigo_light::DistantLight;
use indigo_light::kinds::Distant;
use indigo_light::kinds::background::Background;
use indigo_light::kinds::env_map::Layout;
use indigo_math::Vec3d;
use indigo_spectrum::{Spectrum, read};
use indigo_texture::Curve;
use std::f64::consts::{PI, TAU};

/// The lights of a background, whose `sum` may name materials of the scene.
pub(super) fn lights(
    settings: &Node,
    materials: &MaterialTable,
    context: &mut Context,
) -> Vec<(DistantLight, u16)> {
    let material = settings.node("background_material").and_then(|b| b.node("material"));
    let scale = settings.node("emission_scale").and_then(|scale| scale_of(scale, material, context));
    let Some(material) = material else { return vec![] };
    material.disregard_fields(&["name", "uid"]);
    let Some(kind) = material.alternative() else { return vec![] };
    let mut lights = vec![];
    let mut colours = vec![];
    for (kind, weight) in shining(kind, materials, context) {
        if kind.block.name == "sunsky" {
            if scale.is_some() {
                let message =
                    "sun and sky keep their brightness: <emission_scale> has no effect on a <sunsky>";
                context.sink.push(Diagnostic::warning(codes::IDLE_SCALE, kind.span, message));
            }
            lights.extend(environment::skylight(kind, weight, materials, context));
            colours.resize(lights.len(), None);
            continue;
        }
        let layer = materials.layer(if kind.block.declares("layer") { kind.int("layer") } else { 0 });
        let even = even_light(kind, weight, layer.colour.is_some(), context);
        lights.extend(even.map(|even| (even, layer.group)));
        colours.resize(lights.len(), layer.colour);
    }
    if let Some((node, luminance)) = scale {
        scale_to(&mut lights, luminance, node, context);
    }
    // What is scaled is the light before its layer, as of lamps.
    for ((light, _), colour) in lights.iter_mut().zip(&colours) {
        if let (DistantLight::Background(even), Some(colour)) = (light, colour) {
            even.0 = even.0.times(colour);
        }
    }
    lights
}

/// The scale of a background's material, and the luminance that it asks for; `None` where it is of another, which is told.
fn scale_of<'a>(scale: &'a Node, material: Option<&Node>, context: &mut Context) -> Option<(&'a Node, f64)> {
    scale.disregard_field("measure");
    let is_of = |name: &str| {
        let is = |field| material.and_then(|m| m.opt_text(field)).is_some_and(|own| own.value == name);
        is("name") || is("uid")
    };
    if let Some(named) = scale.opt_text("material_name").filter(|named| !is_of(&named.value)) {
        scale.disregard();
        let message =
            format!("<emission_scale> has no effect: the background's material is not {}", named.value);
        context.sink.push(Diagnostic::warning(codes::IDLE_SCALE, named.span, message));
        return None;
    }
    Some((scale, scale.real("value")))
}

/// The kinds that shine in a kind of material, with the factors on their light: itself, or the parts of a sum.
fn shining<'a>(kind: &'a Node, materials: &MaterialTable<'a>, context: &mut Context) -> Vec<(&'a Node, f64)> {
    if kind.block.name != "sum" {
        return vec![(kind, 1.0)];
    }
    let mut parts = vec![];
    for mat in kind.nodes("mat") {
        let (name, weight) = (mat.text("mat_name"), mat.real("weight"));
        match materials.kind_of(&name.value) {
            Some(part) if part.block.name != "sum" => parts.push((part, weight)),
            // A name that is not there is reported with all others.
            None => {}
            Some(part) => {
                let message = "a <sum> (of version 4.0) in a <sum> is not rendered: it is left out";
                context.sink.push(Diagnostic::warning(codes::STANDS_IN, part.span, message));
            }
        }
    }
    parts
}

/// What a material emits, all round, before the colour of its layer, if that has one.
fn even_light(kind: &Node, weight: f64, is_coloured: bool, context: &mut Context) -> Option<DistantLight> {
    // Of a material that surrounds everything only the emission is to be seen.
    kind.disregard();
    let field = |name: &str| kind.block.declares(name).then(|| kind.node(name)).flatten();
    let base = field("base_emission");
    if let Some(texture) = field("emission_texture") {
        let gain = base.map_or(Spectrum::uniform(1.0), |base| read::emission(base, context.sink));
        if is_coloured || !matches!(gain, Spectrum::Uniform(_)) {
            let message = "the surroundings have the colours of their picture: those of <base_emission> and of the layer are left out";
            context.sink.push(Diagnostic::warning(codes::STANDS_IN, kind.span, message));
        }
        let gain = gain.luminance() / Spectrum::uniform(1.0).luminance() * weight;
        read::refuse_excess(&Spectrum::uniform(gain), kind.span, context.sink);
        return picture(texture, gain, context);
    }
    let radiance = emission::radiance(base, field("emission"), context.sink);
    if radiance.is_none() {
        warn_of_parts(kind, context);
    }
    let radiance = radiance?.scaled(weight);
    read::refuse_excess(&radiance, kind.span, context.sink);
    Some(Background(radiance).into())
}

/// Tells of a kind that is made of other materials, whose light is not looked for.
fn warn_of_parts(kind: &Node, context: &mut Context) {
    if kind.block.fields.iter().any(|field| matches!(field.kind, Kind::Reference("material"))) {
        let what = format!("as a background a <{}>", kind.block.name);
        let message = format!("{what} gives no light but its own: what it is made of is left out");
        context.sink.push(
            Diagnostic::warning(codes::NOT_EMITTING, kind.span, message)
                .hint("give it a <base_emission>, or take the material that emits"),
        );
    }
}

/// A picture of the surroundings, given as a texture.
fn picture(texture: &Node, gain: f64, context: &mut Context) -> Option<DistantLight> {
    texture.disregard();
    let path = texture.text("path");
    let [exponent, a, b, c] = ["exponent", "a", "b", "c"].map(|field| texture.real(field));
    let turn = turn_of(texture, context);
    let Some(file) = context.read_or_stand_in(&path.value, path.span, environment::MAGENTA_LIGHT) else {
        return environment::magenta_light(gain, context);
    };
    let image = context.picture(&file.path, &file.bytes, path.span);
    let surroundings = Surroundings {
        layout: if turn == 0.0 { Layout::LatLong } else { Layout::Turned(turn as indigo_math::Real) },
        curve: Some(Curve { exponent, a, b, c }),
        gain,
    };
    surroundings.env_map(image, &file.path, path.span, context).map(DistantLight::from)
}

/// How far a picture is turned about the z axis, to the left, in parts of a full turn.
fn turn_of(texture: &Node, context: &mut Context) -> f64 {
    let spherical = texture.node("tex_coord_generation").and_then(|t| t.node("spherical"));
    let rotation = spherical.and_then(|s| s.node("rotation")).and_then(|r| r.node("axis_rotation"));
    let Some(rotation) = rotation else { return 0.0 };
    let (axis, angle) = (Vec3d::from(rotation.vec3("axis")).try_normalized(), rotation.real("angle"));
    match axis {
        Some(axis) if axis.x.abs().max(axis.y.abs()) < 1e-6 => axis.z.signum() * angle / TAU,
        _ if angle == 0.0 => 0.0,
        _ => {
            let message = "surroundings are turned about the z axis alone: this turn is left out";
            context.sink.push(Diagnostic::warning(codes::STANDS_IN, rotation.span, message));
            0.0
        }
    }
}

/// Brings even lights and pictures to a mean luminance (cd/m²) over all directions.
fn scale_to(lights: &mut [(DistantLight, u16)], luminance: f64, node: &Node, context: &mut Context) {
    let scalable =
        |light: &DistantLight| matches!(light, DistantLight::Background(_) | DistantLight::EnvMap(_));
    let scaled = lights.iter().map(|(light, _)| light).filter(|light| scalable(light));
    let total: f64 = scaled.map(Distant::total_luminance).sum();
    let factor = luminance * 4.0 * PI / total;
    if !lights.iter().any(|(light, _)| scalable(light)) {
        return;
    }
    if !factor.is_finite() {
        context.sink.push(
            Diagnostic::error(
                codes::NO_FLUX,
                node.span,
                "surroundings without light cannot be scaled to a luminance",
            )
            .expected("expected a spectrum with visible light"),
        );
        return;
    }
    for (light, _) in lights {
        match light {
            DistantLight::Background(even) => {
                even.0 = even.0.scaled(factor);
                read::refuse_excess(&even.0, node.span, context.sink);
            }
            DistantLight::EnvMap(map) => *map = map.clone().scaled(factor),
            _ => {}
        }
    }
}
