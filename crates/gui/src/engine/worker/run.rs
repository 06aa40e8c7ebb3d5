//! A render under way.

use super::Open;
use crate::engine::{Desk, Outlet, Phase, Update};
use crate::work::Work;
use indigo_film::SavedFilm;
use indigo_front::flags::Arguments;
use indigo_front::messages::{Messages, say_saved};
use indigo_front::paths::picture_named;
use indigo_front::prepare::{Prepared, fail, prepare};
use indigo_front::saver::Saver;
use indigo_imaging::PictureSettings;
use indigo_render::{Event, Halt, HaltReason, Options, Progress, Session};
use indigo_scene::schema::settings::MOST_THREADS;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often the window is told how far it is. Each time it is drawn anew, which costs a machine without a graphics card
/// some hundredths of a second.
const BETWEEN_NEWS: Duration = Duration::from_millis(500);
/// How often the picture is renewed in the first moments; the time between two grows up to the setting `display_period`.
const FIRST_PICTURE: Duration = Duration::from_secs(1);
/// Renewing the picture may take this part of the time at most, so that rendering takes no more than some per cent longer.
const PART_FOR_PICTURES: u32 = 40;

/// No picture is waited for longer than so many times the setting `display_period`.
const LONGEST_WAIT: u32 = 3;

/// A session with what belongs to it.
pub struct Run {
    session: Session,
    options: Options,
    /// Holds the picture's name.
    prepared: Prepared,
    saver: Saver,
    /// Rendering time of sessions before this one.
    before: Duration,
    rests: bool,
    /// Whether the film was shown since all threads rest.
    rest_shown: bool,
    news: Instant,
    shown: Instant,
    pictures: u32,
    /// What copying a film took.
    cost: Duration,
}

/// The picture's path, if the command line names one; an error after telling what is wrong with it.
fn named(arguments: &Arguments, messages: &mut dyn Messages) -> Result<Option<PathBuf>, ()> {
    let output = arguments.output.as_deref();
    let named = output.map(picture_named).transpose();
    named.map_err(|reason| messages.error(&format!("-o {}: {reason}", output.unwrap_or_default())))
}

impl Run {
    /// Begins to render; `None` where that cannot be, after telling why.
    pub fn begin(
        open: &Open,
        work: &Work,
        film: Option<&SavedFilm>,
        picture: Option<&PictureSettings>,
        messages: &mut dyn Messages,
    ) -> Option<Self> {
        let arguments = &open.request.arguments;
        let named = named(arguments, messages).ok()?;
        let prepared = prepare(Arc::clone(&open.scene), &open.read, arguments, film, named, messages).ok()?;
        let mut options = prepared.options.clone();
        set(&mut options, work, Duration::ZERO);
        let mut job = prepared.job.clone();
        if let Some(picture) = picture {
            job.development.picture = picture.clone();
        }
        let session = match film {
            Some(film) => Session::go_on(Arc::clone(&open.scene), &options, film),
            None => Session::start(Arc::clone(&open.scene), &options),
        };
        let session = session.map_err(|error| fail(&error, messages)).ok()?;
        let now = Instant::now();
        Some(Self {
            session,
            options,
            prepared,
            saver: Saver::new(job),
            before: Duration::ZERO,
            rests: false,
            rest_shown: false,
            news: now,
            shown: now,
            pictures: 0,
            cost: Duration::ZERO,
        })
    }

    /// Whether there is nothing to do until an order comes.
    pub fn is_at_rest(&self) -> bool {
        self.rests && self.rest_shown
    }

    /// Lets the threads rest.
    pub fn pause(&mut self, outlet: &Outlet) {
        self.session.pause();
        (self.rests, self.rest_shown) = (true, false);
        outlet.send(Update::Phase(Phase::Paused));
    }

    /// Goes on.
    pub fn resume(&mut self, outlet: &Outlet) {
        self.session.resume();
        self.rests = false;
        outlet.send(Update::Phase(Phase::Rendering));
    }

    /// How it is saved.
    pub fn job(&self) -> &indigo_render::output::SaveJob {
        self.saver.job()
    }

    /// Develops by these when saving.
    pub fn set_picture(&mut self, picture: &PictureSettings) {
        self.saver.job_mut().development.picture = picture.clone();
    }

    /// Renders for a moment, and tells; why it has ended, if it has.
    pub fn go_on(&mut self, time: Duration, outlet: &Outlet, desk: &Desk) -> Option<HaltReason> {
        match self.session.wait(time) {
            Event::Halted(reason, progress) => {
                self.tell(&progress, outlet);
                return Some(reason);
            }
            Event::Progress(progress) => {
                let is_first_rest = self.rests && self.session.is_resting();
                if is_first_rest || self.news.elapsed() >= BETWEEN_NEWS {
                    self.tell(&progress, outlet);
                }
                if is_first_rest || !self.rests && self.shown.elapsed() >= self.between_pictures() {
                    self.show(desk);
                    self.rest_shown = is_first_rest;
                }
            }
        }
        let mut messages = crate::log::Gathered::default();
        let version = self.saver.job().version.clone();
        self.saver.tend(|| self.session.saved(&version), &mut messages);
        for line in messages.0 {
            outlet.send(Update::Line(line));
        }
        None
    }

    fn between_pictures(&self) -> Duration {
        let period = self.prepared.scene.output.display_period;
        let period = Duration::try_from_secs_f64(period).unwrap_or(Duration::MAX);
        let growing = FIRST_PICTURE.saturating_mul(1 << self.pictures.min(16));
        // Developing takes long on a machine that is busy with other things, too: pictures come all the same.
        let sparing = self.cost.saturating_mul(PART_FOR_PICTURES).min(period.saturating_mul(LONGEST_WAIT));
        period.min(growing).max(sparing)
    }

    fn show(&mut self, desk: &Desk) {
        let start = Instant::now();
        desk.set_film(Arc::new(self.session.snapshot()));
        self.cost = start.elapsed().max(desk.last_cost());
        self.shown = Instant::now();
        self.pictures += 1;
    }

    fn tell(&mut self, progress: &Progress, outlet: &Outlet) {
        self.news = Instant::now();
        let progress = Progress { elapsed: progress.elapsed + self.before, ..*progress };
        outlet.send(Update::Progress(progress, memory()));
    }

    /// The film as it is now.
    pub fn film(&self) -> SavedFilm {
        self.session.saved(&self.saver.job().version)
    }

    /// Ends the session; the reason.
    pub fn stop(&mut self) -> HaltReason {
        self.session.stop();
        loop {
            if let Event::Halted(reason, _) = self.session.wait(Duration::from_millis(20)) {
                return reason;
            }
        }
    }

    /// Goes on with the same film under other conditions; if that cannot be, why the render has ended.
    pub fn adjust(&mut self, work: &Work, messages: &mut dyn Messages) -> Result<(), HaltReason> {
        let reason = self.stop();
        let film = self.film();
        self.before += self.session.elapsed();
        set(&mut self.options, work, self.before);
        match Session::go_on(Arc::clone(&self.prepared.scene), &self.options, &film) {
            Ok(session) => self.session = session,
            Err(error) => {
                fail(&error, messages);
                return Err(reason);
            }
        }
        if self.rests {
            self.session.pause();
        }
        Ok(())
    }

    /// The film at the end, after its files were written if they are wanted.
    pub fn end(
        mut self,
        reason: &HaltReason,
        saves: bool,
        outlet: &Outlet,
        messages: &mut dyn Messages,
    ) -> SavedFilm {
        self.saver.wait_for_last(messages);
        if let HaltReason::Failed(message) = reason {
            messages.error(message);
        }
        let progress = self.session.progress();
        self.tell(&progress, outlet);
        let film = self.film();
        if saves {
            say_saved(&self.saver.job().save(&film), messages);
        }
        film
    }
}

/// What the controls say becomes the session's options. Time that was rendered already counts.
fn set(options: &mut Options, work: &Work, rendered: Duration) {
    options.threads = work.threads.clamp(1, MOST_THREADS);
    let halt = work.halt();
    options.halt = Halt { time: halt.time.map(|time| time.saturating_sub(rendered)), ..halt };
}

/// Bytes of memory that the program holds, where the system tells.
fn memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}
