//! The window: it hands what happens to the panels, and what they ask for to the engine.

mod answers;
mod asking;
mod writing;

use crate::action::{Action, Ask, PICTURES, has_ending};
use crate::engine::{Command, Engine, Request, Shown};
use crate::log::Weight;
use crate::panels::{self, Textures};
use crate::recent::Recent;
use crate::scene_file::{NotSaved, SceneFile};
use crate::state::{Foot, State, Tab};
use crate::{LEAST_SIZE, signals, theme, words};
use answers::Answer;
use eframe::egui::{
    self, CentralPanel, Context, Frame, Margin, Panel, TextureFilter, TextureOptions, Ui, Vec2,
    ViewportCommand,
};
use indigo_front::flags::{Arguments, Role};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use writing::Writing;

/// Where the files that were opened lately are remembered.
const RECENT: &str = "recent";
/// Where it is remembered what the panel on the right shows.
const TAB: &str = "tab";

/// See the module.
pub struct App {
    state: State,
    engine: Option<Engine>,
    textures: Textures,
    answers: Receiver<Answer>,
    answer: Sender<Answer>,
    writing: Writing,
    /// Whether the window closes when changed elements are saved.
    closes_then: bool,
    /// Whether the engine has ended.
    is_gone: bool,
    /// The least size of the window on this screen, in points.
    least_size: Vec2,
}

impl App {
    /// A window that begins with what the command line says.
    pub fn new(context: &eframe::CreationContext<'_>, arguments: Arguments) -> Self {
        theme::set(&context.egui_ctx);
        let recent = context.storage.and_then(|storage| storage.get_string(RECENT)).unwrap_or_default();
        let mut state = State::new(arguments, Recent::from_text(&recent));
        let tab = context.storage.and_then(|storage| storage.get_string(TAB)).unwrap_or_default();
        state.tab = Tab::named(&tab);
        let engine =
            Engine::new(&context.egui_ctx).map_err(|error| state.tell(Weight::Error, error.to_string())).ok();
        if let Some(engine) = &engine
            && let Err(reason) = signals::catch(engine.quitter())
        {
            state.tell(Weight::Warning, words::no_signals(&reason));
        }
        if let Some(path) = state.arguments.files.first().cloned() {
            state.act(Action::Open(path.into()));
        } else if state.part.role == Some(Role::Slave) {
            state.start_or_pause();
        }
        let (answer, answers) = channel();
        Self {
            state,
            engine,
            textures: Textures::default(),
            answers,
            answer,
            writing: Writing::default(),
            closes_then: false,
            is_gone: false,
            least_size: LEAST_SIZE,
        }
    }

    fn send(&self, command: Command) {
        if let Some(engine) = &self.engine {
            engine.send(command);
        }
    }

    /// Everything that has come since the last frame.
    fn hear(&mut self, context: &Context) {
        if let Some(engine) = &self.engine {
            for update in engine.news() {
                self.state.take(update);
            }
            engine.desk.set_longest_side(context.input(|input| input.max_texture_side));
            if let Some(shown) = engine.desk.take() {
                self.show(shown, context);
            }
        }
        for answer in self.answers.try_iter().collect::<Vec<_>>() {
            self.take(answer, context);
        }
        let dropped = context.input(|input| input.raw.dropped_files.clone());
        self.state.take_dropped(dropped.iter().map(|file| file.path().to_path_buf()).collect());
    }

    /// On a screen that is smaller than the least window, as those of few points are, the window may be smaller, too.
    fn fit_to_screen(&mut self, context: &Context) {
        let Some(screen) = context.input(|input| input.viewport().monitor_size) else { return };
        let least = LEAST_SIZE.min(screen);
        if self.least_size == least {
            return;
        }
        self.least_size = least;
        context.send_viewport_cmd(ViewportCommand::MinInnerSize(least));
        let size = context.input(|input| input.viewport().inner_rect).map_or(least, |rect| rect.size());
        if size.x > screen.x || size.y > screen.y {
            context.send_viewport_cmd(ViewportCommand::InnerSize(size.min(screen)));
        }
    }

    fn complain(&mut self, text: String) {
        self.state.tell(Weight::Error, text);
    }

    fn say(&mut self, text: String) {
        self.state.tell(Weight::Info, text);
    }

    fn tell_written(&mut self, files: &[PathBuf]) {
        // That it worked is to be seen.
        self.state.foot = Foot::Log;
        if files.is_empty() {
            self.say(words::NOTHING_TO_WRITE.to_owned());
        }
        for file in files {
            self.say(words::saved(file));
        }
    }

    fn read_elements(&mut self, context: &Context) {
        let Some(path) = self.state.path.clone() else { return };
        let (answer, context) = (self.answer.clone(), context.clone());
        self.spawn("elements", move || {
            drop(answer.send(Answer::Elements(Box::new(SceneFile::read(&path)))));
            context.request_repaint();
        });
    }

    /// Writes changed elements on a thread of its own, and then goes on with what is to be done.
    fn save_elements(&mut self, then: Action, context: &Context) {
        let files = self.state.take_unsaved();
        let (answer, context) = (self.answer.clone(), context.clone());
        // They are handed over once there is somebody to take them, so that they cannot be lost.
        let (hand, take) = channel::<Vec<SceneFile>>();
        let work = move || {
            let Ok(files) = take.recv() else { return };
            let save = |file: SceneFile| {
                let written = file.save();
                (file, written)
            };
            let saved = files.into_iter().map(save).collect();
            drop(answer.send(Answer::Saved(saved, Box::new(then))));
            context.request_repaint();
        };
        if let Err(error) = self.writing.spawn("elements", work) {
            self.complain(error.to_string());
        }
        match hand.send(files) {
            Ok(()) => self.state.saves_elements = true,
            Err(error) => error.0.into_iter().for_each(|file| self.state.put_back(file)),
        }
    }

    fn write_settings(&mut self, context: &Context) {
        let State { path: Some(path), controls: Some(controls), base: Some(base), .. } = &self.state else {
            return;
        };
        let (path, controls, base) = (path.clone(), controls.clone(), base.clone());
        let (answer, context) = (self.answer.clone(), context.clone());
        let work = move || {
            let read = SceneFile::read(&path).map_err(NotSaved::from);
            let written = read.and_then(|file| file.save_controls(&controls, &base));
            drop(answer.send(Answer::Written(written)));
            context.request_repaint();
        };
        if let Err(error) = self.writing.spawn("settings", work) {
            self.complain(error.to_string());
        }
    }

    fn show(&mut self, shown: Shown, context: &Context) {
        let (image, size) = (Arc::clone(&shown.texture), shown.image.size);
        match &mut self.textures.render {
            Some((texture, shown_size)) if texture.size() == image.size => {
                texture.set(image, options());
                *shown_size = size;
            }
            render => *render = Some((context.load_texture("render", image, options()), size)),
        }
        self.state.picture = Some(shown);
    }

    /// Does all that was asked for, and what that asks for in turn.
    fn act(&mut self, context: &Context) {
        while !self.state.actions.is_empty() {
            for action in std::mem::take(&mut self.state.actions) {
                if let Some(action) = self.state.allowed(action) {
                    self.do_action(action, context);
                }
            }
            // Panels and questions have their parts of the frame behind them already.
            context.request_repaint();
        }
    }

    fn do_action(&mut self, action: Action, context: &Context) {
        match action {
            Action::Command(command) => self.command(command),
            Action::Open(path) => {
                self.state.leave_queue_for(&path);
                self.open(&path, true, context);
            }
            Action::Ask(ask) => self.ask(ask, context),
            Action::Asked(ask, path) => self.asked(ask, path, context),
            Action::Restart => {
                if let Some(request) = self.state.request_again() {
                    self.load(request);
                } else if let Some(path) = self.state.wanted.clone() {
                    self.open(Path::new(&path), false, context);
                }
            }
            Action::ReadElements => self.read_elements(context),
            Action::SaveElements(then) => self.save_elements(*then, context),
            Action::WriteSettings => self.write_settings(context),
            Action::CheckPath(number, line) => self.check_path(number, *line, context),
            Action::ReadResponse(name, path) => self.read_response(name, path, context),
            Action::RunQueue | Action::NextInQueue => self.run_queue(),
            Action::TryToClose => context.send_viewport_cmd(ViewportCommand::Close),
            Action::Close => {
                self.is_gone = true;
                context.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    fn command(&mut self, command: Command) {
        if let (Command::SetPicture(picture), Some(engine)) = (&command, &self.engine) {
            engine.desk.set_settings((**picture).clone());
        }
        if matches!(command, Command::Cancel) {
            self.state.wanted.clone_from(&self.state.path);
        }
        self.send(command);
    }

    /// Opens a scene, a film, or a picture to compare with, by its ending.
    fn open(&mut self, path: &Path, starts: bool, context: &Context) {
        if has_ending(path, PICTURES) {
            self.asked(Ask::Compare, path.to_path_buf(), context);
        } else if has_ending(path, &["igi"]) {
            self.send(Command::OpenFilm(path.to_path_buf()));
        } else if let Some(path) = path.to_str() {
            self.load(self.state.request(path, starts));
        } else {
            self.complain(words::not_text(path));
        }
    }

    fn load(&mut self, request: Request) {
        self.state.wanted = Some(request.path.clone());
        self.send(Command::Open(Box::new(request)));
    }

    fn run_queue(&mut self) {
        if let Some(request) = self.state.request_next() {
            self.load(request);
        }
    }

    fn spawn(&mut self, name: &str, work: impl FnOnce() + Send + 'static) {
        if let Err(error) = std::thread::Builder::new().name(name.to_owned()).spawn(work) {
            self.complain(error.to_string());
        }
    }

    /// Neither a render nor changed elements are lost by closing the window, which lives until the engine has ended: that may
    /// take a while, in which nothing must look dead.
    fn tend_closing(&mut self, context: &Context) {
        let is_wanted = context.input(|input| input.viewport().close_requested());
        if !is_wanted || self.is_gone || self.engine.as_ref().is_none_or(Engine::has_ended) {
            return;
        }
        context.send_viewport_cmd(ViewportCommand::CancelClose);
        if self.state.saves_elements {
            // Whether they could be saved is known soon.
            self.closes_then = true;
            return;
        }
        match self.state.question_before_closing() {
            Some(question) => self.state.ask(question),
            None => self.state.save_and_close(),
        }
        // The question has its part of a frame behind it already.
        context.request_repaint();
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.hear(&context);
        self.fit_to_screen(&context);
        panels::keys(&context, &mut self.state);
        let bar = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(8, 0));
        let state = &mut self.state;
        Panel::top("tools").exact_size(theme::TOOL_BAR).frame(bar).show(ui, |ui| panels::toolbar(ui, state));
        Panel::bottom("status").exact_size(theme::LINE).frame(bar).show(ui, |ui| panels::status(ui, state));
        // How high it was made is remembered with what egui keeps.
        let foot =
            Panel::bottom("foot").resizable(true).default_size(theme::FOOT).size_range(theme::FOOT_HEIGHTS);
        foot.show(ui, |ui| panels::foot(ui, state));
        Panel::right("side").exact_size(theme::SIDE).show(ui, |ui| panels::side(ui, state));
        let textures = &self.textures;
        let middle = Frame::central_panel(ui.style()).inner_margin(0);
        CentralPanel::default().frame(middle).show(ui, |ui| panels::picture(ui, state, textures));
        panels::questions(&context, &mut self.state);
        if std::mem::take(&mut self.state.wants_other_theme) {
            context.set_theme(if ui.visuals().dark_mode { egui::Theme::Light } else { egui::Theme::Dark });
        }
        self.tend_closing(&context);
        self.act(&context);
        let title = self.state.path.as_deref().map_or_else(|| words::PROGRAM.to_owned(), words::title);
        if self.state.title != title {
            self.state.title.clone_from(&title);
            context.send_viewport_cmd(ViewportCommand::Title(title));
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        storage.set_string(RECENT, self.state.recent.to_text());
        storage.set_string(TAB, words::tab(self.state.tab).to_owned());
    }
}

/// Pixels are seen as squares when they are large, and averaged when they are small.
fn options() -> TextureOptions {
    TextureOptions {
        magnification: TextureFilter::Nearest,
        minification: TextureFilter::Linear,
        mipmap_mode: Some(TextureFilter::Linear),
        ..TextureOptions::LINEAR
    }
}
