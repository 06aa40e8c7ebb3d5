//! The engine's own thread: it holds the scene and the running session.

mod opening;
mod region;
mod run;
mod save;
mod source;
mod unsaved;
mod writer;

use super::{Command, Desk, Outlet, Phase, Request, Update, message_of};
use crate::log::Weight;
use crate::part::Part;
use crate::queue::Turn;
use crate::words;
use crate::work::Work;
use indigo_film::SavedFilm;
use indigo_front::flags::Arguments;
use indigo_front::net::slave::SlaveRender;
use indigo_imaging::PictureSettings;
use indigo_render::HaltReason;
use indigo_scene::{Scene, Stop};
use region::RegionWish;
use run::{BETWEEN_NEWS, Run};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};
use unsaved::Unsaved;
use writer::Writer;

/// How long a command may wait while a scene is rendered.
const PULSE: Duration = Duration::from_millis(40);

/// A scene that is open.
struct Open {
    scene: Arc<Scene>,
    read: Vec<PathBuf>,
    request: Request,
    /// The part that is rendered by the scene's files.
    region_of_files: Option<[[u32; 2]; 2]>,
}

/// See the module.
pub struct Worker {
    orders: Receiver<Command>,
    /// For threads that load.
    to_self: Sender<Command>,
    outlet: Outlet,
    desk: Arc<Desk>,
    writer: Writer,
    /// Number of the last scene that was asked for; what comes of others is not wanted any more.
    ticket: u64,
    /// Ends loading that one, as long as it is loaded.
    loading: Option<Stop>,
    open: Option<Open>,
    /// What waits for others to be done with the scene.
    region: Option<RegionWish>,
    run: Option<Run>,
    /// What is rendered for a master, and when that was last told.
    slave: Option<(SlaveRender, Instant)>,
    /// The part of this machine in what is rendered.
    part: Part,
    /// The film of the last render, or one that was opened.
    film: Option<Arc<SavedFilm>>,
    picture: Option<PictureSettings>,
    unsaved: Vec<Unsaved>,
}

impl Worker {
    /// A worker that takes orders.
    ///
    /// # Errors
    /// Where the system gives no thread for what is written.
    pub fn new(
        orders: Receiver<Command>,
        to_self: Sender<Command>,
        outlet: Outlet,
        desk: Arc<Desk>,
    ) -> std::io::Result<Self> {
        Ok(Self {
            orders,
            to_self,
            writer: Writer::start(outlet.clone())?,
            outlet,
            desk,
            ticket: 0,
            loading: None,
            open: None,
            region: None,
            run: None,
            slave: None,
            part: Part::of(&Arguments::default()),
            film: None,
            picture: None,
            unsaved: vec![],
        })
    }

    /// Works until told to quit. What fails by a bug ends the render, with all its files, and not the engine.
    pub fn work(mut self) {
        while let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.serve())) {
            self.say(Weight::Error, words::failed_by_bug(message_of(&*panic)));
            self.give_up_render();
        }
    }

    /// Saves the film as far as that can be, whatever has failed.
    fn give_up_render(&mut self) {
        match catch_unwind(AssertUnwindSafe(|| self.stop(true))) {
            Ok(Some(_)) => self.outlet.send(Update::Done(Turn::Failed)),
            Ok(None) | Err(_) => {
                (self.run, self.slave) = (None, None);
                self.fail_to_begin();
            }
        }
    }

    fn serve(&mut self) {
        loop {
            self.try_region();
            match self.next_order() {
                Ok(Command::Quit { saves }) => {
                    if self.quit(saves) {
                        return;
                    }
                }
                Ok(order) => self.obey(order),
                Err(RecvTimeoutError::Timeout) => self.render_on(),
                // Nobody is left to give orders.
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// The next order; it is waited for as long as there is nothing else to do.
    fn next_order(&self) -> Result<Command, RecvTimeoutError> {
        let is_at_work = self.slave.is_some() || self.run.as_ref().is_some_and(|run| !run.is_at_rest());
        if is_at_work {
            self.orders.recv_timeout(Duration::ZERO)
        } else if self.region.is_some() {
            self.orders.recv_timeout(PULSE)
        } else {
            Ok(self.orders.recv()?)
        }
    }

    fn obey(&mut self, order: Command) {
        match order {
            Command::Open(request) => self.open(*request),
            Command::Cancel => self.cancel(),
            Command::Loaded(ticket, outcome) if ticket == self.ticket => self.loaded(*outcome),
            // Another was asked for meanwhile, or none.
            Command::Loaded(..) | Command::Quit { .. } => {}
            Command::OpenFilm(path) => self.open_film(&path),
            Command::Start(work, part) => {
                self.part = *part;
                self.start(&work);
            }
            Command::StartSlave(part, arguments) => self.start_slave(&part, &arguments),
            Command::Pause => self.with_run(Run::pause),
            Command::Resume => self.with_run(Run::resume),
            Command::Stop => {
                let ended = self.stop(true);
                self.tell_turn(ended);
            }
            Command::Adjust(work) => self.adjust(&work),
            Command::SetRegion(region, work) => self.set_region(region, work),
            Command::SetPicture(picture) => {
                if let Some(run) = &mut self.run {
                    run.set_picture(&picture);
                }
                self.develop_unsaved(&picture);
                self.picture = Some(*picture);
            }
            #[cfg(test)]
            Command::Fail => panic!("told so by a test"),
            Command::SaveAll => self.save_all(),
            Command::DiscardUnsaved => self.discard_unsaved(),
            Command::Save(what, path) => self.save(what, path),
            Command::FilmIsSaved(film) => self.film_is_saved(&film),
        }
    }

    fn with_run(&mut self, act: impl FnOnce(&mut Run, &Outlet)) {
        if let Some(run) = &mut self.run {
            act(run, &self.outlet);
        }
    }

    fn say(&self, weight: Weight, text: impl Into<String>) {
        self.outlet.line(weight, text);
    }

    /// Nothing has been rendered of what is open now.
    fn clear_picture(&self) {
        self.desk.clear();
        self.outlet.send(Update::Cleared);
    }

    /// What the engine is at when nothing is rendered.
    fn at_rest(&self) -> Phase {
        if self.open.is_some() { Phase::Ready } else { Phase::Empty }
    }

    fn start(&mut self, work: &Work) {
        if let Some(wish) = &mut self.region {
            wish.work = Some(*work);
            return;
        }
        let Some(open) = &self.open else { return };
        if self.run.is_some() {
            return;
        }
        let (film, picture) = (self.film.as_deref(), self.picture.as_ref());
        match Run::begin(open, &self.part, work, film, picture, &mut self.outlet) {
            Some(run) => {
                self.run = Some(run);
                self.go_on_with_unsaved();
                self.outlet.send(Update::Phase(Phase::Rendering));
            }
            None => self.fail_to_begin(),
        }
    }

    /// Renders for masters from now on.
    fn start_slave(&mut self, part: &Part, arguments: &Arguments) {
        if self.run.is_some() || self.slave.is_some() {
            return;
        }
        let arguments = match part.in_arguments(arguments) {
            Ok(arguments) => arguments,
            Err(wrong) => return self.say(Weight::Error, wrong),
        };
        if let Ok(slave) = SlaveRender::start(&arguments, &mut self.outlet) {
            self.slave = Some((slave, Instant::now()));
            self.outlet.send(Update::Phase(Phase::Slave));
        }
    }

    fn render_on(&mut self) {
        if let Some((slave, told)) = &mut self.slave {
            if !slave.step(PULSE, &mut self.outlet) {
                return self.end_slave();
            }
            if told.elapsed() >= BETWEEN_NEWS
                && let Some(progress) = slave.progress()
            {
                *told = Instant::now();
                self.outlet.tell_progress(progress);
            }
        } else if let Some(run) = &mut self.run
            && let Some(reason) = run.go_on(PULSE, &mut self.outlet, &self.desk)
        {
            self.end_of_itself(reason);
        }
    }

    /// Ends what is under way, if anything is: then how that was.
    fn stop(&mut self, saves: bool) -> Option<Turn> {
        self.end_slave();
        if let Some(wish) = &mut self.region {
            wish.work = None;
        }
        let run = self.run.as_mut()?;
        self.outlet.send(Update::Phase(Phase::Ending));
        let reason = run.stop();
        self.end(reason, saves)
    }

    /// Sends what is left to the master, and leaves.
    fn end_slave(&mut self) {
        let Some((slave, _)) = self.slave.take() else { return };
        self.outlet.send(Update::Phase(Phase::Ending));
        slave.finish(&mut self.outlet);
        self.outlet.send(Update::Phase(self.at_rest()));
    }

    /// Ends the render; how that was, unless it goes on after all.
    fn end(&mut self, reason: HaltReason, saves: bool) -> Option<Turn> {
        let run = self.run.take()?;
        // The last of its files is the newest, also where one was saved by hand.
        self.writer.wait();
        let job = run.job().clone();
        let (film, is_saved) = match run.end(&reason, saves, &mut self.outlet) {
            Ok((film, is_saved)) => (Arc::new(film), is_saved),
            Err(run) => {
                self.run = Some(run);
                return None;
            }
        };
        let is_good = is_saved && !matches!(reason, HaltReason::Failed(_));
        self.desk.set_film(Arc::new(film.film.clone()));
        self.film = Some(Arc::clone(&film));
        self.outlet.send(Update::Phase(Phase::Halted(reason)));
        if !is_saved {
            self.keep(film, job);
        }
        Some(if is_good { Turn::Done } else { Turn::Failed })
    }

    /// Ends a render for a reason of its own, so that the next scene may begin.
    fn end_of_itself(&mut self, reason: HaltReason) {
        let ended = self.end(reason, true);
        self.tell_turn(ended);
    }

    /// Tells that a render has ended, if it has.
    fn tell_turn(&self, ended: Option<Turn>) {
        if let Some(how) = ended {
            self.outlet.send(Update::Done(how));
        }
    }

    /// Goes on with the same film under other conditions.
    fn adjust(&mut self, work: &Work) {
        let Some(run) = &mut self.run else { return };
        if let Err(reason) = run.adjust(work, &mut self.outlet) {
            self.end_of_itself(reason);
        }
    }

    /// Ends everything; whether that could be without a loss, unless losses are wanted.
    fn quit(&mut self, saves: bool) -> bool {
        if saves && !self.unsaved.is_empty() {
            self.save_unsaved();
        }
        self.stop(saves);
        self.writer.wait();
        if saves && !self.unsaved.is_empty() {
            return false;
        }
        self.outlet.send(Update::Gone);
        true
    }
}
