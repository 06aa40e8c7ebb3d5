//! Films that outlive their session: what is said of them in a file, and how they are read back.

use crate::disk::open_limited;
use crate::pool::with_jobs;
use indigo_film::igi::{IgiError, IgiFile};
use indigo_film::{DevelopedFilm, FilmRecord, FilmSize, FilmState, Mismatch, SavedFilm};
use indigo_imaging::PictureSettings;
use indigo_scene::Scene;
use indigo_transport::driver::Driver;
use std::path::{Path, PathBuf};

/// Why films could not be read or added.
#[derive(Debug, thiserror::Error)]
pub enum FilmFileError {
    /// The file cannot be read.
    #[error("cannot read {}: {source}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file holds no film.
    #[error("{}: {source}", .path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: IgiError,
    },
    /// The film is of another picture.
    #[error("{}: {}", .path.display(), lines(.reasons))]
    Mismatch {
        /// The file.
        path: PathBuf,
        /// Everything that differs.
        reasons: Vec<Mismatch>,
    },
}

/// Reasons, a line each.
pub(crate) fn lines(reasons: &[Mismatch]) -> String {
    let words: Vec<String> = reasons.iter().map(ToString::to_string).collect();
    words.join("\n  ")
}

/// Reads an Indigo image.
///
/// # Errors
/// Where the file cannot be read, or is no sound Indigo image.
pub fn read_film(path: &Path) -> Result<SavedFilm, FilmFileError> {
    with_jobs(usize::MAX, || made_of(path, IgiFile::film))
}

/// Reads an Indigo image and develops it, in a third of the memory of the film; meanwhile `settings` are prepared for its
/// picture, which is expected to be of a size.
///
/// # Errors
/// As [`read_film`].
pub fn develop_film(
    path: &Path,
    settings: &PictureSettings,
    expected: FilmSize,
) -> Result<DevelopedFilm, FilmFileError> {
    with_jobs(usize::MAX, || {
        rayon::join(|| made_of(path, |file| file.develop(&settings.lights)), || settings.prepare(expected)).0
    })
}

fn made_of<T>(path: &Path, make: impl FnOnce(&IgiFile) -> Result<T, IgiError>) -> Result<T, FilmFileError> {
    let loaded = open_limited(path).and_then(|(file, length)| IgiFile::load(file, length));
    let loaded = loaded.map_err(|source| FilmFileError::Read { path: path.to_path_buf(), source })?;
    make(&loaded).map_err(|source| FilmFileError::Content { path: path.to_path_buf(), source })
}

/// Reads Indigo images and adds them, each to the first.
///
/// # Errors
/// As [`read_film`], and where two of them are not of the same picture or hold the same samples.
pub fn merge_films(paths: &[PathBuf]) -> Result<Option<SavedFilm>, FilmFileError> {
    let Some((first, rest)) = paths.split_first() else { return Ok(None) };
    let mut sum = read_film(first)?;
    for path in rest {
        let film = read_film(path)?;
        sum.merge(&film).map_err(|reasons| FilmFileError::Mismatch { path: path.clone(), reasons })?;
    }
    Ok(Some(sum))
}

/// The record of a film of a scene without samples.
pub fn blank_record(scene: &Scene, program: &str) -> FilmRecord {
    FilmRecord {
        program: program.to_owned(),
        scene_path: scene.output.scene_path.clone(),
        scene_hash: scene.identity.hash,
        settings: scene.identity.settings.clone(),
        ..FilmRecord::default()
    }
}

/// A film of a scene without samples.
pub fn blank_film(scene: &Scene, program: &str) -> SavedFilm {
    // The seed does not matter to what layers there are.
    let driver = Driver::new(scene, 0);
    let film = FilmState::new(scene.film.size, driver.layers());
    SavedFilm { film, record: Some(blank_record(scene, program)) }
}
