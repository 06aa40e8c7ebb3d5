//! Kinds of material that later format versions brought and that are not rendered as they are meant: for each, something
//! near stands in.

use indigo_decl::{Block, Field, Group, Kind, Presence, Range};

/// The declaration of `sum`.
pub static SUM: Block = Block::new(
    "sum",
    "Several materials at once, of version 4.0. As the material of a background all of them shine; on a surface the first \
     stands in, with a warning.",
    &[Field::new("mat", Kind::Block(&MAT), Presence::Repeated, "One of them.")],
)
.with_needs(&[Group::any(&["mat"])])
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
        Field::index("sun_layer", "The number of the sun's `layer_setting`."),
        Field::index("sky_layer", "The number of the sky's `layer_setting`."),
    ],
)
.with_example("<sunsky><sundir>0 0.6 1</sundir><turbidity>2</turbidity><model>original</model></sunsky>");

/// A material that stands in, or for whose side nothing else is said.
const fn below(name: &'static str, aliases: &'static [&'static str], doc: &'static str) -> Field {
    Field::new(name, Kind::Reference("material"), Presence::Required, doc).aliases(aliases)
}
