//! `double_sided_thin`: a sheet without thickness, such as paper or a leaf, with a material on each side.
//!
//! A part of the light is scattered back by the material of the side on which it falls, the rest scattered through,
//! evenly into all directions of the other side. As in a blend one of the two is chosen at each point, with the probability of
//! its share, which has the right mean as scattering is linear in both.

use super::blend::Choice;
use super::diffuse_transmitter::DiffuseTransmitter;
use super::fields::{
    BASE_EMISSION, BASE_EMISSION_PARAMETER, EMISSION, EMISSION_PARAMETER, EMISSION_TEXTURE, LAYER,
};
use super::{Material, MaterialContext, MaterialId, MaterialResources, Surface};
use crate::reflectance::Reflectance;
use indigo_decl::{Block, Field, Kind, Later, Node, Parameter, Presence, Range, StandIn, codes};
use indigo_diag::Diagnostic;
use indigo_math::{Float, Real};
use indigo_spectrum::declare::SPECTRUM;
use indigo_texture::declare::TEXTURE;

const NO_GLOSS: &str = "is left out: the sheet has the gloss of the materials of its sides";

/// The declaration of `double_sided_thin`.
pub static BLOCK: Block = Block::new(
    "double_sided_thin",
    "A sheet without thickness, such as paper or a leaf, of version 3.0. A part of the light is scattered back as by the \
     material of the side on which it falls; the rest is let through, scattered evenly into all directions. The sheet's own gloss \
     (`ior`, `roughness`) is not rendered: materials of its sides may have one.",
    &[
        Field::new(
            "front_material_name",
            Kind::Reference("material"),
            Presence::Required,
            "Name of the material of the front. It must let no light through.",
        )
        .aliases(&["front_material_uid"]),
        Field::new(
            "back_material_name",
            Kind::Reference("material"),
            Presence::Optional,
            "Name of the material of the back; that of the front, where it is missing.",
        )
        .aliases(&["back_material_uid"]),
        Field::new(
            "r_f",
            Kind::Real,
            Presence::Default("0.5"),
            "The part of the light that the side's material gets; the rest is let through.",
        )
        .range(Range::Within(0.0, 1.0)),
        Field::new(
            "transmittance_spectrum",
            Kind::OneOf(&SPECTRUM),
            Presence::Optional,
            "What becomes of the rest on its way through, at most 1. Where it is missing nothing comes through.",
        ),
        Field::new(
            "transmittance_texture",
            Kind::Block(&TEXTURE),
            Presence::Optional,
            "An image map that takes the place of `transmittance_spectrum`.",
        ),
        BASE_EMISSION,
        EMISSION,
        EMISSION_TEXTURE,
        LAYER,
    ],
)
.with_parameters(&[
    Parameter {
        name: "transmittance",
        since: "3.0",
        constant: "transmittance_spectrum",
        texture: "transmittance_texture",
        stand_in: StandIn::Uniform("0.5"),
    },
    Parameter { name: "r_f", since: "3.0", constant: "r_f", texture: "", stand_in: StandIn::Text("0.5") },
    BASE_EMISSION_PARAMETER,
    EMISSION_PARAMETER,
])
.with_later(&[
    Later::new("displacement", "1.1").instead("is left out: the surface stays where its mesh is"),
    Later::new("bump", "3.0"),
    Later::new("ior", "3.0").instead(NO_GLOSS),
    Later::new("roughness", "3.0").instead(NO_GLOSS),
    Later::new("front_roughness", "3.0").instead(NO_GLOSS),
    Later::new("back_roughness", "3.0").instead(NO_GLOSS),
    Later::new("fresnel_scale", "3.0").instead(NO_GLOSS),
    Later::new("front_fresnel_scale", "3.0").instead(NO_GLOSS),
    Later::new("back_fresnel_scale", "3.0").instead(NO_GLOSS),
])
.with_example(
    "<double_sided_thin>
    <front_material_name>white</front_material_name>
    <r_f>0.6</r_f>
    <transmittance_spectrum><uniform><value>0.8</value></uniform></transmittance_spectrum>
</double_sided_thin>",
);

/// A sheet of two sides.
#[derive(Clone, Debug)]
pub struct DoubleSidedThin {
    sides: [MaterialId; 2],
    /// The part that is scattered back.
    back: Real,
    through: Box<Material>,
}

impl DoubleSidedThin {
    /// From its element.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        let front = side(node, "front_material_name", resources);
        let back = if node.opt_text("back_material_name").is_some() {
            side(node, "back_material_name", resources)
        } else {
            front
        };
        let through =
            Reflectance::build(node, ["transmittance_texture", "transmittance_spectrum"], None, resources);
        let through = Surface { kind: DiffuseTransmitter::new(through), bump: None };
        Self {
            sides: [front, back],
            back: Real::from_f64(node.real("r_f")),
            through: Box::new(Material::DiffuseTransmitter(through)),
        }
    }

    /// What the sheet is at a point, to light that comes from one of its sides: it may be a blend.
    #[inline]
    pub(super) fn choose<'a>(&'a self, context: &MaterialContext<'a>, choice: &mut Choice) -> &'a Material {
        if choice.is_within(1.0 - self.back) {
            return &self.through;
        }
        &context.materials[self.sides[usize::from(!context.is_front)] as usize]
    }
}

/// The material of a side. One that lets light through was reported.
fn side(node: &Node, field: &str, resources: &mut dyn MaterialResources) -> MaterialId {
    let id = resources.material(node, field);
    let material = resources.built(id);
    if material.may_transmit() || material.internal_medium().is_some() {
        let fault = "the side of a thin sheet can neither let light through nor have a medium inside";
        let expected = "expected an opaque material: what comes through is told by the transmittance";
        resources
            .sink()
            .push(Diagnostic::error(codes::CONTRADICTION, node.span_of(field), fault).expected(expected));
    }
    id
}
