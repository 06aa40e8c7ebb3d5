//! Are the pictures true? Whole scenes, rendered and compared with closed forms.
//!
//! All seeds are fixed; false-alarm rates are stated where verdicts are made
//! (`common::judge`).

#[path = "../common/mod.rs"]
mod common;

mod albedo;
mod coats;
mod colour;
mod coloured_media;
mod direct_light;
mod effects;
mod environment;
mod exposure;
mod first_hits;
mod frosted;
mod furnace;
mod lens;
mod materials;
mod media;
mod portals;
mod prism;
mod shining;
mod surfaces;
mod thick;
mod wine_glass;
