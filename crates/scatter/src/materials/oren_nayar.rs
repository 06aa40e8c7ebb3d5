//! `oren_nayar`: a rough surface without gloss.

use super::fields::{ALBEDO_SPECTRUM, ALBEDO_TEXTURE, BUMP_MAP, LATER};
use indigo_decl::{Block, Field, Group, Kind, Presence, Range};

/// The declaration of `oren_nayar`.
pub static BLOCK: Block = Block::new(
    "oren_nayar",
    "A very rough surface without gloss, such as clay, sprayed concrete, porous rock or the Moon: \
     M. Oren and S. K. Nayar, Generalization of the Lambertian Model and Implications for Machine \
     Vision (1995).",
    &[
        Field::new(
            "sigma",
            Kind::Real,
            Presence::Required,
            "Standard deviation of the slope angles of the microfacets. The higher, the rougher, and the \
             more light is scattered back; 0 is a Lambertian surface.",
        )
        .unit("rad")
        .range(Range::Within(0.0, 1.0)),
        ALBEDO_SPECTRUM,
        ALBEDO_TEXTURE,
        BUMP_MAP,
    ],
)
.with_needs(&[Group::any(&["albedo_spectrum", "albedo_texture"])])
.with_later(LATER)
.with_example(
    "<oren_nayar>
    <sigma>0.3</sigma>
    <albedo_spectrum>
        <uniform><value>0.5</value></uniform>
    </albedo_spectrum>
</oren_nayar>",
);
