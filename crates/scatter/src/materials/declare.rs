//! The declaration of `material`.

use super::KINDS_AND_LATER;
use indigo_decl::{Alternatives, Block, Field, Kind, Later, Presence, Written};

/// The kinds that a material may be of.
pub const MATERIAL_KIND: Alternatives = Alternatives {
    later: &[Later::new("fabric", "4.0"), Later::new("external", "3.0")],
    stand_in: "a grey diffuse surface",
    written: Some(Written::of(
        "diffuse",
        &[Written::of("albedo_spectrum", &[Written::of("uniform", &[Written::text("value", "0.5")])])],
    )),
    ..Alternatives::new("kind of material", KINDS_AND_LATER)
};

/// What later versions put beside the kind.
pub const MATERIAL_LATER: &[Later] = &[
    Later::new("metadata", "3.0"),
    Later::new("backface_emit", "4.0").unless("false"),
    Later::new("emission_sampling_factor", "4.0").unless("1"),
    Later::new("invisible_to_camera", "4.0").unless("false"),
    Later::new("shadow_catcher", "4.0").unless("false"),
];

/// The declaration of `material`.
pub static MATERIAL: Block = Block::new(
    "material",
    "Defines a material: a name and one kind. Where it stands in the scene does not matter.",
    &[
        Field::new("name", Kind::Name, Presence::Required, "Name by which meshes and blends refer to it."),
        Field::new(
            "uid",
            Kind::Text,
            Presence::Optional,
            "A number by which later versions refer to it (`material_uid`, `a_uid`).",
        ),
    ],
)
.with_alternatives(MATERIAL_KIND)
.with_later(MATERIAL_LATER)
.with_example(
    "<material>
    <name>white</name>
    <diffuse>
        <albedo_spectrum>
            <uniform><value>0.8</value></uniform>
        </albedo_spectrum>
    </diffuse>
</material>",
);
