//! Rendering on many machines, from the command line.

mod master;
mod own;
mod scene;
mod slave;

pub use master::master;
pub use slave::slave;

use crate::console::Console;
use indigo_front::flags::Arguments;
use indigo_front::messages::Messages as _;
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_net::NetError;
use indigo_net::event::{Event, Sink};
use indigo_net::key::Key;
use indigo_render::disk::read_limited;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// How long Ctrl-C may go unnoticed on a master.
const PULSE: Duration = Duration::from_millis(50);
/// The variable that holds a key.
const KEY: &str = "INDIGO_KEY";

/// Makes a key; the exit status.
pub fn make_key(path: &Path, console: &mut Console) -> u8 {
    let key = match Key::random() {
        Ok(key) => key,
        Err(error) => {
            console.error(&error.to_string());
            return FAILED;
        }
    };
    let mut options = OpenOptions::new();
    // Never in the place of a key that machines share already.
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let written = options.open(path).and_then(|mut file| {
        writeln!(file, "{}", key.text())?;
        file.sync_all()
    });
    match written {
        Ok(()) => {
            console.say(&format!(
                "Saved {0}: copy it to all machines of the render by a way that nobody else sees, and give it to master and \
                 slaves by --key-file {0}",
                in_shell(path)
            ));
            RENDERED
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            let path = path.display();
            console.error(&format!(
                "{path} is there already, and a key is never written over: give another name"
            ));
            FAILED
        }
        Err(error) => {
            console.error(&format!("cannot write {}: {error}", path.display()));
            FAILED
        }
    }
}

/// A path as it can be copied into a shell.
fn in_shell(path: &Path) -> String {
    let path = path.display().to_string();
    if path.contains([' ', '&', '(', ')', ';']) { format!("\"{path}\"") } else { path }
}

/// What people call this machine.
fn machine() -> String {
    let from_system = std::fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let named = ["HOSTNAME", "COMPUTERNAME"].into_iter().find_map(|name| std::env::var(name).ok());
    from_system
        .or(named)
        .map(|name| name.trim().to_owned())
        .filter(|name| !name.is_empty())
        .unwrap_or_default()
}

/// The shared key, if there is one.
///
/// # Errors
/// The exit status where what is given is none; the reason was told.
fn key(arguments: &Arguments, console: &mut Console) -> Result<Option<Key>, u8> {
    let (source, text) = match (&arguments.key_file, std::env::var(KEY)) {
        (Some(file), _) => {
            let bytes = read_limited(Path::new(file)).map_err(|error| {
                console.error(&format!("cannot read the key {file}: {error}"));
                FAILED
            })?;
            warn_of_readers(Path::new(file), console);
            (file.as_str(), String::from_utf8_lossy(&bytes).into_owned())
        }
        (None, Ok(text)) if !text.is_empty() => (KEY, text),
        _ => return Ok(None),
    };
    Key::parse(&text).map(Some).map_err(|error| {
        console.error(&format!("{source}: {error}"));
        BAD_INPUT
    })
}

/// A key that others on the machine can read is no secret.
#[cfg(unix)]
fn warn_of_readers(file: &Path, console: &mut Console) {
    use std::os::unix::fs::PermissionsExt as _;
    if std::fs::metadata(file).is_ok_and(|meta| meta.permissions().mode() & 0o077 != 0) {
        console.warn(&format!("others on this machine may read the key: chmod 600 {}", file.display()));
    }
}

#[cfg(not(unix))]
fn warn_of_readers(_file: &Path, _console: &mut Console) {}

/// Where events go from the threads of the network, and where they come from here.
fn events() -> (Sink, Receiver<Event>) {
    let (give, take) = channel();
    // At the end nobody listens any more.
    (Arc::new(move |event| drop(give.send(event))), take)
}

/// Says why there is no master or slave; the exit status.
fn fail(error: &NetError, console: &mut Console) -> u8 {
    console.error(&error.to_string());
    FAILED
}
