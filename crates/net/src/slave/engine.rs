//! A session on a thread of its own, which drains its film when asked.

use indigo_film::SavedFilm;
use indigo_render::{Event, HaltReason, Progress, Session};
use std::cell::Cell;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;
use tokio::sync::oneshot;

/// How long a command waits at most.
const PULSE: Duration = Duration::from_millis(20);

/// What is asked of the thread.
enum Command {
    /// Take what has been rendered.
    Drain(oneshot::Sender<Option<SavedFilm>>),
    /// End, and take the rest.
    End(oneshot::Sender<Option<SavedFilm>>),
    /// Rest, or go on.
    Rest(bool),
}

/// A running session. Dropping it ends it, and loses what was not taken.
pub struct Engine {
    commands: Option<Sender<Command>>,
    seen: Arc<Mutex<Seen>>,
    has_ended: Cell<bool>,
    /// Samples that had been rendered when the film was last taken.
    taken_at: Cell<u64>,
    thread: Option<JoinHandle<()>>,
}

/// How it stands.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// How far it is.
    pub progress: Option<Progress>,
    /// Why it renders no more.
    pub failure: Option<String>,
}

impl Engine {
    /// Takes over a session.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(mut session: Session, program: String) -> std::io::Result<Self> {
        let (commands, asked) = channel();
        let seen = Arc::new(Mutex::new(Seen::default()));
        let shown = Arc::clone(&seen);
        let thread = std::thread::Builder::new()
            .name("session".to_owned())
            .spawn(move || run(&mut session, &program, &asked, &shown))?;
        Ok(Self {
            commands: Some(commands),
            seen,
            has_ended: Cell::new(false),
            taken_at: Cell::new(0),
            thread: Some(thread),
        })
    }

    /// How it stands.
    pub fn seen(&self) -> Seen {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What has been rendered since the last time, if anything.
    pub async fn drain(&self) -> Option<SavedFilm> {
        let film = self.ask(Command::Drain).await;
        if film.is_some() {
            self.taken_at.set(self.samples());
        }
        film
    }

    fn samples(&self) -> u64 {
        self.seen().progress.map_or(0, |progress| progress.samples)
    }

    /// Samples that were rendered after the film was last taken. Workers may have held back some that are older.
    pub fn untaken(&self) -> u64 {
        if self.has_ended() { 0 } else { self.samples().saturating_sub(self.taken_at.get()) }
    }

    /// Ends it; the last of what it has rendered.
    pub async fn end(&self) -> Option<SavedFilm> {
        self.has_ended.set(true);
        self.ask(Command::End).await
    }

    /// Whether it was told to end.
    pub fn has_ended(&self) -> bool {
        self.has_ended.get()
    }

    async fn ask(
        &self,
        command: impl FnOnce(oneshot::Sender<Option<SavedFilm>>) -> Command,
    ) -> Option<SavedFilm> {
        let (tell, told) = oneshot::channel();
        self.commands.as_ref()?.send(command(tell)).ok()?;
        told.await.ok().flatten()
    }

    /// Lets it rest, or go on.
    pub fn rest(&self, wanted: bool) {
        if let Some(commands) = &self.commands {
            // A thread that has ended rests.
            drop(commands.send(Command::Rest(wanted)));
        }
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}

/// Until told to end, or nobody is left to tell.
fn run(session: &mut Session, program: &str, asked: &Receiver<Command>, shown: &Mutex<Seen>) {
    let show = |event: Event| {
        let mut seen = shown.lock().unwrap_or_else(PoisonError::into_inner);
        match event {
            Event::Progress(progress) => seen.progress = Some(progress),
            Event::Halted(reason, progress) => {
                seen.progress = Some(progress);
                if let HaltReason::Failed(message) = reason {
                    seen.failure = Some(message);
                }
            }
        }
    };
    loop {
        let event = session.wait(PULSE);
        let has_halted = matches!(event, Event::Halted(..));
        show(event);
        if has_halted {
            // It waits no more by itself.
            std::thread::sleep(PULSE);
        }
        loop {
            // Whoever has asked may have gone.
            match asked.try_recv() {
                Ok(Command::Drain(tell)) => drop(tell.send(session.drain(program))),
                Ok(Command::End(tell)) => {
                    session.stop();
                    while !matches!(session.wait(PULSE), Event::Halted(..)) {}
                    drop(tell.send(session.drain(program)));
                    return;
                }
                Ok(Command::Rest(true)) => session.pause(),
                Ok(Command::Rest(false)) => session.resume(),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return,
            }
        }
    }
}
