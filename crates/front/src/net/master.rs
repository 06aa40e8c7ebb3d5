//! A master: adds up what slaves render, and may render besides.

mod end;
mod ready;

pub use end::Gathered;
pub use ready::{Ready, get_ready};

use super::own::Own;
use super::{PULSE, events, fail};
use crate::messages::{Messages, count};
use crate::prepare::{Prepared, fail as fail_session};
use crate::saver::Saver;
use indigo_film::{FilmState, SavedFilm};
use indigo_net::event::Event;
use indigo_net::ledger::Refusal;
use indigo_net::limits::REPORTS;
use indigo_net::master::{Master, Status};
use indigo_render::output::SaveJob;
use indigo_render::{Halt, HaltReason, Progress};
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// When slaves are to report often, so that they do not render much more than is wanted: they hear of it by a report of the
/// usual time, and the estimate is rough.
const NEAR_END: Duration = Duration::from_secs(3 * REPORTS.as_secs());

/// A render of many machines, as its master has it.
pub struct MasterRender {
    master: Master,
    own: Option<Own>,
    own_seed: u64,
    events: Receiver<Event>,
    started: Instant,
    saver: Saver,
    prepared: Prepared,
}

impl MasterRender {
    /// Works for so long, and saves when it is time; how far it is then.
    pub fn step(&mut self, time: Duration, messages: &mut dyn Messages) -> Progress {
        self.pass(time.min(self.saver.until_due()), messages);
        self.save(messages);
        let progress = self.progress();
        // It may be near as long as nobody has said how fast it comes.
        let is_near_end =
            progress.samples_per_second == 0.0 || progress.left.is_some_and(|left| left < NEAR_END);
        self.master.tell_near_end(is_near_end && self.halt().samples_per_pixel.is_some());
        progress
    }

    /// Lets time pass.
    fn pass(&mut self, time: Duration, messages: &mut dyn Messages) {
        match &mut self.own {
            Some(own) => own.wait(time, &self.master),
            None => {
                // It may also be that there will be none any more.
                if let Ok(event) = self.events.recv_timeout(time) {
                    messages.event(&event);
                }
            }
        }
        self.tell_events(messages);
    }

    fn save(&mut self, messages: &mut dyn Messages) {
        if let Some(record) = self.saver.look_after(messages) {
            self.master.saved(record);
        }
        if self.saver.is_due() {
            let film = self.film(messages);
            self.saver.begin(film, messages);
        }
    }

    /// Adds what has been rendered here to the film.
    fn hand_over(&mut self, messages: &mut dyn Messages) {
        let version = &self.saver.job().version;
        let added = self.own.as_mut().map_or(Ok(None), |own| own.hand_over(&self.master, version));
        say_added(&added, messages);
    }

    /// A copy of the film to be saved, with all that has been rendered here; what it has of others was told by then.
    pub fn film(&mut self, messages: &mut dyn Messages) -> SavedFilm {
        self.hand_over(messages);
        self.copy(messages)
    }

    /// A copy of the film, of all of which the log tells by then.
    fn copy(&self, messages: &mut dyn Messages) -> SavedFilm {
        let film = self.master.copy();
        self.tell_events(messages);
        film
    }

    /// The sums of all that has been rendered and sent, to be looked at.
    pub fn sums(&mut self, messages: &mut dyn Messages) -> FilmState {
        self.hand_over(messages);
        self.master.sums()
    }

    /// How things stand with the slaves.
    pub fn status(&self) -> Status {
        self.master.status()
    }

    /// Saves as soon as no save is under way, and tells what becomes of it.
    pub fn save_by_wish(&mut self) {
        self.saver.save_by_wish();
    }

    /// What is saved.
    pub fn job(&self) -> &SaveJob {
        self.saver.job()
    }

    /// The same, to be changed from the next save on.
    pub fn job_mut(&mut self) -> &mut SaveJob {
        self.saver.job_mut()
    }

    /// When it is to end.
    fn halt(&self) -> Halt {
        self.prepared.options.halt
    }

    /// Goes on under other halting conditions and, where it renders itself, with another number of threads.
    ///
    /// # Errors
    /// The exit status where nothing can be rendered here any more; the reason was told.
    pub fn adjust(&mut self, threads: usize, halt: Halt, messages: &mut dyn Messages) -> Result<(), u8> {
        let options = &mut self.prepared.options;
        options.halt = halt;
        if options.threads == threads {
            return Ok(());
        }
        options.threads = threads;
        if let Some(own) = &mut self.own {
            say_added(&own.end(&self.master, &self.saver.job().version), messages);
        }
        self.start_own_anew(messages)
    }

    /// Begins anew what is rendered here, if anything is, behind what it had when it was ended.
    fn start_own_anew(&mut self, messages: &mut dyn Messages) -> Result<(), u8> {
        if self.own.take().is_none() {
            return Ok(());
        }
        let own = Own::start(&self.prepared.scene, &self.prepared.options, self.own_seed, &self.master);
        self.own = Some(own.map_err(|error| fail_session(&error, messages))?);
        Ok(())
    }

    /// Why it is to end, if it is.
    pub fn why_end(&self) -> Option<HaltReason> {
        let failure = self.own.as_ref().and_then(|own| own.ended.clone());
        let is_late = || self.halt().time.is_some_and(|time| self.started.elapsed() >= time);
        failure
            .or_else(|| self.has_enough(true).then_some(HaltReason::Samples))
            .or_else(|| is_late().then_some(HaltReason::Time))
    }

    /// Whether there are as many samples as were asked for, with those that slaves have still to send or without.
    fn has_enough(&self, with_waiting: bool) -> bool {
        self.halt().samples_per_pixel.is_some_and(|passes| {
            let Status { size: [width, height], samples, waiting, .. } = self.master.status();
            let wanted = u128::from(width) * u128::from(height) * u128::from(passes);
            u128::from(samples) + u128::from(if with_waiting { waiting } else { 0 }) >= wanted
        })
    }

    /// How far it is, with what has been rendered here and is not in the film yet.
    pub fn progress(&self) -> Progress {
        let status = self.master.status();
        let pixels = (f64::from(status.size[0]) * f64::from(status.size[1])).max(1.0);
        let (samples, samples_per_second) = (status.samples, status.samples_per_second);
        let elapsed = self.started.elapsed();
        let by_samples = self.halt().samples_per_pixel.map(|spp| {
            let (wanted, rendered) = (spp as f64 * pixels, samples as f64 + status.waiting as f64);
            let left = (wanted - rendered).max(0.0) / samples_per_second;
            (rendered / wanted.max(1.0), if left.is_finite() { left } else { f64::MAX })
        });
        let by_time = self.halt().time.map(|time| {
            (elapsed.as_secs_f64() / time.as_secs_f64(), time.saturating_sub(elapsed).as_secs_f64())
        });
        let next = [by_samples, by_time].into_iter().flatten().min_by(|a, b| a.1.total_cmp(&b.1));
        Progress {
            samples,
            samples_per_pixel: samples as f64 / pixels,
            samples_per_second,
            rays: self.own.as_ref().map_or(0, |own| own.progress.rays),
            elapsed,
            left: next.and_then(|(_, left)| Duration::try_from_secs_f64(left).ok()),
            fraction: next.map(|(fraction, _)| fraction.clamp(0.0, 1.0)),
            relative_error: None,
        }
    }

    /// Who else is at work.
    pub fn company(&self) -> String {
        count(self.master.status().present, "slave")
    }

    fn tell_events(&self, messages: &mut dyn Messages) {
        for event in self.events.try_iter() {
            messages.event(&event);
        }
    }
}

/// Says what became of what was rendered here.
fn say_added(added: &Result<Option<Event>, Refusal>, messages: &mut dyn Messages) {
    match added {
        Ok(Some(event)) => messages.event(event),
        Ok(None) => {}
        Err(refusal) => messages.warn(&format!("what was rendered here does not fit the film: {refusal}")),
    }
}
