//! A picture's name is one render's at a time: two would write over each other's film, again and again; and what is added up or
//! developed meanwhile would be gone with the next save.

use crate::messages::Messages;
use crate::paths;
use crate::status::FAILED;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

/// Keeps other programs of this user on this machine from a name, as long as it lives: by a lock, which ends with the
/// process however that ends.
pub struct Claim {
    _lock: Option<File>,
}

impl Claim {
    /// Claims the name of a film, which stands for all files of a render: pictures that differ in it only share the film. The
    /// film's folder must be there.
    ///
    /// # Errors
    /// The exit status where another render has it; that was told.
    pub fn of(film: &Path, messages: &mut dyn Messages) -> Result<Self, u8> {
        let locked = open(film).map_err(TryLockError::Error).and_then(|file| file.try_lock().map(|()| file));
        match locked {
            Ok(file) => Ok(Self { _lock: Some(file) }),
            Err(TryLockError::WouldBlock) => {
                messages.error(&format!(
                    "another render writes {}: give this one another name (-o)",
                    film.display()
                ));
                Err(FAILED)
            }
            // Where there can be no lock, nothing is known of others.
            Err(TryLockError::Error(error)) => {
                messages.warn(&format!(
                    "whether another render writes {} cannot be told: no lock can be kept in {}: {error}; the variable \
                     INDIGO_CACHE may name another folder for that",
                    film.display(),
                    paths::claims().display()
                ));
                Ok(Self { _lock: None })
            }
        }
    }

    /// The same for what is only written once, perhaps into a folder that is not there yet, and so nobody else's.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn for_moment(film: &Path, messages: &mut dyn Messages) -> Result<Self, u8> {
        if above(film).is_dir() { Self::of(film, messages) } else { Ok(Self { _lock: None }) }
    }
}

/// The file whose lock stands for a film. It stays: whoever removed it could take away another's.
fn open(film: &Path) -> std::io::Result<File> {
    let place = place(film)?;
    // FNV-1a, of 64 bits: the same in all builds. Names that meet would keep each other out, and do no other harm.
    let hash = place.as_os_str().as_encoded_bytes().iter().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    });
    let folder = paths::claims();
    std::fs::create_dir_all(&folder)?;
    let name = format!("{hash:016x}");
    File::options().create(true).truncate(false).write(true).open(folder.join(name))
}

/// The same for all names of a file that may not be there yet.
fn place(file: &Path) -> std::io::Result<PathBuf> {
    Ok(above(file).canonicalize()?.join(file.file_name().unwrap_or_default()))
}

fn above(file: &Path) -> &Path {
    file.parent().filter(|above| !above.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
