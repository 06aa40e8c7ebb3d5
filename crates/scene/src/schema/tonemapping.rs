//! Tone mapping, declared.

use indigo_decl::{Alternatives, Block, Field, Kind, Later, Presence, Range, Written};

/// The declaration of `tonemapping`.
pub static TONEMAPPING: Block = Block::new(
    "tonemapping",
    "How the light on the sensor becomes the colours of the picture. A scene should say it; without it a \
     default is used, with a warning.",
    &[],
)
.with_alternatives(Alternatives {
    later: &[Later::new("filmic", "4.0")],
    stand_in: "reinhard 4, 1.2, 6",
    written: Some(Written::of(
        "reinhard",
        &[Written::text("pre_scale", "4"), Written::text("post_scale", "1.2"), Written::text("burn", "6")],
    )),
    ..Alternatives::new("tone mapping", &[&LINEAR, &REINHARD, &CAMERA])
})
.with_example(
    "<tonemapping><reinhard><pre_scale>1.0</pre_scale><post_scale>1.0</post_scale></reinhard></tonemapping>",
);

/// The declaration of `linear`.
pub static LINEAR: Block = Block::new(
    "linear",
    "The exposure of the sensor, in lux seconds, times a factor. The open area of the aperture counts: blades and \
     aperture images darken the picture as they do with a real lens.",
    &[Field::new("scale", Kind::Real, Presence::Required, "The factor.").range(Range::AtLeast(0.0))],
)
.with_example("<linear><scale>1.0</scale></linear>");

/// The declaration of `reinhard`.
pub static REINHARD: Block = Block::new(
    "reinhard",
    "Adapts to the brightness of the picture and bends bright parts towards white: E. Reinhard et al., \
     Photographic Tone Reproduction for Digital Images (2002).",
    &[
        Field::new(
            "pre_scale",
            Kind::Real,
            Presence::Required,
            "Luminance that the log-average luminance of the picture is brought to, before the bend.",
        )
        .range(Range::AtLeast(0.0)),
        Field::new(
            "post_scale",
            Kind::Real,
            Presence::Required,
            "Factor after the bend: above 1, more of the picture becomes white.",
        )
        .range(Range::AtLeast(0.0)),
        Field::new(
            "burn",
            Kind::Real,
            Presence::Default("10"),
            "Luminance, after `pre_scale`, from which on the picture is white. The smaller, the more burns out.",
        )
        .range(Range::Above(1.0)),
    ],
)
.with_example("<reinhard><pre_scale>4</pre_scale><post_scale>1.2</post_scale><burn>6</burn></reinhard>");

/// The declaration of `camera` in `tonemapping`.
pub static CAMERA: Block = Block::new(
    "camera",
    "Exposes and develops like a camera, through the measured response of a film or sensor.",
    &[
        Field::new(
            "response_function_path",
            Kind::Path,
            Presence::Optional,
            "A file of response curves as in the DoRF database, beside the scene or in the resource directory, such \
             as `data/camera_response_functions/dslr_s_curve.txt`. Without it, or where it is empty, the picture \
             shows what the sensor gathers.",
        ),
        Field::new(
            "ev_adjust",
            Kind::Real,
            Presence::Required,
            "Adjusts the exposure value: each step of 1 doubles the brightness.",
        ),
        Field::new(
            "film_iso",
            Kind::Real,
            Presence::Required,
            "Speed of the film: twice the speed, twice the brightness. A channel saturates at 78 / `film_iso` lux seconds \
             (ISO 12232).",
        )
        .range(Range::Above(0.0)),
    ],
)
.with_example(
    "<camera>
    <response_function_path>data/camera_response_functions/film_soft.txt</response_function_path>
    <ev_adjust>0</ev_adjust>
    <film_iso>100</film_iso>
</camera>",
);
