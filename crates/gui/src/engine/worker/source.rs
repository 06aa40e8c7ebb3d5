//! What renders: this machine alone, or a master with its slaves.

mod alone;
mod many;

pub use alone::Alone;
pub use many::Many;

use crate::work::Work;
use indigo_film::{FilmState, SavedFilm};
use indigo_front::messages::Messages;
use indigo_net::master::Status;
use indigo_render::output::SaveJob;
use indigo_render::{HaltReason, Options, Progress};
use indigo_scene::schema::settings::MOST_THREADS;
use std::time::Duration;

/// A render under way.
pub trait Source: Send {
    /// Renders for so long, and saves when it is time; how far it is, and why it has ended, if it has.
    fn step(&mut self, time: Duration, messages: &mut dyn Messages) -> (Progress, Option<HaltReason>);
    /// The film's sums, to be looked at.
    fn sums(&mut self, messages: &mut dyn Messages) -> FilmState;
    /// The film, to be saved.
    fn film(&mut self, messages: &mut dyn Messages) -> SavedFilm;
    /// How it is saved.
    fn job(&self) -> &SaveJob;
    /// The same, to be changed from the next save on.
    fn job_mut(&mut self) -> &mut SaveJob;
    /// Saves as soon as no save is under way.
    fn save_soon(&mut self);
    /// The same by wish: what becomes of it is told.
    fn save_by_wish(&mut self);
    /// Whether a save is under way or will soon be, for which steps are needed.
    fn is_saving(&self) -> bool;
    /// Lets the threads rest, or go on.
    fn set_rest(&mut self, rests: bool);
    /// Whether all of them rest.
    fn is_resting(&self) -> bool;
    /// Goes on with the same film under other conditions; if that cannot be, why the render has ended.
    fn adjust(&mut self, work: &Work, messages: &mut dyn Messages) -> Result<(), HaltReason>;
    /// Ends it by wish; the reason.
    fn stop(&mut self) -> HaltReason;
    /// Ends it, and writes its files if they are wanted.
    fn end(self: Box<Self>, reason: &HaltReason, saves: bool, messages: &mut dyn Messages) -> Ended;
    /// How things stand with slaves, where there can be any.
    fn slaves(&self) -> Option<Status>;
}

/// What becomes of a render that is to end.
pub enum Ended {
    /// It has ended.
    Film {
        /// How far it came.
        progress: Progress,
        /// All that was gathered.
        film: Box<SavedFilm>,
        /// Whether all files that are wanted were written.
        is_saved: bool,
        /// How things stand with slaves now.
        slaves: Option<Box<Status>>,
    },
    /// It has not what was asked for after all, and goes on.
    GoesOn(Box<dyn Source>),
}

/// What the controls say becomes a session's options. Time that was rendered already counts.
pub fn set(options: &mut Options, work: &Work, rendered: Duration) {
    options.threads = work.threads.clamp(1, MOST_THREADS);
    options.estimates_error = work.estimates_error;
    let halt = work.halt();
    options.halt = indigo_render::Halt { time: halt.time.map(|time| time.saturating_sub(rendered)), ..halt };
}
