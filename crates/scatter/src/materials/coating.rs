//! `coating`: a clear coat over a diffuse material.
//!
//! It is the coat of [`phong`](super::phong) over a ground whose reflectance is told as it is without the coat. What a
//! Lambertian ground of albedo ρ sends up the coat throws back in part, r, again and again, so that under it the ground
//! shows ρ (1 − r) / (1 − ρ r) (Saunderson 1942, "Calculation of the color of pigmented plastics", equation 5): coats
//! make colours darker and deeper, and leave white as it is.

use super::fields::{BUMP, BUMP_MAP, FRESNEL_SCALE_PARAMETER, ROUGHNESS, ROUGHNESS_MAP, ROUGHNESS_PARAMETER};
use super::phong::Phong;
use super::{Material, MaterialResources, Surface};
use indigo_decl::{Block, Field, Kind, Later, Node, Parameter, Presence, Range, StandIn, codes};
use indigo_diag::Diagnostic;
use indigo_math::{Float, Real};
use indigo_spectrum::declare::SPECTRUM;
use indigo_spectrum::read;

/// The declaration of `coating`.
pub static BLOCK: Block = Block::new(
    "coating",
    "A thin clear coat over another material, of version 3.0. It is rendered over a `diffuse` material; any other stands \
     in without its coat, with a warning.",
    &[
        Field::new(
            "substrate_material_name",
            Kind::Reference("material"),
            Presence::Required,
            "Name of the material below the coat.",
        )
        .aliases(&["substrate_material_uid"]),
        Field::new("ior", Kind::Real, Presence::Default("1.5"), "Index of refraction of the coat.")
            .range(Range::AtLeast(1.0)),
        ROUGHNESS,
        ROUGHNESS_MAP,
        Field::new(
            "fresnel_scale",
            Kind::Real,
            Presence::Default("1"),
            "Factor on the reflectance of the coat. Values above 1 are silently clamped.",
        )
        .range(Range::AtLeast(0.0)),
        Field::new(
            "absorption_spectrum",
            Kind::OneOf(&SPECTRUM),
            Presence::Optional,
            "What the coat absorbs. It is not rendered: the coat is clear, with a warning unless this is 0.",
        ),
        BUMP_MAP,
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
    Parameter { name: "ior", since: "3.0", constant: "ior", texture: "", stand_in: StandIn::Text("1.5") },
    BUMP,
])
.with_later(&[
    Later::new("displacement", "1.1").instead("is left out: the surface stays where its mesh is"),
    Later::new("interference", "3.0").unless("false"),
])
// Without absorption and interference it has no effect.
.with_passed_over(&["thickness"])
.with_example(
    "<coating>
    <substrate_material_name>white</substrate_material_name>
    <ior>1.5</ior>
    <roughness>0.1</roughness>
</coating>",
);

/// Builds the material of an element. What is below is known to be `diffuse`: of all else the scene takes the material below.
pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Material {
    let below = resources.substrate(node, "substrate_material_name");
    let Material::Diffuse(below) = resources.built(below) else {
        node.disregard();
        return Material::grey();
    };
    let (ground, bump) = (below.kind.albedo().clone(), below.bump);
    if node.node("absorption_spectrum").is_some_and(|a| read::coefficient(a, resources.sink()).max() > 0.0) {
        let message = "<absorption> of a <coating> is of a later format version (3.0) and not rendered: the coat is clear";
        let at = node.span_of("absorption_spectrum");
        resources.sink().push_or_count(Diagnostic::warning(codes::LATER_ELEMENT, at, message));
    }
    let coat = Phong::coat(node, Real::from_f64(node.real("ior")), ground, resources);
    let coated = Surface::new(coat, node, resources);
    // Bumps of the ground are those of a coat that has none of its own.
    Material::Phong(Surface { bump: coated.bump.or(bump), ..coated })
}
