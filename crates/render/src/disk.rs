//! The disk: finding the files that scenes name, and keeping built trees.

use crate::atomic::write_atomically;
use indigo_decl::{ResolveError, Resolved, Resolver, SHIPPED};
use indigo_geom::TreeStore;
use indigo_math::pages;
use std::fs::File;
use std::io::{Read, Write as _};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Finds files beside the scene, then beside the file that names them (which the scene may include; of an `.igm` the other way
/// round), then in resource directories.
///
/// `\` and `/` are alike. An absolute path that does not exist (scenes travel between machines) is
/// looked for by its last part beside the scene. Where no file has exactly the name, one that differs
/// in case alone does.
#[derive(Clone, Debug)]
pub struct DiskResolver {
    scene: Option<PathBuf>,
    /// Whether nothing beside the scene counts.
    only_resources: bool,
    resource_directories: Vec<PathBuf>,
    limit: u64,
    /// What has been read; copies of a resolver share it.
    files: Arc<Mutex<Vec<PathBuf>>>,
}

impl DiskResolver {
    /// The largest file that is read, unless told otherwise.
    pub const DEFAULT_LIMIT: u64 = 4 << 30;

    /// A resolver that also looks into these directories.
    pub fn new(resource_directories: Vec<PathBuf>) -> Self {
        Self {
            scene: None,
            only_resources: false,
            resource_directories,
            limit: Self::DEFAULT_LIMIT,
            files: Arc::default(),
        }
    }

    /// A resolver that looks into these directories alone, for files that come with the program. The paths must be
    /// relative and without detours.
    pub fn only(resource_directories: Vec<PathBuf>) -> Self {
        Self { only_resources: true, ..Self::new(resource_directories) }
    }

    /// The same resolver for what is named anywhere in a scene and the files that it includes.
    #[must_use]
    pub fn for_scene(self, path: impl Into<PathBuf>) -> Self {
        Self { scene: Some(path.into()), ..self }
    }

    /// The files that have been read.
    pub fn files(&self) -> Vec<PathBuf> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn candidates(&self, path: &str, from: &str) -> Vec<PathBuf> {
        let path = path.replace('\\', "/");
        if self.only_resources {
            return self.resource_directories.iter().map(|d| d.join(&path)).collect();
        }
        if from.is_empty() {
            return vec![PathBuf::from(path)];
        }
        let directory = |file: &Path| file.parent().unwrap_or(Path::new("")).to_path_buf();
        let mut beside: Vec<PathBuf> =
            self.scene.as_deref().into_iter().chain([Path::new(from)]).map(directory).collect();
        // A library of materials knows the files beside itself, and nothing of the scene.
        if Path::new(from).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("igm")) {
            beside.reverse();
        }
        beside.dedup();
        let has_drive = path.as_bytes().get(1) == Some(&b':');
        if has_drive || path.starts_with('/') {
            let name = path.rsplit('/').next().unwrap_or_default().to_owned();
            let shipped =
                shipped_part(&path).map(|part| self.resource_directories.iter().map(move |d| d.join(&part)));
            let shipped = shipped.into_iter().flatten();
            let beside = beside.iter().map(|d| d.join(&name));
            return [PathBuf::from(&path)].into_iter().chain(beside).chain(shipped).collect();
        }
        beside.iter().chain(&self.resource_directories).map(|d| d.join(&path)).collect()
    }

    fn read_file(&self, path: &Path) -> Result<Resolved, ResolveError> {
        let shown = path.to_string_lossy().into_owned();
        let unreadable = |reason: String| ResolveError::Unreadable { path: shown.clone(), reason };
        let known = std::fs::metadata(path).map_err(|e| unreadable(e.to_string()))?;
        if !known.is_file() {
            // To open a pipe may wait for ever, and a device may have no end.
            return Err(unreadable("not a regular file".to_owned()));
        }
        let file = File::open(path).map_err(|e| unreadable(e.to_string()))?;
        let meta = file.metadata().map_err(|e| unreadable(e.to_string()))?;
        if meta.len() > self.limit {
            return Err(ResolveError::TooLarge { size: meta.len(), limit: self.limit });
        }
        let mut bytes = Vec::with_capacity(meta.len() as usize);
        // A file that grows while it is read must not go beyond the limit either.
        file.take(self.limit).read_to_end(&mut bytes).map_err(|e| unreadable(e.to_string()))?;
        self.files.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_path_buf());
        Ok(Resolved { path: shown, bytes: bytes.into() })
    }
}

/// The part of a path on another machine that leads to a file which comes with the program there.
fn shipped_part(path: &str) -> Option<String> {
    let parts: Vec<&str> = path.split('/').collect();
    let is_shipped = |part: &&str| SHIPPED.iter().any(|folder| part.eq_ignore_ascii_case(folder));
    let at = parts.iter().rposition(is_shipped)?;
    Some(parts.get(at..)?.join("/"))
}

/// A file to be read, and its length, as long as that is no more than is ever read of one.
///
/// # Errors
/// What the system says, or that the file is too large.
pub fn open_limited(path: &Path) -> std::io::Result<(impl Read, u64)> {
    if !std::fs::metadata(path)?.is_file() {
        // To open a pipe may wait for ever, and a device may have no end.
        return Err(std::io::Error::other("not a regular file"));
    }
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    if length > DiskResolver::DEFAULT_LIMIT {
        return Err(std::io::ErrorKind::FileTooLarge.into());
    }
    Ok((file.take(DiskResolver::DEFAULT_LIMIT), length))
}

/// A file's bytes.
///
/// # Errors
/// As [`open_limited`].
pub fn read_limited(path: &Path) -> std::io::Result<Vec<u8>> {
    let (mut file, length) = open_limited(path)?;
    let mut bytes = pages::with_capacity(length as usize);
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

impl Resolver for DiskResolver {
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        let candidates = self.candidates(path, from);
        let found = candidates.iter().find(|c| c.exists()).cloned();
        let ignoring_case = || candidates.iter().find_map(|c| ignoring_case(c));
        let without_detours = || candidates.iter().map(|c| without_detours(c)).find(|c| c.is_file());
        match found.or_else(ignoring_case).or_else(without_detours) {
            Some(path) => self.read_file(&path),
            None => Err(ResolveError::NotFound {
                looked: candidates.iter().map(|c| c.display().to_string()).collect(),
            }),
        }
    }
}

/// The path without `..` after the name of a folder. Windows asks for no such folder to be there; other systems do, and
/// where it is a link they mean something else by it.
fn without_detours(path: &Path) -> PathBuf {
    let mut short = PathBuf::new();
    for part in path.components() {
        let is_below_folder = matches!(short.components().next_back(), Some(Component::Normal(_)));
        if part == Component::ParentDir && is_below_folder {
            short.pop();
        } else {
            short.push(part);
        }
    }
    short
}

/// The file whose path differs from the wanted one in case alone.
fn ignoring_case(wanted: &Path) -> Option<PathBuf> {
    let mut found = PathBuf::new();
    for part in wanted.components() {
        let exact = found.join(part);
        if exact.exists() || found.as_os_str().is_empty() && !matches!(part, Component::Normal(_)) {
            found = exact;
            continue;
        }
        let name = part.as_os_str().to_string_lossy().to_lowercase();
        let directory = if found.as_os_str().is_empty() { Path::new(".") } else { &found };
        let entry = std::fs::read_dir(directory)
            .ok()?
            .filter_map(Result::ok)
            .find(|e| e.file_name().to_string_lossy().to_lowercase() == name)?;
        found.push(entry.file_name());
    }
    found.is_file().then_some(found)
}

/// Keeps built trees as files of a directory.
#[derive(Clone, Debug)]
pub struct DiskTreeStore {
    directory: PathBuf,
}

impl DiskTreeStore {
    /// A store in a directory, made when first needed.
    pub fn new(directory: PathBuf) -> Self {
        Self { directory }
    }

    fn path(&self, key: &[u8; 32]) -> PathBuf {
        let mut name = String::with_capacity(2 * key.len() + 5);
        for byte in key {
            // Writing to a string cannot fail.
            let _ = std::fmt::Write::write_fmt(&mut name, format_args!("{byte:02x}"));
        }
        self.directory.join(name + ".tree")
    }
}

impl TreeStore for DiskTreeStore {
    fn load(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        read_limited(&self.path(key)).ok()
    }

    fn store(&self, key: &[u8; 32], bytes: &[u8]) {
        // A cache that cannot be written costs time, nothing else.
        drop(write_atomically(&self.path(key), |file| file.write_all(bytes)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        let directory = std::env::temp_dir().join(format!("indigo-disk-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&directory).unwrap();
        directory
    }

    #[test]
    fn files_are_found_as_exporters_write_them() {
        let root = scratch("find");
        std::fs::create_dir_all(root.join("Maps")).unwrap();
        std::fs::create_dir_all(root.join("resources/nkdata")).unwrap();
        std::fs::write(root.join("Maps/Wood.JPG"), b"wood").unwrap();
        std::fs::write(root.join("beside.obj"), b"mesh").unwrap();
        std::fs::write(root.join("resources/nkdata/au.nk"), b"gold").unwrap();
        let resolver = DiskResolver::new(vec![root.join("resources")]);
        let from = root.join("scene.igs").display().to_string();
        let text = |path: &str| resolver.read(path, &from).map(|r| r.bytes.to_vec());
        assert_eq!(text("Maps\\Wood.JPG").unwrap(), b"wood");
        assert_eq!(text("maps/wood.jpg").unwrap(), b"wood");
        assert_eq!(text("N:/work\\old/beside.obj").unwrap(), b"mesh");
        assert_eq!(text("/nowhere/Beside.OBJ").unwrap(), b"mesh");
        assert_eq!(text("C:\\Program Files\\Renderer\\NKdata\\Au.NK").unwrap(), b"gold");
        assert_eq!(text("nkdata/Au.nk").unwrap(), b"gold");
        assert_eq!(text("absent\\..\\beside.obj").unwrap(), b"mesh");
        assert!(matches!(text("missing.png"), Err(ResolveError::NotFound { looked }) if looked.len() == 2));
        assert!(matches!(text("Maps"), Err(ResolveError::Unreadable { .. })));
        std::fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn an_included_file_names_what_is_beside_the_scene_before_what_is_beside_itself() {
        let root = scratch("included");
        for folder in ["parts", "resources"] {
            std::fs::create_dir_all(root.join(folder)).unwrap();
        }
        for (file, text) in [
            ("wood.png", "scene"),
            ("parts/wood.png", "parts"),
            ("parts/cloth.png", "parts"),
            ("resources/cloth.png", "resources"),
            ("resources/au.nk", "resources"),
        ] {
            std::fs::write(root.join(file), text).unwrap();
        }
        let resolver = DiskResolver::new(vec![root.join("resources")]).for_scene(root.join("scene.igs"));
        let from = root.join("parts/included.igs").display().to_string();
        let found =
            |path: &str| String::from_utf8(resolver.read(path, &from).unwrap().bytes.to_vec()).unwrap();
        let of_library = resolver.read("wood.png", &root.join("parts/library.igm").display().to_string());
        assert_eq!(&*of_library.unwrap().bytes, b"parts");
        assert_eq!(
            ["wood.png", "cloth.png", "au.nk", "C:\\old\\cloth.png"].map(found),
            ["scene", "parts", "resources", "parts"]
        );
        std::fs::remove_dir_all(root).unwrap();
    }

    /// A pipe that nobody writes to, and a device without end.
    #[cfg(unix)]
    #[test]
    fn only_regular_files_are_read() {
        let root = scratch("pipe");
        let pipe = root.join("pipe.obj").display().to_string();
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let resolver = DiskResolver::new(vec![]);
        for path in [&*pipe, "/dev/zero"] {
            let Err(ResolveError::Unreadable { reason, .. }) = resolver.read(path, "") else {
                panic!("{path}")
            };
            assert_eq!(reason, "not a regular file");
        }
        std::fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn a_file_that_is_too_large_is_not_read() {
        let root = scratch("large");
        std::fs::write(root.join("a.bin"), [0; 100]).unwrap();
        let resolver = DiskResolver { limit: 99, ..DiskResolver::new(vec![]) };
        let path = root.join("a.bin").display().to_string();
        assert_eq!(resolver.read(&path, "").unwrap_err(), ResolveError::TooLarge { size: 100, limit: 99 });
        std::fs::remove_dir_all(root).unwrap();
    }
}
