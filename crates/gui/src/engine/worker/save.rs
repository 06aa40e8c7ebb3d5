//! Saving what is there by wish.

use super::{Open, Worker};
use crate::engine::Outlet;
use crate::log::Weight;
use crate::words;
use indigo_front::messages::{Messages as _, say_saved};
use indigo_front::{logical_cores, program};
use indigo_imaging::PictureSettings;
use indigo_render::output::{OneFile, OutputPaths, SaveJob, save_film_as};
use indigo_scene::Development;
use std::path::PathBuf;
use std::sync::Arc;

impl Worker {
    /// Writes all files of the render, on a thread of its own.
    pub(super) fn save_all(&mut self) {
        let Some(run) = &mut self.run else { return };
        let (job, film) = (run.job().clone(), run.film(&mut self.outlet));
        self.spawn_save(move |messages| {
            say_saved(&job.save(&film), messages);
        });
    }

    /// Writes one file of what is there now, on a thread of its own.
    pub(super) fn save(&mut self, what: OneFile, path: PathBuf) {
        let growing = self.run.as_mut().map(|run| Arc::new(run.film(&mut self.outlet)));
        let film = growing.or_else(|| self.film.clone());
        let (Some(film), Some(picture)) = (film, self.picture.clone()) else {
            return self.say(Weight::Error, words::NOTHING_TO_SAVE);
        };
        let job = self.open.as_ref().map(|open| job(open, picture.clone()));
        self.spawn_save(move |messages| {
            let written = match job {
                Some(job) => job.save_as(&film, what, &path),
                None => save_film_as(&film, what, &path, &picture, &program(), logical_cores()),
            };
            match written {
                Ok(path) => messages.say(&words::saved(&path)),
                Err(error) => messages.error(&error.to_string()),
            }
        });
    }

    fn spawn_save(&self, save: impl FnOnce(&mut Outlet) + Send + 'static) {
        let mut outlet = self.outlet.clone();
        let thread = std::thread::Builder::new().name("save".to_owned());
        if let Err(error) = thread.spawn(move || save(&mut outlet)) {
            self.say(Weight::Error, error.to_string());
        }
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
