//! `skylight`: the sun and the sky, each a light of its own ([`sun`](super::sun), [`sky`](super::sky)).

use indigo_decl::{Block, Field, Kind, Later, Presence, Range};

/// The declaration of `skylight`.
pub static BLOCK: Block = Block::new(
    "skylight",
    "Lights the scene with the sun and the light that the atmosphere scatters. Up is the z axis; below \
     the horizon all is black, and of a sun that stands on it only the part above it shines. The sun is a disc of its \
     true size, 0.5358 degrees across. With `hosek` \
     it darkens towards its limb, with `preetham` and `extra_atmospheric` it is even.",
    &[
        Field::new(
            "sundir",
            Kind::Vec3,
            Presence::Required,
            "Direction towards the sun, of any length: (0, 0, 1) is overhead. z must be > 0.",
        ),
        Field::new(
            "turbidity",
            Kind::Real,
            Presence::Required,
            "How hazy the air is: about 2 on a very clear day, 5 in haze. `hosek` knows values from 1 to 10, \
             `preetham` from 2 to 10; beyond them the nearest is taken, with a warning.",
        )
        .range(Range::Above(0.0)),
        Field::new(
            "extra_atmospheric",
            Kind::Bool,
            Presence::Default("false"),
            "As if above the atmosphere: the sun is not dimmed, and the sky is black.",
        ),
        Field::new(
            "model",
            Kind::Choice(&["hosek", "preetham", "original", "captured-simulation"]),
            Presence::Default("hosek"),
            "The model of the sky: that of L. Hosek and A. Wilkie (2012), or that of A. J. Preetham, \
             P. Shirley and B. Smits (1999), whose zenith is 2 to 3 times brighter. `hosek` is taken \
             over black ground (an albedo of 0, which cannot be set): over bright ground a real sky is some per cent \
             brighter. Of version 3.0 are `original`, which is `preetham`, and `captured-simulation`, for which `hosek` stands in \
             with a warning.",
        ),
        Field::index("sun_layer", "The number of the sun's `layer_setting`. Of version 1.1."),
        Field::index("sky_layer", "The number of the sky's `layer_setting`. Of version 1.1."),
    ],
)
.with_later(&[Later::new("uid", "3.0")])
.with_example(
    "<skylight>
    <sundir>0 0.6 1</sundir>
    <turbidity>2</turbidity>
</skylight>",
);
