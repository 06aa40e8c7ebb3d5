//! `env_map`: light from a picture of the surroundings.

use indigo_decl::{Alternatives, Block, Field, Kind, Presence, Range};

const GAIN: Field = Field::new(
    "gain",
    Kind::Real,
    Presence::Required,
    "Factor on the values of the map, which are spectral radiance once scaled.",
)
.range(Range::Above(0.0));

/// The declaration of `env_map`.
pub static BLOCK: Block = Block::new(
    "env_map",
    "Lights the scene with a high-dynamic-range picture of the surroundings, infinitely far away.",
    &[],
)
.with_alternatives(Alternatives::new("kind of environment map", &[&LATLONG, &SPHERICAL]))
.with_example(
    "<env_map>
    <spherical>
        <path>probes/kitchen_probe.float</path>
        <width>640</width>
        <gain>0.9</gain>
    </spherical>
</env_map>",
);

/// The declaration of `latlong`.
pub static LATLONG: Block = Block::new(
    "latlong",
    "A map in latitude and longitude: an EXR file.",
    &[Field::new("path", Kind::Path, Presence::Required, "The EXR file, relative to the scene file."), GAIN],
)
.with_aliases(&["lat_long"])
.with_example("<latlong><path>sky.exr</path><gain>700000</gain></latlong>");

/// The declaration of `spherical`.
pub static SPHERICAL: Block = Block::new(
    "spherical",
    "A map as seen in a mirrored ball: a .float file of HDR Shop, which is nothing but three 32-bit \
     floats for each pixel.",
    &[
        Field::new("path", Kind::Path, Presence::Required, "The .float file, relative to the scene file."),
        Field::new("width", Kind::Int, Presence::Required, "Width of the map, which is also its height.")
            .unit("pixels")
            .range(Range::Above(0.0)),
        GAIN,
    ],
)
.with_example(
    "<spherical>
    <path>probes/kitchen_probe.float</path>
    <width>640</width>
    <gain>0.9</gain>
</spherical>",
);
