//! Where an instance of a mesh stands: the fields that `model`, `meshlight` and `exit_portal` share.

use indigo_decl::{Block, Field, Kind, Presence, Range};

/// Name of the mesh that is placed.
pub const MESH_NAME: Field =
    Field::new("mesh_name", Kind::Reference("mesh"), Presence::Required, "Name of the mesh to place.")
        .aliases(&["geometry_uid"]);

/// Where the mesh's origin goes.
pub const POS: Field = Field::new(
    "pos",
    Kind::Vec3,
    Presence::Required,
    "Where the mesh's origin stands in the world. A point p of the mesh goes to rotation · (scale · p) + pos.",
)
.unit("m");

/// Uniform scale.
pub const SCALE: Field = Field::new(
    "scale",
    Kind::Real,
    Presence::Required,
    "Factor on the mesh's size, the same in all directions.",
)
.range(Range::Above(0.0));

/// Linear transformation.
pub const ROTATION: Field = Field::new(
    "rotation",
    Kind::Block(&ROTATION_BLOCK),
    Presence::Optional,
    "A linear transformation of the mesh; none where it is missing.",
);

/// The declaration of `rotation`.
pub static ROTATION_BLOCK: Block = Block::new(
    "rotation",
    "A linear transformation. Positions are column vectors. It need not be a rotation: it may scale, \
     shear and mirror.",
    &[Field::new(
        "matrix",
        Kind::Matrix3,
        Presence::Required,
        "A 3×3 matrix, row after row. It must be invertible. Three zeros may follow, as later exporters write.",
    )],
)
.with_example("<rotation><matrix>1 0 0 0 1 0 0 0 1</matrix></rotation>");
