//! Opening scenes and films.

use super::{Open, Worker};
use crate::controls::PLAIN_REINHARD;
use crate::engine::{LoadedFacts, Phase, Request, Update, load};
use crate::log::Weight;
use crate::queue::Turn;
use crate::words;
use crate::work::Work;
use indigo_film::{FilmRecord, FilmSize, SavedFilm};
use indigo_imaging::{Exposure, PictureSettings, ToneMapping};
use indigo_render::saved::read_film;
use indigo_render::{Progress, Session};
use indigo_scene::{FOREGROUND_ALPHA, Stop};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

impl Worker {
    /// Loads a scene. What is rendered rests meanwhile, and ends only for a scene that can be rendered.
    pub(super) fn open(&mut self, request: Request) {
        self.end_slave();
        if let Some(wish) = &mut self.region {
            wish.work = None;
        }
        if let Some(run) = &mut self.run {
            run.hold();
        }
        self.give_up_loading();
        self.outlet.send(Update::Phase(Phase::Loading));
        let stop = Stop::default();
        match load::spawn(self.ticket, request, stop.clone(), self.to_self.clone()) {
            Ok(()) => self.loading = Some(stop),
            Err(error) => {
                self.say(Weight::Error, error.to_string());
                self.fail_to_begin();
            }
        }
    }

    /// What was asked for is not rendered; why was told. What was rendered before goes on, and with it its turn in a queue.
    pub(super) fn fail_to_begin(&mut self) {
        if let Some(run) = &mut self.run {
            let phase = run.release();
            return self.outlet.send(Update::Phase(phase));
        }
        self.outlet.send(Update::Phase(self.at_rest()));
        self.outlet.send(Update::Done(Turn::Failed));
    }

    /// What is being loaded is not wanted any more.
    fn give_up_loading(&mut self) {
        if let Some(stop) = self.loading.take() {
            stop.set();
        }
        self.ticket += 1;
    }

    /// Gives up loading by wish.
    pub(super) fn cancel(&mut self) {
        // It may have been loaded while the wish was on its way: then what is rendered by now goes on.
        if self.loading.is_none() {
            return;
        }
        self.give_up_loading();
        self.say(Weight::Info, words::CANCELLED);
        self.fail_to_begin();
    }

    /// Shows a scene that was loaded, and renders it if that is wanted.
    pub(super) fn loaded(&mut self, outcome: load::Outcome) {
        self.loading = None;
        for line in outcome.lines {
            self.outlet.send(Update::Line(line));
        }
        if outcome.scene.is_none() {
            self.say(Weight::Error, words::not_rendered(&outcome.request.path));
            // The list of findings is soon that of another scene, when a queue goes on.
            for finding in outcome.findings.iter().filter(|finding| finding.weight == Weight::Error) {
                self.say(Weight::Error, &*finding.head);
            }
        }
        // Last, since they are shown then.
        self.outlet.send(Update::Findings(outcome.findings, outcome.sources));
        let Some(scene) = outcome.scene else {
            return self.fail_to_begin();
        };
        self.stop(true);
        if self.run.is_some() {
            // Slaves have still to send what they had told of.
            return self.fail_to_begin();
        }
        let facts = LoadedFacts::of(&scene);
        let of_files = Work::of(&facts.output, outcome.request.arguments.halt_error);
        let kept = outcome.request.kept.filter(|kept| kept.of_files == of_files);
        let mut work = kept.map_or(of_files, |kept| kept.work);
        if let Some(samples) = outcome.request.halts_at {
            work.halt_by(samples);
        }
        self.picture = Some(facts.picture.clone());
        self.desk.set_settings(facts.picture.clone());
        self.film = outcome.film.map(Arc::new);
        let starts = outcome.request.starts;
        self.part = outcome.request.part.clone();
        let (read, request) = (outcome.read, outcome.request);
        let region_of_files = scene.film.region;
        self.region = None;
        self.open = Some(Open { scene, read, request, region_of_files });
        self.outlet.send(Update::Scene(Box::new(facts), Some(work)));
        if let Some(film) = self.film.clone() {
            self.take_region_of(&film);
            self.tell_of_file(&film);
        }
        if starts {
            // The picture before it is looked at until there is another.
            return self.start(&work);
        }
        match &self.film {
            Some(film) => self.desk.set_film(Arc::new(film.film.clone())),
            None => self.clear_picture(),
        }
        self.outlet.send(Update::Phase(Phase::Ready));
    }

    /// A film of the scene that is open is gone on with at the next start; any other is only looked at.
    pub(super) fn open_film(&mut self, path: &Path) {
        let film = match read_film(path) {
            Ok(film) => Arc::new(film),
            Err(error) => return self.say(Weight::Error, error.to_string()),
        };
        self.stop(true);
        self.take_region_of(&film);
        self.desk.set_film(Arc::new(film.film.clone()));
        self.outlet.send(Update::Opened(path.to_path_buf()));
        let fits = self.open.as_ref().map(|open| Session::check(&open.scene, &film).map(|_| ()));
        match fits {
            Some(Ok(())) => {
                self.say(Weight::Info, words::goes_on_with(path));
                self.outlet.send(Update::Phase(Phase::Ready));
            }
            other => {
                if let Some(Err(error)) = other {
                    self.say(Weight::Warning, words::only_looked_at(path, &error.to_string()));
                }
                (self.open, self.region) = (None, None);
                let picture = plain_picture(&film);
                self.picture = Some(picture.clone());
                self.desk.set_settings(picture.clone());
                self.outlet.send(Update::Film(Box::new(picture), path.to_path_buf()));
                self.outlet.send(Update::Phase(Phase::Empty));
            }
        }
        self.tell_of_file(&film);
        self.film = Some(film);
    }

    /// Tells how far a film came that is in a file.
    fn tell_of_file(&self, film: &SavedFilm) {
        if let Some(record) = &film.record {
            self.outlet.tell_progress(progress_of(record, film.film.size));
            self.outlet.send(Update::Kept(record.samples));
        }
    }
}

/// How far a film came when it was rendered.
fn progress_of(record: &FilmRecord, size: FilmSize) -> Progress {
    Progress {
        samples: record.samples,
        samples_per_pixel: record.samples as f64 / size.pixels() as f64,
        samples_per_second: 0.0,
        rays: 0,
        elapsed: Duration::try_from_secs_f64(record.elapsed_s).unwrap_or_default(),
        left: None,
        fraction: None,
        relative_error: None,
    }
}

/// How a film of no scene is shown at first.
fn plain_picture(film: &SavedFilm) -> PictureSettings {
    let [pre_scale, post_scale, burn] = PLAIN_REINHARD;
    let tone_mapping = ToneMapping::Reinhard { pre_scale, post_scale, burn };
    // Reinhard's operator does not look at it; the other two get a middling camera: f/8, 1/125 s.
    let exposure = Exposure { aperture_area: 1.5e-5, lens_sensor_dist: 0.035, duration: 0.008 };
    let said = film.record.as_ref().and_then(|record| record.setting(FOREGROUND_ALPHA));
    PictureSettings {
        foreground_alpha: said == Some("true"),
        ..PictureSettings::plain(tone_mapping, exposure)
    }
}
