//! `blend`: two materials at once.

use indigo_decl::{Block, Field, Group, Kind, Later, Presence, Range};
use indigo_texture::declare::TEXTURE;

/// The declaration of `blend`.
pub static BLOCK: Block = Block::new(
    "blend",
    "Two materials at once, weighted by a number or by an image map. Blends may be made of blends, but \
     at most one material in the whole tree may be `specular` or `null_material`.",
    &[
        Field::new(
            "blend_factor",
            Kind::Real,
            Presence::Optional,
            "The share of material b: 0 is material a alone, 1 is material b alone. Needed unless there is a \
             `blend_map`, which takes its place.",
        )
        .range(Range::Within(0.0, 1.0)),
        Field::new("a_name", Kind::Reference("material"), Presence::Required, "Name of material a."),
        Field::new("b_name", Kind::Reference("material"), Presence::Required, "Name of material b."),
        Field::new(
            "blend_map",
            Kind::Block(&TEXTURE),
            Presence::Optional,
            "An image map that takes the place of `blend_factor`.",
        ),
    ],
)
.with_needs(&[Group::any(&["blend_factor", "blend_map"])])
.with_later(&[
    Later::new("blend", "1.1"),
    Later::new("step_blend", "2.0"),
    Later::new("texture", "1.1"),
    Later::new("a_uid", "3.0"),
    Later::new("b_uid", "3.0"),
])
.with_example(
    "<blend>
    <blend_factor>0.5</blend_factor>
    <a_name>mata</a_name>
    <b_name>matb</b_name>
</blend>",
);
