//! Scenes in the spelling of later format versions are the same scenes: compared exactly, as they are lowered.

mod alike;
mod backgrounds;
mod common;
mod geometry;
mod lights;
mod materials;
mod numbers;
mod real;
mod shining;
mod stand_ins;
