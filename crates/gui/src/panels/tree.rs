//! The elements of the scene, whose texts can be changed.

use super::head;
use crate::action::Action;
use crate::scene_file::SceneFile;
use crate::state::State;
use crate::words;
use eframe::egui::{Button, CollapsingHeader, TextEdit, Ui};
use indigo_decl::Element;

/// The most children of an element that are listed.
const MOST_CHILDREN: usize = 300;
/// The longest text that is edited here, in bytes.
const LONGEST: usize = 400;

/// See the module.
pub fn tree(ui: &mut Ui, state: &mut State) {
    head(ui, words::ELEMENTS);
    let Some(mut file) = state.file.take() else {
        if ui.button(words::READ_ELEMENTS).on_hover_text(words::READ_ELEMENTS_HINT).clicked() {
            state.act(Action::ReadElements);
        }
        return;
    };
    ui.horizontal(|ui| {
        let n = file.changes.len();
        if ui
            .add_enabled(n > 0, Button::new(words::SAVE_CHANGES))
            .on_hover_text(words::SAVE_CHANGES_HINT)
            .clicked()
        {
            state.act(Action::SaveElements);
        }
        if ui.add_enabled(n > 0, Button::new(words::DISCARD)).clicked() {
            file.changes.clear();
        }
        ui.weak(words::changes(n));
    });
    let SceneFile { root, changes, .. } = &mut file;
    let mut way = vec![];
    for (index, child) in root.children.iter().take(MOST_CHILDREN).enumerate() {
        way.push(index);
        element(ui, child, &mut way, changes);
        way.pop();
    }
    more(ui, root);
    state.file = Some(file);
}

fn more(ui: &mut Ui, element: &Element) {
    if element.children.len() > MOST_CHILDREN {
        ui.weak(words::more_elements(element.children.len() - MOST_CHILDREN));
    }
}

fn element(
    ui: &mut Ui,
    element: &Element,
    way: &mut Vec<usize>,
    changes: &mut std::collections::BTreeMap<Vec<usize>, String>,
) {
    if element.children.is_empty() {
        leaf(ui, element, way, changes);
        return;
    }
    let named = element.child("name").map(|name| format!(" {}", name.text.value)).unwrap_or_default();
    CollapsingHeader::new(format!("{}{named}", element.name)).id_salt(way.as_slice()).show(ui, |ui| {
        for (index, child) in element.children.iter().take(MOST_CHILDREN).enumerate() {
            way.push(index);
            self::element(ui, child, way, changes);
            way.pop();
        }
        more(ui, element);
    });
}

fn leaf(
    ui: &mut Ui,
    element: &Element,
    way: &[usize],
    changes: &mut std::collections::BTreeMap<Vec<usize>, String>,
) {
    let old = &*element.text.value;
    ui.horizontal(|ui| {
        let name = ui.label(&*element.name).id;
        if old.len() > LONGEST || element.mesh.is_some() {
            ui.weak(words::LONG_TEXT);
            return;
        }
        let mut text = changes.get(way).cloned().unwrap_or_else(|| old.to_owned());
        if &*element.name == "rgb"
            && let Some(mut colour) = colour(&text)
            && ui.color_edit_button_rgb(&mut colour).labelled_by(name).changed()
        {
            text = colour.map(|v| format!("{v:.4}")).join(" ");
        }
        ui.add(TextEdit::singleline(&mut text).desired_width(f32::INFINITY)).labelled_by(name);
        if text == old {
            changes.remove(way);
        } else {
            changes.insert(way.to_vec(), text);
        }
    });
}

/// Three numbers within what a screen can show.
fn colour(text: &str) -> Option<[f32; 3]> {
    let numbers: Vec<f32> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
    <[f32; 3]>::try_from(numbers).ok().filter(|colour| colour.iter().all(|v| (0.0..=1.0).contains(v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_colours_get_a_picker() {
        assert_eq!(colour("0.5 0 1"), Some([0.5, 0.0, 1.0]));
        assert_eq!(colour("0.5 0"), None);
        assert_eq!(colour("0.5 0 7"), None);
        assert_eq!(colour("a b c"), None);
    }
}
