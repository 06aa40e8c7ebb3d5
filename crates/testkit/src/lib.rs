//! The tools that the test suites judge a renderer with.
//!
//! A Monte Carlo result is never equal to its expectation, so "is it right?" becomes "how likely is
//! a deviation like this one if it were right?". Every tool here answers with a p-value and a
//! threshold that is stated in advance, and is itself tested for the false-alarm rate that it claims
//! and for its power against a stated mistake.
//!
//! - [`chi2`]: does a sampler follow the density that it reports?
//! - [`ztest`]: does a mean of samples agree with an exact value?
//! - [`zgrid`]: do two noisy images agree, block by block?
//! - [`quadrature`]: deterministic integrals to compare with.
//! - [`fit`]: where is a measured curve least?
//! - [`image`]: error measures and difference maps.
//! - [`allocation`]: what does it ask of the heap?
//! - [`stats`], [`special`], [`rng`]: what the above stand on.
//!
//! Everything takes closures and plain numbers, works in `f64` and depends on no other crate. Nothing
//! here reads a file or a clock, nor, but for the counts of [`allocation`], a global; a seed determines each result.

pub mod allocation;
pub mod chi2;
mod domain;
pub mod fit;
pub mod image;
pub mod png;
pub mod quadrature;
pub mod rng;
pub mod special;
pub mod stats;
pub mod zgrid;
pub mod ztest;

pub use special::sidak;
