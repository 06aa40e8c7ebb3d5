//! How surfaces and media scatter light.
//!
//! - [`materials`]: one file each, with the element's declaration, what is read from it, and the
//!   scattering model that it bakes for a path;
//! - [`Scatter`]: what the author of a model writes, in the local frame, without cosines;
//! - [`ShadingPoint`]: the same at a point of a surface, with cosines and corrections for shading normals.

mod bump;
mod directional_albedo;
mod facet_albedo;
pub mod fresnel;
mod immersion;
pub mod materials;
pub mod media;
mod medium_stack;
mod microfacet;
pub mod phase;
mod reflectance;
mod scatter;
mod shading;
mod thin_film;
mod wrong_side;

pub use bump::bumped_normal;
pub use materials::{Interface, Leaf, Material, MaterialContext, MaterialId, MaterialResources, SurfaceKind};
pub use media::{Medium, MediumId};
pub use medium_stack::MediumStack;
pub use phase::Phase;
pub use reflectance::Reflectance;
pub use scatter::{Crossing, Delta, LocalSample, Scatter};
pub use shading::{Evaluation, Mode, Scattered, ShadingPoint};
