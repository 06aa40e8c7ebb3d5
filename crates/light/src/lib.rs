//! Where light comes from: the kinds of light, and a table of all lights to draw from.

mod area;
pub mod kinds;
mod table;

pub use area::{AreaLight, EmitterPoint};
pub use table::{Emission, EmissionPdf, Light, LightSample, LightTable};
