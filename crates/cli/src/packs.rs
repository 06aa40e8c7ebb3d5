//! Packing scenes and unpacking them.

use crate::console::Console;
use crate::interrupts::{end_in_order, is_interrupted};
use crate::{refuse, refuse_scene, tell_findings};
use indigo_front::flags::Arguments;
use indigo_front::load::with_load_options;
use indigo_front::messages::{Messages as _, count};
use indigo_front::packs::is_pack;
use indigo_front::status::{BAD_INPUT, FAILED, INTERRUPTED, RENDERED};
use indigo_igs::pack::{PACK_ENDING, Pack, PackLimits};
use indigo_render::atomic::write_atomically;
use indigo_render::disk::read_limited;
use indigo_scene::load_contents;
use std::cell::Cell;
use std::fs::File;
use std::io::{Error, ErrorKind, Write as _};
use std::path::Path;

/// Packs a scene; the exit status.
pub fn pack(arguments: &Arguments, console: &mut Console) -> u8 {
    // The command line was checked for just these.
    let [scene, output] = &arguments.files[..] else { return refuse("two files are expected", console) };
    if !is_pack(output) {
        return refuse(&format!("{output}: a name that ends in .{PACK_ENDING} is expected"), console);
    }
    if is_pack(scene) {
        return refuse(&format!("{scene} is packed already"), console);
    }
    let packed = with_load_options(scene, arguments, |options| {
        let loaded = load_contents(scene, options);
        let written = loaded.contents.as_ref().map(|contents| {
            let files = Cell::new(0);
            let written = write_atomically(Path::new(output), |file| {
                files.set(contents.pack(file, &loaded.sources, options.resolver)?);
                Ok(())
            });
            written.map(|()| files.get())
        });
        (loaded, written)
    });
    let ((loaded, written), _) = match packed {
        Ok(packed) => packed,
        Err(message) => return refuse_scene(scene, message, arguments, console),
    };
    if !tell_findings(scene, &loaded.sink, &loaded.sources, arguments, console) {
        return FAILED;
    }
    match written {
        Some(Ok(files)) => {
            console.say(&format!("Saved {output}: the scene and {}", count(files, "file")));
            RENDERED
        }
        Some(Err(error)) => {
            console.error(&format!("cannot write {output}: {error}"));
            FAILED
        }
        None => refuse("the scene is not packed", console),
    }
}

/// Unpacks a packed scene or material into a folder that is not there yet, or empty; the exit status.
pub fn unpack(arguments: &Arguments, console: &mut Console) -> u8 {
    let [path, folder] = &arguments.files[..] else { return refuse("two names are expected", console) };
    if folder.is_empty() {
        return refuse("the name of the folder to make is empty", console);
    }
    let opened = read_limited(Path::new(path))
        .map_err(|error| error.to_string())
        .and_then(|bytes| Pack::open(bytes.into(), &PackLimits::default()).map_err(|e| e.to_string()));
    let pack = match opened {
        Ok(pack) => pack,
        Err(error) => return refuse(&format!("{path}: {error}"), console),
    };
    let is_material = Path::new(path).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("pigm"));
    let main = match if is_material { pack.material() } else { pack.main() } {
        Ok(main) => main,
        Err(error) => return refuse(&format!("{path}: {error}"), console),
    };
    let (main, folder) = (main.to_owned(), Path::new(folder));
    match std::fs::read_dir(folder).map(|mut entries| entries.next().is_none()) {
        Ok(false) => {
            return refuse(&format!("{} is not empty; a new folder is expected", folder.display()), console);
        }
        Err(error) if error.kind() != ErrorKind::NotFound => {
            return refuse(&format!("{}: {error}", folder.display()), console);
        }
        _ => {}
    }
    match unpack_as_a_whole(&pack, folder) {
        Ok(()) => {
            console.say(&format!("Saved {}", folder.join(main).display()));
            RENDERED
        }
        Err(error) => {
            console.error(&error.to_string());
            match error.kind() {
                ErrorKind::InvalidData => BAD_INPUT,
                ErrorKind::Interrupted => INTERRUPTED,
                _ => FAILED,
            }
        }
    }
}

/// Says where an error is, too.
fn at(path: &Path) -> impl Fn(Error) -> Error {
    move |error| Error::new(error.kind(), format!("{}: {error}", path.display()))
}

fn write_new(path: &Path, content: &[u8]) -> std::io::Result<()> {
    path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
    let mut file = File::create_new(path)?;
    file.write_all(content)?;
    file.sync_all()
}

/// Writes all files into a folder beside the one to be, which takes its place when all are there.
fn unpack_as_a_whole(pack: &Pack, folder: &Path) -> std::io::Result<()> {
    let mut unfinished = folder.as_os_str().to_owned();
    unfinished.push(".unpacking");
    let unfinished = Path::new(&unfinished);
    if let Some(above) = folder.parent() {
        std::fs::create_dir_all(above).map_err(at(above))?;
    }
    std::fs::create_dir(unfinished).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Error::new(
            ErrorKind::AlreadyExists,
            format!(
                "{} is there: another is unpacking, or was killed; in that case remove it",
                unfinished.display()
            ),
        ),
        _ => at(unfinished)(error),
    })?;
    end_in_order();
    let written = pack.members().try_for_each(|(name, _)| {
        if is_interrupted() {
            return Err(Error::new(ErrorKind::Interrupted, "interrupted: nothing is unpacked"));
        }
        let content = pack.read(name).map_err(|error| Error::new(ErrorKind::InvalidData, error))?;
        let path = unfinished.join(name);
        write_new(&path, &content).map_err(at(&path))
    });
    let moved = written.and_then(|()| {
        // An empty folder of that name may be there.
        drop(std::fs::remove_dir(folder));
        std::fs::rename(unfinished, folder).map_err(at(folder))
    });
    if moved.is_err() {
        // Best effort: the error that matters is the one being returned.
        drop(std::fs::remove_dir_all(unfinished));
    }
    moved
}
