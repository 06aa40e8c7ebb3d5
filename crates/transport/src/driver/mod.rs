//! Drivers: which samples to take, in units of work that any thread can do and any run can replay.

mod independent;

pub use independent::Independent;
