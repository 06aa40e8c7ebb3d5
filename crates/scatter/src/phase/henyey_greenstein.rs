//! `henyey_greenstein`: scattering forwards or backwards.

use indigo_decl::{Block, Field, Kind, Later, Presence};
use indigo_spectrum::declare::SPECTRUM;

/// The declaration of `henyey_greenstein`.
pub static BLOCK: Block = Block::new(
    "henyey_greenstein",
    "Light is scattered forwards or backwards, after L. G. Henyey and J. L. Greenstein, Diffuse Radiation \
     in the Galaxy (1941).",
    &[Field::new(
        "g_spectrum",
        Kind::OneOf(&SPECTRUM),
        Presence::Required,
        "Mean cosine of the scattering angle: -1 straight back, 0 into all directions alike, 1 straight on. \
         Values are silently clamped to [-0.99, 0.99].",
    )],
)
.with_later(&[Later::new("g", "1.1")])
.with_example(
    "<henyey_greenstein>
    <g_spectrum><uniform><value>0.9</value></uniform></g_spectrum>
</henyey_greenstein>",
);
