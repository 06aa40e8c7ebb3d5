//! Embedded meshes, declared: for the reference, since their text goes straight into arrays.

use indigo_decl::{Block, Field, Kind, Presence, Range};

/// The declaration of `embedded`.
pub static EMBEDDED: Block = Block::new(
    "embedded",
    "A mesh written inside the scene. Vertices and sets of triangles may take turns; a triangle may use \
     all vertices that stand before it. Triangles without area are left out.",
    &[
        Field::new(
            "expose_uv_set",
            Kind::Block(&EXPOSE_UV_SET),
            Presence::Repeated,
            "Gives a set of texture coordinates a name. One set may have several names.",
        ),
        Field::new("vertex", Kind::Block(&VERTEX), Presence::Repeated, "A vertex. They count from 0."),
        Field::new(
            "triangle_set",
            Kind::Block(&TRIANGLE_SET),
            Presence::Repeated,
            "Triangles of one material.",
        ),
    ],
);

/// The declaration of `expose_uv_set`.
pub static EXPOSE_UV_SET: Block = Block::new(
    "expose_uv_set",
    "The name by which textures find a set of texture coordinates.",
    &[
        Field::new(
            "index",
            Kind::Int,
            Presence::Required,
            "Which set: N for the attribute uvN of the vertices, which must be there.",
        )
        .range(Range::Within(0.0, 3.0)),
        Field::new("name", Kind::Name, Presence::Required, "The name, for the `uv_set` of textures."),
    ],
);

const UV: Field = Field::new(
    "uv0",
    Kind::Reals,
    Presence::Optional,
    "Attribute. Two texture coordinates; v = 0 is the bottom of an image.",
);

/// The declaration of `vertex`.
pub static VERTEX: Block = Block::new(
    "vertex",
    "A vertex. Everything in it is an attribute: `<vertex pos=\"0 0 1\" normal=\"0 0 1\" uv0=\"0 1\"/>`.",
    &[
        Field::new("pos", Kind::Vec3, Presence::Required, "Attribute. The position.").unit("m"),
        Field::new(
            "normal",
            Kind::Vec3,
            Presence::Optional,
            "Attribute. The normal for smooth shading; brought to length 1. Vertices without one among others \
             that have one get that of their triangles.",
        ),
        UV,
        Field { name: "uv1", ..UV },
        Field { name: "uv2", ..UV },
        Field { name: "uv3", ..UV },
    ],
);

/// The declaration of `triangle_set`.
pub static TRIANGLE_SET: Block = Block::new(
    "triangle_set",
    "Triangles of one material.",
    &[
        Field::new(
            "material_name",
            Kind::Reference("material"),
            Presence::Required,
            "Name of their material.",
        ),
        Field::new(
            "tri",
            Kind::Vec3,
            Presence::Repeated,
            "A triangle: the indices of three vertices, counter-clockwise as seen from the front.",
        ),
    ],
);
