//! Files that were opened lately.

use std::path::{Path, PathBuf};

/// How many are remembered.
const MOST: usize = 10;

/// See the module; the last one is the first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recent {
    paths: Vec<PathBuf>,
}

impl Recent {
    /// From lines of text.
    pub fn from_text(text: &str) -> Self {
        Self { paths: text.lines().filter(|line| !line.is_empty()).take(MOST).map(PathBuf::from).collect() }
    }

    /// As lines of text.
    pub fn to_text(&self) -> String {
        let paths: Vec<&str> = self.paths.iter().filter_map(|path| path.to_str()).collect();
        paths.join("\n")
    }

    /// A file was opened.
    pub fn add(&mut self, path: &Path) {
        // The same file by the same name, wherever the program is started next.
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        self.paths.retain(|old| *old != path);
        self.paths.insert(0, path);
        self.paths.truncate(MOST);
    }

    /// All of them.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_comes_first_and_once() {
        let mut recent = Recent::default();
        for name in ["/a.igs", "/b.igs", "/a.igs"] {
            recent.add(Path::new(name));
        }
        assert_eq!(recent.paths(), ["/a.igs", "/b.igs"].map(PathBuf::from));
        assert_eq!(Recent::from_text(&recent.to_text()), recent);
        (0..20).for_each(|i| recent.add(Path::new(&format!("/{i}"))));
        assert_eq!(recent.paths().len(), MOST);
    }
}
