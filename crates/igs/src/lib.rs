//! Reads `.igs` scene files into element trees.

mod include;

pub use include::INCLUDE;
