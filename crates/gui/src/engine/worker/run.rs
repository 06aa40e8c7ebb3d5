//! A render under way, and what is shown of it.

use super::Open;
use super::source::{Alone, Ended, Many, Source};
use crate::engine::{Desk, Outlet, Phase, Update};
use crate::part::Part;
use crate::words;
use crate::work::Work;
use indigo_film::SavedFilm;
use indigo_front::flags::Arguments;
use indigo_front::messages::Messages;
use indigo_front::net::master::get_ready;
use indigo_front::paths::picture_named;
use indigo_front::prepare::prepare;
use indigo_imaging::PictureSettings;
use indigo_render::output::SaveJob;
use indigo_render::{HaltReason, Progress};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often the window is told how far it is. Each time it is drawn anew, which costs a machine without a graphics card
/// some hundredths of a second of each core.
pub const BETWEEN_NEWS: Duration = Duration::from_secs(2);
/// When the first picture comes; the time between two grows fourfold up to the setting `display_period`.
const FIRST_PICTURE: Duration = Duration::from_millis(250);
/// The same as long as there are pixels without a sample, at most.
const WHILE_IN_PARTS: Duration = Duration::from_secs(1);
/// Renewing the picture may take this part of the time at most, so that rendering takes no more than some per cent longer.
const PART_FOR_PICTURES: u32 = 40;
/// The same as long as the picture that is shown has pixels without a sample: nobody sees much of it.
const PART_FOR_PARTS: u32 = 4;
/// No picture is waited for longer than so many times the setting `display_period`.
const LONGEST_WAIT: u32 = 3;

/// What renders, and when it was last shown.
pub struct Run {
    source: Box<dyn Source>,
    display_period: Duration,
    rests: bool,
    /// Whether the film was shown since all threads rest.
    rest_shown: bool,
    /// Whether it rests for something that is loaded.
    is_held: bool,
    news: Instant,
    shown: Instant,
    pictures: u32,
    /// Samples per pixel of the picture that is shown.
    shown_per_pixel: f64,
    /// What copying the film took.
    copying: Duration,
}

/// The picture's path, if the command line names one; an error after telling what is wrong with it.
fn named(arguments: &Arguments, messages: &mut dyn Messages) -> Result<Option<PathBuf>, ()> {
    let output = arguments.output.as_deref();
    let named = output.map(picture_named).transpose();
    named.map_err(|reason| messages.error(&format!("-o {}: {reason}", output.unwrap_or_default())))
}

/// The same for all names of a file, whether or not it is there yet; `None` where its folder is not.
fn place(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(path.file_name()?))
}

/// Begins to render; `None` where that cannot be, after telling why.
fn begin(
    open: &Open,
    part: &Part,
    work: &Work,
    film: Option<&SavedFilm>,
    picture: Option<&PictureSettings>,
    messages: &mut dyn Messages,
) -> Option<Box<dyn Source>> {
    let arguments = part.in_arguments(&open.request.arguments);
    let arguments = arguments.map_err(|wrong| messages.error(&wrong)).ok()?;
    let named = named(&arguments, messages).ok()?;
    let scene = Arc::clone(&open.scene);
    if part.is_master() {
        if scene.film.region != open.region_of_files {
            messages.error(words::REGION_OF_MANY);
            return None;
        }
        let ready = get_ready(scene, &open.read, &arguments, film, named, messages).ok()?;
        let many = Many::begin(ready, &arguments, work, film.cloned(), picture, messages)?;
        return Some(Box::new(many));
    }
    let prepared = prepare(scene, &open.read, &arguments, film, named, messages).ok()?;
    let mut job = prepared.job.clone();
    if let Some(picture) = picture {
        job.development.picture = picture.clone();
    }
    Some(Box::new(Alone::begin(prepared, job, work, film, messages)?))
}

impl Run {
    /// Begins to render; `None` where that cannot be, after telling why.
    pub fn begin(
        open: &Open,
        part: &Part,
        work: &Work,
        film: Option<&SavedFilm>,
        picture: Option<&PictureSettings>,
        messages: &mut dyn Messages,
    ) -> Option<Self> {
        let source = begin(open, part, work, film, picture, messages)?;
        let display_period = Duration::try_from_secs_f64(open.scene.output.display_period);
        let now = Instant::now();
        Some(Self {
            source,
            display_period: display_period.unwrap_or(Duration::MAX),
            rests: false,
            rest_shown: false,
            is_held: false,
            news: now,
            shown: now,
            pictures: 0,
            shown_per_pixel: 0.0,
            copying: Duration::ZERO,
        })
    }

    /// Whether there is nothing to do until an order comes.
    pub fn rests(&self) -> bool {
        self.rests
    }

    /// The same, and whether the picture of that was shown and saved.
    pub fn is_at_rest(&self) -> bool {
        self.rests && self.rest_shown && !self.source.is_saving()
    }

    /// Whether others may render, too.
    pub fn has_slaves(&self) -> bool {
        self.source.slaves().is_some()
    }

    /// Lets the threads rest, where they can.
    pub fn pause(&mut self, outlet: &Outlet) {
        if self.has_slaves() {
            return;
        }
        self.source.set_rest(true);
        (self.rests, self.rest_shown) = (true, false);
        outlet.send(Update::Phase(Phase::Paused));
    }

    /// Lets the threads rest without a word while something else is loaded, where they can and do not rest already.
    pub fn hold(&mut self) {
        if !self.rests && !self.has_slaves() {
            self.source.set_rest(true);
            (self.rests, self.rest_shown, self.is_held) = (true, false, true);
        }
    }

    /// Nothing is loaded any more: goes on if it was held. What it is at then.
    pub fn release(&mut self) -> Phase {
        if std::mem::take(&mut self.is_held) {
            self.source.set_rest(false);
            self.rests = false;
        }
        if self.rests { Phase::Paused } else { Phase::Rendering }
    }

    /// Goes on.
    pub fn resume(&mut self, outlet: &Outlet) {
        self.source.set_rest(false);
        self.rests = false;
        outlet.send(Update::Phase(Phase::Rendering));
    }

    /// How it is saved.
    pub fn job(&self) -> &SaveJob {
        self.source.job()
    }

    /// Writes all files as soon as none is being written.
    pub fn save_by_wish(&mut self) {
        self.source.save_by_wish();
    }

    /// Whether a path is that of one of its files.
    pub fn writes(&self, path: &Path) -> bool {
        let Some(place) = place(path) else { return false };
        self.source.job().files().any(|own| self::place(&own).as_ref() == Some(&place))
    }

    /// Develops by these when saving.
    pub fn set_picture(&mut self, picture: &PictureSettings) {
        self.source.job_mut().development.picture = picture.clone();
    }

    /// Renders for a moment, and tells; why it has ended, if it has.
    pub fn go_on(&mut self, time: Duration, outlet: &mut Outlet, desk: &Desk) -> Option<HaltReason> {
        let (progress, reason) = self.source.step(time, outlet);
        if reason.is_some() {
            self.tell(progress, outlet);
            return reason;
        }
        let is_first_rest = self.rests && !self.rest_shown && self.source.is_resting();
        let shows =
            is_first_rest || !self.rests && self.shown.elapsed() >= self.between_pictures(desk.last_cost());
        if shows {
            self.rest_shown = is_first_rest;
        }
        if shows && self.show(progress.samples_per_pixel, desk, outlet) {
            outlet.tell_progress_with_picture(progress);
            self.tell_of_slaves(outlet);
        } else if is_first_rest || self.news.elapsed() >= BETWEEN_NEWS {
            self.tell(progress, outlet);
        }
        if is_first_rest {
            // Somebody may leave the machine like this.
            self.source.save_soon();
        }
        None
    }

    /// How long the picture stays, where developing the last one took some time.
    fn between_pictures(&self, developing: Duration) -> Duration {
        let growing = FIRST_PICTURE.saturating_mul(1 << (2 * self.pictures).min(16));
        let is_in_parts = self.shown_per_pixel < 1.0;
        let growing = if is_in_parts { growing.min(WHILE_IN_PARTS) } else { growing };
        // Developing takes long on a machine that is busy with other things, too: pictures come all the same.
        let longest = self.display_period.saturating_mul(LONGEST_WAIT);
        let cost = self.copying + developing;
        let part = if is_in_parts { PART_FOR_PARTS } else { PART_FOR_PICTURES };
        let sparing = cost.saturating_mul(part).min(longest);
        self.display_period.min(growing).max(sparing)
    }

    /// Has the film developed; whether there is something to be seen.
    fn show(&mut self, samples_per_pixel: f64, desk: &Desk, messages: &mut dyn Messages) -> bool {
        let start = Instant::now();
        let sums = self.source.sums(messages);
        // A black picture would be taken for what is rendered.
        let has_samples = sums.layers.iter().any(|layer| layer.totals.n_samples > 0.0);
        if has_samples {
            desk.set_film(Arc::new(sums));
        }
        self.copying = start.elapsed();
        self.shown = Instant::now();
        self.pictures += 1;
        self.shown_per_pixel = samples_per_pixel;
        has_samples
    }

    fn tell(&mut self, progress: Progress, outlet: &Outlet) {
        outlet.tell_progress(progress);
        self.tell_of_slaves(outlet);
    }

    /// The last of the news.
    fn tell_of_slaves(&mut self, outlet: &Outlet) {
        self.news = Instant::now();
        if let Some(status) = self.source.slaves() {
            outlet.send(Update::Slaves(Box::new(status)));
        }
    }

    /// The film as it is now.
    pub fn film(&mut self, messages: &mut dyn Messages) -> SavedFilm {
        self.source.film(messages)
    }

    /// Ends it by wish; the reason.
    pub fn stop(&mut self) -> HaltReason {
        self.source.stop()
    }

    /// Goes on with the same film under other conditions; if that cannot be, why the render has ended.
    pub fn adjust(&mut self, work: &Work, messages: &mut dyn Messages) -> Result<(), HaltReason> {
        self.source.adjust(work, messages)?;
        if self.rests {
            self.source.set_rest(true);
        }
        Ok(())
    }

    /// The film at the end, after its files were written if they are wanted, and whether that could be.
    ///
    /// # Errors
    /// The render where it goes on after all: slaves have not sent samples that they had told of.
    pub fn end(
        self,
        reason: &HaltReason,
        saves: bool,
        outlet: &mut Outlet,
    ) -> Result<(SavedFilm, bool), Self> {
        match self.source.end(reason, saves, outlet) {
            Ended::Film { progress, film, is_saved, slaves } => {
                if let Some(status) = slaves {
                    outlet.send(Update::Slaves(status));
                }
                outlet.tell_progress(progress);
                Ok((*film, is_saved))
            }
            Ended::GoesOn(source) => Err(Self { source, ..self }),
        }
    }
}
