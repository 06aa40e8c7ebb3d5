//! Rendering another part of the picture.

use super::Worker;
use super::run::Run;
use crate::engine::{LoadedFacts, Phase, Update};
use crate::log::Weight;
use crate::words;
use crate::work::Work;
use indigo_film::SavedFilm;
use indigo_render::Session;
use indigo_scene::{RENDER_REGION, region_of_words};
use std::sync::Arc;

/// Another part of the picture to be rendered, or all of it.
pub struct RegionWish {
    region: Option<[[u32; 2]; 2]>,
    /// How to render it at once, if that is wanted.
    pub work: Option<Work>,
}

impl Worker {
    /// Ends what is rendered, with all its files, and renders another part of the picture as soon as that can be.
    pub(super) fn set_region(&mut self, region: Option<[[u32; 2]; 2]>, work: Work) {
        if self.run.as_ref().is_some_and(Run::has_slaves) {
            return self.say(Weight::Error, words::REGION_OF_MANY);
        }
        if !self.unsaved.is_empty() {
            // The window asks before; this wish came before it knew.
            return self.say(Weight::Error, words::REGION_OF_UNSAVED);
        }
        let was_at_work = self.run.as_ref().is_some_and(|run| !run.rests());
        let waiting = self.region.take().and_then(|wish| wish.work);
        self.stop(true);
        if !self.unsaved.is_empty() {
            // Its files could not be written, which was told: it can be gone on with after a slip of the mouse.
            return;
        }
        self.film = None;
        let work = was_at_work.then_some(work).or(waiting);
        self.region = Some(RegionWish { region, work });
        self.try_region();
    }

    /// Sets the region that is wanted, unless somebody who saves a picture still looks at the scene.
    pub(super) fn try_region(&mut self) {
        let (Some(open), Some(RegionWish { region, work })) = (&mut self.open, self.region.take()) else {
            return;
        };
        let Some(scene) = Arc::get_mut(&mut open.scene) else {
            self.region = Some(RegionWish { region, work });
            return;
        };
        if let Err(error) = scene.set_region(region) {
            return self.say(Weight::Error, error.to_string());
        }
        self.tell_of_region();
        match work {
            Some(work) => self.start(&work),
            None => {
                self.clear_picture();
                self.outlet.send(Update::Phase(Phase::Ready));
            }
        }
    }

    /// Renders the part of the picture that a film is of, where nothing else keeps it from being gone on with.
    pub(super) fn take_region_of(&mut self, film: &SavedFilm) {
        let said = film.record.as_ref().and_then(|record| record.setting(RENDER_REGION));
        let (Some(open), Some(part)) = (&mut self.open, said.and_then(region_of_words)) else { return };
        let before = open.scene.film.region;
        let corners = |[[x1, x2], [y1, y2]]: [[u32; 2]; 2]| [[x1, y1], [x2, y2]];
        let Some(scene) = Arc::get_mut(&mut open.scene).filter(|_| part != before) else { return };
        if scene.set_region(part.map(corners)).is_ok() && Session::check(scene, film).is_ok() {
            self.tell_of_region();
        } else if let Err(error) = scene.set_region(before.map(corners)) {
            self.say(Weight::Error, error.to_string());
        }
    }

    /// Another part of the picture is rendered from now on.
    fn tell_of_region(&mut self) {
        let Some(open) = &self.open else { return };
        let facts = LoadedFacts::of(&open.scene);
        if let Some(picture) = &mut self.picture {
            picture.region = facts.picture.region;
        }
        self.outlet.send(Update::Scene(Box::new(facts), None));
    }
}
