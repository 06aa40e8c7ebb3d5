//! How the scene is rendered.

use super::{choice, head, named, row};
use crate::engine::Command;
use crate::state::{State, Tool};
use crate::work::{Mode, Sampling, Work};
use crate::{theme, words};
use eframe::egui::{Button, ComboBox, DragValue, Response, Ui};
use indigo_scene::schema::settings::MOST_THREADS;

/// See the module.
pub fn work(ui: &mut Ui, state: &mut State) {
    let (Some(mut work), Some(mut mode)) = (state.work, state.mode) else {
        ui.add_space(8.0);
        ui.label(words::NOTHING_TO_RENDER);
        return;
    };
    head(ui, words::HALT);
    halts(ui, &mut work);
    head(ui, words::MACHINE);
    row(ui, words::THREADS, |ui| ui.add(DragValue::new(&mut work.threads).range(1..=MOST_THREADS)));
    let is_changed = state.work != Some(work);
    state.work = Some(work);
    // While a number is dragged or typed the render goes on as it is.
    let is_settled = !ui.ctx().egui_is_using_pointer() && !ui.ctx().text_edit_focused();
    state.work_is_new |= is_changed;
    if state.work_is_new && is_settled {
        state.work_is_new = false;
        if state.has_growing_film() {
            state.command(Command::Adjust(work));
        }
    }
    head(ui, words::LIGHT_TRANSPORT);
    transport(ui, &mut mode);
    state.mode_is_chosen |= state.mode != Some(mode);
    state.mode = Some(mode);
    let is_other = state.facts.as_ref().is_some_and(|facts| Mode::of(&facts.transport) != mode);
    row(ui, "", |ui| {
        let button = ui.add_enabled(is_other, Button::new(words::APPLY_MODE));
        if button.clicked() {
            state.restart_open();
        }
        button.on_hover_text(words::APPLY_MODE_HINT)
    });
    head(ui, words::REGION);
    region(ui, state, work);
}

fn halts(ui: &mut Ui, work: &mut Work) {
    condition(ui, &mut work.halt_spp.0, words::HALT_SPP, |ui| {
        ui.add(DragValue::new(&mut work.halt_spp.1).range(1..=u64::from(u32::MAX)))
    });
    condition(ui, &mut work.halt_time.0, words::HALT_TIME, |ui| {
        ui.add(DragValue::new(&mut work.halt_time.1).range(1.0..=1e7).suffix(words::SECONDS))
    });
    condition(ui, &mut work.halt_error.0, words::HALT_ERROR, |ui| {
        ui.add(DragValue::new(&mut work.halt_error.1).range(0.01..=100.0).speed(0.05).suffix(words::PER_CENT))
    })
    .on_hover_text(words::HALT_ERROR_HINT);
    // Halting by it estimates it already.
    ui.add_enabled_ui(!work.halt_error.0, |ui| {
        row(ui, "", |ui| ui.checkbox(&mut work.estimates_error, words::ESTIMATE_ERROR))
            .on_hover_text(words::ESTIMATE_ERROR_HINT);
    });
}

/// A halting condition that can be switched on.
fn condition(ui: &mut Ui, is_on: &mut bool, name: &str, value: impl FnOnce(&mut Ui) -> Response) -> Response {
    ui.horizontal(|ui| {
        let switch = named(ui, |ui| ui.checkbox(is_on, name));
        let value = ui.add_enabled_ui(*is_on, value).inner.labelled_by(switch.id);
        switch | value
    })
    .inner
}

fn transport(ui: &mut Ui, mode: &mut Mode) {
    row(ui, words::TECHNIQUE, |ui| {
        ComboBox::from_id_salt("technique")
            .width(theme::CONTROL)
            .truncate()
            .selected_text(words::technique(mode.bidirectional))
            .show_ui(ui, |ui| {
                for bidirectional in [false, true] {
                    let name = words::technique(bidirectional);
                    choice(ui, &mut mode.bidirectional, bidirectional, name);
                }
            })
            .response
    });
    row(ui, words::SAMPLING, |ui| {
        ComboBox::from_id_salt("sampling")
            .width(theme::CONTROL)
            .truncate()
            .selected_text(words::sampling(mode.sampling))
            .show_ui(ui, |ui| {
                for sampling in Sampling::ALL {
                    choice(ui, &mut mode.sampling, sampling, words::sampling(sampling));
                }
            })
            .response
    });
}

fn region(ui: &mut Ui, state: &mut State, work: Work) {
    let region = state.facts.as_ref().and_then(|facts| facts.region);
    ui.label(words::region(region));
    ui.horizontal(|ui| {
        let draws = state.tool == Tool::Region;
        let draw = Button::new(words::DRAW_REGION).selected(draws);
        if ui.add(draw).on_hover_text(words::REGION_HINT).clicked() {
            state.set_tool(if draws { Tool::Pan } else { Tool::Region });
        }
        if ui.add_enabled(region.is_some(), Button::new(words::WHOLE_PICTURE)).clicked() {
            state.command(Command::SetRegion(None, work));
        }
    });
}
