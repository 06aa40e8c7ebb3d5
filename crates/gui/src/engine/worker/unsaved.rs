//! Films of renders that have ended whose files could not be written: on a full disk, say. They stay in memory until they are
//! saved or given up, whatever else is rendered meanwhile.

use super::Worker;
use crate::engine::{Outlet, Update};
use indigo_film::SavedFilm;
use indigo_front::claim::Claim;
use indigo_front::messages::say_saved;
use indigo_imaging::PictureSettings;
use indigo_render::output::SaveJob;
use std::sync::Arc;

/// Such a film.
pub struct Unsaved {
    film: Arc<SavedFilm>,
    job: SaveJob,
}

impl Unsaved {
    /// Tries it once more; whether all files are there now. Another program may have taken the name meanwhile.
    fn save(&self, outlet: &mut Outlet) -> bool {
        Claim::of(&self.job.paths.igi(), outlet)
            .is_ok_and(|_claim| say_saved(&self.job.save(&self.film), outlet))
    }
}

impl Worker {
    /// Keeps a film that is in no file.
    pub(super) fn keep(&mut self, film: Arc<SavedFilm>, job: SaveJob) {
        self.unsaved.push(Unsaved { film, job });
        self.tell_unsaved();
    }

    /// Tries to save all of them once more.
    pub(super) fn save_unsaved(&mut self) {
        let outlet = &mut self.outlet;
        self.unsaved.retain(|unsaved| !unsaved.save(outlet));
        self.tell_unsaved();
    }

    /// Gives all of them up.
    pub(super) fn discard_unsaved(&mut self) {
        self.unsaved.clear();
        self.tell_unsaved();
    }

    /// The film that was opened or rendered last is gone on with, and will be saved with what is added.
    pub(super) fn go_on_with_unsaved(&mut self) {
        if let Some(film) = self.film.clone() {
            self.forget_unsaved(&film);
        }
    }

    /// A film is not in memory alone any more.
    pub(super) fn forget_unsaved(&mut self, film: &Arc<SavedFilm>) {
        let before = self.unsaved.len();
        self.unsaved.retain(|unsaved| !Arc::ptr_eq(&unsaved.film, film));
        if self.unsaved.len() < before {
            self.tell_unsaved();
        }
    }

    /// The film that was rendered last is developed like this when it is saved after all.
    pub(super) fn develop_unsaved(&mut self, picture: &PictureSettings) {
        let Some(film) = &self.film else { return };
        if let Some(unsaved) = self.unsaved.iter_mut().find(|unsaved| Arc::ptr_eq(&unsaved.film, film)) {
            unsaved.job.development.picture = picture.clone();
        }
    }

    fn tell_unsaved(&self) {
        self.outlet.send(Update::Unsaved(self.unsaved.len()));
    }
}
