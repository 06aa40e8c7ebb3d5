//! The tool bar: files, the render, the view.

use crate::action::{Action, Ask};
use crate::comparison::Layout;
use crate::engine::{Command, Phase};
use crate::state::{Gesture, State, Tool};
use crate::words;
use eframe::egui::{Button, Ui};
use indigo_render::output::OneFile;

/// See the module.
pub fn toolbar(ui: &mut Ui, state: &mut State) {
    ui.horizontal_centered(|ui| {
        open(ui, state);
        save(ui, state);
        ui.separator();
        render(ui, state);
        ui.separator();
        view(ui, state);
        ui.separator();
        tools(ui, state);
        ui.separator();
        compare(ui, state);
        ui.separator();
        if ui.button(words::THEME_SHORT).on_hover_text(words::THEME).clicked() {
            state.wants_other_theme = true;
        }
        if ui.button(words::KEYS).on_hover_text(words::KEYS_HINT).clicked() {
            state.shows_keys = !state.shows_keys;
        }
    });
}

fn open(ui: &mut Ui, state: &mut State) {
    ui.menu_button(words::OPEN, |ui| {
        if ui.button(words::OPEN_FILE).clicked() {
            state.act(Action::Ask(Ask::Open));
            ui.close();
        }
        let name = state.wanted.as_deref().filter(|wanted| state.path.as_deref() != Some(wanted));
        let reload = Button::new(name.map_or_else(|| words::RELOAD.to_owned(), words::reload));
        if ui.add_enabled(state.wanted.is_some(), reload).clicked() {
            state.act(Action::Restart);
            ui.close();
        }
        ui.separator();
        ui.weak(words::RECENT);
        for path in state.recent.paths().to_vec() {
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
            if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                state.act(Action::Open(path));
                ui.close();
            }
        }
        if state.recent.paths().is_empty() {
            ui.weak(words::NONE);
        }
    });
}

fn save(ui: &mut Ui, state: &mut State) {
    ui.add_enabled_ui(state.picture.is_some(), |ui| {
        ui.menu_button(words::SAVE, |ui| {
            if ui.add_enabled(state.can_save_now(), Button::new(words::SAVE_NOW)).clicked() {
                state.command(Command::SaveAll);
                ui.close();
            }
            ui.separator();
            for (what, words) in [
                (OneFile::Picture, words::SAVE_PICTURE),
                (OneFile::Luminances, words::SAVE_EXR),
                (OneFile::Film, words::SAVE_FILM),
            ] {
                if ui.button(words).clicked() {
                    state.act(Action::Ask(Ask::Save(what)));
                    ui.close();
                }
            }
        });
    });
}

fn render(ui: &mut Ui, state: &mut State) {
    // As wide as the longest of its words, so that nothing moves when it changes.
    let size = eframe::egui::vec2(84.0, ui.spacing().interact_size.y + 2.0);
    if state.phase == Phase::Loading {
        if ui.add_sized(size, Button::new(words::CANCEL)).clicked() {
            state.command(Command::Cancel);
        }
    } else {
        let is_possible = state.can_start() || state.has_growing_film() && !state.is_master();
        let text = match state.phase {
            Phase::Rendering => words::PAUSE,
            Phase::Paused => words::RESUME,
            Phase::Halted(_) => words::GO_ON,
            // A film was opened.
            Phase::Ready if state.progress.is_some() => words::GO_ON,
            _ => words::START,
        };
        let button = ui.add_enabled_ui(is_possible, |ui| ui.add_sized(size, Button::new(text))).inner;
        let button =
            if state.is_master() { button.on_disabled_hover_text(words::NO_PAUSE_OF_MANY) } else { button };
        if button.clicked() {
            state.start_or_pause();
        }
    }
    let can_stop = matches!(state.phase, Phase::Rendering | Phase::Paused | Phase::Slave);
    if ui.add_enabled(can_stop, Button::new(words::STOP)).on_hover_text(words::STOP_HINT).clicked() {
        state.command(Command::Stop);
    }
}

fn view(ui: &mut Ui, state: &mut State) {
    let fits = state.view.is_fitting();
    if ui.selectable_label(fits, words::FIT).on_hover_text(words::FIT_HINT).clicked() {
        state.view.fit();
    }
    if ui
        .selectable_label(state.view.is_one_to_one(), words::ONE_TO_ONE)
        .on_hover_text(words::ONE_TO_ONE_HINT)
        .clicked()
    {
        state.gesture(Gesture::OneToOne);
    }
}

fn tools(ui: &mut Ui, state: &mut State) {
    for (tool, name, hint) in [
        (Tool::Pan, words::PAN, words::PAN_HINT),
        (Tool::Grey, words::GREY, words::GREY_HINT),
        (Tool::Region, words::REGION, words::REGION_HINT),
    ] {
        if ui.selectable_label(state.tool == tool, name).on_hover_text(hint).clicked() {
            state.set_tool(tool);
        }
    }
}

fn compare(ui: &mut Ui, state: &mut State) {
    ui.menu_button(words::COMPARE, |ui| {
        if ui.button(words::COMPARE_WITH).clicked() {
            state.act(Action::Ask(Ask::Compare));
            ui.close();
        }
        ui.separator();
        let has_picture = state.comparison.picture.is_some();
        for layout in Layout::ALL {
            let choice = Button::selectable(state.comparison.layout == layout, words::layout(layout));
            if ui.add_enabled(has_picture || layout == Layout::Off, choice).clicked() {
                state.comparison.layout = layout;
                ui.close();
            }
        }
    });
}
