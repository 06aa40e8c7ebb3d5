//! `rectanglelight`: a horizontal lamp that shines downwards.

use super::LAYER;
use super::efficacy::EFFICACY_SCALE;
use indigo_decl::{Block, Field, Kind, Later, Presence, Range};
use indigo_spectrum::declare::SPECTRUM;

/// The declaration of `rectanglelight`.
pub static BLOCK: Block = Block::new(
    "rectanglelight",
    "A horizontal rectangle that shines downwards, towards (0, 0, -1), with the same radiance in all \
     directions. It only emits: light that falls on it is lost.",
    &[
        Field::new("pos", Kind::Vec3, Presence::Required, "The middle of the rectangle.").unit("m"),
        Field::new("width", Kind::Real, Presence::Required, "Width along x.")
            .unit("m")
            .range(Range::Above(0.0)),
        Field::new("height", Kind::Real, Presence::Required, "Width along y.")
            .unit("m")
            .range(Range::Above(0.0)),
        Field::new("spectrum", Kind::OneOf(&SPECTRUM), Presence::Required, "What it emits."),
        EFFICACY_SCALE,
        LAYER,
    ],
)
.with_later(&[Later::new("uid", "3.0")])
.with_example(
    "<rectanglelight>
    <pos>0.0 0 1.9</pos>
    <width>0.2</width>
    <height>0.2</height>
    <spectrum>
        <peak>
            <peak_min>300</peak_min>
            <peak_width>550</peak_width>
            <base_value>0</base_value>
            <peak_value>200</peak_value>
        </peak>
    </spectrum>
    <efficacy_scale>
        <power_drawn>100</power_drawn>
        <overall_luminous_efficacy>17.5</overall_luminous_efficacy>
    </efficacy_scale>
</rectanglelight>",
);
