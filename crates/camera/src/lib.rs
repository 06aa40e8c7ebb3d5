//! The camera: where paths begin.

pub mod declare;
mod thin_lens;

pub use thin_lens::{CameraRay, FilmPosition, ThinLens, ThinLensParameters};
