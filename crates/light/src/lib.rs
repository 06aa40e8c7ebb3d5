//! Where light comes from: the kinds of light, and a table of all lights to draw from.

mod area;
mod environment;
pub mod kinds;
mod light_tree;
mod line_tree;
mod map_mean;
mod map_row;
mod modulation;
mod portals;
mod profile;
mod query;
pub mod sky;
mod table;

pub use area::AreaLight;
pub use kinds::{Distant, DistantLight};
pub use portals::{Passage, Portals};
pub use profile::Profile;
pub use query::{
    Emission, EmissionPdf, EmitterHit, EmitterPoint, LightSample, Receiver, Sender, Source, SourceView,
};
pub use table::LightTable;
