//! The console program, run as users run it.

mod denoising;
mod files;
mod films;
mod messages;
#[cfg(unix)]
mod signals;
mod workbench;
