//! All that the window shows and remembers, as plain data.

mod developing;
mod dropped;
mod news;
mod pointing;
mod requests;
mod unsaved;
mod unsaved_films;

pub use pointing::{Gesture, between};

use crate::action::Action;
use crate::comparison::Comparison;
use crate::controls::Controls;
use crate::engine::{Command, LoadedFacts, Phase, Shown};
use crate::log::{Finding, Line, Log, SourceView, Weight};
use crate::part::Part;
use crate::question::Questions;
use crate::queue::Queue;
use crate::recent::Recent;
use crate::scene_file::SceneFile;
use crate::view::View;
use crate::words;
use crate::work::{Mode, Work};
use eframe::egui::Pos2;
use indigo_diag::SourceMap;
use indigo_front::flags::{Arguments, Role};
use indigo_imaging::PictureSettings;
use indigo_net::master::Status;
use indigo_render::Progress;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// What the pointer does in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Moves it.
    #[default]
    Pan,
    /// Takes a point for grey.
    Grey,
    /// Draws the part that is rendered.
    Region,
}

/// What the panel on the right shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tab {
    /// How the picture is developed.
    #[default]
    Picture,
    /// How the scene is rendered.
    Render,
    /// What the scene holds.
    Scene,
    /// Scenes to render.
    Queue,
    /// The part in renders of many machines.
    Network,
}

impl Tab {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Picture, Self::Render, Self::Scene, Self::Queue, Self::Network];

    /// By its name, or the first where none has that name.
    pub fn named(name: &str) -> Self {
        Self::ALL.into_iter().find(|tab| words::tab(*tab) == name).unwrap_or_default()
    }
}

/// What the panel at the bottom shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Foot {
    /// What was said.
    #[default]
    Log,
    /// What was found in the scene.
    Findings,
    /// Who renders, too.
    Slaves,
}

/// See the module.
#[expect(clippy::struct_excessive_bools, reason = "each is a wish of its own")]
pub struct State {
    /// What the command line says.
    pub arguments: Arguments,
    /// What the engine is at.
    pub phase: Phase,
    /// The scene that is open.
    pub facts: Option<LoadedFacts>,
    /// The path of the scene or film that is open.
    pub path: Option<String>,
    /// The path that was asked for last, whether or not it could be opened.
    pub wanted: Option<String>,
    /// How far the render is.
    pub progress: Option<Progress>,
    /// Memory that the program holds, in bytes.
    pub memory: Option<u64>,
    /// What was said.
    pub log: Log,
    /// What was found in the scene.
    pub findings: Vec<Finding>,
    /// The path of the scene in which that was, whether or not it could be opened.
    pub findings_of: Option<String>,
    /// Its files.
    pub sources: Arc<SourceMap>,
    /// Its elements, once they were asked for.
    pub file: Option<SceneFile>,
    /// Those of scenes that were open before in which something is changed, by their paths.
    pub set_aside: BTreeMap<String, SceneFile>,
    /// How many films are in memory alone, since they could not be saved.
    pub unsaved_films: usize,
    /// What is done once the film is in a file that somebody is asked for.
    pub after_film: Option<Box<Action>>,
    /// How many samples the film has that was saved last, opened, or given up.
    pub kept_samples: u64,
    /// What is done once they are saved.
    pub after_saving: Option<Box<Action>>,
    /// A text that is read as a whole, and the panel that it is of.
    pub reading: Option<(Foot, String)>,
    /// A place in a file that is looked at.
    pub source_view: Option<SourceView>,
    /// How the scene has its picture developed.
    pub base: Option<PictureSettings>,
    /// How it is developed now.
    pub controls: Option<Controls>,
    /// How it was developed before all controls were put back, until they are moved.
    pub before_reset: Option<Controls>,
    /// Response curves to choose from.
    pub responses: Vec<(String, PathBuf)>,
    /// How the scene is rendered.
    pub work: Option<Work>,
    /// How light is to be transported.
    pub mode: Option<Mode>,
    /// Whether that was chosen here, whatever the scene's files say.
    pub mode_is_chosen: bool,
    /// The part in renders of many machines, from the next start on.
    pub part: Part,
    /// How things stand with slaves, where this is or was their master.
    pub slaves: Option<Box<Status>>,
    /// The last picture that was developed.
    pub picture: Option<Shown>,
    /// Where it is on the screen.
    pub view: View,
    /// What the pointer does in it.
    pub tool: Tool,
    /// Where a region began to be drawn.
    pub drag_from: Option<Pos2>,
    /// The pixel under the pointer.
    pub hovered: Option<[u32; 2]>,
    /// The pixel that keys point at.
    pub cross: Option<[u32; 2]>,
    /// The corner of a region at which that began to be drawn by keys.
    pub corner: Option<[u32; 2]>,
    /// What keys want of the picture.
    pub gestures: Vec<Gesture>,
    /// The picture that is compared with.
    pub comparison: Comparison,
    /// What the panel on the right shows.
    pub tab: Tab,
    /// What the panel at the bottom shows.
    pub foot: Foot,
    /// Files that were opened lately.
    pub recent: Recent,
    /// Scenes to render.
    pub queue: Queue,
    /// What the user is asked, one after another.
    pub questions: Questions,
    /// Whether changed elements are being written.
    pub saves_elements: bool,
    /// The response curve that was chosen, until it is read.
    pub awaited_response: Option<String>,
    /// Whether the panel of the scene shows its elements.
    pub shows_elements: bool,
    /// Whether the theme is to change.
    pub wants_other_theme: bool,
    /// Whether conditions of the render were changed and not sent yet.
    pub work_is_new: bool,
    /// The title of the window.
    pub title: String,
    /// Whether the list of keys is shown.
    pub shows_keys: bool,
    /// What is to be done.
    pub actions: Vec<Action>,
}

impl State {
    /// Nothing is open.
    pub fn new(arguments: Arguments, recent: Recent) -> Self {
        Self {
            phase: Phase::Empty,
            facts: None,
            path: None,
            wanted: None,
            progress: None,
            memory: None,
            log: Log::default(),
            findings: vec![],
            findings_of: None,
            sources: Arc::default(),
            file: None,
            unsaved_films: 0,
            after_film: None,
            kept_samples: 0,
            after_saving: None,
            set_aside: BTreeMap::new(),
            reading: None,
            source_view: None,
            base: None,
            controls: None,
            before_reset: None,
            responses: crate::controls::responses(),
            work: None,
            mode: None,
            mode_is_chosen: false,
            part: Part::of(&arguments),
            arguments,
            slaves: None,
            picture: None,
            view: View::default(),
            tool: Tool::Pan,
            drag_from: None,
            hovered: None,
            cross: None,
            corner: None,
            gestures: vec![],
            comparison: Comparison::default(),
            tab: Tab::Picture,
            foot: Foot::Log,
            recent,
            queue: Queue::default(),
            questions: Questions::default(),
            saves_elements: false,
            awaited_response: None,
            shows_elements: false,
            wants_other_theme: false,
            work_is_new: false,
            title: String::new(),
            shows_keys: false,
            actions: vec![],
        }
    }

    /// Asks for something.
    pub fn act(&mut self, action: Action) {
        self.actions.push(action);
    }

    /// Tells something; what went wrong is shown, whatever was looked at.
    pub fn tell(&mut self, weight: Weight, text: impl Into<String>) {
        if weight == Weight::Error {
            self.foot = Foot::Log;
        }
        self.log.add(Line { weight, text: text.into() });
    }

    /// Tells the engine.
    pub fn command(&mut self, command: Command) {
        self.actions.push(Action::Command(command));
    }

    /// Whether something is rendered, or would be after a pause.
    pub fn is_under_way(&self) -> bool {
        matches!(self.phase, Phase::Rendering | Phase::Paused | Phase::Ending | Phase::Slave)
    }

    /// Whether the film grows, or would after a pause: what can be saved now and again.
    pub fn has_growing_film(&self) -> bool {
        matches!(self.phase, Phase::Rendering | Phase::Paused)
    }

    /// The time that the render will still take, while it is under way: none passes in a pause, and nothing is left afterwards.
    pub fn time_left(&self) -> Option<Duration> {
        let goes_on = matches!(self.phase, Phase::Rendering | Phase::Slave);
        self.progress.filter(|_| goes_on).and_then(|progress| progress.left)
    }

    /// Whether this is the master of the render that is under way.
    pub fn is_master(&self) -> bool {
        self.slaves.is_some() && self.has_growing_film()
    }

    /// Whether a render can begin. A slave gets its scene from its master.
    pub fn can_start(&self) -> bool {
        let rests = matches!(self.phase, Phase::Empty | Phase::Ready | Phase::Halted(_));
        rests && (self.part.role == Some(Role::Slave) || self.facts.is_some() && self.phase != Phase::Empty)
    }

    /// Starts, pauses or goes on, whichever comes next.
    pub fn start_or_pause(&mut self) {
        match self.phase {
            // Slaves would not rest.
            Phase::Rendering if self.is_master() => {}
            Phase::Rendering => self.command(Command::Pause),
            Phase::Paused => self.command(Command::Resume),
            _ if self.can_start() => self.start(),
            _ => {}
        }
    }

    fn start(&mut self) {
        let part = Box::new(self.part.clone());
        if part.role == Some(Role::Slave) {
            self.command(Command::StartSlave(part, Box::new(self.arguments.clone())));
        } else if let Some(work) = self.work {
            self.command(Command::Start(work, part));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> State {
        State::new(Arguments::default(), Recent::default())
    }

    #[test]
    fn one_key_starts_pauses_and_goes_on() {
        let mut state = state();
        state.start_or_pause();
        assert!(state.actions.is_empty(), "nothing is open");
        state.phase = Phase::Rendering;
        state.start_or_pause();
        assert!(matches!(state.actions.pop(), Some(Action::Command(Command::Pause))));
        state.phase = Phase::Paused;
        state.start_or_pause();
        assert!(matches!(state.actions.pop(), Some(Action::Command(Command::Resume))));
    }

    #[test]
    fn time_left_passes_only_while_something_is_rendered() {
        let mut state = state();
        let left = Some(Duration::from_secs(30));
        state.progress = Some(Progress {
            samples: 0,
            samples_per_pixel: 0.0,
            samples_per_second: 0.0,
            rays: 0,
            elapsed: Duration::ZERO,
            left,
            fraction: None,
            relative_error: None,
        });
        for (phase, expected) in [
            (Phase::Rendering, left),
            (Phase::Slave, left),
            (Phase::Paused, None),
            (Phase::Halted(indigo_render::HaltReason::Stopped), None),
        ] {
            state.phase = phase;
            assert_eq!(state.time_left(), expected, "{:?}", state.phase);
        }
    }

    #[test]
    fn a_slave_needs_no_scene() {
        let mut state = state();
        state.part.role = Some(Role::Slave);
        state.start_or_pause();
        assert!(matches!(state.actions.pop(), Some(Action::Command(Command::StartSlave(..)))));
    }
}
