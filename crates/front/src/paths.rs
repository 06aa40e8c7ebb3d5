//! Where things are on this machine.

use indigo_render::calendar::Moment;
use indigo_render::output::OutputPaths;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Where the shape of the aperture is shown, in the folder of the picture.
pub const APERTURE_PREVIEW: &str = "aperture_preview.png";

/// The settings file: in the current directory, else beside the program.
pub fn inifile() -> Option<String> {
    const NAME: &str = "inifile.xml";
    let beside = program_directory().map(|d| d.join(NAME));
    std::iter::once(PathBuf::from(NAME)).chain(beside).find(|p| p.is_file()).map(|p| p.display().to_string())
}

/// Where files that come with the program are: the folder that the environment names, the program's own, and the
/// nearest one above it that holds the program's data.
pub fn resource_directories() -> Vec<PathBuf> {
    const DATA: &str = "data/camera_response_functions";
    let named = std::env::var_os("INDIGO_RESOURCES").map(PathBuf::from);
    let program = program_directory();
    let above = program.as_deref().and_then(|d| d.ancestors().find(|d| d.join(DATA).is_dir()));
    let above = above.filter(|above| program.as_deref() != Some(above)).map(Path::to_path_buf);
    named.into_iter().chain(program.clone()).chain(above).collect()
}

fn program_directory() -> Option<PathBuf> {
    Some(std::env::current_exe().ok()?.parent()?.to_path_buf())
}

/// Where built trees are kept.
pub fn tree_cache() -> PathBuf {
    cache().join("tree_cache")
}

/// Where a slave keeps the scenes of its masters.
pub fn pack_cache() -> PathBuf {
    cache().join("packs")
}

/// The directory of locks that stand for pictures that are being rendered.
pub fn claims() -> PathBuf {
    cache().join("claims")
}

/// The user's cache directory, or `INDIGO_CACHE`.
fn cache() -> PathBuf {
    let from = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
    let base = from("INDIGO_CACHE")
        .or_else(|| from("XDG_CACHE_HOME").map(|d| d.join("indigo")))
        .or_else(|| from("LOCALAPPDATA").map(|d| d.join("Indigo/cache")))
        .or_else(|| from("HOME").map(|d| d.join(".cache/indigo")));
    base.unwrap_or_else(std::env::temp_dir)
}

/// The picture's path from the one that the user gives: ending in `.png`, which may be left out.
///
/// # Errors
/// Why no picture can go there.
pub fn picture_named(given: &str) -> Result<PathBuf, String> {
    const ENDING: &str = "png";
    let path = Path::new(given);
    if given.is_empty() {
        return Err("the path of the picture is empty".to_owned());
    }
    if given.ends_with(['/', std::path::MAIN_SEPARATOR]) || path.file_name().is_none() {
        return Err("this is a directory; the path of a .png file is expected".to_owned());
    }
    check_writable_kind(path)?;
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case(ENDING) => Ok(path.to_path_buf()),
        Some(ending) => Err(format!(
            "the picture is a PNG: a path that ends in .{ENDING} is expected, not in .{}",
            ending.to_string_lossy()
        )),
        None => {
            let path = PathBuf::from(format!("{given}.{ENDING}"));
            check_writable_kind(&path)?;
            Ok(path)
        }
    }
}

/// What is there already must be a file, which can be replaced.
fn check_writable_kind(path: &Path) -> Result<(), String> {
    match std::fs::metadata(path) {
        Ok(meta) if meta.is_dir() => {
            Err("this is a directory; the path of a .png file is expected".to_owned())
        }
        Ok(meta) if !meta.is_file() => {
            Err("this is a device or the like; the path of a file is expected".to_owned())
        }
        // What is not there, or cannot be looked at, is told when it cannot be written.
        _ => Ok(()),
    }
}

/// A picture's path with an empty file that keeps others away from the name; an empty one is removed at
/// the end.
#[derive(Debug)]
pub struct Reserved {
    /// The path.
    pub path: PathBuf,
}

impl Drop for Reserved {
    fn drop(&mut self) {
        if std::fs::metadata(&self.path).is_ok_and(|meta| meta.len() == 0) {
            // At worst an empty file stays.
            drop(std::fs::remove_file(&self.path));
        }
    }
}

/// The picture's path where none is given: `renders/im_<UTC time>_<scene>.png`, with `-2`, `-3` and so on before the
/// ending where there is such a picture already, or another program is about to make it.
///
/// # Errors
/// What the system says if there can be no such file.
pub fn reserve_picture(scene: &str, now: SystemTime) -> std::io::Result<Reserved> {
    let mut number = 1;
    loop {
        let path = picture_of(scene, now, number);
        number += 1;
        let paths = OutputPaths::new(path.clone());
        if paths.siblings().iter().any(|p| p.exists()) {
            continue;
        }
        if let Some(directory) = path.parent() {
            std::fs::create_dir_all(directory)?;
        }
        match std::fs::File::create_new(&path) {
            Ok(_) => return Ok(Reserved { path }),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

fn picture_of(scene: &str, now: SystemTime, number: u32) -> PathBuf {
    let stem = Path::new(scene).file_stem().map_or_else(|| "scene".into(), |s| s.to_string_lossy());
    let number = if number > 1 { format!("-{number}") } else { String::new() };
    Path::new("renders").join(format!("im_{}_{stem}{number}.png", utc(now).replace(['-', ':'], "")))
}

/// A moment as 2008-03-25T14:23:01Z (ISO 8601).
pub fn utc(now: SystemTime) -> String {
    let Moment { date: [year, month, day], time: [hour, minute, second] } = Moment::of(now);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, UNIX_EPOCH};

    #[test]
    fn pictures_are_named_by_time_and_scene() {
        let at = |s| picture_of("a/b/box.igs", UNIX_EPOCH + Duration::from_secs(s), 1);
        assert_eq!(at(1_206_454_981), Path::new("renders/im_20080325T142301Z_box.png"));
        assert_eq!(at(951_782_400), Path::new("renders/im_20000229T000000Z_box.png"));
        assert_eq!(at(0), Path::new("renders/im_19700101T000000Z_box.png"));
    }
}
