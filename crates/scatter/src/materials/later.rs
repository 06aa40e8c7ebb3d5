//! Kinds of material that later format versions brought and that are not rendered as they are meant: for each, something
//! near stands in.

use super::fields::{BASE_EMISSION_PARAMETER, BUMP, EMISSION_PARAMETER, LATER, ROUGHNESS_PARAMETER};
use super::phong;
use indigo_decl::{Block, Field, Kind, Later, Parameter, Presence, Range, StandIn};

/// The declaration of `coating`.
pub static COATING: Block = Block::new(
    "coating",
    "A thin coat over another material, of version 3.0. It is not rendered: the material below stands in, with a warning.",
    &[below("substrate_material_name", &["substrate_material_uid"], "Name of the material below the coat.")],
)
.with_passed_over(&[
    "absorption",
    "bump",
    "displacement",
    "fresnel_scale",
    "interference",
    "ior",
    "roughness",
    "texture",
    "thickness",
])
.with_example("<coating><substrate_material_name>white</substrate_material_name></coating>");

/// The declaration of `double_sided_thin`.
pub static DOUBLE_SIDED_THIN: Block = Block::new(
    "double_sided_thin",
    "A thin sheet with a material on each side, of version 3.0. It is not rendered: the material of the front stands in on \
     both sides, with a warning.",
    &[
        below("front_material_name", &["front_material_uid"], "Name of the material of the front."),
        Field::new("back_material_name", Kind::Text, Presence::Optional, "Name of the material of the back.")
            .aliases(&["back_material_uid"]),
    ],
)
.with_passed_over(&[
    "bump",
    "displacement",
    "front_fresnel_scale",
    "back_fresnel_scale",
    "front_roughness",
    "back_roughness",
    "fresnel_scale",
    "ior",
    "r_f",
    "roughness",
    "texture",
    "transmittance",
])
.with_example("<double_sided_thin><front_material_name>white</front_material_name></double_sided_thin>");

/// The declaration of `fast_sss`.
pub static FAST_SSS: Block = Block::new(
    "fast_sss",
    "Light scattered below the surface, of version 4.0. It is not rendered: a `phong` of the same albedo stands in, with a \
     warning. It has the fields of `phong`.",
    phong::FIELDS,
)
.with_parameters(&[
    Parameter {
        name: "albedo",
        since: "4.0",
        constant: "diffuse_albedo_spectrum",
        texture: "albedo_texture",
        stand_in: StandIn::Uniform("0.5"),
    },
    BASE_EMISSION_PARAMETER,
    EMISSION_PARAMETER,
    ROUGHNESS_PARAMETER,
    BUMP,
])
.with_later(LATER)
.with_example(
    "<fast_sss>
    <albedo><constant><rgb><rgb>0.8 0.6 0.5</rgb></rgb></constant></albedo>
    <roughness><constant>0.3</constant></roughness>
</fast_sss>",
);

/// The declaration of `sum`.
pub static SUM: Block = Block::new(
    "sum",
    "Several materials at once, of version 4.0. As the material of a background all of them shine; on a surface the first \
     stands in, with a warning.",
    &[Field::new("mat", Kind::Block(&MAT), Presence::Repeated, "One of them.")],
)
.with_example("<sum><mat><mat_name>white</mat_name><weight>1</weight></mat></sum>");

/// The declaration of `mat`.
pub static MAT: Block = Block::new(
    "mat",
    "One of the materials of a `sum`.",
    &[
        below("mat_name", &["mat_uid"], "Its name."),
        Field::new("weight", Kind::Real, Presence::Default("1"), "What its light is multiplied by.")
            .range(Range::AtLeast(0.0)),
    ],
)
.with_example("<mat><mat_name>white</mat_name><weight>1</weight></mat>");

/// The declaration of `sunsky`.
pub static SUNSKY: Block = Block::new(
    "sunsky",
    "Sun and sky as the material of a background, of version 3.0: what `skylight` is. A surface of it is black.",
    &[
        Field::new("sundir", Kind::Vec3, Presence::Required, "Direction towards the sun, as in `skylight`."),
        Field::new("turbidity", Kind::Real, Presence::Default("2"), "How hazy the air is, as in `skylight`.")
            .range(Range::Above(0.0)),
        Field::new(
            "extra_atmospheric",
            Kind::Bool,
            Presence::Default("false"),
            "As if above the atmosphere, as in `skylight`.",
        ),
        Field::new(
            "model",
            Kind::Choice(&["captured-simulation", "original"]),
            Presence::Default("original"),
            "The model of the sky: `original` is `preetham` of `skylight`; `hosek` stands in for `captured-simulation`, with a \
             warning.",
        ),
    ],
)
.with_later(&[
    Later::new("sun_layer", "1.1").unless("0"),
    Later::new("sky_layer", "1.1").unless("0"),
])
.with_example("<sunsky><sundir>0 0.6 1</sundir><turbidity>2</turbidity><model>original</model></sunsky>");

/// A material that stands in, or for whose side nothing else is said.
const fn below(name: &'static str, aliases: &'static [&'static str], doc: &'static str) -> Field {
    Field::new(name, Kind::Reference("material"), Presence::Required, doc).aliases(aliases)
}
