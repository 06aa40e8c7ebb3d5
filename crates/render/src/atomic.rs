//! Writing files so that a crash, a kill or a full disk at any moment leaves the old file or the new one, never
//! half of one.
//!
//! A file is written under a temporary name, synced, and renamed. Whoever dies on the way leaves the temporary
//! file; the next save into the same directory removes it. A living writer holds a lock on its temporary
//! file, which ends with it however it ends: so only what nobody writes any more is removed, and only files of
//! such names.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The ending of temporary files, behind the name of the file to be and the number of the process.
const ENDING: &str = ".indigo.tmp";

/// Writes a file as a whole, with directories above it as needed.
///
/// # Errors
/// What the system or `write` says; the old file is untouched then.
pub fn write_atomically(
    path: &Path,
    write: impl Fn(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let directory = directory_of(path);
    std::fs::create_dir_all(&directory)?;
    remove_stale(&directory);
    let temporary = temporary_of(path, &directory);
    let written = match write_temporary(&temporary, path, &write) {
        // Another process took it for stale in the instant between its making and its lock.
        Err(error) if error.kind() == ErrorKind::NotFound => write_temporary(&temporary, path, &write),
        other => other,
    };
    if written.is_err() {
        // Best effort: the error that matters is the one being returned.
        drop(std::fs::remove_file(&temporary));
        return written;
    }
    // The rename itself must reach the disk; not every file system can sync a directory.
    if let Ok(d) = File::open(&directory) {
        drop(d.sync_all());
    }
    Ok(())
}

/// Whether a file could be written: makes the directories above it, and a temporary file beside it for a
/// moment.
///
/// # Errors
/// What the system says.
pub fn check_writable(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    let directory = directory_of(path);
    std::fs::create_dir_all(&directory)?;
    let temporary = temporary_of(path, &directory);
    File::create(&temporary)?;
    std::fs::remove_file(&temporary)
}

fn directory_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(d) if !d.as_os_str().is_empty() => d.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// The process number keeps two programs that write the same picture apart.
fn temporary_of(path: &Path, directory: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}{ENDING}", std::process::id()));
    directory.join(name)
}

fn write_temporary(
    temporary: &Path,
    path: &Path,
    write: &impl Fn(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let file = File::create(temporary)?;
    // Where there are no locks, nobody can take the file for stale either.
    drop(file.try_lock());
    let mut buffered = BufWriter::with_capacity(1 << 16, &file);
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    file.sync_all()?;
    std::fs::rename(temporary, path)
}

/// Removes temporary files that nobody writes any more.
fn remove_stale(directory: &Path) {
    let Ok(entries) = std::fs::read_dir(directory) else { return };
    for entry in entries.filter_map(Result::ok).filter(|e| is_temporary(&e.file_name().to_string_lossy())) {
        let path = entry.path();
        let unlocked = OpenOptions::new().read(true).open(&path).is_ok_and(|file| file.try_lock().is_ok());
        if unlocked {
            // Another process may be faster.
            drop(std::fs::remove_file(path));
        }
    }
}

/// Whether a file has a name such as only this module gives.
fn is_temporary(name: &str) -> bool {
    let number = name.strip_suffix(ENDING).and_then(|n| n.rsplit_once('.'));
    number.is_some_and(|(stem, n)| !stem.is_empty() && !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        let directory = std::env::temp_dir().join(format!("indigo-atomic-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&directory).unwrap();
        directory
    }

    fn put(path: &Path, bytes: &[u8]) -> io::Result<()> {
        write_atomically(path, |file| file.write_all(bytes))
    }

    #[test]
    fn writing_replaces_as_a_whole_and_leaves_nothing_behind() {
        let root = scratch("write");
        let path = root.join("new/dir/picture.png");
        put(&path, b"one").unwrap();
        put(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
        // A directory in the way: the error is told, and no temporary file stays.
        let blocked = root.join("new/dir");
        assert!(put(&blocked, b"x").is_err());
        assert!(check_writable(&blocked).is_err());
        assert_eq!(std::fs::read_dir(root.join("new")).unwrap().count(), 1);
        // A writer that fails half way leaves the old file.
        let fails = write_atomically(&path, |file| {
            file.write_all(b"half")?;
            Err(ErrorKind::StorageFull.into())
        });
        assert_eq!(fails.unwrap_err().kind(), ErrorKind::StorageFull);
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        check_writable(&path).unwrap();
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
        std::fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn what_the_dead_left_is_removed_and_nothing_else() {
        let root = scratch("stale");
        let kept = ["a.png.tmp", "a.png.12.tmp", "12.indigo.tmp", "a.x.indigo.tmp", "a.png"];
        for name in kept.iter().chain(&["b.png.4711.indigo.tmp"]) {
            std::fs::write(root.join(name), b"x").unwrap();
        }
        let living = File::create(root.join("c.png.4712.indigo.tmp")).unwrap();
        living.lock().unwrap();
        put(&root.join("d.png"), b"new").unwrap();
        let mut names: Vec<String> = std::fs::read_dir(&root)
            .unwrap()
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        let mut expected: Vec<&str> = kept.to_vec();
        expected.extend(["c.png.4712.indigo.tmp", "d.png"]);
        expected.sort_unstable();
        assert_eq!(names, expected);
        drop(living);
        std::fs::remove_dir_all(root).unwrap();
    }
}
