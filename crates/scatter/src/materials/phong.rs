//! `phong`: a glossy coat over a diffuse ground, or a metal.

use super::fields::{ALBEDO_TEXTURE, BUMP_MAP, COLOUR_DEPRECATED, LATER};
use indigo_decl::{Block, Field, Group, Kind, Presence, Range};
use indigo_spectrum::declare::SPECTRUM;
use indigo_texture::declare::TEXTURE;

/// The declaration of `phong`.
pub static BLOCK: Block = Block::new(
    "phong",
    "A glossy surface with a Phong lobe: by default a dielectric coat of index `ior` over a diffuse \
     ground. With `nk_data` it is a metal of measured complex index; with \
     `specular_reflectivity_spectrum` a metal of the given reflectivity. Where several are given, \
     `nk_data` counts before `specular_reflectivity_spectrum`, and that before `ior` and the diffuse ground.",
    &[
        Field::new(
            "diffuse_albedo_spectrum",
            Kind::OneOf(&SPECTRUM),
            Presence::Optional,
            "The reflectance of the diffuse ground; black where it is missing. Values outside [0, 1] are \
             silently clamped. Has no effect on a metal.",
        ),
        Field::new(
            "diffuse",
            Kind::Vec3,
            Presence::Optional,
            "The reflectance of the ground as red, green and blue as picked on a screen: each is raised to \
             the power 2.2 and then clamped to [0, 0.9]. Has no effect beside `diffuse_albedo_spectrum`.",
        )
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
            "Exponent of the Phong lobe, from about 1 (broad highlights) to 10000 and more (nearly a \
             mirror). Needed unless there is an `exponent_map`.",
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
             law. Values outside [0, 1] are silently clamped.",
        ),
        ALBEDO_TEXTURE,
        BUMP_MAP,
        Field::new(
            "exponent_map",
            Kind::Block(&TEXTURE),
            Presence::Optional,
            "An image map that takes the place of the exponent.",
        ),
    ],
)
.with_needs(&[
    Group::any(&["ior", "nk_data", "specular_reflectivity_spectrum"]),
    Group::any(&["exponent", "exponent_map"]),
])
.with_later(LATER)
.with_example(
    "<phong>
    <exponent>300</exponent>
    <specular_reflectivity_spectrum>
        <rgb><rgb>0.8 0.3 0.6</rgb><gamma>1</gamma></rgb>
    </specular_reflectivity_spectrum>
</phong>",
);
