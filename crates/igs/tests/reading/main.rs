//! The reader of scene files, from outside.

mod common;
mod editing;
mod editing_laws;
mod embedded;
mod includes;
mod properties;
mod syntax;
