//! Scenes: the declaration of everything that a scene can hold, and what is made of it.

pub mod schema;
