//! `--upgrade`: a scene of any version of the format, written anew.

use crate::console::Console;
use crate::{refuse, refuse_scene, tell_findings};
use indigo_front::flags::Arguments;
use indigo_front::load::with_load_options;
use indigo_front::messages::{Messages as _, count};
use indigo_front::prepare::overwrites;
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_front::{VERSION, paths};
use indigo_render::atomic::write_atomically;
use indigo_scene::{NamedFile, load_canonical};
use std::cell::RefCell;
use std::collections::{BTreeMap, HashSet};
use std::io::Write as _;
use std::path::{Path, PathBuf, absolute};
use std::sync::Arc;

/// Writes a scene anew; the exit status.
pub fn upgrade(arguments: &Arguments, console: &mut Console) -> u8 {
    let [scene, output] = &arguments.files[..] else { return refuse("two files are expected", console) };
    if !Path::new(output).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("igs")) {
        return refuse(&format!("{output}: a name that ends in .igs is expected"), console);
    }
    let title = format!("{scene}, written anew by {VERSION}");
    let unpacked = Unpacked::beside(Path::new(output));
    let rewrite = |file: &NamedFile| {
        let path = seen_from(file.written, Path::new(file.path), Path::new(output));
        path.unwrap_or_else(|| unpacked.take(file))
    };
    let loaded =
        with_load_options(scene, arguments, |options| load_canonical(scene, options, &title, &rewrite));
    let (loaded, read) = match loaded {
        Ok(loaded) => loaded,
        Err(message) => return refuse_scene(scene, message, arguments, console),
    };
    if overwrites(std::iter::once(output.into()), &read).is_some() {
        return refuse(
            &format!("the scene reads {output}, which would be overwritten: give another name"),
            console,
        );
    }
    if !tell_findings(scene, &loaded.sink, &loaded.sources, arguments, console) {
        return FAILED;
    }
    let Some(text) = loaded.text else { return BAD_INPUT };
    let files = unpacked.files();
    if let Some((path, _)) = files.iter().find(|(path, bytes)| holds_something_else(path, bytes)) {
        let what = "is there already, and would be written over: give another name";
        return refuse(&format!("{} {what}", path.display()), console);
    }
    let write = |path: &Path, bytes: &[u8]| {
        write_atomically(path, |file| file.write_all(bytes)).map_err(|error| (path.to_owned(), error))
    };
    let written = files.iter().try_for_each(|(path, bytes)| write(path, bytes));
    match written.and_then(|()| write(Path::new(output), text.as_bytes())) {
        Ok(()) => {
            let with = match files.len() {
                0 => String::new(),
                n => format!(", and {} of packed ones in {}", count(n, "file"), unpacked.folder.display()),
            };
            let missing = match loaded.missing {
                0 => String::new(),
                n => format!(", without {} that it names", count(n, "file")),
            };
            console.say(&format!("Saved {output}{with}{missing}"));
            RENDERED
        }
        Err((path, error)) => {
            console.error(&format!("cannot write {}: {error}", path.display()));
            FAILED
        }
    }
}

/// Whether a file is there that has not these bytes.
fn holds_something_else(path: &Path, bytes: &[u8]) -> bool {
    path.exists() && std::fs::read(path).ok().as_deref() != Some(bytes)
}

/// Files of packed scenes and materials, where no path leads: they are written into a folder beside the scene.
struct Unpacked {
    /// The folder: `scene.igs` has `scene_files`.
    folder: PathBuf,
    /// By where it was found.
    taken: RefCell<BTreeMap<String, Taken>>,
}

/// A file, by its name in that folder.
struct Taken {
    name: String,
    bytes: Arc<[u8]>,
}

impl Unpacked {
    fn beside(output: &Path) -> Self {
        let mut name = output.file_stem().unwrap_or_default().to_owned();
        name.push("_files");
        Self { folder: output.with_file_name(name), taken: RefCell::default() }
    }

    /// Takes a file, and gives its path as the scene can write it.
    fn take(&self, file: &NamedFile) -> String {
        let mut taken = self.taken.borrow_mut();
        let names: HashSet<String> = taken.values().map(|file| file.name.to_lowercase()).collect();
        // Packs allow no names but those that every system has.
        let last = file.path.rsplit('/').next().unwrap_or_default();
        let numbered = (2_u32..).map(|n| format!("{n}_{last}"));
        let free =
            std::iter::once(last.to_owned()).chain(numbered).find(|n| !names.contains(&n.to_lowercase()));
        let new = || Taken { name: free.unwrap_or_default(), bytes: file.bytes.clone() };
        let Taken { name, .. } = taken.entry(file.path.to_owned()).or_insert_with(new);
        format!("{}/{name}", self.folder.file_name().unwrap_or_default().to_string_lossy())
    }

    /// What was taken: where it goes, and its bytes.
    fn files(&self) -> Vec<(PathBuf, Arc<[u8]>)> {
        let taken = self.taken.borrow();
        taken.values().map(|file| (self.folder.join(&file.name), file.bytes.clone())).collect()
    }
}

/// The path of a file as another one can write it: the same where it leads to what comes with the program, else from where
/// that other file is. `None` for what is no file of its own.
fn seen_from(written: &str, found: &Path, output: &Path) -> Option<String> {
    if !found.is_file() {
        return None;
    }
    let same =
        |path: &Path| path.canonicalize().ok().is_some_and(|path| found.canonicalize().ok() == Some(path));
    let name = written.replace('\\', "/");
    if paths::resource_directories().iter().any(|folder| same(&folder.join(&name))) {
        return Some(written.to_owned());
    }
    let (found, output) = (absolute(found).ok()?, absolute(output).ok()?);
    let shown = output.parent().and_then(|folder| found.strip_prefix(folder).ok()).unwrap_or(&found);
    Some(shown.to_string_lossy().replace('\\', "/"))
}
