//! Are the pictures true? Whole scenes, rendered and compared with closed forms.
//!
//! All seeds are fixed; the probability that any of the statistical verdicts is a false alarm is 1e-4
//! together (see `common::judge`).

#[path = "../common/mod.rs"]
mod common;

mod colour;
mod direct_light;
mod exposure;
mod furnace;
mod surfaces;
