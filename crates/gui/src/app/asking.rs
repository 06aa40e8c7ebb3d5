//! Asking for paths, and what becomes of them.

use super::{Answer, App};
use crate::action::{Action, Ask};
use crate::dialog::{self, NoDialog, Wanted};
use crate::engine::Command;
use crate::question::PathLine;
use crate::{comparison, words};
use eframe::egui::Context;
use indigo_front::net::make_key;
use std::path::{Path, PathBuf};

impl App {
    /// Asks for a path by the desktop's own dialog, on a thread that waits for it; by a line to type in where there is none.
    pub(super) fn ask(&mut self, ask: Ask, context: &Context) {
        let wanted = self.wanted(ask);
        let (answer, context) = (self.answer.clone(), context.clone());
        self.spawn("dialog", move || {
            let answered = match dialog::choose(&wanted) {
                Ok(Some(path)) => Answer::Path(ask, path),
                Ok(None) => return,
                Err(NoDialog) => Answer::NoDialog(PathLine::new(ask, wanted.folder.as_deref(), &wanted.name)),
            };
            // The window may be closed by now.
            drop(answer.send(answered));
            context.request_repaint();
        });
    }

    fn wanted(&self, ask: Ask) -> Wanted {
        let folder = self.state.wanted.as_deref().and_then(|path| Path::new(path).parent());
        let folder = folder.filter(|folder| folder.is_dir()).map(Path::to_path_buf);
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
            Ask::NewKey => match make_key(&path) {
                Ok(()) => {
                    self.say(words::key_made(&path));
                    self.take_key(&path);
                }
                Err(text) => self.complain(text),
            },
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

    fn take_key(&mut self, path: &Path) {
        match path.to_str() {
            Some(text) => text.clone_into(&mut self.state.part.key_file),
            None => self.complain(words::not_text(path)),
        }
    }
}
