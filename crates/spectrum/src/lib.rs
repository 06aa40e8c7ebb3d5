//! Light by wavelength: the wavelengths that a path carries, the spectra of a scene, and the
//! observer.
//!
//! - [`SampledWavelengths`]: a hero wavelength and its companions, with the density of each.
//! - [`SampledSpectrum`], [`LanePdf`]: a value, or a density, for each of them.
//! - [`Spectrum`]: a function of wavelength as a scene gives it.
//! - [`observer`]: colour matching, and the film's weights from lanes to XYZ.
//! - [`rgb`]: spectra from RGB triples, of three kinds.
//! - [`illuminant`], [`adaptation`], [`photometry`]: whites, white balance, and the scales of lights.
//!
//! Wavelengths are in nm, from 360 to 830; spectral radiance is in W m^-3 sr^-1 (per metre of
//! wavelength), so 1e-9 of it is radiance per nm. Tables and integrals are `f64`, what a path
//! evaluates is [`indigo_math::Real`].
//!
//! # Three kinds of RGB
//!
//! | kind | constructor | what holds | (1, 1, 1) is |
//! |---|---|---|---|
//! | reflectance | [`Spectrum::rgb_reflectance`] | within [0, 1]; lit by D65 it has the RGB it was made from | 1 at every wavelength |
//! | emission | [`Spectrum::rgb_emission`] | chromaticity of the triple; doubling the triple doubles the spectrum | D65 with the luminance of `uniform` 1 |
//! | coefficient | [`Spectrum::rgb_coefficient`] | linear in the triple, no upper limit; a grey is flat | 1 at every wavelength |

pub mod adaptation;
pub mod declare;
mod error;
pub mod grid;
pub mod illuminant;
mod integrate;
pub mod kinds;
mod lanes;
pub mod observer;
pub mod photometry;
pub mod read;
pub mod rgb;
#[cfg(test)]
mod test_support;
mod wavelengths;

pub use error::SpectrumError;
pub use kinds::Spectrum;
pub use lanes::{LANES, LanePdf, SampledSpectrum};
pub use rgb::{Reflectance, RgbTable};
pub use wavelengths::{LightSpectrum, SampledWavelengths, WavelengthSampler};
