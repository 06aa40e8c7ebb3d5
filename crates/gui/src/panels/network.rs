//! The part of this machine in renders of many.

use super::{head, row};
use crate::action::{Action, Ask};
use crate::engine::Phase;
use crate::part::Part;
use crate::state::State;
use crate::words;
use eframe::egui::{Button, DragValue, RadioButton, TextEdit, Ui, vec2};
use indigo_front::flags::Role;
use indigo_scene::schema::settings::MOST_THREADS;

/// See the module.
pub fn network(ui: &mut Ui, state: &mut State) {
    head(ui, words::NETWORK);
    // What is rendered rests while something is loaded.
    let can_change = !state.is_under_way() && state.phase != Phase::Loading;
    if state.is_under_way() {
        ui.weak(words::PART_IS_FIXED);
    }
    ui.add_enabled_ui(can_change, |ui| {
        for role in Part::ROLES {
            let choice = RadioButton::new(state.part.role == role, words::role(role));
            if ui.add(choice).on_hover_text(words::role_hint(role)).clicked() && state.part.role != role {
                state.part.role = role;
                state.forget_slaves();
            }
        }
        if state.part.role.is_some() {
            head(ui, words::CONNECTION);
            connection(ui, &mut state.part);
            key(ui, state);
        }
    });
    ui.add_space(10.0);
    button(ui, state);
    if state.phase == Phase::Slave {
        ui.label(words::SLAVE_AT_WORK);
    } else if state.is_master() {
        ui.label(words::MASTER_AT_WORK);
    }
}

fn connection(ui: &mut Ui, part: &mut Part) {
    if part.role == Some(Role::Slave) {
        row(ui, words::MASTER, |ui| {
            let field = TextEdit::singleline(&mut part.host).hint_text(words::SEARCHED);
            ui.add(field.desired_width(f32::INFINITY))
        })
        .on_hover_text(words::MASTER_HINT);
        row(ui, words::THREADS, |ui| ui.add(DragValue::new(&mut part.threads).range(1..=MOST_THREADS)));
    } else {
        row(ui, words::PORT, |ui| ui.add(DragValue::new(&mut part.port).range(0..=u16::MAX)))
            .on_hover_text(words::PORT_HINT);
    }
}

fn key(ui: &mut Ui, state: &mut State) {
    row(ui, words::KEY_FILE, |ui| {
        let field = TextEdit::singleline(&mut state.part.key_file).hint_text(words::NO_KEY);
        ui.add(field.desired_width(f32::INFINITY))
    })
    .on_hover_text(words::KEY_HINT);
    row(ui, "", |ui| {
        let choose = ui.button(words::CHOOSE);
        if choose.clicked() {
            state.act(Action::Ask(Ask::Key));
        }
        let make = ui.button(words::MAKE_KEY).on_hover_text(words::MAKE_KEY_HINT);
        if make.clicked() {
            state.act(Action::Ask(Ask::NewKey));
        }
        choose
    });
}

/// What the tool bar's button does, too, in the words of the part that is chosen.
fn button(ui: &mut Ui, state: &mut State) {
    let Some(role) = state.part.role else { return };
    ui.vertical_centered_justified(|ui| begin_or_end(ui, state, role));
}

fn begin_or_end(ui: &mut Ui, state: &mut State, role: Role) {
    let size = vec2(0.0, ui.spacing().interact_size.y + 4.0);
    if state.is_under_way() {
        let can_stop = state.phase != Phase::Ending;
        if ui.add_enabled(can_stop, Button::new(words::STOP).min_size(size)).clicked() {
            state.command(crate::engine::Command::Stop);
        }
        return;
    }
    let start = Button::new(words::start_as(role)).min_size(size);
    if ui.add_enabled(state.can_start(), start).on_disabled_hover_text(words::MASTER_NEEDS_SCENE).clicked() {
        state.start_or_pause();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Command;
    use crate::recent::Recent;
    use crate::theme;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use indigo_front::flags::Arguments;

    #[test]
    fn why_nothing_can_be_changed_is_said() {
        let mut state = State::new(Arguments::default(), Recent::default());
        state.phase = Phase::Paused;
        let mut harness =
            Harness::builder().with_size(vec2(theme::SIDE, 600.0)).build_ui_state(network, state);
        harness.run();
        assert!(harness.query_by_label(words::PART_IS_FIXED).is_some());
        harness.state_mut().phase = Phase::Ready;
        harness.run();
        assert!(harness.query_by_label(words::PART_IS_FIXED).is_none());
    }

    #[test]
    fn a_slave_is_started_by_the_names_of_its_controls() {
        let state = State::new(Arguments::default(), Recent::default());
        let mut harness =
            Harness::builder().with_size(vec2(theme::SIDE, 600.0)).build_ui_state(network, state);
        harness.run();
        assert!(harness.query_by_label(words::MASTER).is_none(), "it renders alone");
        harness.get_by_label(words::role(Some(Role::Slave))).click();
        harness.run();
        assert!(harness.query_all_by_label(words::MASTER).count() > 0);
        harness.get_by_label(words::start_as(Role::Slave)).click();
        harness.run();
        let started = harness.state().actions.iter().any(|action| {
            matches!(action, Action::Command(Command::StartSlave(part, _)) if part.role == Some(Role::Slave))
        });
        assert!(started);
        harness.get_by_label(words::role(Some(Role::Master))).click();
        harness.run();
        assert!(harness.query_all_by_label(words::PORT).count() > 0);
        harness.get_by_label(words::start_as(Role::Master)).click();
        harness.run();
        assert_eq!(harness.state().actions.len(), 1, "a master needs a scene");
    }
}
