//! The console program, run as users run it.

mod denoising;
mod files;
mod films;
mod messages;
mod packs;
mod saying;
#[cfg(unix)]
mod signals;
#[allow(dead_code, reason = "every test program uses its own part")]
mod workbench;
