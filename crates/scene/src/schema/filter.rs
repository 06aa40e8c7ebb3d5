//! Reconstruction filters, declared.

use indigo_decl::{Alternatives, Block, Field, Kind, Later, Presence, Written};

const KINDS: &[&Block] = &[&BOX, &GAUSSIAN, &MN_CUBIC];

const CHOICE: Alternatives = Alternatives {
    later: &[Later::new("radial", "4.0"), Later::new("sharp", "4.0")],
    stand_in: "box",
    written: Some(Written::of("box", &[])),
    ..Alternatives::new("filter", KINDS)
};

/// The declaration of `splat_filter`.
pub static SPLAT_FILTER: Block = Block::new(
    "splat_filter",
    "The filter with which a sample is spread over the pixels around it. Its size is in pixels of the \
     super-sampled picture.",
    &[],
)
.with_alternatives(CHOICE)
.with_example("<splat_filter><gaussian/></splat_filter>");

/// The declaration of `downsize_filter`.
pub static DOWNSIZE_FILTER: Block = Block::new(
    "downsize_filter",
    "The filter with which a super-sampled picture is made smaller; used if `super_sample_factor` is \
     greater than 1. Its size is in pixels of the finished picture.",
    &[],
)
.with_alternatives(CHOICE)
.with_example(
    "<downsize_filter>
    <mn_cubic><blur>0.6</blur><ring>0.2</ring></mn_cubic>
</downsize_filter>",
);

/// The declaration of `box`.
pub static BOX: Block = Block::new(
    "box",
    "The mean over one pixel. Aliases badly; the sharpest in theory, the worst to look at. It has no parameters.",
    &[],
)
.with_aliases(&["fastbox"])
.with_example("<box/>");

/// The declaration of `gaussian`.
pub static GAUSSIAN: Block =
    Block::new("gaussian", "A Gaussian with a standard deviation of 0.35 pixels. It has no parameters.", &[])
        .with_example("<gaussian/>");

/// The declaration of `mn_cubic`.
pub static MN_CUBIC: Block = Block::new(
    "mn_cubic",
    "The cubic filter of D. P. Mitchell and A. N. Netravali, Reconstruction Filters in Computer Graphics \
     (1988): little aliasing, a good filter for everything. They recommend 2·ring + blur = 1.",
    &[
        Field::new(
            "blur",
            Kind::Real,
            Presence::Default("0.6"),
            "The parameter B of the paper: the higher, the more blurred. Best in [0, 1].",
        ),
        Field::new(
            "ring",
            Kind::Real,
            Presence::Default("0.2"),
            "The parameter C of the paper: the higher, the more dark and bright fringes along edges. Best in [0, 1].",
        ),
    ],
)
.with_later(&[Later::new("radius", "3.0").instead("is taken as 2, that of the paper").unless("2")])
.with_example("<mn_cubic><blur>0.6</blur><ring>0.2</ring></mn_cubic>");
