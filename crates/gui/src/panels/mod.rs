//! The parts of the window, a file each.

mod cross;
mod foot;
mod keys;
mod lights;
mod network;
mod picture;
mod questions;
mod queue;
mod scene;
mod slaves;
mod status;
mod tone;
mod toolbar;
mod tree;
mod work;

pub use keys::keys;
pub use picture::{Textures, picture};
pub use questions::questions;
pub use status::status;
pub use toolbar::toolbar;

use crate::state::{State, Tab};
use crate::{theme, words};
use eframe::egui::{Align, Layout, Response, ScrollArea, Ui, vec2};

/// The panel on the right.
pub fn side(ui: &mut Ui, state: &mut State) {
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for tab in Tab::ALL {
            ui.selectable_value(&mut state.tab, tab, words::tab(tab));
        }
    });
    ui.separator();
    ScrollArea::vertical().id_salt(("side", state.tab)).auto_shrink(false).show(ui, |ui| match state.tab {
        Tab::Picture => tone::tone(ui, state),
        Tab::Render => work::work(ui, state),
        Tab::Scene => scene::scene(ui, state),
        Tab::Queue => queue::queue(ui, state),
        Tab::Network => network::network(ui, state),
    });
}

/// The panel at the bottom.
pub fn foot(ui: &mut Ui, state: &mut State) {
    foot::foot(ui, state);
}

/// A control with its name in front.
fn row(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui) -> Response) -> Response {
    ui.horizontal(|ui| {
        let label = named(ui, |ui| ui.label(name).id);
        let control = add(ui);
        // What has words of its own keeps them.
        if name.is_empty() { control } else { control.labelled_by(label) }
    })
    .inner
}

/// The first column of a row, with what names the second.
fn named<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let size = vec2(theme::NAME, ui.spacing().interact_size.y);
    let name = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(theme::NAME);
        add(ui)
    });
    // All numbers are of one width.
    ui.spacing_mut().interact_size.x = theme::VALUE;
    name.inner
}

/// The head of a group of controls.
fn head(ui: &mut Ui, text: &str) {
    ui.add_space(6.0);
    ui.strong(text);
}

/// A fact with its name in front.
fn fact(ui: &mut Ui, name: &str, value: impl Into<String>) {
    let value = value.into();
    ui.scope(|ui| {
        // Lower than what can be pressed.
        ui.spacing_mut().interact_size.y = theme::FACT;
        row(ui, name, |ui| ui.monospace(value));
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recent::Recent;
    use egui_kittest::Harness;
    use indigo_front::flags::Arguments;

    #[test]
    fn nothing_is_wider_than_the_side() {
        // Less the margins of a panel, 8 points each.
        let width = theme::SIDE - 16.0;
        for tab in Tab::ALL {
            let state = State { tab, ..State::new(Arguments::default(), Recent::default()) };
            let show = |ui: &mut Ui, state: &mut State| {
                ui.set_max_width(width);
                side(ui, state);
                assert!(ui.min_rect().width() <= width, "{tab:?}: {}", ui.min_rect().width());
            };
            Harness::builder().with_size(vec2(2.0 * width, 600.0)).build_ui_state(show, state).run();
        }
    }
}
