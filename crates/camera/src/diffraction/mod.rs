//! Diffraction by the aperture: its far field, and rays that follow it.

pub(crate) mod deflection;
pub mod far_field;
mod fourier;
mod pupil;

pub use far_field::FarField;
pub use pupil::Pupil;
