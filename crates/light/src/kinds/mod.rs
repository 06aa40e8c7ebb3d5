//! The kinds of light, one file each.

pub mod background;
pub mod efficacy;
pub mod env_map;
pub mod mesh;
pub mod placement;
pub mod portal;
pub mod rectangle;
pub mod skylight;
