//! `efficacy_scale`: the power of a lamp as it stands on its box.

use indigo_decl::{Block, Field, Kind, Presence, Range};

/// The scale of a lamp by its power and efficacy.
pub const EFFICACY_SCALE: Field = Field::new(
    "efficacy_scale",
    Kind::Block(&EFFICACY_SCALE_BLOCK),
    Presence::Optional,
    "Scales the spectrum so that the lamp emits a given luminous flux. It overrides any gain.",
)
.aliases(&["efficiacy_scale"]);

/// The declaration of `efficacy_scale`.
pub static EFFICACY_SCALE_BLOCK: Block = Block::new(
    "efficacy_scale",
    "The power of a lamp as it stands on its box: the luminous flux is `power_drawn` times \
     `overall_luminous_efficacy`.",
    &[
        Field::new(
            "power_drawn",
            Kind::Real,
            Presence::Required,
            "Electrical power that the lamp draws, such as 100.",
        )
        .unit("W")
        .range(Range::Above(0.0)),
        Field::new(
            "overall_luminous_efficacy",
            Kind::Real,
            Presence::Required,
            "Luminous flux for each watt drawn: about 17.5 for an incandescent bulb, 60 for a fluorescent tube. \
             More than 683 no light has.",
        )
        .aliases(&["overall_luminous_efficiacy"])
        .unit("lm/W")
        .range(Range::Above(0.0)),
    ],
)
.with_example(
    "<efficacy_scale>
    <power_drawn>100</power_drawn>
    <overall_luminous_efficacy>17.5</overall_luminous_efficacy>
</efficacy_scale>",
);
