//! All that the window shows and remembers, as plain data.

use crate::comparison::Comparison;
use crate::controls::Controls;
use crate::engine::{Command, Histogram, LoadedFacts, Phase, Request, Update};
use crate::log::{Finding, Line, Log, SourceView, Weight};
use crate::queue::Queue;
use crate::recent::Recent;
use crate::scene_file::SceneFile;
use crate::view::View;
use crate::words;
use crate::work::{Mode, Work};
use eframe::egui::Pos2;
use indigo_diag::SourceMap;
use indigo_film::XyzImage;
use indigo_front::flags::Arguments;
use indigo_imaging::PictureSettings;
use indigo_render::Progress;
use indigo_render::output::OneFile;
use std::path::{Path, PathBuf};
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
}

impl Tab {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Picture, Self::Render, Self::Scene, Self::Queue];
}

/// What the panel at the bottom shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Foot {
    /// What was said.
    #[default]
    Log,
    /// What was found in the scene.
    Findings,
}

/// What a dialog asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// A scene or a film to open.
    Open,
    /// Where to write a file.
    Save(OneFile),
    /// A picture to compare with.
    Compare,
    /// Scenes for the queue.
    Queue,
}

/// What is to be done, by whichever panel or key asked for it.
pub enum Action {
    /// Tell the engine.
    Command(Command),
    /// Open a file, by its ending.
    Open(PathBuf),
    /// Ask the user for a path.
    Ask(Ask),
    /// Load the scene again, with another mode.
    Restart,
    /// Read the scene's elements.
    ReadElements,
    /// Write what was changed in them.
    SaveElements,
    /// Write how the picture is developed into the scene.
    WriteSettings,
    /// Begin the queue, or go on with it.
    RunQueue,
    /// Close the window.
    Close,
}

/// The last picture that was developed.
pub struct Picture {
    /// Width and height.
    pub size: [usize; 2],
    /// Red, green and blue of a pixel as shown.
    pub image: Arc<eframe::egui::ColorImage>,
    /// How often each brightness is there.
    pub histogram: Histogram,
    /// XYZ in cd/m² of each pixel.
    pub light: Arc<XyzImage>,
    /// From cd/m² to lux·s.
    pub lux_seconds_per_nit: f64,
    /// How long developing took.
    pub time: Duration,
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
    /// The path that is open or being opened.
    pub path: Option<String>,
    /// How far the render is.
    pub progress: Option<Progress>,
    /// Memory that the program holds, in bytes.
    pub memory: Option<u64>,
    /// What was said.
    pub log: Log,
    /// What was found in the scene.
    pub findings: Vec<Finding>,
    /// Its files.
    pub sources: Arc<SourceMap>,
    /// Its elements, once they were asked for.
    pub file: Option<SceneFile>,
    /// A place in a file that is looked at.
    pub source_view: Option<SourceView>,
    /// How the scene has its picture developed.
    pub base: Option<PictureSettings>,
    /// How it is developed now.
    pub controls: Option<Controls>,
    /// Response curves to choose from.
    pub responses: Vec<(String, PathBuf)>,
    /// How the scene is rendered.
    pub work: Option<Work>,
    /// How light is to be transported.
    pub mode: Option<Mode>,
    /// The picture.
    pub picture: Option<Picture>,
    /// Where it is on the screen.
    pub view: View,
    /// What the pointer does in it.
    pub tool: Tool,
    /// Where a region began to be drawn.
    pub drag_from: Option<Pos2>,
    /// The pixel under the pointer.
    pub hovered: Option<[u32; 2]>,
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
    /// Whether the user is asked what to do with a running render before the window closes.
    pub asks_to_close: bool,
    /// Whether the next picture is to be shown pixel by pixel.
    pub wants_one_to_one: bool,
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
            arguments,
            phase: Phase::Empty,
            facts: None,
            path: None,
            progress: None,
            memory: None,
            log: Log::default(),
            findings: vec![],
            sources: Arc::default(),
            file: None,
            source_view: None,
            base: None,
            controls: None,
            responses: crate::controls::responses(),
            work: None,
            mode: None,
            picture: None,
            view: View::default(),
            tool: Tool::Pan,
            drag_from: None,
            hovered: None,
            comparison: Comparison::default(),
            tab: Tab::Picture,
            foot: Foot::Log,
            recent,
            queue: Queue::default(),
            asks_to_close: false,
            wants_one_to_one: false,
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

    /// Tells the engine.
    pub fn command(&mut self, command: Command) {
        self.actions.push(Action::Command(command));
    }

    /// Whether threads are at work, or would be after a pause.
    pub fn is_under_way(&self) -> bool {
        matches!(self.phase, Phase::Rendering | Phase::Paused | Phase::Ending)
    }

    /// Whether a render can begin.
    pub fn can_start(&self) -> bool {
        self.facts.is_some() && matches!(self.phase, Phase::Ready | Phase::Halted(_))
    }

    /// Starts, pauses or goes on, whichever comes next.
    pub fn start_or_pause(&mut self) {
        match self.phase {
            Phase::Rendering => self.command(Command::Pause),
            Phase::Paused => self.command(Command::Resume),
            _ if self.can_start() => {
                if let Some(work) = self.work {
                    self.command(Command::Start(work));
                }
            }
            _ => {}
        }
    }

    /// The request for a scene, with what the command line says.
    pub fn request(&self, path: &str, starts: bool) -> Request {
        let mut arguments = self.arguments.clone();
        if arguments.files.first().is_none_or(|first| first != path) {
            // The command line's film and name of the picture are of the command line's scene.
            (arguments.resume, arguments.output) = (None, None);
        }
        let film = arguments.resume.as_ref().map(PathBuf::from);
        Request { path: path.to_owned(), arguments, film, starts, halts_at: None }
    }

    /// The request for the open scene in the mode that is chosen.
    pub fn request_in_mode(&self) -> Option<Request> {
        let (path, mode) = (self.path.as_ref()?, self.mode?);
        let mut request = Request { film: None, ..self.request(path, self.is_under_way()) };
        request.arguments.settings.extend(mode.overrides());
        Some(request)
    }

    /// Takes news of the engine.
    pub fn take(&mut self, update: Update) {
        match update {
            Update::Phase(phase) => self.phase = phase,
            Update::Scene(facts) => self.take_scene(*facts),
            Update::Findings(findings, sources) => {
                if findings.iter().any(|finding| finding.weight != Weight::Info) {
                    self.foot = Foot::Findings;
                }
                (self.findings, self.sources, self.source_view) = (findings, sources, None);
            }
            Update::Film(settings, path) => {
                self.facts = None;
                self.path = Some(path.display().to_string());
                self.controls = Some(Controls::of(&settings));
                self.base = Some(*settings);
                (self.work, self.mode, self.progress) = (None, None, None);
            }
            Update::Progress(progress, memory) => (self.progress, self.memory) = (Some(progress), memory),
            Update::Line(line) => self.log.add(line),
            Update::Done => self.scene_is_done(),
            Update::Gone => self.act(Action::Close),
        }
    }

    fn take_scene(&mut self, facts: LoadedFacts) {
        let is_same = self.facts.as_ref().is_some_and(|old| old.path == facts.path && old.size == facts.size);
        if !is_same {
            self.view.fit();
            self.picture = None;
            self.work = None;
        }
        self.progress = None;
        self.file = None;
        // What was tried out on the same scene stays.
        if !is_same || self.controls.is_none() {
            self.controls = Some(Controls::of(&facts.picture));
        }
        self.base = Some(facts.picture.clone());
        self.work.get_or_insert(Work::of(&facts.output, self.arguments.halt_error));
        self.mode = Some(Mode::of(&facts.transport));
        self.recent.add(Path::new(&facts.path));
        self.path = Some(facts.path.clone());
        self.facts = Some(facts);
        self.controls_changed();
    }

    /// The next scene of the queue, if it runs.
    fn scene_is_done(&mut self) {
        if self.queue.done() {
            self.act(Action::RunQueue);
        }
    }

    /// Sends the controls to where pictures are made.
    pub fn controls_changed(&mut self) {
        if let (Some(base), Some(controls)) = (&self.base, &self.controls) {
            let picture = controls.apply(base);
            self.command(Command::SetPicture(Box::new(picture)));
        }
    }

    /// As the scene has it.
    pub fn reset_controls(&mut self) {
        if let Some(base) = &self.base {
            self.controls = Some(Controls::of(base));
            self.controls_changed();
        }
    }

    /// Makes the picture brighter or darker.
    pub fn brighten(&mut self, steps: f64) {
        if let Some(controls) = &mut self.controls {
            controls.brighten(steps);
            self.controls_changed();
        }
    }

    /// Takes a pixel of the picture for grey.
    pub fn take_grey(&mut self, [x, y]: [u32; 2]) {
        let (Some(picture), Some(controls)) = (&self.picture, &mut self.controls) else { return };
        let index = y as usize * picture.light.size.width() as usize + x as usize;
        let Some(&[x, y, z, _]) = picture.light.pixels.get(index) else { return };
        if controls.take_grey([x, y, z]) {
            self.tool = Tool::Pan;
            self.controls_changed();
        } else {
            self.log.add(Line { weight: Weight::Warning, text: words::NO_GREY.to_owned() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_imaging::{Exposure, ToneMapping};

    fn state() -> State {
        State::new(Arguments::default(), Recent::default())
    }

    #[test]
    fn a_film_alone_has_controls_but_no_work() {
        let mut state = state();
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let settings = PictureSettings::plain(ToneMapping::Linear { scale: 2.0 }, exposure);
        state.take(Update::Film(Box::new(settings), "a.igi".into()));
        assert_eq!(state.controls.as_ref().map(|c| c.scale), Some(2.0));
        assert!(!state.can_start() && state.work.is_none());
        state.brighten(1.0);
        assert_eq!(state.controls.as_ref().map(|c| c.scale), Some(4.0));
        assert!(matches!(state.actions.last(), Some(Action::Command(Command::SetPicture(_)))));
        state.reset_controls();
        assert_eq!(state.controls.as_ref().map(|c| c.scale), Some(2.0));
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
    fn what_is_wrong_in_a_scene_is_shown() {
        let mut state = state();
        let finding =
            Finding { weight: Weight::Warning, head: String::new(), full: String::new(), span: None };
        state.take(Update::Findings(vec![finding], Arc::default()));
        assert_eq!(state.foot, Foot::Findings);
    }
}
