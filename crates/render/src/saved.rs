//! Films that outlive their session: what is said of them in a file, and how they are read back.

use crate::disk::read_limited;
use crate::pool::with_jobs;
use indigo_film::igi::{self, IgiError};
use indigo_film::{FilmRecord, Mismatch, SavedFilm};
use indigo_scene::Scene;
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
    let bytes =
        read_limited(path).map_err(|source| FilmFileError::Read { path: path.to_path_buf(), source })?;
    with_jobs(usize::MAX, || igi::read(&bytes))
        .map_err(|source| FilmFileError::Content { path: path.to_path_buf(), source })
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
