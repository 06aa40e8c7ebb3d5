//! What the user is asked before anything else goes on.

use crate::action::Action;
use crate::engine::Command;
use crate::log::Weight;
use crate::question::{PathLine, Question};
use crate::state::State;
use crate::{theme, words};
use eframe::egui::{Context, Id, Key, Modal, TextEdit, Ui};

/// Shows a question, if there is one, and does what is answered.
pub fn questions(context: &Context, state: &mut State) {
    let Some(question) = state.question.take() else { return };
    state.question = match question {
        Question::Close => closing(context, state),
        Question::Unsaved(action) => unsaved(context, state, action),
        Question::UnsavedFilm(action) => unsaved_film(context, state, action),
        Question::Path(line) => path(context, state, line),
    };
}

/// What becomes of a render when the window closes.
fn closing(context: &Context, state: &mut State) -> Option<Question> {
    let answers = [words::CLOSE_SAVE, words::CLOSE_DISCARD, words::CLOSE_NOT];
    match choose(context, words::CLOSE_HEAD, words::CLOSE_TEXT, answers) {
        None => return Some(Question::Close),
        Some(0) => state.save_and_close(),
        Some(1) => state.command(Command::Quit { saves: false }),
        Some(_) => {}
    }
    None
}

/// What becomes of changed elements before something is done.
fn unsaved(context: &Context, state: &mut State, action: Box<Action>) -> Option<Question> {
    let answers = [words::UNSAVED_SAVE, words::UNSAVED_DISCARD, words::CANCEL];
    match choose(context, words::UNSAVED_HEAD, &words::unsaved(state.n_unsaved()), answers) {
        None => return Some(Question::Unsaved(action)),
        Some(0) => state.act(Action::SaveElements(action)),
        Some(1) => {
            state.discard_unsaved();
            state.act(*action);
        }
        Some(_) => {}
    }
    None
}

/// What becomes of films that could not be saved before something is done.
fn unsaved_film(context: &Context, state: &mut State, action: Box<Action>) -> Option<Question> {
    let answers = [words::FILM_SAVE, words::UNSAVED_DISCARD, words::CANCEL];
    match choose(context, words::FILM_HEAD, &words::unsaved_films(state.unsaved_films), answers) {
        None => return Some(Question::UnsavedFilm(action)),
        Some(0) => state.save_films_before(action),
        Some(1) => {
            state.discard_films();
            state.act(*action);
        }
        Some(_) => {}
    }
    None
}

/// The number of the answer that was chosen; the last where the question is closed.
fn choose(context: &Context, head: &str, text: &str, answers: [&str; 3]) -> Option<usize> {
    let modal = Modal::new(Id::unique("question")).show(context, |ui| {
        ui.set_width(380.0);
        ui.heading(head);
        ui.add_space(6.0);
        ui.label(text);
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            answers.map(|answer| ui.button(answer).clicked()).iter().position(|clicked| *clicked)
        })
        .inner
    });
    let is_left = modal.should_close();
    modal.inner.or(is_left.then_some(answers.len() - 1))
}

/// A path, where the desktop has no dialog for it.
fn path(context: &Context, state: &mut State, mut line: PathLine) -> Option<Question> {
    let modal = Modal::new(Id::unique("path")).show(context, |ui| path_line(ui, &mut line));
    let is_left = modal.should_close();
    match modal.inner {
        Some(true) => match line.accept() {
            Some(path) => {
                state.act(Action::Asked(line.ask, path));
                None
            }
            None => Some(Question::Path(line)),
        },
        None if !is_left => Some(Question::Path(line)),
        _ => None,
    }
}

/// Whether the path is to be taken, or none; nothing is decided at first.
fn path_line(ui: &mut Ui, line: &mut PathLine) -> Option<bool> {
    ui.set_width(520.0);
    ui.heading(words::asked_for(line.ask));
    ui.add_space(6.0);
    let name = ui.label(words::NO_DIALOG).id;
    ui.add_space(4.0);
    let field = ui.add(TextEdit::singleline(&mut line.text).desired_width(f32::INFINITY)).labelled_by(name);
    if std::mem::take(&mut line.is_new) {
        field.request_focus();
    }
    if field.changed() {
        line.wrong.clear();
    }
    let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if is_entered {
        // It may have to be mended.
        field.request_focus();
    }
    if !line.wrong.is_empty() {
        ui.colored_label(theme::of_weight(Weight::Error, ui.visuals()), &line.wrong);
    }
    ui.add_space(10.0);
    let answers = [words::answer(line.ask), words::CANCEL];
    let clicked = ui.horizontal(|ui| answers.map(|answer| ui.button(answer).clicked())).inner;
    match clicked {
        [true, _] => Some(true),
        [_, true] => Some(false),
        _ => is_entered.then_some(true),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::action::Ask;
    use crate::panels::keys;
    use crate::recent::Recent;
    use crate::scene_file::SceneFile;
    use crate::state::Tool;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use indigo_front::flags::Arguments;
    use std::path::PathBuf;

    fn harness(question: Question) -> Harness<'static, State> {
        let mut state = State::new(Arguments::default(), Recent::default());
        (state.question, state.tool) = (Some(question), Tool::Region);
        let ui = |ui: &mut Ui, state: &mut State| {
            keys(ui.ctx(), state);
            questions(ui.ctx(), state);
        };
        let mut harness = Harness::new_ui_state(ui, state);
        harness.run();
        harness
    }

    fn scratch(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("indigo-questions-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn escape_answers_the_question_and_only_then_ends_what_the_pointer_does() {
        let mut harness = harness(Question::Close);
        for (is_asked, tool) in [(false, Tool::Region), (false, Tool::Pan)] {
            harness.key_press(Key::Escape);
            harness.run();
            let state = harness.state();
            assert_eq!((state.question.is_some(), state.tool), (is_asked, tool));
        }
    }

    #[test]
    fn changed_elements_are_saved_given_up_or_kept_before_another_scene_is_opened() {
        let folder = scratch("unsaved");
        let path = folder.join("a.igs");
        std::fs::write(&path, "<scene><camera><pos>0 0 0</pos></camera></scene>").unwrap();
        for (answer, is_changed) in
            [(words::UNSAVED_SAVE, true), (words::UNSAVED_DISCARD, false), (words::CANCEL, true)]
        {
            let mut harness = harness(Question::Close);
            let state = harness.state_mut();
            state.question = None;
            let mut file = SceneFile::read(path.to_str().unwrap()).unwrap();
            file.changes.insert(vec![0, 0], "1 2 3".to_owned());
            state.file = Some(file);
            assert!(state.allowed(Action::ReadElements).is_some(), "nothing is lost by that");
            assert!(state.allowed(Action::Open("picture.png".into())).is_some());
            assert!(matches!(state.question_before_closing(), Some(Question::Unsaved(_))));
            assert!(state.allowed(Action::Open("b.igs".into())).is_none());
            harness.run();
            harness.get_by_label(answer).click();
            harness.run();
            let state = harness.state_mut();
            assert!(state.question.is_none());
            assert_eq!(state.has_unsaved(), is_changed, "{answer}");
            match state.actions.pop() {
                Some(Action::SaveElements(then)) if answer == words::UNSAVED_SAVE => {
                    assert!(matches!(*then, Action::Open(_)));
                }
                Some(Action::Open(_)) if answer == words::UNSAVED_DISCARD => {}
                None if answer == words::CANCEL => {}
                _ => panic!("{answer} does something else"),
            }
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_path_is_typed_where_the_desktop_has_no_dialog() {
        let folder = scratch("path");
        let mut harness = harness(Question::Path(PathLine::new(Ask::Open, Some(&folder), "a.igs")));
        harness.key_press(Key::Enter);
        harness.run();
        let Some(Question::Path(line)) = &harness.state().question else { panic!("it is taken") };
        assert!(line.wrong.contains("a.igs"), "{}", line.wrong);
        std::fs::write(folder.join("a.igs"), "<scene/>").unwrap();
        harness.key_press(Key::Enter);
        harness.run();
        let state = harness.state_mut();
        assert!(state.question.is_none());
        let Some(Action::Asked(Ask::Open, path)) = state.actions.pop() else { panic!("it is not taken") };
        assert_eq!(path, folder.join("a.igs"));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
