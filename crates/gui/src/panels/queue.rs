//! Scenes that are rendered one after another.

use super::{head, row};
use crate::action::{Action, Ask};
use crate::queue::Turn;
use crate::state::State;
use crate::words;
use eframe::egui::{Button, DragValue, Label, Role, Ui, WidgetInfo};

/// See the module.
pub fn queue(ui: &mut Ui, state: &mut State) {
    head(ui, words::QUEUE);
    ui.label(words::QUEUE_HINT);
    let mut removed = None;
    for (index, (path, turn)) in state.queue.scenes.iter().enumerate() {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        ui.horizontal(|ui| {
            let can_go = *turn != Turn::Now;
            let button = Button::new(words::REMOVE).small();
            let button = ui.add_enabled(can_go, button).on_hover_text(words::remove(&name));
            button.widget_info(|| WidgetInfo::labeled(Role::Button, can_go, words::remove(&name)));
            if button.clicked() {
                removed = Some(index);
            }
            let how = ui.weak(words::turn(*turn));
            if *turn == Turn::Failed {
                how.on_hover_text(words::TURN_FAILED_HINT);
            }
            ui.add(Label::new(&name).truncate()).on_hover_text(path.display().to_string());
        });
    }
    if let Some(index) = removed {
        state.queue.scenes.remove(index);
    }
    if state.queue.scenes.is_empty() {
        ui.weak(words::NONE);
    }
    ui.add_space(4.0);
    row(ui, words::QUEUE_HALT, |ui| {
        ui.add(
            DragValue::new(&mut state.queue.halts_at)
                .range(1..=u64::from(u32::MAX))
                .suffix(words::QUEUE_HALT_UNIT),
        )
    })
    .on_hover_text(words::QUEUE_HALT_HINT);
    ui.horizontal(|ui| {
        if ui.button(words::ADD).clicked() {
            state.act(Action::Ask(Ask::Queue));
        }
        let waits = state.queue.scenes.iter().any(|scene| scene.1 == Turn::Waiting);
        if state.queue.runs {
            if ui.button(words::QUEUE_END).on_hover_text(words::QUEUE_END_HINT).clicked() {
                state.queue.runs = false;
            }
        } else if ui.add_enabled(waits && state.can_run_queue(), Button::new(words::QUEUE_START)).clicked() {
            state.act(Action::RunQueue);
        }
    });
}
