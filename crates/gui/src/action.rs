//! What the window is asked to do, by whichever panel or key asked for it.

use crate::engine::Command;
use indigo_render::output::OneFile;
use std::path::PathBuf;

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

/// What is to be done.
pub enum Action {
    /// Tell the engine.
    Command(Command),
    /// Open a file, by its ending.
    Open(PathBuf),
    /// Ask the user for a path.
    Ask(Ask),
    /// Load the scene again, with another mode.
    Restart,
    /// Read the scene's elements.
    ReadElements,
    /// Write what was changed in them.
    SaveElements,
    /// Write how the picture is developed into the scene.
    WriteSettings,
    /// Begin the queue, or go on with it.
    RunQueue,
    /// Close the window.
    Close,
}
