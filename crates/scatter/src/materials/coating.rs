//! `coating`: a coat over a diffuse material, or a thin film over a metal.
//!
//! Over `diffuse` it is the coat of [`phong`] over a ground whose reflectance is told as it is without the coat.
//! What a Lambertian ground of albedo ρ sends up the coat throws back in part, r, again and again, so that under it the ground
//! shows ρ (1 − r) / (1 − ρ r) (Saunderson 1942, "Calculation of the color of pigmented plastics", equation 5): coats
//! make colours darker and deeper, and leave white as it is. What the coat absorbs is lost on each of those ways.
//!
//! With `interference` over a metal of measured indices it is a film as even as the metal's own facets: light that is reflected
//! above and below it interferes, which makes the colours of anodised and tempered metals.

use super::fields::{
    BASE_EMISSION, BASE_EMISSION_PARAMETER, BUMP, BUMP_MAP, EMISSION, EMISSION_PARAMETER, EMISSION_TEXTURE,
    FRESNEL_SCALE_PARAMETER, LAYER, ROUGHNESS_MAP, ROUGHNESS_PARAMETER,
};
use super::phong::{self, Phong};
use super::{Material, MaterialResources, Surface};
use indigo_decl::{Block, Field, Kind, Later, Node, Parameter, Presence, Range, StandIn, codes};
use indigo_diag::{Diagnostic, Sink};
use indigo_math::{Float, Real};
use indigo_spectrum::declare::SPECTRUM;
use indigo_spectrum::{Spectrum, read};
use indigo_texture::TextureId;

/// The declaration of `coating`.
pub static BLOCK: Block = Block::new(
    "coating",
    "A thin coat over another material, of version 3.0. It is rendered over a `diffuse` material and, with `interference`, over \
     a `phong` of `nk_data`; any other stands in without its coat, with a warning. It shines by its \
     own emission, or else by that of the material below, of which it absorbs nothing.",
    &[
        Field::new(
            "substrate_material_name",
            Kind::Reference("material"),
            Presence::Required,
            "Name of the material below the coat.",
        )
        .aliases(&["substrate_material_uid"]),
        Field::new("ior", Kind::Real, Presence::Default("1.5"), "Index of refraction of the coat.")
            .range(Range::Within(1.0, 1000.0)),
        Field::new(
            "roughness",
            Kind::Real,
            Presence::Optional,
            "How rough the coat is: the width α of the distribution of small facets, from 0 to 1; smooth where it is missing.",
        )
        .range(Range::Within(0.0, 1.0)),
        ROUGHNESS_MAP,
        Field::new(
            "fresnel_scale",
            Kind::Real,
            Presence::Default("1"),
            "Factor on the reflectance of the coat, or of a metal and the film on it. Values above 1 are silently clamped.",
        )
        .range(Range::AtLeast(0.0)),
        Field::new(
            "absorption_spectrum",
            Kind::OneOf(&SPECTRUM),
            Presence::Optional,
            "Absorption coefficient of the coat, at least 0; none where it is missing. It needs a `thickness`. A film that \
             interferes is clear, with a warning.",
        )
        .unit("1/m"),
        Field::new(
            "thickness",
            Kind::Real,
            Presence::Default("0"),
            "Thickness of the coat. It counts for what absorbs or interferes.",
        )
        .unit("m")
        .range(Range::AtLeast(0.0)),
        Field::new(
            "interference",
            Kind::Bool,
            Presence::Default("false"),
            "Whether light that is reflected above and below the coat interferes, which takes a `phong` of `nk_data` below. The film \
             is as rough as the metal. Over `diffuse`, which reflects nothing that could interfere, it has no effect, with a \
             warning.",
        ),
        BUMP_MAP,
        BASE_EMISSION,
        EMISSION,
        EMISSION_TEXTURE,
        LAYER,
    ],
)
.with_parameters(&[
    ROUGHNESS_PARAMETER,
    FRESNEL_SCALE_PARAMETER,
    Parameter {
        name: "absorption",
        since: "3.0",
        constant: "absorption_spectrum",
        texture: "",
        stand_in: StandIn::Nothing,
    },
    Parameter {
        name: "thickness",
        since: "3.0",
        constant: "thickness",
        texture: "",
        stand_in: StandIn::Text("0"),
    },
    Parameter { name: "ior", since: "3.0", constant: "ior", texture: "", stand_in: StandIn::Text("1.5") },
    BUMP,
    BASE_EMISSION_PARAMETER,
    EMISSION_PARAMETER,
])
.with_later(&[Later::new("displacement", "1.1").instead("is left out: the surface stays where its mesh is")])
.with_example(
    "<coating>
    <substrate_material_name>white</substrate_material_name>
    <ior>1.5</ior>
    <roughness>0.1</roughness>
</coating>",
);

/// Whether a coat is rendered over a kind of material.
pub fn is_rendered_over(coat: &Node, below: &Node) -> bool {
    below.block.name == "diffuse"
        || (coat.bool("interference") && below.block.name == "phong" && phong::is_measured(below))
}

/// Builds the material of an element. What is below is known to be one that the coat [is rendered over](is_rendered_over): of all
/// else the scene takes the material below.
pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Material {
    let below = resources.substrate(node, "substrate_material_name");
    match resources.built(below) {
        Material::Diffuse(below) => {
            let (ground, bump) = (below.kind.albedo().clone(), below.bump);
            let index = Real::from_f64(node.real("ior"));
            report_lost_interference(node, resources.sink());
            let coat = Phong::coat(node, index, optical_depth(node, resources.sink()), ground, resources);
            with_bumps(coat, bump, node, resources)
        }
        Material::Phong(below) => {
            let bump = below.bump;
            match below.kind.under_film(node) {
                Some(filmed) => {
                    report_unfit_for_films(node, resources.sink());
                    with_bumps(filmed, bump, node, resources)
                }
                // It is no measured metal, over which no coat is rendered.
                None => grey(node),
            }
        }
        // What is below could not be built, which has been reported.
        _ => grey(node),
    }
}

fn grey(node: &Node) -> Material {
    node.disregard();
    Material::grey()
}

/// Bumps of what is below are those of a coat that has none of its own.
fn with_bumps(
    kind: Phong,
    below: Option<TextureId>,
    node: &Node,
    resources: &mut dyn MaterialResources,
) -> Material {
    let coated = Surface::new(kind, node, resources);
    Material::Phong(Surface { bump: coated.bump.or(below), ..coated })
}

/// The optical depth along the normal of a coat that absorbs.
fn optical_depth(node: &Node, sink: &mut Sink) -> Option<Spectrum> {
    let thickness = node.real("thickness");
    let absorption = read::coefficient(node.node("absorption_spectrum")?, sink);
    if absorption.max() == 0.0 {
        return None;
    }
    if thickness == 0.0 && !node.is_faulty("thickness") {
        let message = "<absorption> of a <coating> without a <thickness> has no effect";
        sink.push_or_count(Diagnostic::warning(
            codes::LATER_ELEMENT,
            node.span_of("absorption_spectrum"),
            message,
        ));
        return None;
    }
    // No light is left long before that, and single precision ends soon after.
    Some(absorption.scaled(thickness).clamped(0.0, 1e30))
}

fn report_lost_interference(node: &Node, sink: &mut Sink) {
    if node.bool("interference") {
        let message = "<interference> of a <coating> over <diffuse> has no effect: nothing below it reflects light that could interfere";
        sink.push_or_count(Diagnostic::warning(codes::LATER_ELEMENT, node.span_of("interference"), message));
    }
}

/// What a film has no use for: it follows the facets of the metal, and is too thin to absorb.
fn report_unfit_for_films(node: &Node, sink: &mut Sink) {
    let absorbs = node.node("absorption_spectrum").is_some_and(|a| read::coefficient(a, sink).max() > 0.0);
    let is_rough = node.opt_real("roughness").is_some_and(|r| r.value > 0.0);
    for (is_said, field, why) in [
        (
            absorbs,
            "absorption_spectrum",
            "<absorption> of a <coating> with <interference> has no effect: the film is clear",
        ),
        (
            is_rough,
            "roughness",
            "<roughness> of a <coating> with <interference> has no effect: the film is as rough as the metal below",
        ),
        (
            node.has("roughness_map"),
            "roughness_map",
            "<roughness> of a <coating> with <interference> has no effect: the film is as rough as the metal below",
        ),
        (
            node.real("thickness") == 0.0 && !node.is_faulty("thickness"),
            "interference",
            "<interference> of a <coating> without a <thickness> has no effect",
        ),
    ] {
        if is_said {
            sink.push_or_count(Diagnostic::warning(codes::LATER_ELEMENT, node.span_of(field), why));
        }
    }
    node.disregard_fields(&["roughness", "roughness_map"]);
}
