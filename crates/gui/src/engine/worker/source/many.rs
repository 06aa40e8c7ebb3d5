//! A render of many machines, of which this is the master.

use super::{Ended, Source, set};
use crate::words;
use crate::work::Work;
use indigo_film::{FilmState, SavedFilm};
use indigo_front::flags::Arguments;
use indigo_front::messages::Messages;
use indigo_front::net::master::{MasterRender, Ready};
use indigo_imaging::PictureSettings;
use indigo_net::master::Status;
use indigo_render::output::SaveJob;
use indigo_render::{HaltReason, Progress};
use std::time::Duration;

/// See the module.
pub struct Many(MasterRender);

impl Many {
    /// Begins to listen; `None` where that cannot be, after telling why.
    pub fn begin(
        mut ready: Ready,
        arguments: &Arguments,
        work: &Work,
        film: Option<SavedFilm>,
        picture: Option<&PictureSettings>,
        messages: &mut dyn Messages,
    ) -> Option<Self> {
        warn_of_error(work, messages);
        set(&mut ready.prepared.options, work, Duration::ZERO);
        if let Some(picture) = picture {
            ready.prepared.job.development.picture = picture.clone();
        }
        ready.start(arguments, film, messages).ok().map(Self)
    }
}

/// Nobody estimates the error of what slaves send.
fn warn_of_error(work: &Work, messages: &mut dyn Messages) {
    if work.halt_error.0 {
        messages.warn(words::NO_ERROR_OF_MANY);
    } else if work.estimates_error {
        messages.warn(words::NO_ESTIMATE_OF_MANY);
    }
}

impl Source for Many {
    fn step(&mut self, time: Duration, messages: &mut dyn Messages) -> (Progress, Option<HaltReason>) {
        let progress = self.0.step(time, messages);
        (progress, self.0.why_end())
    }

    fn sums(&mut self, messages: &mut dyn Messages) -> FilmState {
        self.0.sums(messages)
    }

    fn film(&mut self, messages: &mut dyn Messages) -> SavedFilm {
        self.0.film(messages)
    }

    fn job(&self) -> &SaveJob {
        self.0.job()
    }

    fn job_mut(&mut self) -> &mut SaveJob {
        self.0.job_mut()
    }

    // What needs saving early is a rest.
    fn save_soon(&mut self) {}

    fn save_by_wish(&mut self) {
        self.0.save_by_wish();
    }

    // Nor would steps be left out.
    fn is_saving(&self) -> bool {
        false
    }

    // The window lets no master rest: its slaves would not.
    fn set_rest(&mut self, _rests: bool) {}

    fn is_resting(&self) -> bool {
        false
    }

    fn adjust(&mut self, work: &Work, messages: &mut dyn Messages) -> Result<(), HaltReason> {
        warn_of_error(work, messages);
        self.0.adjust(work.threads, work.halt(), messages).map_err(|_| HaltReason::Stopped)
    }

    fn stop(&mut self) -> HaltReason {
        HaltReason::Stopped
    }

    fn end(self: Box<Self>, reason: &HaltReason, saves: bool, messages: &mut dyn Messages) -> Ended {
        let mut render = self.0;
        if !saves {
            let progress = render.progress();
            return Ended::Film {
                progress,
                film: render.discard(messages).into(),
                is_saved: true,
                slaves: None,
            };
        }
        if let HaltReason::Failed(message) = reason {
            messages.error(message);
        }
        if let Some(slaves) = render.begin_end(messages) {
            messages.say(&words::waiting_for(&slaves));
        }
        let mut gathered = render.gather(reason, messages);
        if gathered.lacks_samples {
            match gathered.go_on(messages) {
                Ok(render) => return Ended::GoesOn(Box::new(Self(render))),
                Err(back) => gathered = *back,
            }
        }
        let (progress, slaves) = (gathered.progress, Some(gathered.status().into()));
        let (film, is_saved) = gathered.save(messages);
        Ended::Film { progress, film: film.into(), is_saved, slaves }
    }

    fn slaves(&self) -> Option<Status> {
        Some(self.0.status())
    }
}
