//! What the user is asked before anything else goes on.

use crate::action::{Action, Ask};
use crate::engine::Command;
use crate::state::State;
use crate::words;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// See the module.
pub enum Question {
    /// What becomes of a render when the window closes.
    Close,
    /// What becomes of changed elements before something is done.
    Unsaved(Box<Action>),
    /// What becomes of films that could not be saved before something is done.
    UnsavedFilm(Box<Action>),
    /// What becomes of samples that are in no file before something is done.
    LostSamples(Box<Action>),
    /// A path, where the desktop has no dialog for it.
    Path(PathLine),
}

impl Question {
    /// Whether two ask the same, whatever is done then.
    fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Close, Self::Close)
            | (Self::Unsaved(_), Self::Unsaved(_))
            | (Self::UnsavedFilm(_), Self::UnsavedFilm(_))
            | (Self::LostSamples(_), Self::LostSamples(_)) => true,
            (Self::Path(one), Self::Path(other)) => one.ask == other.ask,
            _ => false,
        }
    }
}

/// Questions that wait to be answered, one after another.
#[derive(Default)]
pub struct Questions {
    waiting: VecDeque<Question>,
    /// Whether the first of them has been shown already.
    is_shown: bool,
    /// How many paths were sent to be looked at.
    tries: u64,
}

impl Questions {
    /// Asks after all others; what is asked already is not asked again, but what was wanted last is done.
    pub fn ask(&mut self, question: Question) {
        match self.waiting.iter_mut().find(|other| other.is_like(&question)) {
            Some(Question::Path(_)) => {}
            Some(other) => *other = question,
            None => self.waiting.push_back(question),
        }
    }

    /// Whether any waits.
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// The first, and whether it was not shown yet.
    pub fn take(&mut self) -> Option<(Question, bool)> {
        let is_new = !self.is_shown;
        self.is_shown = false;
        self.waiting.pop_front().map(|question| (question, is_new))
    }

    /// Puts the first back, which was shown and not answered.
    pub fn keep(&mut self, question: Question) {
        self.is_shown = true;
        self.waiting.push_front(question);
    }

    /// A number for a path that is looked at.
    pub fn next_try(&mut self) -> u64 {
        self.tries += 1;
        self.tries
    }

    /// Takes out the line that waits for a path to be looked at under a number, or leaves all as they are.
    fn is_answered(&mut self, number: u64) -> bool {
        let waits =
            |question: &Question| matches!(question, Question::Path(line) if line.checked_as == Some(number));
        let Some(at) = self.waiting.iter().position(waits) else { return false };
        self.is_shown &= at > 0;
        self.waiting.remove(at);
        true
    }
}

impl State {
    /// Asks the user.
    pub fn ask(&mut self, question: Question) {
        self.questions.ask(question);
    }

    /// What is asked before the window closes, if anything would be lost.
    pub fn question_before_closing(&self) -> Option<Question> {
        if self.has_unsaved() {
            return Some(Question::Unsaved(Action::TryToClose.into()));
        }
        if self.unsaved_films > 0 {
            return Some(Question::UnsavedFilm(Action::TryToClose.into()));
        }
        if self.would_lose_work() {
            return Some(Question::LostSamples(Action::TryToClose.into()));
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
        // A slip of the mouse may ask for another region.
        let is_region = matches!(action, Action::Command(Command::SetRegion(..)));
        if is_region && self.would_lose_samples() || action.leaves_film() && self.would_lose_work() {
            self.ask(Question::LostSamples(Box::new(action)));
            return None;
        }
        Some(action)
    }

    /// A path that was typed has been looked at; nobody may wait for it any more.
    pub fn path_is_checked(&mut self, number: u64, result: Result<(Ask, PathBuf), PathLine>) {
        if !self.questions.is_answered(number) {
            return;
        }
        match result {
            Ok((ask, path)) => self.act(Action::Asked(ask, path)),
            // It can be mended.
            Err(line) => self.questions.keep(Question::Path(PathLine { is_new: true, ..line })),
        }
    }
}

/// A path as it is typed.
#[derive(Clone)]
pub struct PathLine {
    /// What it is for.
    pub ask: Ask,
    /// As far as it is typed.
    pub text: String,
    /// What is wrong with it, as far as was seen.
    pub wrong: String,
    /// Whether it is to have the focus.
    pub is_new: bool,
    /// The number under which it is looked at, if it is.
    pub checked_as: Option<u64>,
    /// Whether it comes from a dialog of the desktop.
    pub is_of_dialog: bool,
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
        Self {
            ask,
            text,
            wrong: String::new(),
            is_new: true,
            checked_as: None,
            is_of_dialog: false,
            replaces: None,
        }
    }

    /// A path that was chosen in a dialog of the desktop, with the ending of its kind.
    ///
    /// # Errors
    /// A line to ask once more where another file has that name: the desktop has asked about the name without the ending.
    pub fn of_dialog(ask: Ask, path: &Path) -> Result<PathBuf, Self> {
        let completed = ask.completed(path.to_path_buf());
        if completed == path || !completed.exists() {
            return Ok(completed);
        }
        let line = Self::new(ask, completed.parent(), "");
        Self { text: completed.display().to_string(), is_of_dialog: true, ..line }.accept()
    }

    /// The path, if it can be what was asked for. It may be on a disk that takes its time.
    ///
    /// # Errors
    /// The line, with what is wrong.
    pub fn accept(mut self) -> Result<PathBuf, Self> {
        self.checked_as = None;
        let typed = at_home(self.text.trim());
        let path = if typed.is_dir() { typed } else { self.ask.completed(typed) };
        match self.check(&path) {
            Ok(()) => Ok(path),
            Err(wrong) => Err(Self { wrong, ..self }),
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
        // A key that somebody may have is never lost.
        if is_there && self.ask == Ask::NewKey {
            return Err(words::key_is_there(path));
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
    use crate::recent::Recent;
    use indigo_front::flags::Arguments;
    use indigo_render::output::OneFile;

    #[test]
    fn a_path_is_taken_when_it_can_be_what_was_asked_for() {
        let folder = std::env::temp_dir().join(format!("indigo-path-line-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("there.png"), "x").unwrap();
        let line = PathLine::new(Ask::Open, Some(&folder), "");
        assert_eq!(Path::new(&line.text), folder);
        let wrong =
            |text: &str| PathLine { text: text.to_owned(), ..line.clone() }.accept().err().map(|l| l.wrong);
        assert!(wrong(&line.text).is_some_and(|wrong| wrong.contains("folder")));
        for (name, is_wrong) in [("none/a.igs", "no folder"), ("none.igs", "no file")] {
            let wrong = wrong(&folder.join(name).display().to_string());
            assert!(wrong.as_ref().is_some_and(|wrong| wrong.contains(is_wrong)), "{name}: {wrong:?}");
        }
        assert_eq!(wrong("").as_deref(), Some(words::NO_PATH));
        let there = folder.join("there.png");
        let line = PathLine { text: format!(" {} ", there.display()), ..line };
        assert_eq!(line.accept().ok(), Some(there));
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
        let line = PathLine::new(Ask::Save(OneFile::Picture), Some(&folder), "a");
        let mut line = line.accept().expect_err("it is there");
        line.text = folder.join("b.png").display().to_string();
        let line = line.accept().expect_err("that is another file");
        assert_eq!(line.clone().accept().ok(), Some(folder.join("b.png")));
        let line = PathLine { text: folder.join("new").display().to_string(), ..line };
        assert_eq!(line.accept().ok(), Some(folder.join("new.png")));
        // The desktop has asked about the name without the ending, if at all.
        let save = Ask::Save(OneFile::Picture);
        assert_eq!(PathLine::of_dialog(save, &folder.join("a.png")).ok(), Some(folder.join("a.png")));
        assert_eq!(PathLine::of_dialog(save, &folder.join("c")).ok(), Some(folder.join("c.png")));
        let line = PathLine::of_dialog(save, &folder.join("a")).expect_err("it is there");
        assert_eq!(line.accept().ok(), Some(folder.join("a.png")));
        // A key that others have is not written over, however often that is asked for.
        let key = PathLine::new(Ask::NewKey, Some(&folder), "a.png");
        let key = key.accept().expect_err("it is there");
        assert!(key.wrong.contains("another name"), "{}", key.wrong);
        assert!(key.accept().is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }

    fn state() -> State {
        State::new(Arguments::default(), Recent::default())
    }

    #[test]
    fn a_question_waits_for_the_one_before() {
        let mut state = state();
        state.ask(Question::Path(PathLine::new(Ask::Key, None, "a.key")));
        state.ask(Question::Close);
        state.ask(Question::Close);
        let first = state.questions.take().expect("it is asked");
        assert!(matches!(first, (Question::Path(_), true)));
        state.questions.keep(first.0);
        let (first, is_new) = state.questions.take().expect("it is not answered");
        assert!(matches!(first, Question::Path(_)) && !is_new);
        assert!(matches!(state.questions.take(), Some((Question::Close, true))));
        assert!(state.questions.is_empty(), "asked once");
    }

    #[test]
    fn only_the_path_that_is_waited_for_is_taken() {
        let mut state = state();
        let ask = |state: &mut State, number| {
            let line = PathLine::new(Ask::Open, None, "a.igs");
            state.ask(Question::Path(PathLine { checked_as: Some(number), ..line }));
        };
        ask(&mut state, 2);
        state.path_is_checked(1, Ok((Ask::Open, "a.igs".into())));
        assert!(state.actions.is_empty() && !state.questions.is_empty(), "the first was given up");
        let line = PathLine { wrong: "not there".to_owned(), ..PathLine::new(Ask::Open, None, "a.igs") };
        state.path_is_checked(2, Err(line));
        let Some((Question::Path(line), _)) = state.questions.take() else { panic!("it can be mended") };
        assert_eq!((line.wrong.as_str(), line.checked_as), ("not there", None));
        ask(&mut state, 3);
        state.path_is_checked(3, Ok((Ask::Open, "a.igs".into())));
        assert!(state.questions.is_empty());
        assert!(matches!(state.actions.pop(), Some(Action::Asked(Ask::Open, _))));
    }
}
