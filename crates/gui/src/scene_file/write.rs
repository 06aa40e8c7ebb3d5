//! Changes of a scene, written to its files: to all of them, or to none that could have been known not to take them.

use super::NotSaved;
use crate::words;
use indigo_diag::SourceMap;
use indigo_igs::edit::{EditedFile, Edits};
use indigo_render::atomic::write_atomically;
use indigo_render::disk::read_limited;
use std::fs::{OpenOptions, Permissions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// A file that can be written: where it is itself, behind all links, and what it permits to whom.
struct Target {
    path: PathBuf,
    permissions: Permissions,
}

/// Writes changes to the files of a scene of some path; these.
///
/// # Errors
/// Where a file cannot be changed or written, or has changed since it was read.
pub fn write(edits: &Edits, sources: &SourceMap, scene: &str) -> Result<Vec<PathBuf>, NotSaved> {
    let files = edits.apply(sources).map_err(|error| match error.span() {
        Some(span) => {
            let at = sources.position(span);
            format!("{}:{}:{}: {error}", sources.name(span.source), at.line, at.column)
        }
        None => format!("{scene}: {error}"),
    })?;
    let targets = files.iter().map(|file| target(file, sources)).collect::<Result<Vec<_>, _>>()?;
    for (file, target) in files.iter().zip(&targets) {
        let written = write_atomically(&target.path, |to| {
            // Before anything is in it that others may not read.
            to.get_ref().set_permissions(target.permissions.clone())?;
            to.write_all(&file.bytes)
        });
        written.map_err(|error| format!("{}: {error}", file.path))?;
    }
    Ok(files.into_iter().map(|file| PathBuf::from(file.path)).collect())
}

/// The file that one is to be written to, if it is the one that was read, and may be written.
fn target(file: &EditedFile, sources: &SourceMap) -> Result<Target, NotSaved> {
    let in_words = |error: std::io::Error| format!("{}: {error}", file.path);
    // A link stays one, and what it leads to is changed.
    let path = Path::new(&file.path).canonicalize().map_err(in_words)?;
    if read_limited(&path).map_err(in_words)? != sources.text(file.source) {
        return Err(NotSaved::ChangedElsewhere(file.path.clone()));
    }
    let permissions = path.metadata().map_err(in_words)?.permissions();
    // A new file takes its place, for which it would not have to be asked.
    if permissions.readonly() || OpenOptions::new().write(true).open(&path).is_err() {
        return Err(words::read_only(&file.path).into());
    }
    Ok(Target { path, permissions })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::SceneFile;

    /// A scene that includes another file, with a number changed in each.
    fn changed(name: &str) -> (PathBuf, SceneFile) {
        let folder = std::env::temp_dir().join(format!("indigo-write-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let sphere = |include: &str| {
            format!(
                "<scenedata>{include}<sphere><center>0 0 0</center><radius>1</radius></sphere></scenedata>"
            )
        };
        std::fs::write(folder.join("b.igs"), sphere("")).unwrap();
        let include = "<include><pathname>b.igs</pathname></include>";
        std::fs::write(folder.join("a.igs"), sphere(include)).unwrap();
        let mut file = SceneFile::read(folder.join("a.igs").to_str().unwrap()).unwrap();
        let spheres: Vec<usize> =
            (0..file.root.children.len()).filter(|&i| &*file.root.children[i].name == "sphere").collect();
        assert_eq!(spheres.len(), 2);
        for sphere in spheres {
            file.changes.insert(vec![sphere, 1], "2".to_owned());
        }
        (folder, file)
    }

    fn is_changed(path: &Path) -> bool {
        std::fs::read_to_string(path).unwrap().contains("<radius>2</radius>")
    }

    #[test]
    fn none_of_two_files_is_written_where_one_has_changed() {
        let (folder, file) = changed("two");
        let files = ["a.igs", "b.igs"].map(|name| folder.join(name));
        for other in &files {
            let before = std::fs::read_to_string(other).unwrap();
            std::fs::write(other, format!("{before}\n")).unwrap();
            assert!(
                matches!(file.save(), Err(NotSaved::ChangedElsewhere(path)) if Path::new(&path) == other)
            );
            assert!(!files.iter().any(|path| is_changed(path)), "{}", other.display());
            std::fs::write(other, before).unwrap();
        }
        assert_eq!(file.save().unwrap().len(), 2);
        assert!(files.iter().all(|path| is_changed(path)));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay_and_what_is_read_only_is_not_replaced() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let (folder, _) = changed("links");
        let (link, itself) = (folder.join("b.igs"), folder.join("shared.igs"));
        std::fs::rename(&link, &itself).unwrap();
        symlink(&itself, &link).unwrap();
        let mode = |bits: u32| std::fs::set_permissions(&itself, Permissions::from_mode(bits)).unwrap();
        let again = || {
            let mut file = SceneFile::read(folder.join("a.igs").to_str().unwrap()).unwrap();
            let way = (0..3)
                .map(|i| vec![i, 1])
                .find(|way| file.at(way).is_some_and(|e| &*e.name == "radius" && &*e.text.value == "1"));
            file.changes.insert(way.unwrap(), "2".to_owned());
            file
        };
        mode(0o444);
        let NotSaved::Because(words) = again().save().unwrap_err() else { panic!("nothing has changed") };
        assert!(words.contains("read-only"), "{words}");
        assert!(!is_changed(&itself));
        mode(0o640);
        again().save().unwrap();
        assert!(is_changed(&itself) && link.is_symlink());
        assert_eq!(itself.metadata().unwrap().permissions().mode() & 0o777, 0o640);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
