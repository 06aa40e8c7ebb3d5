//! Image maps over surfaces: texels as they came, made linear by a curve and read bilinearly.

pub mod declare;
mod map;

pub use map::{Curve, Texture};

/// Number of a texture in a scene's list.
pub type TextureId = u32;
