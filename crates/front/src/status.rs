//! Exit status of programs.

/// The picture was rendered.
pub const RENDERED: u8 = 0;
/// Rendering, or reading or writing files, failed.
pub const FAILED: u8 = 1;
/// The scene or the command line is wrong.
pub const BAD_INPUT: u8 = 2;
/// Somebody pressed Ctrl-C where that ends nothing in good order: 128 and the number of the signal, as shells tell it.
pub const INTERRUPTED: u8 = 130;
