//! `--upgrade`: a scene of any version of the format, written anew.

use crate::console::Console;
use crate::{refuse, refuse_scene, tell_findings};
use indigo_front::flags::Arguments;
use indigo_front::load::with_load_options;
use indigo_front::messages::{Messages as _, count};
use indigo_front::packs::is_pack;
use indigo_front::prepare::overwrites;
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_front::{VERSION, paths};
use indigo_render::atomic::write_atomically;
use indigo_scene::load_canonical;
use std::io::Write as _;
use std::path::{Path, absolute};

/// Writes a scene anew; the exit status.
pub fn upgrade(arguments: &Arguments, console: &mut Console) -> u8 {
    let [scene, output] = &arguments.files[..] else { return refuse("two files are expected", console) };
    if is_pack(scene) {
        return refuse(&format!("{scene} is packed: --unpack it first"), console);
    }
    if !Path::new(output).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("igs")) {
        return refuse(&format!("{output}: a name that ends in .igs is expected"), console);
    }
    let title = format!("{scene}, written anew by {VERSION}");
    let rewrite = |written: &str, found: &str| seen_from(written, Path::new(found), Path::new(output));
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
    if let Some(path) = loaded.unreachable.first() {
        let what = "is in a packed file, where no path leads: unpack that, and include what is in it";
        return refuse(&format!("{scene}: {path} {what}"), console);
    }
    match write_atomically(Path::new(output), |file| file.write_all(text.as_bytes())) {
        Ok(()) => {
            let missing = match loaded.missing {
                0 => String::new(),
                n => format!(", without {} that it names", count(n, "file")),
            };
            console.say(&format!("Saved {output}{missing}"));
            RENDERED
        }
        Err(error) => {
            console.error(&format!("cannot write {output}: {error}"));
            FAILED
        }
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
