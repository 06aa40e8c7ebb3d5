//! Where bytes come from.
//!
//! No library opens a file by path: a front end supplies a [`Resolver`] over a disk, a packed scene
//! or memory. It also knows that `\` and `/` are alike, that case may differ, and where to look.

use std::sync::Arc;

/// A file that was found.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// Name to show and to resolve further paths against.
    pub path: String,
    /// The content.
    pub bytes: Arc<[u8]>,
}

/// Why a file could not be had.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
pub enum ResolveError {
    /// It is nowhere where it was looked for.
    #[error("no such file; looked for {}", .looked.join(", "))]
    NotFound {
        /// The places tried.
        looked: Vec<String>,
    },
    /// It is larger than what may be read.
    #[error("the file has {size} bytes; at most {limit} are read")]
    TooLarge {
        /// Its size in bytes.
        size: u64,
        /// The limit in bytes.
        limit: u64,
    },
    /// It is there but cannot be read.
    #[error("{path}: {reason}")]
    Unreadable {
        /// Its path.
        path: String,
        /// What the system said.
        reason: String,
    },
}

/// Finds files by the paths that scenes write.
pub trait Resolver: Sync {
    /// The bytes of `path`, as written in the file `from` (empty for the program's own arguments).
    ///
    /// # Errors
    /// See [`ResolveError`].
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError>;
}
