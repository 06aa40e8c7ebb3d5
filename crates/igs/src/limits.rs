//! How much a scene may ask for.

/// Bounds on a scene file and what it includes, so that a damaged or hostile file ends in an error
/// and not in a full memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest size of one file in bytes. Positions are 32 bits wide, so more than 4 GiB are never read.
    pub file_bytes: u64,
    /// Largest size of all files together in bytes.
    pub total_bytes: u64,
    /// How deep includes may be nested; the scene itself is at depth 0.
    pub include_depth: usize,
    /// Largest number of files, counting a file each time that it is included.
    pub files: usize,
    /// How deep elements may be nested.
    pub element_depth: usize,
    /// Largest number of elements, not counting the vertices and triangles of embedded meshes.
    pub elements: usize,
}

impl Default for Limits {
    /// Room for the largest real scenes: 4 GiB of text and two million elements.
    fn default() -> Self {
        Self {
            file_bytes: u64::from(u32::MAX),
            total_bytes: u64::from(u32::MAX),
            include_depth: 32,
            files: 1000,
            element_depth: 100,
            elements: 2_000_000,
        }
    }
}
