//! Files that bring in other files.

use indigo_decl::{Block, Field, Kind, Later, Presence};

/// The declaration of `include`.
pub static INCLUDE: Block = Block::new(
    "include",
    "Brings in the elements of another file, in this place. The root of that file is `scenedata` or `scene`.",
    &[Field::new(
        "pathname",
        Kind::Path,
        Presence::Required,
        "The file, relative to the scene or else to the file that includes it.",
    )],
)
.with_later(&[Later::new("offset_uids", "3.0")])
.with_example("<include><pathname>materials.igs</pathname></include>");
