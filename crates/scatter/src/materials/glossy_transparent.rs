//! `glossy_transparent`: a rough surface of a dielectric.

use super::fields::{BUMP_MAP, INTERNAL_MEDIUM_NAME, LATER};
use indigo_decl::{Block, Field, Kind, Presence, Range};

/// The declaration of `glossy_transparent`.
pub static BLOCK: Block = Block::new(
    "glossy_transparent",
    "A rough surface of a transparent dielectric, such as frosted glass or skin.",
    &[
        INTERNAL_MEDIUM_NAME,
        Field::new(
            "exponent",
            Kind::Real,
            Presence::Required,
            "Exponent of the Phong lobe of reflection and of transmission, from about 1 (broad) to 10000 and \
             more (nearly smooth).",
        )
        .range(Range::Above(0.0)),
        BUMP_MAP,
    ],
)
.with_later(LATER)
.with_example(
    "<glossy_transparent>
    <internal_medium_name>glass</internal_medium_name>
    <exponent>1000</exponent>
</glossy_transparent>",
);
