//! One file of a film, whatever the scene asks for.

use super::{OneFile, SaveError, SaveJob, encoded, metadata, said, write_film};
use crate::pool::with_jobs;
use indigo_film::{FilmSize, SavedFilm};
use indigo_imaging::{
    Content, Metadata, PictureSettings, develop_image, exr, linear_picture, on_sensor, png,
};
use std::path::{Path, PathBuf};

impl SaveJob {
    /// Writes one file to a path, whatever else the scene asks for.
    ///
    /// # Errors
    /// What keeps it from being written; a file that was there before is untouched then.
    pub fn save_as(&self, saved: &SavedFilm, what: OneFile, path: &Path) -> Result<PathBuf, SaveError> {
        let format = self.development.output.png;
        let metadata = |size| metadata::of(self, size, saved.record.as_ref());
        with_jobs(self.threads, || write_one(saved, what, path, &self.development.picture, format, metadata))
    }
}

/// Writes one file of a film whose scene is not there, by a program: pictures tell what the film knows of itself.
///
/// # Errors
/// As [`SaveJob::save_as`].
pub fn save_film_as(
    saved: &SavedFilm,
    what: OneFile,
    path: &Path,
    settings: &PictureSettings,
    program: &str,
    threads: usize,
) -> Result<PathBuf, SaveError> {
    let metadata = |size| metadata::of_film(size, saved.record.as_ref(), settings, program);
    with_jobs(threads, || write_one(saved, what, path, settings, png::Format::default(), metadata))
}

fn write_one(
    saved: &SavedFilm,
    what: OneFile,
    path: &Path,
    settings: &PictureSettings,
    format: png::Format,
    metadata: impl FnOnce(FilmSize) -> Metadata,
) -> Result<PathBuf, SaveError> {
    if what == OneFile::Film {
        let record = saved.record.clone().unwrap_or_default();
        return write_film(path, &saved.film, &record);
    }
    let light = saved.film.develop_mixed(&settings.lights, |_| true);
    let metadata = metadata(light.size);
    let image = on_sensor(light, settings);
    let content = match (settings.foreground_alpha, what) {
        (true, _) => Content::Coverage,
        (false, OneFile::Picture) => Content::Developed,
        (false, _) => Content::Luminances,
    };
    let metadata = said(&metadata, content);
    let bytes = match what {
        OneFile::Picture => png::encode(&develop_image(&image, settings), &metadata, format),
        _ if settings.foreground_alpha => {
            exr::encode_display_linear(&linear_picture(&image, settings), &metadata)
        }
        _ => exr::encode(&linear_picture(&image, settings), &metadata),
    };
    encoded(path, bytes)
}
