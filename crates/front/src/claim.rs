//! A picture's name is one render's at a time: two would write over each other's film, again and again.

use crate::messages::Messages;
use crate::paths;
use crate::status::FAILED;
use std::fs::{File, TryLockError};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};

/// Keeps other renders of this user on this machine from a name, as long as it lives: by a lock, which ends with the
/// process however that ends.
pub struct Claim {
    _lock: Option<File>,
}

impl Claim {
    /// Claims the name of a picture.
    ///
    /// # Errors
    /// The exit status where another render has it; that was told.
    pub fn of(picture: &Path, messages: &mut dyn Messages) -> Result<Self, u8> {
        // Where there can be no lock, nothing is known of others.
        let Ok(file) = open(picture) else { return Ok(Self { _lock: None }) };
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                messages.error(&format!(
                    "another render writes {}: give this one another name (-o)",
                    picture.display()
                ));
                Err(FAILED)
            }
            locked => Ok(Self { _lock: locked.ok().map(|()| file) }),
        }
    }
}

/// The file whose lock stands for a picture. It stays: whoever removed it could take away another's.
fn open(picture: &Path) -> std::io::Result<File> {
    let mut hasher = DefaultHasher::new();
    place(picture)?.hash(&mut hasher);
    let folder = paths::claims();
    std::fs::create_dir_all(&folder)?;
    let name = format!("{:016x}", hasher.finish());
    File::options().create(true).truncate(false).write(true).open(folder.join(name))
}

/// The same for all names of a file that may not be there yet.
fn place(picture: &Path) -> std::io::Result<PathBuf> {
    let above = picture.parent().filter(|above| !above.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Ok(above.canonicalize()?.join(picture.file_name().unwrap_or_default()))
}
