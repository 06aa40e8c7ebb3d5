//! Listing the files that a scene needs.

use crate::console::Console;
use crate::{answer, refuse, refuse_scene, tell_findings};
use indigo_diag::{quoted, shown};
use indigo_front::flags::Arguments;
use indigo_front::load::with_load_options;
use indigo_front::messages::{Messages as _, count};
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_scene::{Need, load_needs};

/// Prints each file that a scene names, and which are missing; the exit status.
pub fn run(arguments: &Arguments, console: &mut Console) -> u8 {
    let [scene] = &arguments.files[..] else { return refuse("one scene is expected", console) };
    let loaded = match with_load_options(scene, arguments, |options| load_needs(scene, options)) {
        Ok((loaded, _)) => loaded,
        Err(message) => return refuse_scene(scene, message, arguments, console),
    };
    let line = if arguments.json { json } else { text };
    let listing: String = loaded.needs.iter().map(line).collect();
    let printed = answer(&listing, console);
    if printed != RENDERED {
        return printed;
    }
    if !tell_findings(scene, &loaded.sink, &loaded.sources, arguments, console) {
        return FAILED;
    }
    let missing = loaded.needs.iter().filter(|need| need.bytes.is_err()).count();
    if missing > 0 && !arguments.json {
        console.error(&format!("{scene}: {} missing", count(missing, "file")));
    }
    if missing > 0 || loaded.sink.has_errors() { BAD_INPUT } else { RENDERED }
}

/// As a line for people.
fn text(need: &Need) -> String {
    let Need { path, named_in, .. } = need;
    let line = match &need.bytes {
        Ok(bytes) => format!("{bytes:>12}  {path}"),
        Err(error) if named_in.is_empty() => format!("{:>12}  {path}: {error}", "missing"),
        Err(error) => format!("{:>12}  {path}, named in {named_in}: {error}", "missing"),
    };
    format!("{}\n", shown(&line))
}

/// As an object of JSON in a line of its own.
fn json(need: &Need) -> String {
    let what = match &need.bytes {
        Ok(bytes) => format!("\"bytes\":{bytes}"),
        Err(error) => format!("\"missing\":{}", quoted(&error.to_string())),
    };
    format!("{{\"path\":{},{what},\"named_in\":{}}}\n", quoted(&need.path), quoted(&need.named_in))
}
