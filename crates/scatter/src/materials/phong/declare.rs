//! `phong`, declared.

use crate::materials::fields::{
    ALBEDO_TEXTURE, BASE_EMISSION, BASE_EMISSION_PARAMETER, BUMP, BUMP_MAP, COLOUR_DEPRECATED, EMISSION,
    EMISSION_PARAMETER, EMISSION_TEXTURE, EXPONENT_PARAMETER, FRESNEL_SCALE_PARAMETER, LATER, LAYER,
    ROUGHNESS, ROUGHNESS_MAP, ROUGHNESS_PARAMETER,
};
use indigo_decl::{Block, Field, Group, Kind, Parameter, Presence, Range, StandIn};
use indigo_spectrum::declare::SPECTRUM;
use indigo_texture::declare::TEXTURE;

/// The fields, and further ones.
macro_rules! fields {
    ($($more:expr,)*) => {
        &[
            Field::new(
                "diffuse_albedo_spectrum",
                Kind::OneOf(&SPECTRUM),
                Presence::Optional,
                "The reflectance of the diffuse ground, at least 0; black where it is missing. Values above 1 are \
                 silently clamped. Has no effect on a metal.",
            ),
            Field::new(
                "diffuse",
                Kind::Vec3,
                Presence::Optional,
                "The reflectance of the ground as red, green and blue as picked on a screen: each is raised to \
                 the power 2.2 and then clamped to [0, 0.9]. Has no effect beside `diffuse_albedo_spectrum`.",
            )
            .range(Range::AtLeast(0.0))
            .deprecated(COLOUR_DEPRECATED),
            Field::new(
                "ior",
                Kind::Real,
                Presence::Optional,
                "Index of refraction of the coat. Needed unless the surface is a metal.",
            )
            .range(Range::AtLeast(1.0)),
            Field::new(
                "exponent",
                Kind::Real,
                Presence::Optional,
                "Exponent of the normals of small facets, from about 1 (broad highlights) to 10000 and more (nearly a mirror): \
                 their distribution is that of Trowbridge and Reitz with the peak of a Phong lobe of this exponent, and longer \
                 tails. Needed unless there is an `exponent_map`.",
            )
            .range(Range::Above(0.0)),
            Field::new(
                "nk_data",
                Kind::Path,
                Presence::Optional,
                "A file of measured complex indices of refraction, such as `nkdata/au.nk`, beside the scene or in \
                 the resource directory. Empty means none.",
            ),
            Field::new(
                "specular_reflectivity_spectrum",
                Kind::OneOf(&SPECTRUM),
                Presence::Optional,
                "Reflectivity of a metal at normal incidence; towards grazing angles it rises to 1 by Schlick's \
                 law. At least 0; values above 1 are silently clamped.",
            ),
            ALBEDO_TEXTURE,
            BUMP_MAP,
            Field::new(
                "exponent_map",
                Kind::Block(&TEXTURE),
                Presence::Optional,
                "An image map that takes the place of the exponent.",
            ),
            ROUGHNESS,
            ROUGHNESS_MAP,
            Field::new(
                "specular_reflectivity_texture",
                Kind::Block(&TEXTURE),
                Presence::Optional,
                "An image map that takes the place of `specular_reflectivity_spectrum`. Below 0 it counts as 0, and above 1 as 1, with \
                 a warning.",
            ),
            Field::new(
                "fresnel_scale",
                Kind::Real,
                Presence::Default("1"),
                "Factor on the reflectance of the coat or of the metal. Values above 1 are silently clamped.",
            )
            .range(Range::AtLeast(0.0)),
            BASE_EMISSION,
            EMISSION,
            EMISSION_TEXTURE,
            LAYER,
            $($more,)*
        ]
    };
}

/// The fields.
const FIELDS: &[Field] = fields![];

/// Those of `fast_sss`.
pub(in crate::materials) const FAST_SSS_FIELDS: &[Field] = fields![
    Field::new(
        "internal_medium_name",
        Kind::Reference("medium"),
        Presence::Optional,
        "Name of the medium that fills the inside of the object.",
    )
    .aliases(&["internal_medium_uid"]),
];

/// The declaration of `phong`.
pub static BLOCK: Block = Block::new(
    "phong",
    "A glossy surface of small facets: by default a dielectric coat of index `ior` over a diffuse \
     ground. With `nk_data` it is a metal of measured complex index; with \
     `specular_reflectivity_spectrum` a metal of the given reflectivity. Where several are given, \
     `nk_data` counts before `specular_reflectivity_spectrum`, and that before `ior` and the diffuse ground. \
     Under water, or in another medium, coats and measured metals reflect by the quotient of both indices.",
    FIELDS,
)
.with_needs(&[
    Group::any(&["ior", "nk_data", "specular_reflectivity_spectrum", "specular_reflectivity_texture"]),
    Group::any(&["exponent", "exponent_map", "roughness", "roughness_map"]),
])
.with_parameters(PARAMETERS)
.with_later(LATER)
.with_example(
    "<phong>
    <exponent>300</exponent>
    <specular_reflectivity_spectrum>
        <rgb><rgb>0.8 0.3 0.6</rgb><gamma>1</gamma></rgb>
    </specular_reflectivity_spectrum>
</phong>",
);

/// The parameters as later versions write them.
pub(in crate::materials) const PARAMETERS: &[Parameter] = &[
    BASE_EMISSION_PARAMETER,
    EMISSION_PARAMETER,
    Parameter {
        name: "diffuse_albedo",
        since: "1.1",
        constant: "diffuse_albedo_spectrum",
        texture: "albedo_texture",
        stand_in: StandIn::Uniform("0.5"),
    },
    Parameter {
        name: "specular_reflectivity",
        since: "1.1",
        constant: "specular_reflectivity_spectrum",
        texture: "specular_reflectivity_texture",
        stand_in: StandIn::Uniform("0.5"),
    },
    Parameter { name: "ior", since: "1.1", constant: "ior", texture: "", stand_in: StandIn::Text("1.5") },
    EXPONENT_PARAMETER,
    ROUGHNESS_PARAMETER,
    FRESNEL_SCALE_PARAMETER,
    BUMP,
];
