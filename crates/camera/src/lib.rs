//! The camera: where paths begin.
//!
//! - [`ThinLens`]: geometry, from film positions to rays and back.
//! - [`Aperture`]: the shape of the opening, by which lens points are chosen and the blur gets its form.
//! - [`Pupil`], [`FarField`]: an aperture with what stands before it, and how it spreads light.
//! - [`Camera`]: lens and aperture together, and the diffraction of rays.

mod aperture;
mod camera;
pub mod declare;
pub mod diffraction;
mod thin_lens;

pub use aperture::{Aperture, Blades, BladesError, GreyImage, Mask, NothingOpen, Transmission};
pub use camera::{Camera, CameraRay};
pub use diffraction::{FarField, Pupil};
pub use thin_lens::{FilmPosition, LensRay, ThinLens, ThinLensParameters};
