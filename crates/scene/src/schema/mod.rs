//! The scene as a whole: every top-level element, declared.

pub mod emission;
pub mod filter;
pub mod geometry;
pub mod settings;
pub mod tonemapping;

use indigo_camera::declare::CAMERA;
use indigo_decl::{Block, Field, Kind, Later, Presence};
use indigo_igs::INCLUDE;
use indigo_light::kinds::{background, env_map, mesh, portal, rectangle, skylight};
use indigo_scatter::materials::{MATERIAL, MATERIAL_KIND, MATERIAL_LATER};
use indigo_scatter::media::MEDIUM;

const fn one(block: &'static Block, doc: &'static str) -> Field {
    Field::new(block.name, Kind::Block(block), Presence::Optional, doc)
}

const fn many(block: &'static Block, doc: &'static str) -> Field {
    Field::new(block.name, Kind::Block(block), Presence::Repeated, doc)
}

/// The declaration of the root element of a scene.
///
/// What a scene must have is checked when it is complete, since parts may come from several files.
pub static SCENE: Block = Block::new(
    "scene",
    "A scene. Its elements may stand in any order, and names may be used before they are defined.",
    &[
        one(&settings::RENDERER_SETTINGS, "How to render."),
        one(&tonemapping::TONEMAPPING, "How light becomes the colours of the picture."),
        one(&CAMERA, "Where the picture is taken from. A scene needs one."),
        one(&background::BLOCK, "The same light from everywhere."),
        one(&skylight::BLOCK, "Sun and sky."),
        one(&env_map::BLOCK, "Light from a picture of the surroundings."),
        one(&emission::BACKGROUND_SETTINGS, "What surrounds the scene, as later versions write it."),
        many(&MATERIAL, "Defines a material."),
        many(&MEDIUM, "Defines a medium."),
        many(&geometry::MESH, "Defines a mesh."),
        many(&geometry::MODEL, "Places a mesh.").aliases(geometry::MODEL.aliases),
        many(&geometry::SPHERE, "A sphere."),
        many(&geometry::PLANE, "An infinite plane."),
        many(&rectangle::BLOCK, "A rectangular lamp."),
        many(&mesh::BLOCK, "A lamp in the shape of a mesh."),
        many(&portal::BLOCK, "An opening through which outdoor light comes in."),
        many(&INCLUDE, "Brings in another file, in this place."),
    ],
)
.with_aliases(&["scenedata"])
.with_later(&[
    Later::new("metadata", "3.0"),
    Later::new("section_plane", "3.0"),
    Later::new("environment_settings", "4.0"),
    Later::new("selection", "4.0"),
    Later::new("colour_space", "4.0"),
])
.with_example(
    r"<scene>
    <camera>
        <pos>0 -4 1</pos>
        <up>0 0 1</up>
        <forwards>0 1 0</forwards>
        <aperture_radius>0.001</aperture_radius>
        <focus_distance>4</focus_distance>
        <aspect_ratio>1.333</aspect_ratio>
        <sensor_width>0.036</sensor_width>
        <lens_sensor_dist>0.03</lens_sensor_dist>
    </camera>
    <tonemapping><linear><scale>1</scale></linear></tonemapping>
    <background><spectrum><uniform><value>1e9</value></uniform></spectrum></background>
    <material>
        <name>white</name>
        <diffuse><albedo_spectrum><uniform><value>0.8</value></uniform></albedo_spectrum></diffuse>
    </material>
    <sphere><center>0 0 1</center><radius>1</radius><material_name>white</material_name></sphere>
</scene>",
);

/// The material of a background: as any, but that it need not have a name.
pub static BACKGROUND_KIND: Block = Block::new(
    "material",
    "The material of what surrounds the scene: a kind of material that emits, `sunsky` or `sum`.",
    &[
        Field::new("name", Kind::Text, Presence::Optional, "Its name."),
        Field::new("uid", Kind::Text, Presence::Optional, "A number of its own."),
    ],
)
.with_alternatives(MATERIAL_KIND)
.with_later(MATERIAL_LATER)
.with_example("<material><name>surroundings</name><sunsky><sundir>0 0.6 1</sundir></sunsky></material>");

/// The reference of the scene format, as Markdown.
pub fn reference() -> String {
    format!("{}{}", include_str!("reference.md"), indigo_decl::reference::markdown(&SCENE))
}

/// The list of diagnostics with their codes, as Markdown.
pub fn errors() -> String {
    let codes = [indigo_igs::codes::ALL, indigo_decl::codes::ALL, crate::codes::ALL];
    format!("{}{}", include_str!("errors.md"), indigo_decl::reference::codes(&codes))
}
