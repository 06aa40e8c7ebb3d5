//! Keys, and the list of them.

use super::picture::picture_id;
use crate::action::{Action, Ask};
use crate::engine::Command;
use crate::state::{Gesture, State, Tab, Tool};
use crate::{theme, words};
use eframe::egui::{Context, Grid, Key, KeyboardShortcut, Memory, Modifiers, Popup, Ui, Window, pos2};
use indigo_render::output::OneFile;

/// What the keys of a row do, of which the second argument says the one that was pressed.
type Effect = fn(&mut State, usize);

/// Keys that do alike: what is held besides, the keys, what they do in words, and the effect.
type Row = (Modifiers, &'static [Key], &'static str, Effect);

/// How far `,` and `.` move the line of a comparison, as a part of the width.
const LINE_STEP: f32 = 0.02;

const ARROWS: &[Key] = &[Key::ArrowLeft, Key::ArrowUp, Key::ArrowRight, Key::ArrowDown];

/// All keys that work wherever the focus is.
const COMMANDS: &[Row] = &[
    (Modifiers::COMMAND, &[Key::O], words::OPEN_FILE, |state, _| state.act(Action::Ask(Ask::Open))),
    // Before the same key without Shift, which would take it.
    (Modifiers::COMMAND.plus(Modifiers::SHIFT), &[Key::S], words::SAVE_PICTURE, |state, _| {
        if state.picture.is_some() {
            state.act(Action::Ask(Ask::Save(OneFile::Picture)));
        }
    }),
    (Modifiers::COMMAND, &[Key::S], words::SAVE_NOW, |state, _| {
        if state.can_save_now() {
            state.command(Command::SaveAll);
        }
    }),
    (Modifiers::COMMAND, &[Key::R], words::RELOAD, |state, _| {
        if state.wanted.is_some() {
            state.act(Action::Restart);
        }
    }),
    (
        Modifiers::COMMAND,
        &[Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5],
        words::TABS_HINT,
        |state, index| state.tab = Tab::ALL[index],
    ),
];

/// All keys that work unless something is being typed.
const PLAIN: &[Row] = &[
    (Modifiers::NONE, &[Key::P], words::START_OR_PAUSE, |state, _| state.start_or_pause()),
    (Modifiers::NONE, &[Key::OpenBracket, Key::CloseBracket], words::DARKER_BRIGHTER, |state, index| {
        state.brighten(if index == 0 { -0.5 } else { 0.5 });
    }),
    (Modifiers::NONE, &[Key::Backspace], words::RESET_HINT, |state, _| state.reset_controls()),
    (Modifiers::NONE, &[Key::F], words::FIT_HINT, |state, _| state.view.fit()),
    (Modifiers::NONE, &[Key::Num1], words::ONE_TO_ONE_HINT, |state, _| state.gesture(Gesture::OneToOne)),
    (Modifiers::NONE, &[Key::Plus, Key::Equals, Key::Minus], words::ZOOM_HINT, |state, index| {
        state.gesture(if index == 2 { Gesture::ZoomOut } else { Gesture::ZoomIn });
    }),
    (Modifiers::NONE, &[Key::I], words::CROSS_HINT, |state, _| state.gesture(Gesture::Cross)),
    (Modifiers::NONE, &[Key::G], words::GREY_KEY_HINT, |state, _| state.set_tool(Tool::Grey)),
    (Modifiers::NONE, &[Key::R], words::REGION_KEY_HINT, |state, _| state.set_tool(Tool::Region)),
    (Modifiers::NONE, &[Key::Escape], words::PAN_KEY_HINT, |state, _| state.leave()),
    (Modifiers::NONE, &[Key::C], words::LAYOUT_HINT, |state, _| state.next_layout()),
    (Modifiers::NONE, &[Key::Comma, Key::Period], words::LINE_HINT, |state, index| {
        state.move_line(if index == 0 { -LINE_STEP } else { LINE_STEP });
    }),
    (Modifiers::NONE, &[Key::F1], words::KEYS_HINT, |state, _| state.shows_keys = !state.shows_keys),
    (Modifiers::NONE, &[Key::F2], words::THEME, |state, _| state.wants_other_theme = true),
];

/// All keys that work where no other control has the focus, to which they mean something.
const IN_PICTURE: &[Row] = &[
    // Before the same keys without Shift, which would take them.
    (Modifiers::SHIFT, ARROWS, words::FAR_STEP_HINT, |state, index| step(state, index, true)),
    (Modifiers::NONE, ARROWS, words::STEP_HINT, |state, index| step(state, index, false)),
    (Modifiers::NONE, &[Key::Enter], words::TAKE_HINT, |state, _| state.gesture(Gesture::Take)),
];

/// One of the arrows.
fn step(state: &mut State, arrow: usize, is_far: bool) {
    let to = [[-1, 0], [0, -1], [1, 0], [0, 1]][arrow];
    state.gesture(Gesture::Step { to, is_far });
}

/// Does what keys ask for, and shows the list of them.
pub fn keys(context: &Context, state: &mut State) {
    // A question and open lists take all keys: Escape closes them.
    if !state.questions.is_empty() || Popup::is_any_open(context) {
        return;
    }
    let focused = context.memory(Memory::focused);
    obey(context, state, COMMANDS);
    if !context.text_edit_focused() {
        obey(context, state, PLAIN);
    }
    if focused.is_none_or(|id| id == picture_id()) {
        obey(context, state, IN_PICTURE);
    }
    let mut is_open = state.shows_keys;
    let window = Window::new(words::KEYS).open(&mut is_open).resizable(false).collapsible(false);
    // Beside what it explains, as far as there is room.
    let window = window.default_pos(pos2(12.0, theme::TOOL_BAR + 12.0));
    window.show(context, list);
    state.shows_keys = is_open && state.shows_keys;
}

fn obey(context: &Context, state: &mut State, rows: &[Row]) {
    for (modifiers, keys, _, effect) in rows {
        for (index, key) in keys.iter().enumerate() {
            // On a slow machine a key may have been pressed twice since the last frame.
            for _ in 0..context.input_mut(|input| input.count_and_consume_key(*modifiers, *key)) {
                effect(state, index);
            }
        }
    }
}

fn list(ui: &mut Ui) {
    // So that it fits into the smallest window.
    let grid = Grid::new("keys").num_columns(2).spacing([24.0, 3.0]).min_row_height(16.0);
    grid.show(ui, |ui| {
        for (modifiers, keys, what, _) in COMMANDS.iter().chain(PLAIN).chain(IN_PICTURE) {
            ui.monospace(names(ui, *modifiers, keys));
            ui.label(*what);
            ui.end_row();
        }
        for (name, what) in [(words::WHEEL, words::WHEEL_HINT), (words::TAB_KEY, words::TAB_HINT)] {
            ui.monospace(name);
            ui.label(what);
            ui.end_row();
        }
    });
    ui.add_space(4.0);
}

/// Keys as they are written on the keyboard, what is held besides only once.
fn names(ui: &Ui, modifiers: Modifiers, keys: &[Key]) -> String {
    let name = |(index, key): (usize, &Key)| match (index, modifiers.is_none()) {
        (0, false) => ui.ctx().format_shortcut(&KeyboardShortcut::new(modifiers, *key)),
        // No font of even widths has their symbols.
        _ if ARROWS.contains(key) => key.name().to_owned(),
        _ => key.symbol_or_name().to_owned(),
    };
    keys.iter().enumerate().map(name).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_has_two_meanings() {
        let rows = COMMANDS.iter().chain(PLAIN).chain(IN_PICTURE);
        let all: Vec<_> = rows.flat_map(|(held, keys, ..)| keys.iter().map(move |key| (held, key))).collect();
        for (i, one) in all.iter().enumerate() {
            assert!(!all[..i].contains(one), "{one:?}");
        }
    }
}
