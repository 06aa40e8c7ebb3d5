//! `background`: light from everywhere.

use indigo_decl::{Block, Field, Kind, Presence};
use indigo_spectrum::declare::SPECTRUM;

/// The declaration of `background`.
pub static BLOCK: Block = Block::new(
    "background",
    "Lights the scene with the same radiance from all directions.",
    &[Field::new("spectrum", Kind::OneOf(&SPECTRUM), Presence::Required, "The radiance.")],
)
.with_ignored(&["radiance"])
.with_example(
    "<background>
    <spectrum>
        <blackbody><temperature>3500</temperature><gain>1.0</gain></blackbody>
    </spectrum>
</background>",
);
