//! The desktop's own dialogs for paths.

use crate::action::{Ask, PICTURES, SCENES};
use crate::words;
use std::path::PathBuf;

/// The desktop has no dialogs that can be reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoDialog;

/// What is asked for, and what is shown at first.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// What it is for.
    pub ask: Ask,
    /// The folder that it is likely to be in.
    pub folder: Option<PathBuf>,
    /// The name of a file to be written; empty: none is guessed.
    pub name: String,
}

/// Asks, and waits for the answer: the path, if one was chosen.
///
/// # Errors
/// Where nobody can be asked. The library that asks does not tell that from an answer, so it is found out before.
pub fn choose(wanted: &Wanted) -> Result<Option<PathBuf>, NoDialog> {
    if !is_there() {
        return Err(NoDialog);
    }
    let dialog = rfd::AsyncFileDialog::new();
    let dialog = match &wanted.folder {
        Some(folder) => dialog.set_directory(folder),
        None => dialog,
    };
    let dialog = match wanted.ask {
        Ask::Open => dialog.add_filter(words::SCENES_AND_FILMS, &["igs", "pigs", "igi"]),
        Ask::Queue => dialog.add_filter(words::SCENES, SCENES),
        Ask::Compare => dialog.add_filter(words::PICTURES, PICTURES),
        Ask::Save(what) => dialog.add_filter(words::ending(what), &[words::ending(what)]),
        Ask::Key | Ask::NewKey => dialog,
    };
    let file = if wanted.ask.writes() {
        pollster::block_on(dialog.set_file_name(&wanted.name).save_file())
    } else {
        pollster::block_on(dialog.pick_file())
    };
    Ok(file.map(|file| file.path().to_path_buf()))
}

/// Whether the desktop can ask: everywhere but under X11 and Wayland, where it does by a portal or the program `zenity`.
#[cfg(not(all(unix, not(target_os = "macos"))))]
fn is_there() -> bool {
    true
}

#[cfg(all(unix, not(target_os = "macos")))]
fn is_there() -> bool {
    let has_zenity = |folders| std::env::split_paths(&folders).any(|folder| folder.join("zenity").is_file());
    has_portal() || std::env::var_os("PATH").is_some_and(has_zenity)
}

/// Whether a program answers for dialogs of files, which the version of that part of the portal shows.
#[cfg(all(unix, not(target_os = "macos")))]
fn has_portal() -> bool {
    let version = async {
        let bus = zbus::Connection::session().await?;
        bus.call_method(
            Some("org.freedesktop.portal.Desktop"),
            "/org/freedesktop/portal/desktop",
            Some("org.freedesktop.DBus.Properties"),
            "Get",
            &("org.freedesktop.portal.FileChooser", "version"),
        )
        .await
    };
    pollster::block_on(version).is_ok()
}
