//! Rendering as a running thing: threads, halting, saving, events.
//!
//! A [`Session`] renders a scene until it is halted; console, window, network slave and scripts are
//! equal clients of it. Below this crate nothing starts a thread, reads a clock or touches a disk.

pub mod atomic;
pub mod calendar;
pub mod denoise;
pub mod disk;
mod error_estimate;
mod error_meter;
pub mod first_hits;
mod gate;
pub mod memory;
mod options;
pub mod output;
pub mod pool;
pub mod preview;
mod progress;
pub mod saved;
mod session;
mod worker;

pub use options::{Halt, Options};
pub use progress::Progress;
pub use session::{Event, HaltReason, Session, SessionError};

pub use indigo_transport::replay::replay;
