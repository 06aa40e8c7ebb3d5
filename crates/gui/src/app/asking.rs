//! Asking for paths, and what becomes of them.

use super::App;
use super::answers::Answer;
use crate::action::{Action, Ask};
use crate::dialog::{self, NoDialog, Wanted};
use crate::engine::Command;
use crate::question::PathLine;
use crate::{comparison, controls, words};
use eframe::egui::Context;
use indigo_front::net::make_key;
use std::path::{Path, PathBuf};

impl App {
    /// Asks for a path by the desktop's own dialog, on a thread that waits for it; by a line to type in where there is none.
    pub(super) fn ask(&mut self, ask: Ask, context: &Context) {
        let mut wanted = self.wanted(ask);
        let (answer, context) = (self.answer.clone(), context.clone());
        self.spawn("dialog", move || {
            wanted.folder.take_if(|folder| !folder.is_dir());
            let answered = match dialog::choose(&wanted) {
                Ok(Some(path)) => match PathLine::of_dialog(ask, &path) {
                    Ok(path) => Answer::Path(ask, path),
                    Err(line) => Answer::NoDialog(line),
                },
                Ok(None) => Answer::NoPath(ask),
                Err(NoDialog) => Answer::NoDialog(PathLine::new(ask, wanted.folder.as_deref(), &wanted.name)),
            };
            // The window may be closed by now.
            drop(answer.send(answered));
            context.request_repaint();
        });
    }

    fn wanted(&self, ask: Ask) -> Wanted {
        let folder = self.state.wanted.as_deref().and_then(|path| Path::new(path).parent());
        let folder = folder.map(Path::to_path_buf);
        let stem = self.state.path.as_deref().and_then(|path| Path::new(path).file_stem());
        let name = match ask {
            Ask::Save(what) => {
                format!("{}.{}", stem.unwrap_or_default().to_string_lossy(), words::ending(what))
            }
            Ask::NewKey => words::KEY_NAME.to_owned(),
            _ => String::new(),
        };
        Wanted { ask, folder, name }
    }

    /// Takes a path for what was asked.
    pub(super) fn asked(&mut self, ask: Ask, path: PathBuf, context: &Context) {
        match ask {
            Ask::Open => self.state.act(Action::Open(path)),
            Ask::Queue => self.state.queue.add(path),
            Ask::Save(what) => self.send(Command::Save(what, path)),
            Ask::Key => self.take_key(&path),
            Ask::NewKey => {
                let (answer, context) = (self.answer.clone(), context.clone());
                self.spawn("key", move || {
                    let made = make_key(&path);
                    drop(answer.send(Answer::NewKey(path, made)));
                    context.request_repaint();
                });
            }
            Ask::Compare => {
                let (answer, context) = (self.answer.clone(), context.clone());
                let longest_side = context.input(|input| input.max_texture_side);
                self.spawn("compare", move || {
                    let read = comparison::read(&path, longest_side);
                    drop(answer.send(Answer::Comparison(path, read)));
                    context.request_repaint();
                });
            }
        }
    }

    /// Looks at a path that was typed, which may be on a disk that takes its time.
    pub(super) fn check_path(&mut self, number: u64, line: PathLine, context: &Context) {
        let (answer, context) = (self.answer.clone(), context.clone());
        self.spawn("path", move || {
            let ask = line.ask;
            let accepted = line.accept().map(|path| (ask, path));
            drop(answer.send(Answer::Checked(number, Box::new(accepted))));
            context.request_repaint();
        });
    }

    /// Reads a response curve that was chosen.
    pub(super) fn read_response(&mut self, name: String, path: PathBuf, context: &Context) {
        let (answer, context) = (self.answer.clone(), context.clone());
        self.spawn("response", move || {
            let read = controls::read_response(&name, &path);
            drop(answer.send(Answer::Response(name, read)));
            context.request_repaint();
        });
    }

    pub(super) fn take_key(&mut self, path: &Path) {
        match path.to_str() {
            Some(text) => text.clone_into(&mut self.state.part.key_file),
            None => self.complain(words::not_text(path)),
        }
    }
}
