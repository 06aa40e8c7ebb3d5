//! Techniques: from a primary sample to light.

pub mod path;
mod surface;
mod visibility;
