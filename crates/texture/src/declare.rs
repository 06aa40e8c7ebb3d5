//! Image maps, declared.

use indigo_decl::{Block, Field, Kind, Later, Presence, Range};

/// The declaration of `tex_coord_generation`.
pub static TEX_COORD_GENERATION: Block = Block::new(
    "tex_coord_generation",
    "How texture coordinates are made. On a surface they are those of the mesh, which `uv` transforms; where `spherical` ones \
     are asked for, those of the mesh stand in, with a warning. Round a background they are `spherical`.",
    &[
        Field::new("uv", Kind::Block(&UV), Presence::Optional, "Those of the mesh, transformed."),
        Field::new("spherical", Kind::Block(&SPHERICAL), Presence::Optional, "By latitude and longitude."),
    ],
)
.with_example("<tex_coord_generation><uv><matrix>1 0 0 1</matrix><translation>0 0</translation></uv></tex_coord_generation>");

/// The declaration of `uv`.
pub static UV: Block = Block::new(
    "uv",
    "The texture coordinates of the mesh, transformed: the map is read at `matrix` times (u, v), plus `translation`.",
    &[
        Field::new(
            "matrix",
            Kind::Reals,
            Presence::Optional,
            "A matrix of two rows of two, row after row. The identity where it is left out.",
        ),
        Field::new("translation", Kind::Reals, Presence::Optional, "Two numbers that are added then."),
    ],
)
.with_example("<uv><matrix>2 0 0 2</matrix><translation>0.5 0</translation></uv>");

/// The declaration of `spherical` in `tex_coord_generation`.
pub static SPHERICAL: Block = Block::new(
    "spherical",
    "By latitude and longitude, as `latlong` in `env_map`: the middle of the map lies towards +y before it is turned.",
    &[Field::new("rotation", Kind::Block(&ROTATION), Presence::Optional, "How the map is turned.")],
)
.with_example("<spherical><rotation><axis_rotation><axis>0 0 1</axis><angle>0.5</angle></axis_rotation></rotation></spherical>");

/// The declaration of `rotation` in `spherical`.
pub static ROTATION: Block = Block::new(
    "rotation",
    "How a map round a background is turned.",
    &[Field::new("axis_rotation", Kind::Block(&AXIS_ROTATION), Presence::Optional, "About an axis.")],
)
.with_later(&[Later::new("matrix", "3.0")])
.with_example("<rotation><axis_rotation><axis>0 0 1</axis><angle>0.5</angle></axis_rotation></rotation>");

/// The declaration of `axis_rotation`.
pub static AXIS_ROTATION: Block = Block::new(
    "axis_rotation",
    "A turn by an angle about an axis, counter-clockwise for someone towards whom the axis points. About other axes than z \
     it is not rendered.",
    &[
        Field::new("axis", Kind::Vec3, Presence::Required, "The axis."),
        Field::new("angle", Kind::Real, Presence::Required, "The angle.").unit("rad"),
    ],
)
.with_example("<axis_rotation><axis>0 0 1</axis><angle>0.5</angle></axis_rotation>");

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
     repetition. Those of environment maps stand in the middle of their cells.\n\n\
     Of image files, wherever they are named: alpha is dropped, with a warning where the image is not opaque throughout. \
     Values of EXR and Radiance files and of TIFF files in floating point are as they are, and may be beyond 1; so are \
     whole numbers (UINT) of an EXR file, with a warning. A TIFF file is read if it is grey, or red, green and blue, of \
     1, 2, 4 (grey alone), 8 or 16 bits or of floating-point numbers of 16 or 32, and not compressed or by LZW, Deflate or \
     PackBits: its first page, with a warning where there are more, and with a warning where there are samples beside the \
     colours that are no alpha. Palettes, inks (CMYK), YCbCr and L*a*b* in TIFF files are errors.",
    &[
        Field::new(
            "uv_set",
            Kind::Name,
            Presence::Default("default"),
            "Name of the set of texture coordinates to look the image up with; the mesh must expose it. Where it is not \
             given, and the mesh exposes no set called `default`, it is the first one.",
        ),
        Field::new(
            "uv_set_index",
            Kind::Int,
            Presence::Optional,
            "Number of the set of texture coordinates, from 0, as later versions write it in place of `uv_set`.",
        )
        .range(Range::AtLeast(0.0)),
        Field::new(
            "path",
            Kind::Path,
            Presence::Required,
            "The image file (JPEG, PNG, TGA, BMP, TIFF, EXR or Radiance HDR), relative to the scene file.",
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
        Field::new(
            "tex_coord_generation",
            Kind::Block(&TEX_COORD_GENERATION),
            Presence::Optional,
            "How texture coordinates are made, as later versions write it.",
        ),
    ],
)
.with_later(&[
    // Texels are mixed evenly, and bumps smoothly, whatever it says.
    Later::new("smooth", "2.0").unless("true"),
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
