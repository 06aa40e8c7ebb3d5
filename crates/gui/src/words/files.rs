//! What the window says of files and their paths: the third part of its list of words.

use crate::action::Ask;
use indigo_render::output::OneFile;
use std::path::Path;

/// A place in a file.
pub fn place(name: &str, line: usize) -> String {
    format!("{name}, line {line}")
}

/// A scene was loaded.
pub fn loaded(path: &str, seconds: f64) -> String {
    format!("Loaded {path} in {seconds:.2} s")
}

/// A scene with errors.
pub fn not_rendered(path: &str) -> String {
    format!("{path} cannot be rendered")
}

/// What another part of the picture costs.
pub fn lost_samples(samples_per_pixel: f64) -> String {
    format!(
        "{samples_per_pixel:.1} samples per pixel of the film are in no file and would be gone; a saved picture cannot be continued, nor developed otherwise. Saved as IGI it can."
    )
}

/// Nothing was written, for a reason.
pub fn nothing_saved(reason: &str) -> String {
    format!("Nothing was saved: {reason}")
}

/// Whose findings are shown, where another scene is open or none.
pub fn not_open(path: &str) -> String {
    format!("In {path}, which is not open:")
}

/// A film will be gone on with.
pub fn goes_on_with(path: &Path) -> String {
    format!("{} is a film of this scene: press Continue to add samples", path.display())
}

/// A film of another scene.
pub fn only_looked_at(path: &Path, reason: &str) -> String {
    format!("{} can be viewed but not continued: {reason}", path.display())
}

/// A path that is no text.
pub fn not_text(path: &Path) -> String {
    format!("The path {} is not valid Unicode", path.display())
}

/// A file was written.
pub fn saved(path: &Path) -> String {
    format!("Saved {}", path.display())
}

/// What a path is asked for.
pub fn asked_for(ask: Ask) -> &'static str {
    match ask {
        Ask::Open => "Open a scene or film",
        Ask::Save(OneFile::Picture) => "Save the picture as PNG",
        Ask::Save(OneFile::Luminances) => "Save the luminances as EXR",
        Ask::Save(OneFile::Film) => "Save the film as IGI",
        Ask::Compare => "Compare with a saved picture",
        Ask::Queue => "Add a scene to the queue",
        Ask::Key => "Choose a key file",
        Ask::NewKey => "Save a new key",
    }
}

/// The button that takes it.
pub fn answer(ask: Ask) -> &'static str {
    match ask {
        Ask::Open | Ask::Compare => "Open",
        Ask::Save(_) | Ask::NewKey => "Save",
        Ask::Queue => "Add",
        Ask::Key => "Choose",
    }
}

/// A folder where a file is expected.
pub fn is_folder(path: &Path) -> String {
    format!("{} is a folder: expected a file", path.display())
}

/// No such folder.
pub fn no_folder(path: &Path) -> String {
    format!("There is no folder {}", path.display())
}

/// No such file.
pub fn no_file(path: &Path) -> String {
    format!("There is no file {}", path.display())
}

/// A file that would be written over.
pub fn is_there(path: &Path) -> String {
    format!("{} is there already: save once more to replace it", path.display())
}

/// Changed elements of a scene that is not open any more.
pub fn set_aside(n: usize, path: &str) -> String {
    let changes = indigo_front::messages::count(n, "change");
    format!(
        "Not saved yet: {changes} to the elements of {path}; open it again to see them, or save them when the window closes"
    )
}

/// Something failed that must not.
pub fn failed_by_bug(message: &str) -> String {
    format!("an error of the program, which is a bug, please report it: {message}")
}

/// Nobody hears of the end of a session.
pub fn no_signals(reason: &str) -> String {
    format!("a render will not be saved when the session ends: {reason}")
}

/// Films that could not be saved and would be lost.
pub fn unsaved_films(n: usize) -> String {
    match n {
        1 => "Its film is in memory only and would be lost. The log says what went wrong.".to_owned(),
        n => format!(
            "The films of {n} renders are in memory only and would be lost. The log says what went wrong."
        ),
    }
}

/// The ending of a file.
pub fn ending(what: OneFile) -> &'static str {
    match what {
        OneFile::Picture => "png",
        OneFile::Luminances => "exr",
        OneFile::Film => "igi",
    }
}

/// A file in the place of a new key.
pub fn key_is_there(path: &Path) -> String {
    format!("{} is there already and will not be replaced: choose another name", path.display())
}

/// A packed scene cannot be changed.
pub fn packed(path: &str) -> String {
    format!("{path} is packed: to change it, unpack it with indigo_console --unpack")
}

/// A scene that cannot be read.
pub fn unreadable(path: &str) -> String {
    format!("{path} cannot be read")
}

/// A file is another than the one that was read.
pub fn changed_elsewhere(path: &str) -> String {
    format!("{path} was changed elsewhere, so nothing was saved; it is read again: save once more")
}

/// A file that nobody is to write to.
pub fn read_only(path: &str) -> String {
    format!("{path} is read-only")
}

/// A key was made.
pub fn key_made(path: &Path) -> String {
    format!(
        "Saved {}: copy it to all machines of the render in a way that nobody else can see",
        path.display()
    )
}
