//! The parts of the automation that tests use, too: scenes that are made by program.

pub mod process;
pub mod scenes;

/// What a command gives back: nothing, or one message for the person at the terminal.
pub type Outcome = Result<(), String>;
