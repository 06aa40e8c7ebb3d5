//! What works behind the window: loading, rendering and saving on one thread, developing on another. The window sends
//! commands and reads what comes of them; it never waits for either.

mod develop;
mod load;
#[cfg(test)]
mod tests;
mod worker;

#[cfg(test)]
pub use develop::BINS;
pub use develop::{Desk, Histogram, Shown};
pub use load::LoadedFacts;

use crate::log::{Finding, Line, Weight};
use crate::part::Part;
use crate::queue::Turn;
use crate::words;
use crate::work::Work;
use eframe::egui;
use indigo_diag::SourceMap;
use indigo_film::SavedFilm;
use indigo_front::flags::Arguments;
use indigo_front::messages::Messages;
use indigo_imaging::PictureSettings;
use indigo_net::event::{self, Event};
use indigo_net::master::Status;
use indigo_render::output::OneFile;
use indigo_render::{HaltReason, Progress};
use std::any::Any;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// What the window asks for.
pub enum Command {
    /// Load a scene.
    Open(Box<Request>),
    /// Do not wait for the scene that is being loaded.
    Cancel,
    /// A scene was loaded, or not. From a thread that loads.
    Loaded(u64, Box<load::Outcome>),
    /// Look at a film, or go on with it where it is of the scene.
    OpenFilm(PathBuf),
    /// Begin to render, or go on with the film that is there.
    Start(Work, Box<Part>),
    /// Render for masters.
    StartSlave(Box<Part>, Box<Arguments>),
    /// Let the threads rest.
    Pause,
    /// Go on after a rest.
    Resume,
    /// End the render, with all its files.
    Stop,
    /// Go on with the same film under other conditions.
    Adjust(Work),
    /// Render a part of the picture, or all of it; what is there is lost.
    SetRegion(Option<[[u32; 2]; 2]>, Work),
    /// The picture is developed like this when it is saved.
    SetPicture(Box<PictureSettings>),
    /// Write all files of the render now, and of those before it that could not be saved.
    SaveAll,
    /// Give up the films that could not be saved.
    DiscardUnsaved,
    /// Write one file.
    Save(OneFile, PathBuf),
    /// A film is in a file. From the thread that writes.
    FilmIsSaved(Arc<SavedFilm>),
    /// End it all, with all files or without; not at all where they are wanted and cannot be written.
    Quit {
        /// Whether the render's files are written.
        saves: bool,
    },
    /// Fail by a bug.
    #[cfg(test)]
    Fail,
}

/// A scene to load.
#[derive(Clone, Debug)]
pub struct Request {
    /// Its path.
    pub path: String,
    /// What the command line says, with what the window adds.
    pub arguments: Arguments,
    /// The part of this machine, if others render the scene, too.
    pub part: Part,
    /// The film to go on with.
    pub film: Option<PathBuf>,
    /// Whether to render at once.
    pub starts: bool,
    /// Samples per pixel at which to halt where the scene has no condition of its own.
    pub halts_at: Option<u64>,
    /// How it was rendered before.
    pub kept: Option<Kept>,
}

/// How a scene was rendered, which it is again if its files say what they said.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    /// As the controls had it.
    pub work: Work,
    /// As the files had it.
    pub of_files: Work,
}

/// What the engine is at.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Nothing is open.
    #[default]
    Empty,
    /// A scene is being loaded.
    Loading,
    /// A scene can be rendered.
    Ready,
    /// It is.
    Rendering,
    /// It rests.
    Paused,
    /// The last samples are gathered and the files written.
    Ending,
    /// The render has ended.
    Halted(HaltReason),
    /// This machine renders for a master.
    Slave,
}

/// What the window is told.
pub enum Update {
    /// What the engine is at now.
    Phase(Phase),
    /// A scene is there, and how it is rendered where it was loaded just now.
    Scene(Box<LoadedFacts>, Option<Work>),
    /// What was found in the files of a scene, whether or not it can be rendered.
    Findings(Vec<Finding>, Arc<SourceMap>),
    /// A film was opened.
    Opened(PathBuf),
    /// A film is looked at that is of no scene.
    Film(Box<PictureSettings>, PathBuf),
    /// How far the render is, and the memory that the program holds, in bytes.
    Progress(Progress, Option<u64>),
    /// How things stand with slaves.
    Slaves(Box<Status>),
    /// Something to tell.
    Line(Line),
    /// What was to be rendered has ended, well or not.
    Done(Turn),
    /// So many films are in memory alone, since they could not be saved.
    Unsaved(usize),
    /// A film of so many samples is in a file.
    Kept(u64),
    /// The film that somebody wanted in a file of his choice could not be written.
    NotKept,
    /// There is no picture any more.
    Cleared,
    /// Everything has ended: the window may close.
    Gone,
}

/// When the window is drawn after a new picture. Without any delay egui draws it twice, for answers to what people do.
const SOON: Duration = Duration::from_millis(1);
/// When it is drawn after other news, several of which often come together: nobody sees that delay, and each time it is
/// drawn costs a machine without a graphics card some hundredths of a second.
const WITH_OTHERS: Duration = Duration::from_millis(30);

/// Where the engine's news go.
#[derive(Clone)]
pub struct Outlet {
    updates: Sender<Update>,
    context: egui::Context,
}

impl Outlet {
    /// Sends news and wakes the window.
    pub fn send(&self, update: Update) {
        // Without a window nobody wants to know.
        drop(self.updates.send(update));
        self.context.request_repaint_after(WITH_OTHERS);
    }

    /// Tells how far a render is.
    pub fn tell_progress(&self, progress: Progress) {
        self.send(Update::Progress(progress, memory()));
    }

    /// The same where the picture is developed, which wakes the window.
    pub fn tell_progress_with_picture(&self, progress: Progress) {
        drop(self.updates.send(Update::Progress(progress, memory())));
    }

    /// Tells something.
    pub fn line(&self, weight: Weight, text: impl Into<String>) {
        self.send(Update::Line(Line { weight, text: text.into() }));
    }
}

impl Messages for Outlet {
    fn error(&mut self, message: &str) {
        self.line(Weight::Error, message);
    }

    fn warn(&mut self, message: &str) {
        self.line(Weight::Warning, message);
    }

    fn say(&mut self, message: &str) {
        self.line(Weight::Info, message);
    }

    fn detail(&mut self, _message: &str) {}

    fn event(&mut self, event: &Event) {
        match event.weight() {
            event::Weight::Detail => {}
            event::Weight::Info => self.say(&event.to_string()),
            event::Weight::Warning => self.warn(&event.to_string()),
        }
    }
}

/// What a panic says.
fn message_of(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message")
}

/// Bytes of memory that the program holds, where the system tells.
fn memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}

/// The engine, as the window holds it.
pub struct Engine {
    commands: Sender<Command>,
    updates: Receiver<Update>,
    /// Where pictures are developed.
    pub desk: Arc<Desk>,
    threads: Vec<JoinHandle<()>>,
}

impl Engine {
    /// Starts its threads.
    pub fn new(context: &egui::Context) -> std::io::Result<Self> {
        let (commands, orders) = channel();
        let (news, updates) = channel();
        let outlet = Outlet { updates: news, context: context.clone() };
        let desk = Arc::new(Desk::default());
        let developing = Arc::clone(&desk);
        let wake = context.clone();
        let named = |name: &str| std::thread::Builder::new().name(name.to_owned());
        let tell = outlet.clone();
        let developer = named("develop").spawn(move || {
            let fail = || tell.line(Weight::Error, words::DEVELOPING_FAILED);
            developing.work(&|| wake.request_repaint_after(SOON), &fail);
        })?;
        let worker = worker::Worker::new(orders, commands.clone(), outlet, Arc::clone(&desk))?;
        let worker = named("engine").spawn(move || worker.work())?;
        Ok(Self { commands, updates, desk, threads: vec![developer, worker] })
    }

    /// Asks for something.
    pub fn send(&self, command: Command) {
        // Without an engine there is nothing to be done; it only ends when the window does.
        drop(self.commands.send(command));
    }

    /// Ends everything with all files, from wherever it is called.
    pub fn quitter(&self) -> impl Fn() + Send + use<> {
        let commands = self.commands.clone();
        move || drop(commands.send(Command::Quit { saves: true }))
    }

    /// Whether one of its threads has ended: nothing more comes of it then.
    pub fn has_ended(&self) -> bool {
        self.threads.iter().any(JoinHandle::is_finished)
    }

    /// All news since the last call.
    pub fn news(&self) -> Vec<Update> {
        self.updates.try_iter().collect()
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        // Who wanted nothing saved has ended it before. Otherwise the window is gone without a question: its display is lost, say.
        self.send(Command::Quit { saves: true });
        // A film that cannot be saved is kept for an answer, and nobody is left to give one.
        self.send(Command::Quit { saves: false });
        self.desk.close();
        for thread in self.threads.drain(..) {
            // Nobody is left to hear of a failure.
            drop(thread.join());
        }
    }
}
