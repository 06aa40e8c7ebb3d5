//! The console program, run as users run it.

mod denoising;
mod files;
mod films;
mod messages;
mod packs;
mod saying;
#[cfg(unix)]
mod signals;
mod workbench;
