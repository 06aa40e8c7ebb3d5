//! Readers of mesh, picture and other data files: bytes in, plain data or a positioned error out.
//!
//! | module | files | result |
//! |---|---|---|
//! | [`obj`], [`ply`], [`three_ds`], [`igmesh`] | meshes | [`MeshData`] |
//! | [`nk`] | complex indices of refraction | [`nk::ComplexIndex`] |
//! | [`image`] | PNG, JPEG, TGA, BMP, TIFF, HDR, EXR | [`image::Image`] |
//! | [`float_map`] | .float | [`image::Image`] |
//! | [`ies`] | photometric data of lamps | [`ies::Photometry`] |
//! | [`response`] | response curves of cameras | [`response::ResponseCurve`] |
//!
//! Readers take the whole file as bytes: who opens it, and where, is the caller's business. Files may be damaged or
//! hostile: a reader never panics, never allocates by a number that the file merely claims, and takes a time bounded by
//! the file's size. Every mesh that it returns holds valid indices and finite positions.
#![cfg_attr(
    not(test),
    deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing)
)]

mod builder;
mod bytes;
mod error;
pub mod float_map;
pub mod ies;
pub mod igmesh;
pub mod image;
mod mesh_file;
pub mod nk;
pub mod obj;
pub mod ply;
mod polygon;
pub mod response;
mod text;
pub mod three_ds;
mod vec3;
mod weld;

pub use error::{FormatError, Position};
pub use indigo_decl::mesh::MeshData;
pub use mesh_file::{MeshFormat, read_mesh};
