//! Rays and what they hit: triangle meshes, spheres, infinite planes and instances of meshes.
//!
//! [`Accel`] owns the meshes and answers two questions: the closest hit of a ray, and whether
//! anything is in its way. [`Accel::surface`] turns a hit into a [`SurfacePoint`] with an error
//! bound; [`offset_origin`] starts the next ray clear of that error, and [`offset_target`] ends one there.
//!
//! What moves has a [`Movement`], and is where it is at the [`Ray::time`].
//!
//! One node format (8-wide, `wide`), two builders (`build`), one traversal kernel (`traverse`)
//! whose lanes are AVX2 registers or plain arrays, chosen once per [`Accel`]; both give the same
//! hits bit for bit. Nothing here opens a file: built trees are kept by a [`TreeStore`] of the host.

mod accel;
mod build;
mod cache;
mod mesh;
mod movement;
mod object;
mod ray;
mod shapes;
mod soup;
mod stop;
mod store;
mod surface;
mod top;
mod traverse;
mod trees;
mod uv;
mod wide;

pub use accel::{Accel, BuildError, BuildOptions, KernelChoice, Stats};
pub use mesh::{MeshBuffers, MeshError, TriangleMesh};
pub use movement::Movement;
pub use object::Object;
pub use ray::{Hit, Ray};
pub use stop::Stop;
pub use store::{NoStore, TreeStore};
pub use surface::{SurfacePoint, offset_origin, offset_target};
