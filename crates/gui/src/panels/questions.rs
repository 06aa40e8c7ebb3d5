//! What the user is asked before anything else goes on.

use crate::action::Action;
use crate::engine::Command;
use crate::log::Weight;
use crate::question::{PathLine, Question};
use crate::state::State;
use crate::{theme, words};
use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::text_edit::TextEditState;
use eframe::egui::{Button, Context, Id, Key, Modal, Response, TextEdit, Ui};

/// Shows a question, if there is one, and does what is answered.
pub fn questions(context: &Context, state: &mut State) {
    let Some((question, is_new)) = state.questions.take() else { return };
    let is_left = match question {
        Question::Close => closing(context, state, is_new),
        Question::Unsaved(action) => unsaved(context, state, action, is_new),
        Question::UnsavedFilm(action) => unsaved_film(context, state, action, is_new),
        Question::LostSamples(action) => lost_samples(context, state, action, is_new),
        Question::Path(line) => path(context, state, line),
    };
    if let Some(question) = is_left {
        state.questions.keep(question);
    }
}

/// What becomes of a render when the window closes.
fn closing(context: &Context, state: &mut State, is_new: bool) -> Option<Question> {
    if !state.has_growing_film() {
        // It ended while something else was asked.
        state.act(Action::TryToClose);
        return None;
    }
    let [head, stay] = words::closing(&state.phase);
    let answers = [words::CLOSE_SAVE, words::CLOSE_DISCARD, stay];
    match choose(context, head, words::CLOSE_TEXT, answers, is_new) {
        None => return Some(Question::Close),
        Some(0) => state.save_and_close(),
        Some(1) => state.command(Command::Quit { saves: false }),
        Some(_) => {}
    }
    None
}

/// What becomes of changed elements before something is done.
fn unsaved(context: &Context, state: &mut State, action: Box<Action>, is_new: bool) -> Option<Question> {
    if !state.has_unsaved() {
        // Nothing would be lost any more.
        state.act(*action);
        return None;
    }
    let answers = [words::UNSAVED_SAVE, words::UNSAVED_DISCARD, words::CANCEL];
    match choose(context, words::UNSAVED_HEAD, &words::unsaved(state.n_unsaved()), answers, is_new) {
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
fn unsaved_film(context: &Context, state: &mut State, action: Box<Action>, is_new: bool) -> Option<Question> {
    if state.unsaved_films == 0 {
        state.act(*action);
        return None;
    }
    let answers = [words::FILM_SAVE, words::FILM_SAVE_AS, words::UNSAVED_DISCARD, words::CANCEL];
    match choose(context, words::FILM_HEAD, &words::unsaved_films(state.unsaved_films), answers, is_new) {
        None => return Some(Question::UnsavedFilm(action)),
        Some(0) => state.save_films_before(action),
        Some(1) => state.save_film_before(action),
        Some(2) => {
            state.discard_films();
            state.act(*action);
        }
        Some(_) => {}
    }
    None
}

/// What becomes of samples that are in no file before something else takes their place.
fn lost_samples(context: &Context, state: &mut State, action: Box<Action>, is_new: bool) -> Option<Question> {
    if !state.would_lose_samples() {
        state.act(*action);
        return None;
    }
    let lost = state.samples_in_no_file();
    let answers = [words::SAMPLES_SAVE, words::SAMPLES_DISCARD, words::CANCEL];
    match choose(context, words::SAMPLES_HEAD, &words::lost_samples(lost), answers, is_new) {
        None => return Some(Question::LostSamples(action)),
        Some(0) => state.save_film_before(action),
        Some(1) => {
            state.give_up_samples();
            state.act(*action);
        }
        Some(_) => {}
    }
    None
}

/// The number of the answer that was chosen; the last where the question is closed.
fn choose<const N: usize>(
    context: &Context,
    head: &str,
    text: &str,
    answers: [&str; N],
    is_new: bool,
) -> Option<usize> {
    let modal = Modal::new(Id::unique("question")).show(context, |ui| {
        ui.set_width(380.0);
        ui.heading(head);
        ui.add_space(6.0);
        ui.label(text);
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            let buttons = answers.map(|answer| ui.button(answer));
            if is_new {
                // So that it can be answered by a key, and a screen reader says it.
                buttons[0].request_focus();
            }
            buttons.iter().position(Response::clicked)
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
        Some(true) => {
            let number = state.questions.next_try();
            line.checked_as = Some(number);
            state.act(Action::CheckPath(number, Box::new(line.clone())));
            Some(Question::Path(line))
        }
        None if !is_left => Some(Question::Path(line)),
        _ => {
            state.path_is_not_given(line.ask);
            None
        }
    }
}

/// Whether the path is to be taken, or none; nothing is decided at first.
fn path_line(ui: &mut Ui, line: &mut PathLine) -> Option<bool> {
    ui.set_width(520.0);
    ui.heading(words::asked_for(line.ask));
    ui.add_space(6.0);
    let name = ui.label(if line.is_of_dialog { words::PATH } else { words::NO_DIALOG }).id;
    ui.add_space(4.0);
    let is_checked = line.checked_as.is_some();
    let field = TextEdit::singleline(&mut line.text).desired_width(f32::INFINITY);
    let field = ui.add_enabled(!is_checked, field).labelled_by(name);
    if !is_checked && std::mem::take(&mut line.is_new) {
        field.request_focus();
        // Where one goes on typing, or takes back a letter.
        let mut edit = TextEditState::load(ui.ctx(), field.id).unwrap_or_default();
        let end = CCursor::new(line.text.chars().count());
        edit.cursor.set_char_range(Some(CCursorRange::one(end)));
        edit.store(ui.ctx(), field.id);
    }
    if field.changed() {
        line.wrong.clear();
    }
    let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if is_checked {
        ui.weak(words::CHECKING);
    } else if !line.wrong.is_empty() {
        ui.colored_label(theme::of_weight(Weight::Error, ui.visuals()), &line.wrong);
    }
    ui.add_space(10.0);
    let clicked = ui.horizontal(|ui| {
        let take = ui.add_enabled(!is_checked, Button::new(words::answer(line.ask))).clicked();
        [take, ui.button(words::CANCEL).clicked()]
    });
    match clicked.inner {
        [true, _] => Some(true),
        [_, true] => Some(false),
        _ => (is_entered && !is_checked).then_some(true),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::action::Ask;
    use crate::engine::Phase;
    use crate::panels::keys;
    use crate::recent::Recent;
    use crate::scene_file::SceneFile;
    use crate::state::Tool;
    use egui_kittest::Harness;
    use egui_kittest::kittest::{NodeT as _, Queryable as _};
    use indigo_front::flags::Arguments;
    use std::path::PathBuf;

    fn harness(question: Question) -> Harness<'static, State> {
        let mut state = State::new(Arguments::default(), Recent::default());
        state.ask(question);
        (state.tool, state.phase) = (Tool::Region, Phase::Rendering);
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
            assert_eq!((!state.questions.is_empty(), state.tool), (is_asked, tool));
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
            drop(state.questions.take());
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
            assert!(state.questions.is_empty());
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
        for (is_there, is_wrong) in [(false, true), (true, false)] {
            if is_there {
                std::fs::write(folder.join("a.igs"), "<scene/>").unwrap();
            }
            harness.key_press(Key::Enter);
            harness.run();
            let state = harness.state_mut();
            // The window looks at no disk itself.
            let Some(Action::CheckPath(number, line)) = state.actions.pop() else {
                panic!("it is not taken")
            };
            assert!(harness.get_by_label(words::answer(Ask::Open)).accesskit_node().is_disabled());
            assert!(!harness.get_by_label(words::CANCEL).accesskit_node().is_disabled());
            let checked = line.accept().map(|path| (Ask::Open, path));
            harness.state_mut().path_is_checked(number, checked);
            harness.run();
            assert_eq!(harness.query_by_label_contains("no file").is_some(), is_wrong);
        }
        let state = harness.state_mut();
        assert!(state.questions.is_empty());
        let Some(Action::Asked(Ask::Open, path)) = state.actions.pop() else { panic!("it is not taken") };
        assert_eq!(path, folder.join("a.igs"));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_question_is_answered_by_keys_alone_and_in_the_words_of_what_is_under_way() {
        let mut harness = harness(Question::Close);
        assert!(harness.get_by_label(words::CLOSE_SAVE).is_focused());
        assert!(harness.query_by_label("Keep rendering").is_some());
        harness.state_mut().phase = Phase::Paused;
        harness.run();
        assert!(harness.query_by_label("Keep rendering").is_none(), "it rests");
        harness.key_press(Key::Enter);
        harness.run();
        let action = harness.state_mut().actions.pop();
        assert!(matches!(action, Some(Action::Command(Command::Quit { saves: true }))));
    }

    #[test]
    fn a_question_without_a_ground_is_not_asked() {
        let mut harness = harness(Question::Close);
        harness.state_mut().phase = Phase::Ready;
        harness.run();
        assert!(harness.state().questions.is_empty());
        assert!(matches!(harness.state_mut().actions.pop(), Some(Action::TryToClose)));
    }
}
