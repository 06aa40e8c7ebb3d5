//! What lowering says about scenes that bind well but cannot be rendered as they are: each code with its
//! place, and settings with the layer that they come from.

mod common;
mod elements;
mod faults;
mod files;
mod materials;
mod settings;
mod surfaces;
