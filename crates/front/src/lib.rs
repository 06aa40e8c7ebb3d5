//! What the front ends share: the command line, where files are, loading a scene, getting ready to render it, and
//! saving on the way. `indigo_console` adds what is said on a terminal, `indigo` a window.

pub mod claim;
pub mod cpu;
pub mod flags;
pub mod load;
pub mod messages;
pub mod net;
pub mod packs;
pub mod paths;
pub mod prepare;
pub mod saver;
pub mod status;

/// Name and version, in the form that programs which call this one look for.
pub const VERSION: &str = concat!("Indigo Renderer v", env!("CARGO_PKG_VERSION"));

/// Name, version and platform of the program.
pub fn program() -> String {
    format!("{VERSION}, {} {} build.", std::env::consts::OS, std::env::consts::ARCH)
}

/// Number of logical cores.
pub fn logical_cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
