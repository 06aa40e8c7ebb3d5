//! What the window is asked to do, by whichever panel or key asked for it.

use crate::engine::Command;
use crate::question::PathLine;
use crate::words;
use indigo_render::output::OneFile;
use std::path::{Path, PathBuf};

/// Endings of scenes.
pub const SCENES: &[&str] = &["igs", "pigs"];
/// Endings of pictures to compare with.
pub const PICTURES: &[&str] = &["png", "exr", "jpg", "jpeg", "tif", "tiff", "hdr"];

/// What a dialog asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// A scene or a film to open.
    Open,
    /// Where to write a file.
    Save(OneFile),
    /// A picture to compare with.
    Compare,
    /// Scenes for the queue.
    Queue,
    /// The file of a key.
    Key,
    /// Where to write a new key.
    NewKey,
}

impl Ask {
    /// Whether a file is to be written there.
    pub fn writes(self) -> bool {
        matches!(self, Self::Save(_) | Self::NewKey)
    }

    /// A path that was given, which gets the ending of its kind where it has another or none.
    pub fn completed(self, path: PathBuf) -> PathBuf {
        match self {
            Self::Save(what) if !has_ending(&path, &[words::ending(what)]) => {
                let mut longer = path.into_os_string();
                longer.push(".");
                longer.push(words::ending(what));
                longer.into()
            }
            _ => path,
        }
    }
}

/// What is to be done.
pub enum Action {
    /// Tell the engine.
    Command(Command),
    /// Open a file, by its ending.
    Open(PathBuf),
    /// Ask the user for a path.
    Ask(Ask),
    /// Take a path for what was asked.
    Asked(Ask, PathBuf),
    /// Load the scene anew that was asked for last, as it is rendered now.
    Restart,
    /// Read the scene's elements.
    ReadElements,
    /// Write what was changed in them; what is done then.
    SaveElements(Box<Action>),
    /// Write how the picture is developed into the scene.
    WriteSettings,
    /// Look whether a path that was typed can be what was asked for; the number is that of the try.
    CheckPath(u64, Box<PathLine>),
    /// Read a response curve, by its name, from a file.
    ReadResponse(String, PathBuf),
    /// Begin the queue, or go on with it, by hand.
    RunQueue,
    /// Begin the next scene of the queue, whether or not anybody is there.
    NextInQueue,
    /// Close the window if nothing stands against it.
    TryToClose,
    /// Close the window.
    Close,
}

impl Action {
    /// Whether the scene that is open is open no longer then, or read anew.
    pub fn leaves_scene(&self) -> bool {
        match self {
            Self::Open(path) => !has_ending(path, PICTURES),
            Self::Restart | Self::RunQueue | Self::TryToClose => true,
            _ => false,
        }
    }

    /// Whether the film that was rendered last is not there any more then.
    pub fn leaves_film(&self) -> bool {
        match self {
            // It is asked for before anything is written.
            Self::SaveElements(then) => then.leaves_film(),
            Self::Command(Command::SetRegion(..)) => true,
            _ => self.leaves_scene(),
        }
    }
}

/// Whether a path has one of some endings.
pub fn has_ending(path: &Path, endings: &[&str]) -> bool {
    path.extension().is_some_and(|ending| endings.iter().any(|one| ending.eq_ignore_ascii_case(one)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_get_the_ending_of_their_kind() {
        let completed = |what, path: &str| Ask::Save(what).completed(path.into());
        assert_eq!(completed(OneFile::Luminances, "a/b"), PathBuf::from("a/b.exr"));
        assert_eq!(completed(OneFile::Picture, "a/b.PNG"), PathBuf::from("a/b.PNG"));
        assert_eq!(completed(OneFile::Picture, "a/b.jpg"), PathBuf::from("a/b.jpg.png"));
        assert_eq!(completed(OneFile::Luminances, "a/b.igi"), PathBuf::from("a/b.igi.exr"));
        assert_eq!(Ask::NewKey.completed("key".into()), PathBuf::from("key"));
    }
}
