//! Exit status of programs.

/// The picture was rendered.
pub const RENDERED: u8 = 0;
/// Rendering, or reading or writing files, failed.
pub const FAILED: u8 = 1;
/// The scene or the command line is wrong.
pub const BAD_INPUT: u8 = 2;
