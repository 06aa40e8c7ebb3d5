//! Light transport: which numbers a sample is made of, the techniques that turn them into light on
//! the film, and the drivers that decide which samples to take.
//!
//! - [`sampler`]: primary samples, in blocks of four numbers with fixed meaning;
//! - [`technique`]: path tracing, and bidirectional path tracing with multiple importance sampling;
//! - [`first_hit`]: what a pixel shows besides light, for denoisers and compositing;
//! - [`driver`]: independent samples in low-discrepancy order, Metropolis sampling in primary sample space, and
//!   their hybrid;
//! - [`replay`]: a single sample of a render, told in words;
//! - [`strategies`]: what each strategy of bidirectional path tracing adds, as pictures.
//!
//! Nothing here starts a thread, reads a clock, allocates for a sample of a render, or prints.

pub mod driver;
pub mod first_hit;
pub mod replay;
pub mod sampler;
pub mod strategies;
pub mod technique;
