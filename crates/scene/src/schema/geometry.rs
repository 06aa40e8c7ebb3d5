//! Geometry, declared.

use super::emission::{EMISSION_SCALE, IES_PROFILE};
use indigo_camera::declare::KEYFRAME;
use indigo_decl::{Block, Field, Group, Kind, Later, Presence, Range};
use indigo_igs::EMBEDDED;
use indigo_light::kinds::placement::{MESH_NAME, POS, ROTATION, SCALE};

const MATERIAL_NAME: Field =
    Field::new("material_name", Kind::Reference("material"), Presence::Required, "Name of its material.")
        .aliases(&["material_uid"]);

/// The declaration of `mesh`.
pub static MESH: Block = Block::new(
    "mesh",
    "Defines a triangle mesh, which `model`, `meshlight` and `exit_portal` place in the scene as often as \
     they like. Where it stands in the scene does not matter.",
    &[
        Field::new("name", Kind::Name, Presence::Required, "Name by which it is placed."),
        Field::new(
            "uid",
            Kind::Text,
            Presence::Optional,
            "A number by which later versions refer to it (`geometry_uid`).",
        ),
        Field::new("scale", Kind::Real, Presence::Default("1.0"), "Factor on the vertex positions.")
            .range(Range::Above(0.0)),
        Field::new(
            "normal_smoothing",
            Kind::Bool,
            Presence::Default("true"),
            "Whether shading uses normals interpolated between the vertices. If not, every triangle looks flat.",
        ),
        Field::new(
            "external",
            Kind::Block(&EXTERNAL),
            Presence::Optional,
            "The mesh is in a file of its own.",
        ),
        Field::new(
            "embedded",
            Kind::EmbeddedMesh(&EMBEDDED),
            Presence::Optional,
            "The mesh is written here.",
        ),
        Field::new(
            "path",
            Kind::Path,
            Presence::Optional,
            "The file of the mesh, relative to the scene file.",
        )
        .deprecated("write <external><path>...</path></external>"),
    ],
)
.with_needs(&[Group::one(&["external", "embedded", "path"])])
.with_later(&[
    Later::new("metadata", "3.0"),
    // Subdivision alone would see a difference.
    Later::new("merge_vertices_with_same_pos_and_normal", "2.0").unless("false"),
    Later::new("subdivision_smoothing", "1.1").instead("is ignored: the mesh is not subdivided").unless("false"),
    Later::new("max_num_subdivisions", "1.1").instead("is ignored: the mesh is not subdivided").unless("0"),
    Later::new("subdivide_pixel_threshold", "1.1"),
    Later::new("subdivide_curvature_threshold", "1.1"),
    Later::new("displacement_error_threshold", "1.1"),
    Later::new("view_dependent_subdivision", "1.1").unless("false"),
    Later::new("wrap_u", "2.0").unless("false"),
    Later::new("wrap_v", "2.0").unless("false"),
    Later::new("invisible_to_camera", "4.0").unless("false"),
])
.with_example(
    r#"<mesh>
    <name>quad</name>
    <normal_smoothing>false</normal_smoothing>
    <embedded>
        <expose_uv_set><index>0</index><name>albedo</name></expose_uv_set>
        <vertex pos="-10 -10 0" normal="0 0 1" uv0="0 0"/>
        <vertex pos="10 -10 0" normal="0 0 1" uv0="10 0"/>
        <vertex pos="10 10 0" normal="0 0 1" uv0="10 10"/>
        <vertex pos="-10 10 0" normal="0 0 1" uv0="0 10"/>
        <triangle_set>
            <material_name>white</material_name>
            <tri>0 1 2</tri>
            <tri>0 2 3</tri>
        </triangle_set>
    </embedded>
</mesh>"#,
);

/// The declaration of `external`.
pub static EXTERNAL: Block = Block::new(
    "external",
    "A mesh in a file of its own.",
    &[Field::new(
        "path",
        Kind::Path,
        Presence::Required,
        "The file, relative to the scene file: .obj, .3ds, .ply or .igmesh.",
    )],
)
.with_example("<external><path>..\\hand\\hand.obj</path></external>");

/// The declaration of `model`.
pub static MODEL: Block = Block::new(
    "model",
    "Places a mesh in the scene. The parts of it whose materials emit are lamps.",
    &[
        Field::new("name", Kind::Text, Presence::Optional, "What the model is called; nothing refers to it."),
        Field::new(
            "uid",
            Kind::Text,
            Presence::Optional,
            "A number of later versions; nothing refers to it.",
        ),
        Field { presence: Presence::Optional, ..POS },
        KEYFRAME,
        Field { presence: Presence::Default("1"), ..SCALE },
        ROTATION,
        MESH_NAME,
        Field::new(
            "materials",
            Kind::Block(&MATERIALS),
            Presence::Optional,
            "Its materials, in place of those that the mesh names.",
        ),
        Field::new(
            "emission_scale",
            Kind::Block(&EMISSION_SCALE),
            Presence::Repeated,
            "Scales the light of one of its materials.",
        ),
        Field::new(
            "ies_profile",
            Kind::Block(&IES_PROFILE),
            Presence::Repeated,
            "Into which directions one of its materials shines.",
        ),
    ],
)
.with_aliases(&["model2"])
.with_needs(&[Group::any(&["pos", "keyframe"])])
.with_later(&[Later::new("invisible_to_camera", "4.0").unless("false")])
.with_ignored(&["enable_normal_smoothing"])
.with_example(
    "<model>
    <pos>0 0 0</pos>
    <scale>1.0</scale>
    <rotation><matrix>1 0 0 0 1 0 0 0 1</matrix></rotation>
    <mesh_name>quad</mesh_name>
</model>",
);

/// The declaration of `materials`.
pub static MATERIALS: Block = Block::new(
    "materials",
    "The materials of a model, one after the other: the first takes the place of the first that the mesh lists in its file, or names in the scene, and so on.",
    &[Field::new(
        "material_name",
        Kind::Reference("material"),
        Presence::Repeated,
        "Name of a material.",
    )
    .aliases(&["material_uid"])],
)
.with_example("<materials><material_name>white</material_name></materials>");

/// The declaration of `plane`.
pub static PLANE: Block = Block::new(
    "plane",
    "An infinite plane. It cannot be rendered with `bidirectional`: use a large mesh there.",
    &[
        Field::new("normal", Kind::Vec3, Presence::Required, "The normal of the plane, of length 1."),
        Field::new(
            "dist",
            Kind::Real,
            Presence::Required,
            "Distance of the plane from the origin, along the normal.",
        )
        .unit("m"),
        MATERIAL_NAME,
    ],
)
.with_example("<plane><normal>0 0 1</normal><dist>0</dist><material_name>white</material_name></plane>");

/// The declaration of `sphere`.
pub static SPHERE: Block = Block::new(
    "sphere",
    "A sphere.",
    &[
        Field::new("center", Kind::Vec3, Presence::Required, "The centre.").unit("m"),
        Field::new("radius", Kind::Real, Presence::Required, "The radius.")
            .unit("m")
            .range(Range::Above(0.0)),
        MATERIAL_NAME,
    ],
)
.with_later(&[Later::new("uid", "3.0"), Later::new("name", "3.0")])
.with_example(
    "<sphere><center>0 0 1</center><radius>1</radius><material_name>white</material_name></sphere>",
);
