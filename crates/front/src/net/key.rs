//! Files of keys.

use crate::flags::Arguments;
use crate::messages::Messages;
use crate::status::{BAD_INPUT, FAILED};
use indigo_net::key::Key;
use indigo_render::atomic::write_atomically;
use indigo_render::disk::read_limited;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::Path;

/// The variable that holds a key.
const KEY: &str = "INDIGO_KEY";

/// Makes a key, in a file that nobody else may read.
///
/// # Errors
/// Why there is none, in words.
pub fn make_key(path: &Path) -> Result<(), String> {
    let key = Key::random().map_err(|error| error.to_string())?;
    if let Some(folder) = path.parent() {
        let made = std::fs::create_dir_all(folder);
        made.map_err(|error| format!("cannot make the folder {}: {error}", folder.display()))?;
    }
    let written = write_key(path, &key);
    let path = path.display();
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            format!("{path} is there already, and a key is never written over: give another name")
        }
        _ => format!("cannot write {path}: {error}"),
    })
}

/// All of it or nothing, and never in the place of a key that machines share already.
fn write_key(path: &Path, key: &Key) -> std::io::Result<()> {
    // Who takes the name first has it.
    OpenOptions::new().write(true).create_new(true).open(path)?;
    let written = write_atomically(path, |file| {
        for_us_alone(file.get_ref())?;
        writeln!(file, "{}", key.text())
    });
    written.inspect_err(|_| {
        // Nothing is in it; where it stays somebody has to remove it.
        drop(std::fs::remove_file(path));
    })
}

/// Nobody else may read a file.
#[cfg(unix)]
fn for_us_alone(file: &File) -> std::io::Result<()> {
    file.set_permissions(std::os::unix::fs::PermissionsExt::from_mode(0o600))
}

#[cfg(not(unix))]
fn for_us_alone(_file: &File) -> std::io::Result<()> {
    Ok(())
}

/// The shared key, if there is one.
///
/// # Errors
/// The exit status where what is given is none; the reason was told.
pub fn key(arguments: &Arguments, messages: &mut dyn Messages) -> Result<Option<Key>, u8> {
    let (source, text) = match (&arguments.key_file, std::env::var(KEY)) {
        (Some(file), _) => {
            let bytes = read_limited(Path::new(file)).map_err(|error| {
                messages.error(&format!("cannot read the key {file}: {error}"));
                FAILED
            })?;
            warn_of_readers(Path::new(file), messages);
            (file.as_str(), String::from_utf8_lossy(&bytes).into_owned())
        }
        (None, Ok(text)) if !text.is_empty() => (KEY, text),
        _ => return Ok(None),
    };
    Key::parse(&text).map(Some).map_err(|error| {
        messages.error(&format!("{source}: {error}"));
        BAD_INPUT
    })
}

/// A key that others on the machine can read is no secret.
#[cfg(unix)]
fn warn_of_readers(file: &Path, messages: &mut dyn Messages) {
    use std::os::unix::fs::PermissionsExt as _;
    if std::fs::metadata(file).is_ok_and(|meta| meta.permissions().mode() & 0o077 != 0) {
        messages.warn(&format!("others on this machine may read the key: chmod 600 {}", file.display()));
    }
}

#[cfg(not(unix))]
fn warn_of_readers(_file: &Path, _messages: &mut dyn Messages) {}
