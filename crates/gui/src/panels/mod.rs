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
    if state.tab == Tab::Scene {
        scene::bar(ui, state);
    }
    ui.spacing_mut().scroll.bar_outer_margin = -theme::BAR;
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

/// An entry of a list of choices, which is closed by choosing it, with a key too.
fn choice<T: PartialEq>(ui: &mut Ui, chosen: &mut T, value: T, name: &str) -> Response {
    let entry = ui.selectable_value(chosen, value, name);
    if entry.clicked() {
        ui.close();
    }
    entry
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
pub(super) mod tests {
    use super::*;
    use crate::action::Action;
    use crate::engine::{LoadedFacts, Phase, Update};
    use crate::log::{Finding, Weight};
    use crate::recent::Recent;
    use crate::scene_file::SceneFile;
    use crate::work::Work;
    use egui_kittest::kittest::Queryable as _;
    use egui_kittest::{Harness, HarnessBuilder};
    use indigo_front::flags::{Arguments, Role};
    use indigo_front::load::load_scene;

    /// A scene is open, and every panel has something to show.
    pub fn full() -> State {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../testscenes/cornell_box.igs");
        let arguments = Arguments::default();
        let (loaded, _) = load_scene(path, &arguments, None).expect("the scene is there");
        let facts = LoadedFacts::of(&loaded.scene.expect("it can be rendered"));
        let mut state = State::new(arguments, Recent::default());
        let work = Work::of(&facts.output, None);
        state.take(Update::Scene(Box::new(facts), Some(work)));
        state.take(Update::Phase(Phase::Ready));
        state.part.role = Some(Role::WorkingMaster);
        state.queue.add("a scene with a name that is longer than there is room for it in a line.igs".into());
        state.file = Some(SceneFile::read(path).expect("the scene is there"));
        let (head, full) = ("something ".repeat(40), "something".to_owned());
        state.findings.push(Finding { weight: Weight::Warning, head, full, span: None });
        state
    }

    /// Room for more than the side, in the theme from the first frame on.
    fn wide() -> HarnessBuilder<State> {
        Harness::builder().with_size(vec2(2.0 * theme::SIDE, 900.0)).with_context_setup(theme::set)
    }

    #[test]
    fn nothing_is_wider_than_the_side() {
        // Less the margins of a panel, 8 points each.
        let width = theme::SIDE - 16.0;
        let show = |ui: &mut Ui, state: &mut State| {
            ui.set_max_width(width);
            side(ui, state);
            assert!(ui.min_rect().width() <= width, "{:?}: {}", state.tab, ui.min_rect().width());
        };
        for (tab, shows_elements, seen) in [
            (Tab::Picture, false, words::BURN),
            (Tab::Render, false, words::APPLY_MODE),
            (Tab::Scene, false, words::TRIANGLES),
            (Tab::Scene, true, words::SAVE_CHANGES),
            (Tab::Queue, false, words::QUEUE_START),
            (Tab::Network, false, words::KEY_FILE),
        ] {
            let state = State { tab, shows_elements, ..full() };
            let mut harness = wide().build_ui_state(show, state);
            harness.run();
            assert!(harness.query_all_by_label(seen).count() > 0, "{tab:?} shows nothing");
        }
    }

    /// Down to the values, with what is wrong with them.
    #[test]
    fn elements_are_no_wider_than_the_side() {
        let width = theme::SIDE - 16.0;
        let mut state = State { tab: Tab::Scene, shows_elements: true, ..full() };
        if let Some(file) = &mut state.file {
            file.changes.insert(vec![0, 0], "-1234567890123456".to_owned());
        }
        let show = |ui: &mut Ui, state: &mut State| {
            ui.set_max_width(width);
            side(ui, state);
            assert!(ui.min_rect().width() <= width, "{}", ui.min_rect().width());
        };
        let mut harness = wide().build_ui_state(show, state);
        for title in ["renderer_settings", "camera", "material white", "diffuse", "albedo_spectrum"] {
            harness.run();
            harness.get_by_label(title).click();
        }
        harness.run();
        assert!(harness.query_by_label_contains("must be > 0").is_some());
        assert!(!harness.state().actions.iter().any(|action| matches!(action, Action::SaveElements(_))));
    }

    #[test]
    fn a_tab_is_known_by_its_name() {
        for tab in Tab::ALL {
            assert_eq!(Tab::named(words::tab(tab)), tab);
        }
        assert_eq!(Tab::named("of a later version"), Tab::Picture);
    }
}
