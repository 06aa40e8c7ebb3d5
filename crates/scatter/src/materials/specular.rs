//! `specular`: a perfectly smooth surface of a dielectric.

use super::fields::{BUMP_MAP, INTERNAL_MEDIUM_NAME, LATER};
use indigo_decl::{Block, Field, Kind, Presence};

/// The declaration of `specular`.
pub static BLOCK: Block = Block::new(
    "specular",
    "A perfectly smooth surface of a dielectric, such as glass or water: it reflects like a mirror and \
     lets the rest of the light through, refracted.",
    &[
        INTERNAL_MEDIUM_NAME,
        Field::new(
            "transparent",
            Kind::Bool,
            Presence::Default("true"),
            "Whether light goes through. If not, only the reflected light is there.",
        ),
        BUMP_MAP,
    ],
)
.with_later(LATER)
.with_example(
    "<specular>
    <transparent>true</transparent>
    <internal_medium_name>glass</internal_medium_name>
</specular>",
);
