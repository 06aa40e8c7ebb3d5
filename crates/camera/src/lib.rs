//! The camera: where paths begin.
//!
//! - [`ThinLens`]: geometry, from film positions to rays and back.
//! - [`Orthographic`], [`Spherical`]: cameras without a lens.
//! - [`Aperture`]: the shape of the opening, by which lens points are chosen and the blur gets its form.
//! - [`Pupil`], [`FarField`]: an aperture with what stands before it, and how it spreads light.
//! - [`Camera`]: lens and aperture together, and the diffraction of rays.

mod aperture;
mod camera;
pub mod declare;
pub mod diffraction;
mod orthographic;
mod spherical;
mod thin_lens;

pub use aperture::{Aperture, Blades, BladesError, GreyImage, Mask, NothingOpen, Transmission};
pub use camera::{Camera, CameraKind, CameraRay, Optics};
pub use diffraction::{FarField, Pupil};
pub use orthographic::Orthographic;
pub use spherical::Spherical;
pub use thin_lens::{FilmPosition, LensRay, ThinLens, ThinLensParameters};
