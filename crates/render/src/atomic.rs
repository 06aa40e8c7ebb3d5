//! Writing files so that a crash, a kill or a full disk at any moment leaves the old file or the new one, never
//! half of one.
//!
//! A file is written under a temporary name, synced, and renamed. Whoever dies on the way leaves the temporary
//! file; the next save into the same directory removes it. A living writer holds a lock on its temporary
//! file, which ends with it however it ends: so only what nobody writes any more is removed, and only files of
//! such names. A temporary file's name has the number of the process and one that the process gives but once, and the
//! file is made only where there is none of that name: nobody ever writes into another's.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The ending of temporary files, behind the name of the file to be and two numbers.
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
    write_temporary(&directory, path, &write)?;
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
    // Kept open, and so locked, until it is gone.
    let (_file, temporary) = new_temporary(&directory, path)?;
    let removed = std::fs::remove_file(&temporary);
    forget(&temporary);
    removed
}

fn directory_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(d) if !d.as_os_str().is_empty() => d.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// The temporary files of this process. Held where a file is made and locked, and where one without a lock is removed.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(vec![]);

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all temporary files of this process, as it is about to end: whoever begins to write from now on waits for that.
pub fn abandon() {
    let mut unfinished = unfinished();
    for temporary in unfinished.drain(..) {
        // It may just have taken its place.
        drop(std::fs::remove_file(temporary));
    }
    std::mem::forget(unfinished);
}

/// A temporary file is finished, or given up.
fn forget(temporary: &Path) {
    unfinished().retain(|other| other != temporary);
}

/// A new file beside the one to be, locked.
fn new_temporary(directory: &Path, path: &Path) -> io::Result<(File, PathBuf)> {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let mut unfinished = unfinished();
    loop {
        let mut name = path.file_name().unwrap_or_default().to_os_string();
        name.push(format!(".{}.{}{ENDING}", std::process::id(), NUMBER.fetch_add(1, Ordering::Relaxed)));
        let temporary = directory.join(name);
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            // Of a process of the same number: a dead one's, or one's on another machine that shares the disk.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            made => {
                let file = made?;
                // Where there are no locks, nobody can take the file for stale either. Another process may have done so
                // before it was locked: that one has the lock, or has removed the file.
                let is_ours = !matches!(file.try_lock(), Err(TryLockError::WouldBlock));
                if is_ours && std::fs::exists(&temporary)? {
                    unfinished.push(temporary.clone());
                    return Ok((file, temporary));
                }
            }
        }
    }
}

fn write_temporary(
    directory: &Path,
    path: &Path,
    write: &impl Fn(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let (file, temporary) = new_temporary(directory, path)?;
    let written = fill(&file, write).and_then(|()| std::fs::rename(&temporary, path));
    if written.is_err() {
        // Best effort: the error that matters is the one being returned.
        drop(std::fs::remove_file(&temporary));
    }
    forget(&temporary);
    written
}

fn fill(file: &File, write: &impl Fn(&mut BufWriter<&File>) -> io::Result<()>) -> io::Result<()> {
    let mut buffered = BufWriter::with_capacity(1 << 16, file);
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    file.sync_all()
}

/// Removes temporary files that nobody writes any more.
fn remove_stale(directory: &Path) {
    let Ok(entries) = std::fs::read_dir(directory) else { return };
    for entry in entries.filter_map(Result::ok).filter(|e| is_temporary(&e.file_name().to_string_lossy())) {
        let _making = unfinished();
        remove_unless_locked(&entry.path());
    }
}

/// Removes a file that nobody has locked, and keeps it locked until it is gone: who has just made it sees one or the other.
fn remove_unless_locked(path: &Path) {
    let Ok(file) = OpenOptions::new().read(true).open(path) else { return };
    if file.try_lock().is_ok() {
        // Another process may be faster.
        drop(std::fs::remove_file(path));
    }
}

/// Whether a file has a name such as only this module gives.
fn is_temporary(name: &str) -> bool {
    let is_number = |n: &str| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit());
    let mut parts = name.strip_suffix(ENDING).unwrap_or_default().rsplitn(3, '.');
    let numbers = [parts.next(), parts.next()];
    numbers.iter().all(|n| n.is_some_and(is_number)) && parts.next().is_some_and(|stem| !stem.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;

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

    /// Names in a directory, sorted.
    fn names(root: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(root).unwrap();
        let mut names: Vec<String> =
            entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn what_the_dead_left_is_removed_and_nothing_else() {
        let root = scratch("stale");
        let kept = [
            "a.png.tmp",
            "a.png.12.7.tmp",
            "a.png.12.indigo.tmp",
            "12.7.indigo.tmp",
            "a.x.7.indigo.tmp",
            "a.png",
        ];
        for name in kept.iter().chain(&["b.png.4711.0.indigo.tmp"]) {
            std::fs::write(root.join(name), b"x").unwrap();
        }
        let living = File::create(root.join("c.png.4712.3.indigo.tmp")).unwrap();
        living.lock().unwrap();
        put(&root.join("d.png"), b"new").unwrap();
        let mut expected: Vec<&str> = kept.to_vec();
        expected.extend(["c.png.4712.3.indigo.tmp", "d.png"]);
        expected.sort_unstable();
        assert_eq!(names(&root), expected);
        drop(living);
        std::fs::remove_dir_all(root).unwrap();
    }

    /// Saves of one name at once, in one process: each is whole, and the last one stays.
    #[test]
    fn saves_of_one_name_do_not_mix() {
        let root = scratch("together");
        let path = root.join("a.png");
        std::thread::scope(|scope| {
            for byte in 0..8u8 {
                let path = &path;
                scope.spawn(move || {
                    for _ in 0..10 {
                        let bytes = vec![byte; 1 << 18];
                        write_atomically(path, |file| bytes.chunks(999).try_for_each(|c| file.write_all(c)))
                            .unwrap();
                        let read = std::fs::read(path).unwrap();
                        assert!(read.len() == 1 << 18 && read.iter().all(|b| *b == read[0]));
                    }
                });
            }
        });
        assert_eq!(names(&root), ["a.png"]);
        std::fs::remove_dir_all(root).unwrap();
    }

    /// Another process looks for what the dead left all the while, and sees files before they are locked.
    #[test]
    fn who_removes_what_is_stale_takes_nothing_of_the_living() {
        let root = scratch("remover");
        let path = root.join("a.png");
        let is_done = AtomicBool::new(false);
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| {
                    while !is_done.load(Ordering::Relaxed) {
                        for entry in std::fs::read_dir(&root).unwrap().filter_map(Result::ok) {
                            if is_temporary(&entry.file_name().to_string_lossy()) {
                                remove_unless_locked(&entry.path());
                            }
                        }
                    }
                });
            }
            let put_all = || {
                (0..600).try_for_each(|i: u32| {
                    check_writable(&path)?;
                    put(&path, &i.to_le_bytes())
                })
            };
            let result = std::panic::catch_unwind(put_all);
            is_done.store(true, Ordering::Relaxed);
            result.unwrap().unwrap();
        });
        assert_eq!(names(&root), ["a.png"]);
        std::fs::remove_dir_all(root).unwrap();
    }

    /// The number of a process that died may be that of one that lives.
    #[test]
    fn a_dead_ones_file_of_the_same_number_is_not_written_into() {
        let root = scratch("number");
        let path = root.join("a.png");
        let (file, first) = new_temporary(&root, &path).unwrap();
        let next = |name: &Path| {
            let text = name.to_string_lossy().into_owned();
            let (stem, number) = text.strip_suffix(ENDING).unwrap().rsplit_once('.').unwrap();
            PathBuf::from(format!("{stem}.{}{ENDING}", number.parse::<u64>().unwrap() + 1))
        };
        // The numbers that come next are taken; other tests may draw some in between.
        let mut taken = first.clone();
        for _ in 0..50 {
            taken = next(&taken);
            std::fs::write(&taken, b"another's").unwrap();
        }
        let (_, second) = new_temporary(&root, &path).unwrap();
        assert!(std::fs::read(&second).unwrap().is_empty() && second != first);
        drop(file);
        std::fs::remove_dir_all(root).unwrap();
    }
}
