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

impl ResolveError {
    /// What was expected in place of such a file, for messages.
    pub fn expected(&self) -> &'static str {
        match self {
            Self::NotFound { .. } => "expected the path of a file that is there",
            Self::TooLarge { .. } => "expected a file of no more than that",
            Self::Unreadable { .. } => "expected a file that can be read",
        }
    }
}

/// Folders of files that come with the program, which every scene may name.
pub const SHIPPED: [&str; 3] = ["data", "media", "nkdata"];

/// A hint for a file that is not there: the one of its name that comes with the program, if there is one.
pub fn hint_of_shipped(
    path: &str,
    from: &str,
    error: &ResolveError,
    resolver: &dyn Resolver,
) -> Option<String> {
    let ResolveError::NotFound { .. } = error else { return None };
    let name = path.rsplit(['/', '\\']).next().filter(|name| !name.is_empty())?;
    let mut shipped = SHIPPED.iter().map(|folder| format!("{folder}/{name}"));
    let found = shipped.find(|other| other != path && resolver.has(other, from))?;
    Some(format!("did you mean {found}?"))
}

/// Finds files by the paths that scenes write.
pub trait Resolver: Sync {
    /// The bytes of `path`, as written in the file `from` (empty for the program's own arguments).
    ///
    /// # Errors
    /// See [`ResolveError`].
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError>;

    /// Whether there is such a file, asked for a hint alone: who keeps a list of what was read leaves it out.
    fn has(&self, path: &str, from: &str) -> bool {
        self.read(path, from).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Has `media/water.igs` alone.
    struct Water;

    impl Resolver for Water {
        fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
            match path {
                "media/water.igs" => Ok(Resolved { path: path.to_owned(), bytes: Arc::from([]) }),
                _ => Err(ResolveError::NotFound { looked: vec![] }),
            }
        }
    }

    #[test]
    fn files_that_come_with_the_program_are_hinted_at() {
        let missing = ResolveError::NotFound { looked: vec![] };
        let hint = |path: &str| hint_of_shipped(path, "scene.igs", &missing, &Water);
        for path in ["water.igs", "liquids/water.igs", "..\\water.igs", "nkdata/water.igs"] {
            assert_eq!(hint(path).as_deref(), Some("did you mean media/water.igs?"), "{path}");
        }
        for path in ["wine.igs", "media/water.igs", "", "water.igs/"] {
            assert_eq!(hint(path), None, "{path}");
        }
        let too_large = ResolveError::TooLarge { size: 2, limit: 1 };
        assert_eq!(hint_of_shipped("water.igs", "scene.igs", &too_large, &Water), None);
    }
}
