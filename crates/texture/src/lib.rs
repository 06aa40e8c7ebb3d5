//! Image maps over surfaces: texels as they came, made linear by a curve and read bilinearly.

mod curve;
pub mod declare;
mod map;
mod mapping;

pub use curve::Curve;
pub use map::Texture;
pub use mapping::Mapping;

/// Number of a texture in a scene's list.
pub type TextureId = u32;
