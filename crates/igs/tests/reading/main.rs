//! The reader of scene files, from outside.

mod common;
mod embedded;
mod includes;
mod properties;
mod syntax;
