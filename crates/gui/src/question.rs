//! What the user is asked before anything else goes on.

use crate::action::{Action, Ask};
use crate::state::State;
use crate::words;
use std::path::{Path, PathBuf};

/// See the module.
pub enum Question {
    /// What becomes of a render when the window closes.
    Close,
    /// What becomes of changed elements before something is done.
    Unsaved(Box<Action>),
    /// What becomes of films that could not be saved before something is done.
    UnsavedFilm(Box<Action>),
    /// A path, where the desktop has no dialog for it.
    Path(PathLine),
}

impl State {
    /// Asks the user.
    pub fn ask(&mut self, question: Question) {
        self.question = Some(question);
    }

    /// What is asked before the window closes, if anything would be lost.
    pub fn question_before_closing(&self) -> Option<Question> {
        if self.has_unsaved() {
            return Some(Question::Unsaved(Action::TryToClose.into()));
        }
        if self.unsaved_films > 0 {
            return Some(Question::UnsavedFilm(Action::TryToClose.into()));
        }
        self.has_growing_film().then_some(Question::Close)
    }

    /// Something to do, unless changed elements or a film would be lost by it: then the user is asked.
    pub fn allowed(&mut self, action: Action) -> Option<Action> {
        if self.has_unsaved() && action.leaves_scene() {
            self.ask(Question::Unsaved(Box::new(action)));
            return None;
        }
        if self.unsaved_films > 0 && action.leaves_film() {
            self.ask(Question::UnsavedFilm(Box::new(action)));
            return None;
        }
        Some(action)
    }
}

/// A path as it is typed.
pub struct PathLine {
    /// What it is for.
    pub ask: Ask,
    /// As far as it is typed.
    pub text: String,
    /// What is wrong with it, as far as was seen.
    pub wrong: String,
    /// Whether it has not been shown yet.
    pub is_new: bool,
    /// The file that may be written over: the one of which it was told that it is there.
    replaces: Option<PathBuf>,
}

impl PathLine {
    /// Begins in a folder, if there is one, with the name of a file, if that can be guessed.
    pub fn new(ask: Ask, folder: Option<&Path>, name: &str) -> Self {
        let folder =
            folder.map(|folder| std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf()));
        // With a slash at its end where no name follows.
        let text = folder.unwrap_or_default().join(name).display().to_string();
        Self { ask, text, wrong: String::new(), is_new: true, replaces: None }
    }

    /// The path, if it can be what was asked for; else what is wrong can be read.
    pub fn accept(&mut self) -> Option<PathBuf> {
        let typed = at_home(self.text.trim());
        let path = if typed.is_dir() { typed } else { self.ask.completed(typed) };
        match self.check(&path) {
            Ok(()) => Some(path),
            Err(wrong) => {
                self.wrong = wrong;
                None
            }
        }
    }

    fn check(&mut self, path: &Path) -> Result<(), String> {
        if path.as_os_str().is_empty() {
            return Err(words::NO_PATH.to_owned());
        }
        if path.is_dir() {
            return Err(words::is_folder(path));
        }
        // A name alone stands in the folder in which the program runs.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return Err(words::no_folder(folder));
        }
        let is_there = path.exists();
        if !self.ask.writes() {
            return if is_there { Ok(()) } else { Err(words::no_file(path)) };
        }
        if is_there && self.replaces.as_deref() != Some(path) {
            self.replaces = Some(path.to_path_buf());
            return Err(words::is_there(path));
        }
        Ok(())
    }
}

/// A path, of which `~` at its beginning is the user's folder, as in a shell.
fn at_home(text: &str) -> PathBuf {
    match (text.strip_prefix("~/"), std::env::home_dir()) {
        (Some(rest), Some(home)) => home.join(rest),
        _ => PathBuf::from(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_render::output::OneFile;

    #[test]
    fn a_path_is_taken_when_it_can_be_what_was_asked_for() {
        let folder = std::env::temp_dir().join(format!("indigo-path-line-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("there.png"), "x").unwrap();
        let mut line = PathLine::new(Ask::Open, Some(&folder), "");
        assert_eq!(Path::new(&line.text), folder);
        assert!(line.accept().is_none() && line.wrong.contains("folder"), "{}", line.wrong);
        for (name, is_wrong) in [("none/a.igs", "no folder"), ("none.igs", "no file"), ("", "")] {
            line.text = if name.is_empty() { String::new() } else { folder.join(name).display().to_string() };
            assert!(line.accept().is_none() && line.wrong.contains(is_wrong), "{name}: {}", line.wrong);
        }
        line.text = format!(" {} ", folder.join("there.png").display());
        assert_eq!(line.accept(), Some(folder.join("there.png")));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_file_is_written_over_when_that_is_said_twice() {
        let folder = std::env::temp_dir().join(format!("indigo-path-twice-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for name in ["a.png", "b.png"] {
            std::fs::write(folder.join(name), "x").unwrap();
        }
        // The ending is part of the name that is there.
        let mut line = PathLine::new(Ask::Save(OneFile::Picture), Some(&folder), "a");
        assert_eq!(line.accept(), None);
        line.text = folder.join("b.png").display().to_string();
        assert_eq!(line.accept(), None, "that is another file");
        assert_eq!(line.accept(), Some(folder.join("b.png")));
        line.text = folder.join("new").display().to_string();
        assert_eq!(line.accept(), Some(folder.join("new.png")));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
