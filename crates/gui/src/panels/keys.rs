//! Keys, and the question before the window closes.

use crate::action::{Action, Ask};
use crate::engine::Command;
use crate::state::{State, Tab, Tool};
use crate::words;
use eframe::egui::{Context, Grid, Id, Key, KeyboardShortcut, Modal, Modifiers, Popup, Window};
use indigo_render::output::OneFile;

/// What a key does.
type Effect = fn(&mut State);

/// All keys that work wherever the focus is, with what they do.
const COMMANDS: &[(Modifiers, Key, &str, Effect)] = &[
    (Modifiers::COMMAND, Key::O, words::OPEN_FILE, |state| state.act(Action::Ask(Ask::Open))),
    // Before the same key without Shift, which would take it.
    (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S, words::SAVE_PICTURE, |state| {
        if state.facts.is_some() {
            state.act(Action::Ask(Ask::Save(OneFile::Picture)));
        }
    }),
    (Modifiers::COMMAND, Key::S, words::SAVE_NOW, |state| {
        if state.has_growing_film() {
            state.command(Command::SaveAll);
        }
    }),
    (Modifiers::COMMAND, Key::Num1, words::TAB_PICTURE, |state| state.tab = Tab::Picture),
    (Modifiers::COMMAND, Key::Num2, words::TAB_RENDER, |state| state.tab = Tab::Render),
    (Modifiers::COMMAND, Key::Num3, words::TAB_SCENE, |state| state.tab = Tab::Scene),
    (Modifiers::COMMAND, Key::Num4, words::TAB_QUEUE, |state| state.tab = Tab::Queue),
    (Modifiers::COMMAND, Key::Num5, words::TAB_NETWORK, |state| state.tab = Tab::Network),
    (Modifiers::COMMAND, Key::R, words::RELOAD, |state| {
        if state.wanted.is_some() {
            state.act(Action::Restart);
        }
    }),
];

/// All keys that work unless something is being typed.
const PLAIN: &[(Modifiers, Key, &str, Effect)] = &[
    (Modifiers::NONE, Key::P, words::START_OR_PAUSE, State::start_or_pause),
    (Modifiers::NONE, Key::F, words::FIT_HINT, |state| state.view.fit()),
    (Modifiers::NONE, Key::Num1, words::ONE_TO_ONE_HINT, |state| state.wants_one_to_one = true),
    (Modifiers::NONE, Key::CloseBracket, words::BRIGHTER, |state| state.brighten(0.5)),
    (Modifiers::NONE, Key::OpenBracket, words::DARKER, |state| state.brighten(-0.5)),
    (Modifiers::NONE, Key::Backspace, words::RESET_HINT, State::reset_controls),
    (Modifiers::NONE, Key::G, words::GREY_HINT, |state| state.tool = Tool::Grey),
    (Modifiers::NONE, Key::R, words::REGION_HINT, |state| state.tool = Tool::Region),
    (Modifiers::NONE, Key::Escape, words::PAN_HINT, |state| {
        (state.tool, state.drag_from) = (Tool::Pan, None);
    }),
    (Modifiers::NONE, Key::F1, words::KEYS_HINT, |state| state.shows_keys = !state.shows_keys),
    (Modifiers::NONE, Key::F2, words::THEME, |state| state.wants_other_theme = true),
];

/// Does what keys ask for, and shows the list of them.
pub fn keys(context: &Context, state: &mut State) {
    // The question before closing and open lists take all keys: Escape closes them.
    if state.asks_to_close || Popup::is_any_open(context) {
        return;
    }
    let is_typing = context.text_edit_focused();
    for (modifiers, key, _, effect) in COMMANDS.iter().chain(PLAIN.iter().filter(|_| !is_typing)) {
        // On a slow machine a key may have been pressed twice since the last frame.
        for _ in 0..context.input_mut(|input| input.count_and_consume_key(*modifiers, *key)) {
            effect(state);
        }
    }
    let mut is_open = state.shows_keys;
    Window::new(words::KEYS).open(&mut is_open).resizable(false).collapsible(false).show(context, |ui| {
        Grid::new("keys").num_columns(2).spacing([24.0, 6.0]).show(ui, |ui| {
            for (modifiers, key, what, _) in COMMANDS.iter().chain(PLAIN) {
                let shortcut = KeyboardShortcut::new(*modifiers, *key);
                // As it is written on the key.
                let is_plain = modifiers.is_none();
                let name = if is_plain {
                    key.symbol_or_name().to_owned()
                } else {
                    ui.ctx().format_shortcut(&shortcut)
                };
                ui.monospace(name);
                ui.label(*what);
                ui.end_row();
            }
            ui.monospace(words::WHEEL);
            ui.label(words::WHEEL_HINT);
            ui.end_row();
            ui.monospace(words::TAB_KEY);
            ui.label(words::TAB_HINT);
            ui.end_row();
        });
    });
    state.shows_keys = is_open && state.shows_keys;
}

/// Asks what becomes of a render when the window closes.
pub fn ask_to_close(context: &Context, state: &mut State) {
    if !state.asks_to_close {
        return;
    }
    let modal = Modal::new(Id::unique("close")).show(context, |ui| {
        ui.set_width(380.0);
        ui.heading(words::CLOSE_HEAD);
        ui.add_space(6.0);
        ui.label(words::CLOSE_TEXT);
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            if ui.button(words::CLOSE_SAVE).clicked() {
                state.act(Action::Command(Command::Quit { saves: true }));
                state.asks_to_close = false;
            }
            if ui.button(words::CLOSE_DISCARD).clicked() {
                state.act(Action::Command(Command::Quit { saves: false }));
                state.asks_to_close = false;
            }
            if ui.button(words::CLOSE_NOT).clicked() {
                state.asks_to_close = false;
            }
        });
    });
    if modal.should_close() {
        state.asks_to_close = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recent::Recent;
    use egui_kittest::Harness;
    use indigo_front::flags::Arguments;

    #[test]
    fn escape_answers_the_question_and_only_then_ends_what_the_pointer_does() {
        let mut state = State::new(Arguments::default(), Recent::default());
        (state.asks_to_close, state.tool) = (true, Tool::Region);
        let ui = |ui: &mut eframe::egui::Ui, state: &mut State| {
            keys(ui.ctx(), state);
            ask_to_close(ui.ctx(), state);
        };
        let mut harness = Harness::new_ui_state(ui, state);
        for (asks_to_close, tool) in [(false, Tool::Region), (false, Tool::Pan)] {
            harness.key_press(Key::Escape);
            harness.run();
            let state = harness.state();
            assert_eq!((state.asks_to_close, state.tool), (asks_to_close, tool));
        }
    }

    #[test]
    fn no_key_has_two_meanings() {
        let all: Vec<_> = COMMANDS.iter().chain(PLAIN).map(|(modifiers, key, ..)| (modifiers, key)).collect();
        for (i, one) in all.iter().enumerate() {
            assert!(!all[..i].contains(one), "{one:?}");
        }
    }
}
