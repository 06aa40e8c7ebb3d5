//! `--upgrade`: a scene of any version of the format, written anew.

use crate::console::Console;
use crate::{refuse, tell_findings};
use indigo_front::VERSION;
use indigo_front::flags::Arguments;
use indigo_front::load::with_load_options;
use indigo_front::messages::Messages as _;
use indigo_front::packs::is_pack;
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_render::atomic::write_atomically;
use indigo_scene::load_canonical;
use std::io::Write as _;
use std::path::{Path, PathBuf, absolute};

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
    let rewrite = |written: &str, from: &str| seen_from(written, Path::new(from), Path::new(output));
    let loaded =
        with_load_options(scene, arguments, |options| load_canonical(scene, options, &title, &rewrite));
    let loaded = match loaded {
        Ok((loaded, _)) => loaded,
        Err(message) => return refuse(&message, console),
    };
    if !tell_findings(scene, &loaded.sink, &loaded.sources, arguments, console) {
        return FAILED;
    }
    let Some(text) = loaded.text else { return BAD_INPUT };
    match write_atomically(Path::new(output), |file| file.write_all(text.as_bytes())) {
        Ok(()) => {
            console.say(&format!("Saved {output}"));
            RENDERED
        }
        Err(error) => {
            console.error(&format!("cannot write {output}: {error}"));
            FAILED
        }
    }
}

/// A path as it is written in one file, for another file: the same where that lies beside, or where it is found elsewhere
/// than beside the first.
fn seen_from(written: &str, from: &Path, output: &Path) -> String {
    let place = |file: &Path| absolute(file).ok().and_then(|file| file.parent().map(Path::to_path_buf));
    let (Some(here), Some(there)) = (place(from), place(output)) else { return written.to_owned() };
    let found: PathBuf = here.join(written.replace('\\', "/"));
    if here == there || !found.is_file() {
        return written.to_owned();
    }
    let shown = found.strip_prefix(&there).unwrap_or(&found);
    shown.to_string_lossy().replace('\\', "/")
}
