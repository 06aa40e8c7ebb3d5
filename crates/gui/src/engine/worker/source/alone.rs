//! A render of this machine alone.

use super::{Ended, Source, set};
use crate::work::Work;
use indigo_film::{FilmState, SavedFilm};
use indigo_front::messages::{Messages, say_saved};
use indigo_front::prepare::{Prepared, fail};
use indigo_front::saver::Saver;
use indigo_net::master::Status;
use indigo_render::output::SaveJob;
use indigo_render::{Event, HaltReason, Options, Progress, Session};
use std::sync::Arc;
use std::time::Duration;

/// See the module.
pub struct Alone {
    session: Session,
    options: Options,
    saver: Saver,
    /// Rendering time of sessions before this one.
    before: Duration,
    /// That of the film that is gone on with.
    of_film: Duration,
    /// Holds the picture's name.
    prepared: Prepared,
}

impl Alone {
    /// Begins to render, or goes on with a film; `None` where that cannot be, after telling why.
    pub fn begin(
        prepared: Prepared,
        job: SaveJob,
        work: &Work,
        film: Option<&SavedFilm>,
        messages: &mut dyn Messages,
    ) -> Option<Self> {
        let mut options = prepared.options.clone();
        set(&mut options, work, Duration::ZERO);
        let session = match film {
            Some(film) => Session::go_on(Arc::clone(&prepared.scene), &options, film),
            None => Session::start(Arc::clone(&prepared.scene), &options),
        };
        let session = session.map_err(|error| fail(&error, messages)).ok()?;
        let of_film = film.and_then(|film| film.record.as_ref()).map(|record| record.elapsed_s);
        Some(Self {
            session,
            options,
            saver: Saver::new(job),
            before: Duration::ZERO,
            of_film: of_film.and_then(|s| Duration::try_from_secs_f64(s).ok()).unwrap_or_default(),
            prepared,
        })
    }

    fn with_before(&self, progress: &Progress) -> Progress {
        Progress { elapsed: progress.elapsed + self.before + self.of_film, ..*progress }
    }
}

impl Source for Alone {
    fn step(&mut self, time: Duration, messages: &mut dyn Messages) -> (Progress, Option<HaltReason>) {
        match self.session.wait(time) {
            Event::Halted(reason, progress) => (self.with_before(&progress), Some(reason)),
            Event::Progress(progress) => {
                let version = self.saver.job().version.clone();
                self.saver.tend(|| self.session.saved(&version), messages);
                (self.with_before(&progress), None)
            }
        }
    }

    fn sums(&mut self, _messages: &mut dyn Messages) -> FilmState {
        self.session.snapshot()
    }

    fn film(&mut self, _messages: &mut dyn Messages) -> SavedFilm {
        self.session.saved(&self.saver.job().version)
    }

    fn job(&self) -> &SaveJob {
        self.saver.job()
    }

    fn job_mut(&mut self) -> &mut SaveJob {
        self.saver.job_mut()
    }

    fn save_soon(&mut self) {
        self.saver.save_soon();
    }

    fn save_by_wish(&mut self) {
        self.saver.save_by_wish();
    }

    fn is_saving(&self) -> bool {
        self.saver.is_at_work()
    }

    fn set_rest(&mut self, rests: bool) {
        if rests {
            self.session.pause();
        } else {
            self.session.resume();
        }
    }

    fn is_resting(&self) -> bool {
        self.session.is_resting()
    }

    fn adjust(&mut self, work: &Work, messages: &mut dyn Messages) -> Result<(), HaltReason> {
        let reason = self.stop();
        if matches!(reason, HaltReason::Failed(_)) {
            // It would go unsaid, and what failed would fail again.
            return Err(reason);
        }
        let film = self.film(messages);
        self.before += self.session.elapsed();
        set(&mut self.options, work, self.before);
        match Session::go_on(Arc::clone(&self.prepared.scene), &self.options, &film) {
            Ok(session) => self.session = session,
            Err(error) => {
                fail(&error, messages);
                return Err(reason);
            }
        }
        Ok(())
    }

    fn stop(&mut self) -> HaltReason {
        self.session.stop();
        loop {
            if let Event::Halted(reason, _) = self.session.wait(Duration::from_millis(20)) {
                return reason;
            }
        }
    }

    fn end(mut self: Box<Self>, reason: &HaltReason, saves: bool, messages: &mut dyn Messages) -> Ended {
        if let HaltReason::Failed(message) = reason {
            messages.error(message);
        }
        let progress = self.session.progress();
        let film = self.film(messages);
        let is_saved = if saves {
            self.saver.wait_for_last(messages);
            say_saved(&self.job().save(&film), messages)
        } else {
            self.saver.keep_word(|| film.clone(), messages);
            true
        };
        Ended::Film { progress: self.with_before(&progress), film: film.into(), is_saved, slaves: None }
    }

    fn slaves(&self) -> Option<Status> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Outlet;
    use crate::engine::tests::{Folder, PATIENCE, even_light};
    use eframe::egui::Context;
    use indigo_front::flags::Arguments;
    use indigo_front::load::load_scene;
    use indigo_front::prepare::prepare;
    use indigo_imaging::{LinearImage, Metadata, exr};
    use std::sync::mpsc::channel;
    use std::time::Instant;

    /// A render that fails: a texture is gone.
    fn failing(folder: &Folder, messages: &mut Outlet) -> Alone {
        let texel = LinearImage { width: 1, height: 1, pixels: vec![[0.5; 4]] };
        let texture = exr::encode(&texel, &Metadata::default()).expect("a picture");
        std::fs::write(folder.path("t.exr"), texture).expect("the texture is written");
        let sphere = "<material><name>m</name><diffuse><albedo_texture><path>t.exr</path></albedo_texture></diffuse>\
                      </material><sphere><center>0 0 0</center><radius>1</radius><material_name>m</material_name></sphere>\
                      </scene>";
        folder.write("scene.igs", &even_light().replace("</scene>", sphere));
        let arguments = Arguments { output: Some(folder.path("picture.png")), ..Arguments::default() };
        let (loaded, _) = load_scene(&folder.path("scene.igs"), &arguments, None).expect("it is read");
        let mut scene = loaded.scene.expect("a sound scene");
        scene.textures.clear();
        let named = Some(folder.path("picture.png").into());
        let prepared = prepare(Arc::new(scene), &[], &arguments, None, named, messages);
        let prepared = prepared.unwrap_or_else(|_| panic!("it can be written"));
        let job = prepared.job.clone();
        Alone::begin(prepared, job, &Work::endless(), None, messages).expect("a session")
    }

    #[test]
    fn a_failure_is_not_hidden_by_other_conditions() {
        let folder = Folder::new("hidden");
        let (updates, _news) = channel();
        let mut messages = Outlet { updates, context: Context::default() };
        let mut alone = failing(&folder, &mut messages);
        let start = Instant::now();
        while !matches!(alone.step(Duration::from_millis(5), &mut messages).1, Some(HaltReason::Failed(_))) {
            assert!(start.elapsed() < PATIENCE, "it does not fail");
        }
        let adjusted = alone.adjust(&Work { threads: 2, ..Work::endless() }, &mut messages);
        assert!(matches!(adjusted, Err(HaltReason::Failed(_))), "{adjusted:?}");
    }
}
