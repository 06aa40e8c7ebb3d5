//! The mathematics under everything else: vectors, transforms, frames, bounds, random and
//! low-discrepancy numbers, sampling warps with their inverses, and discrete distributions.
//!
//! Nothing here allocates on evaluation, locks, reads a clock or depends on another crate of the workspace.
//! [`Real`] is the scalar of the rendering kernel; sums, tables and transforms at load are `f64`.

pub mod angle;
pub mod bounds;
pub mod distribution;
pub mod elementary;
pub mod frame;
pub mod grid_distribution;
pub mod motion;
pub mod pages;
pub mod rng;
pub mod scalar;
pub mod sobol;
pub mod transform;
pub mod vec;
pub mod warp;

pub use bounds::Bounds3;
pub use frame::Frame;
pub use motion::{Motion, Pose};
pub use scalar::{Float, Real};
pub use transform::Transform;
pub use vec::{Mat3, Vec2, Vec3, Vec3d};
