//! `diffuse_transmitter`: a thin sheet that scatters all light to its other side.

use super::fields::{ALBEDO_TEXTURE, COLOUR_DEPRECATED, LATER};
use indigo_decl::{Block, Field, Group, Kind, Presence};
use indigo_spectrum::declare::SPECTRUM;

/// The declaration of `diffuse_transmitter`.
pub static BLOCK: Block = Block::new(
    "diffuse_transmitter",
    "A thin sheet that scatters light to its other side, with a cosine-weighted distribution: the limit \
     of many scatterings in a thin layer. For curtains and lampshades made of single-layer geometry; it \
     has no medium inside. Blend it with `diffuse` to have light scattered back as well.",
    &[
        Field::new(
            "albedo_spectrum",
            Kind::OneOf(&SPECTRUM),
            Presence::Optional,
            "The fraction of light that is let through. Values outside [0, 1] are silently clamped.",
        ),
        Field::new(
            "colour",
            Kind::Vec3,
            Presence::Optional,
            "The fraction let through as red, green and blue as picked on a screen: each is raised to the \
             power 2.2 and then clamped to [0, 0.9]. Has no effect beside `albedo_spectrum`.",
        )
        .deprecated(COLOUR_DEPRECATED),
        ALBEDO_TEXTURE,
    ],
)
.with_needs(&[Group::any(&["albedo_spectrum", "colour", "albedo_texture"])])
.with_later(LATER)
.with_example(
    "<diffuse_transmitter>
    <albedo_spectrum>
        <uniform><value>0.4</value></uniform>
    </albedo_spectrum>
</diffuse_transmitter>",
);
