//! Saving what is there by wish.

use super::{Open, Worker};
use crate::engine::{Command, Update};
use crate::log::Weight;
use crate::words;
use indigo_film::SavedFilm;
use indigo_front::messages::Messages as _;
use indigo_front::{logical_cores, program};
use indigo_imaging::PictureSettings;
use indigo_render::output::{OneFile, OutputPaths, SaveJob, save_film_as};
use indigo_scene::Development;
use std::path::PathBuf;
use std::sync::Arc;

impl Worker {
    /// Writes all files of the render, and of those before it that could not be saved. It writes them itself, so that no older film can take a newer one's place.
    pub(super) fn save_all(&mut self) {
        if let Some(run) = &mut self.run {
            run.save_by_wish();
        }
        if !self.unsaved.is_empty() {
            self.save_unsaved();
        }
    }

    /// Writes one file of what is there now, on the thread for that.
    pub(super) fn save(&mut self, what: OneFile, path: PathBuf) {
        if self.run.as_ref().is_some_and(|run| run.writes(&path)) {
            return self.save_all();
        }
        let growing = self.run.as_mut().map(|run| Arc::new(run.film(&mut self.outlet)));
        let film = growing.or_else(|| self.film.clone());
        let (Some(film), Some(picture)) = (film, self.picture.clone()) else {
            return self.say(Weight::Error, words::NOTHING_TO_SAVE);
        };
        let job = self.open.as_ref().map(|open| job(open, picture.clone()));
        let to_self = self.to_self.clone();
        self.writer.write(move |messages| {
            let written = match job {
                Some(job) => job.save_as(&film, what, &path),
                None => save_film_as(&film, what, &path, &picture, &program(), logical_cores()),
            };
            match written {
                Ok(path) => {
                    messages.say(&words::saved(&path));
                    if what == OneFile::Film {
                        // The engine may have ended.
                        drop(to_self.send(Command::FilmIsSaved(film)));
                    }
                }
                Err(error) => {
                    messages.error(&error.to_string());
                    if what == OneFile::Film {
                        messages.send(Update::NotKept);
                    }
                }
            }
        });
    }

    /// A film is in a file, wherever that is.
    pub(super) fn film_is_saved(&mut self, film: &Arc<SavedFilm>) {
        if let Some(record) = &film.record {
            self.outlet.send(Update::Kept(record.samples));
        }
        self.forget_unsaved(film);
    }
}

/// How one file of a scene's film is saved, by the controls.
fn job(open: &Open, picture: PictureSettings) -> SaveJob {
    SaveJob {
        development: Development { picture, ..open.scene.development() },
        paths: OutputPaths::new(""),
        version: program(),
        threads: logical_cores(),
        first_hits: None,
        denoiser: None,
    }
}
