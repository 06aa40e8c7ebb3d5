//! Rendering another part of the picture.

use super::Worker;
use super::run::Run;
use crate::engine::{LoadedFacts, Phase, Update};
use crate::log::Weight;
use crate::words;
use crate::work::Work;
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
        let facts = LoadedFacts::of(scene);
        if let Some(picture) = &mut self.picture {
            picture.region = facts.picture.region;
        }
        self.outlet.send(Update::Scene(Box::new(facts), None));
        match work {
            Some(work) => self.start(&work),
            None => {
                self.clear_picture();
                self.outlet.send(Update::Phase(Phase::Ready));
            }
        }
    }
}
