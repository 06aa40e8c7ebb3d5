//! Image maps, declared.

use indigo_decl::{Block, Field, Kind, Later, Presence, Range};

/// An image map.
///
/// Its element is called after its use: `albedo_texture`, `bump_map`, `exponent_map`, `blend_map`, `texture`.
pub static TEXTURE: Block = Block::new(
    "texture",
    "An image map over the surface. The element bears the name of its use: `albedo_texture`, \
     `bump_map`, `exponent_map`, `blend_map`, or `texture` in a mesh light.\n\n\
     Each component x of the image, scaled to [0, 1], becomes f = a·g² + b·g + c with g = x^exponent. \
     Where one number is wanted (bump, exponent, blend) it is the mean of f over red, green and blue. \
     v = 0 is the bottom of the image, which repeats in both directions. Texels stand at the corners of a grid, the \
     first of them at (0, 0), and between them values are linear: the last run on into the first ones of the next \
     repetition. Those of environment maps stand in the middle of their cells.",
    &[
        Field::new(
            "uv_set",
            Kind::Text,
            Presence::Default("default"),
            "Name of the set of texture coordinates to look the image up with; the mesh must expose it.",
        ),
        Field::new(
            "path",
            Kind::Path,
            Presence::Required,
            "The image file (JPEG, PNG, TGA, BMP, TIFF or EXR), relative to the scene file.",
        ),
        Field::new(
            "exponent",
            Kind::Real,
            Presence::Default("2.2"),
            "Power that turns the values of the image into linear ones: 2.2 for ordinary pictures, 1 for \
             heights and other measures.",
        )
        .range(Range::Above(0.0)),
        Field::new("a", Kind::Real, Presence::Default("0"), "Factor of the square."),
        Field::new(
            "b",
            Kind::Real,
            Presence::Default("1"),
            "Factor of the value: the gain. For a bump map it is the height in metres that white stands \
             for, often as small as 0.001.",
        ),
        Field::new("c", Kind::Real, Presence::Default("0"), "Added at the end."),
    ],
)
.with_later(&[
    Later::new("uv_set_index", "1.1"),
    Later::new("tex_coord_generation", "2.0"),
    Later::new("smooth", "2.0"),
])
.with_example(
    "<albedo_texture>
    <uv_set>albedo</uv_set>
    <path>indigo.jpg</path>
    <exponent>2.2</exponent>
    <a>0</a>
    <b>0.8</b>
    <c>0</c>
</albedo_texture>",
);
