//! What comes back from threads that wait for the user or a disk.

use super::{App, options};
use crate::action::{Action, Ask};
use crate::comparison::Layout;
use crate::question::{PathLine, Question};
use crate::scene_file::{NotSaved, SceneFile};
use crate::words;
use eframe::egui::{ColorImage, Context};
use indigo_imaging::Response;
use std::path::PathBuf;
use std::sync::Arc;

/// See the module.
pub enum Answer {
    /// A path for what was asked.
    Path(Ask, PathBuf),
    /// None was given.
    NoPath(Ask),
    /// The desktop cannot ask for it, or has not asked for all.
    NoDialog(PathLine),
    /// A path that was typed under a number: itself if it can be what was asked for, or else what is wrong.
    Checked(u64, Box<Result<(Ask, PathBuf), PathLine>>),
    /// A new key is in a file.
    NewKey(PathBuf, Result<(), String>),
    /// A response curve, by its name.
    Response(String, Result<Arc<Response>, String>),
    /// A picture to compare with.
    Comparison(PathBuf, Result<Arc<ColorImage>, String>),
    /// The elements of a scene.
    Elements(Box<Result<SceneFile, String>>),
    /// What was written into a scene.
    Written(Result<Vec<PathBuf>, NotSaved>),
    /// What was written of changed elements, and what is done then.
    Saved(Vec<(SceneFile, Result<Vec<PathBuf>, NotSaved>)>, Box<Action>),
}

impl App {
    /// Takes what came back.
    pub(super) fn take(&mut self, answer: Answer, context: &Context) {
        match answer {
            Answer::Path(ask, path) => self.asked(ask, path, context),
            Answer::NoPath(ask) => self.state.path_is_not_given(ask),
            Answer::NoDialog(line) => self.state.ask(Question::Path(line)),
            Answer::Checked(number, result) => self.state.path_is_checked(number, *result),
            Answer::NewKey(path, Ok(())) => {
                self.say(words::key_made(&path));
                self.take_key(&path);
            }
            Answer::Response(name, result) => self.take_response(&name, result),
            Answer::Comparison(path, Ok(image)) => self.compare(path, image, context),
            Answer::Elements(file) => match *file {
                Ok(file) => self.state.take_file(file),
                Err(text) => self.complain(text),
            },
            Answer::Written(Ok(files)) => {
                self.tell_written(&files);
                // They are read again, so that changes of theirs can still be saved.
                if self.state.file.is_some() {
                    self.read_elements(context);
                }
            }
            Answer::Saved(files, then) => self.elements_are_saved(files, *then),
            Answer::Written(Err(error)) => self.complain(error.in_words()),
            Answer::NewKey(_, Err(text)) | Answer::Comparison(_, Err(text)) => self.complain(text),
        }
    }

    fn compare(&mut self, path: PathBuf, image: Arc<ColorImage>, context: &Context) {
        self.textures.other = Some(context.load_texture("other", Arc::clone(&image), options()));
        self.state.comparison.picture = Some((path, image));
        if self.state.comparison.layout == Layout::Off {
            self.state.comparison.layout = Layout::Wipe;
        }
    }

    /// A curve is there; another may have been chosen since.
    fn take_response(&mut self, name: &str, result: Result<Arc<Response>, String>) {
        if self.state.awaited_response.take_if(|awaited| awaited == name).is_none() {
            return;
        }
        match (result, &mut self.state.controls) {
            (Ok(response), Some(controls)) => {
                controls.response = response;
                self.state.controls_changed();
            }
            (Err(text), _) => self.complain(text),
            _ => {}
        }
    }

    /// Changed elements are in their files, or are not.
    fn elements_are_saved(&mut self, files: Vec<(SceneFile, Result<Vec<PathBuf>, NotSaved>)>, then: Action) {
        self.state.saves_elements = false;
        let mut are_saved = true;
        for (file, written) in files {
            match written {
                Ok(files) => {
                    self.state.was_saved(&file);
                    self.tell_written(&files);
                }
                Err(error) => {
                    are_saved = false;
                    let is_open = self.state.path.as_deref() == Some(file.path());
                    if is_open && matches!(error, NotSaved::ChangedElsewhere(_)) {
                        self.state.act(Action::ReadElements);
                    }
                    self.state.put_back(file);
                    self.complain(error.in_words());
                }
            }
        }
        // Unless they are saved the window stays.
        let closes = std::mem::take(&mut self.closes_then);
        if are_saved {
            self.state.act(if closes { Action::TryToClose } else { then });
        }
    }
}
