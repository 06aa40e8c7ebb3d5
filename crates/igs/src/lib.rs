//! Reads `.igs` scene files, and writes them.
//!
//! [`read_scene`] turns a file and everything that it includes into one tree of
//! [`Element`](indigo_decl::Element)s, each with its place; [`read_document`] does so for a file of
//! any root, such as `inifile.xml`. What the elements mean is not known here, with two exceptions:
//! `include`, and the bulk data of an `embedded` mesh, which goes straight into arrays.
//!
//! [`edit`] changes the text of scenes that were read and leaves everything else in it as it stands.
//!
//! The syntax is XML 1.0 without document types, read by a scanner of our own: a
//! library for XML stops at the first fault, while a user wants to hear of all of them, and real
//! exporters write comments that no XML library accepts. Nothing here panics on any input, and the
//! memory used is bounded by the length of the input times a constant, and by [`Limits`].
#![cfg_attr(
    not(test),
    deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing)
)]

pub mod codes;
pub mod edit;
mod embedded;
mod include;
mod limits;
pub mod pack;
mod read;
mod scan;
mod tag;
mod text;
mod tree;
mod write;

pub use embedded::{EMBEDDED, EXPOSE_UV_SET, TRIANGLE_SET, VERTEX};
pub use include::INCLUDE;
pub use limits::Limits;
pub use read::{read_document, read_scene, read_scene_until};
pub use write::{write, write_explained};
