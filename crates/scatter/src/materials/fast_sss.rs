//! `fast_sss`: light scattered below the surface, which later versions do in a quick way of their own.

use super::fields::{
    BASE_EMISSION_PARAMETER, BUMP, EMISSION_PARAMETER, EXPONENT_PARAMETER, FRESNEL_SCALE_PARAMETER,
    INTERNAL_MEDIUM_NAME, LATER, ROUGHNESS, ROUGHNESS_PARAMETER,
};
use super::glossy_transparent::GlossyTransparent;
use super::phong::{FAST_SSS_FIELDS, Phong};
use super::{Material, MaterialResources, Surface};
use crate::microfacet::Microfacets;
use indigo_decl::{Block, Node, Parameter, StandIn, codes};
use indigo_diag::Diagnostic;
use indigo_math::{Float, Real};

/// The declaration of `fast_sss`.
pub static BLOCK: Block = Block::new(
    "fast_sss",
    "Light scattered below the surface, of version 4.0. With a medium inside it is the rough surface of that (`glossy_transparent` of the \
     same roughness), in which light is scattered as it is. Without one a `phong` of the same albedo stands in, with a warning. It \
     has the fields of `phong`.",
    FAST_SSS_FIELDS,
)
.with_parameters(&[
    Parameter {
        name: "albedo",
        since: "4.0",
        constant: "diffuse_albedo_spectrum",
        texture: "albedo_texture",
        stand_in: StandIn::Uniform("0.5"),
    },
    BASE_EMISSION_PARAMETER,
    EMISSION_PARAMETER,
    EXPONENT_PARAMETER,
    FRESNEL_SCALE_PARAMETER,
    ROUGHNESS_PARAMETER,
    BUMP,
])
.with_later(LATER)
.with_example(
    "<fast_sss>
    <albedo><constant><rgb><rgb>0.8 0.6 0.5</rgb></rgb></constant></albedo>
    <roughness><constant>0.3</constant></roughness>
</fast_sss>",
);

/// Fields that say nothing of the surface of a medium.
const IDLE: [&str; 11] = [
    "albedo_texture",
    "diffuse_albedo_spectrum",
    "diffuse",
    "ior",
    "exponent",
    "exponent_map",
    "roughness_map",
    "fresnel_scale",
    "nk_data",
    "specular_reflectivity_spectrum",
    "specular_reflectivity_texture",
];

/// Builds the material of an element.
pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Material {
    if node.opt_text(INTERNAL_MEDIUM_NAME.name).is_none() {
        return Material::Phong(Surface::new(Phong::build(node, resources), node, resources));
    }
    let medium = resources.medium(node, INTERNAL_MEDIUM_NAME.name);
    let width = node.opt_real(ROUGHNESS.name).map_or(0.3, |width| width.value);
    // Its colours are those of the medium.
    for idle in IDLE.into_iter().filter(|name| node.has(name)) {
        let message = format!(
            "<{idle}> has no effect beside <internal_medium_name>: the surface is that of the medium"
        );
        let at = node.span_of(idle);
        resources.sink().push_or_count(Diagnostic::warning(codes::DUPLICATE_ELEMENT, at, message));
    }
    node.disregard();
    let facets = Microfacets::of_width(Real::from_f64(width));
    Material::GlossyTransparent(Surface::new(GlossyTransparent::new(medium, facets), node, resources))
}
