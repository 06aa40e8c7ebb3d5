//! The elements of the scene, whose texts can be changed.

use crate::action::Action;
use crate::scene_file::SceneFile;
use crate::state::State;
use crate::words;
use eframe::egui::{Align, Button, CollapsingHeader, Label, Layout, TextEdit, Ui, vec2};
use indigo_decl::Element;
use std::collections::{BTreeMap, HashMap};

/// The most children of an element that are listed.
const MOST_CHILDREN: usize = 300;
/// The longest text that is edited here, in bytes.
const LONGEST: usize = 400;
/// The longest name in the head of an element, in characters.
const LONGEST_NAME: usize = 28;
/// All fields begin this far from the left, however deep their elements are.
const EDGE: f32 = 150.0;
/// Unless their names would get less than this.
const LEAST_NAME: f32 = 56.0;
/// How much further to the right children stand.
const INDENT: f32 = 12.0;
/// Children by which elements of one kind are told from each other, the best first.
const NAMES: [&str; 5] = ["name", "mesh_name", "material_name", "pathname", "uid"];

/// See the module.
pub fn tree(ui: &mut Ui, state: &mut State) {
    let Some(mut file) = state.file.take() else {
        if ui.button(words::READ_ELEMENTS).on_hover_text(words::READ_ELEMENTS_HINT).clicked() {
            state.act(Action::ReadElements);
        }
        return;
    };
    ui.horizontal(|ui| {
        let n = file.changes.len();
        let save = ui.add_enabled(n > 0, Button::new(words::SAVE_CHANGES));
        if save.on_hover_text(words::SAVE_CHANGES_HINT).clicked() {
            state.act(Action::SaveElements(Action::Restart.into()));
        }
        if ui.add_enabled(n > 0, Button::new(words::DISCARD)).clicked() {
            file.changes.clear();
        }
        ui.weak(words::changes(n));
    });
    ui.spacing_mut().indent = INDENT;
    let SceneFile { root, changes, .. } = &mut file;
    let mut tree = Tree { left: ui.cursor().left(), way: vec![], changes };
    tree.children(ui, root);
    state.file = Some(file);
}

/// What is known on the way through the elements.
struct Tree<'f> {
    /// The left edge of the panel.
    left: f32,
    /// The numbers of the children on the way here.
    way: Vec<usize>,
    changes: &'f mut BTreeMap<Vec<usize>, String>,
}

impl Tree<'_> {
    fn children(&mut self, ui: &mut Ui, element: &Element) {
        let mut titles = HashMap::new();
        for (index, child) in element.children.iter().take(MOST_CHILDREN).enumerate() {
            self.way.push(index);
            if child.children.is_empty() {
                self.leaf(ui, child);
            } else {
                let title = title(child);
                let same = titles.entry(title.clone()).and_modify(|n| *n += 1).or_insert(1);
                // Two models of one mesh, say.
                let title = if *same > 1 { words::one_of_many(&title, *same) } else { title };
                CollapsingHeader::new(title)
                    .id_salt(self.way.as_slice())
                    .show(ui, |ui| self.children(ui, child));
            }
            self.way.pop();
        }
        if element.children.len() > MOST_CHILDREN {
            ui.weak(words::more_elements(element.children.len() - MOST_CHILDREN));
        }
    }

    fn leaf(&mut self, ui: &mut Ui, element: &Element) {
        let old = &*element.text.value;
        ui.horizontal(|ui| {
            let width = (EDGE - (ui.cursor().left() - self.left)).max(LEAST_NAME);
            let size = vec2(width, ui.spacing().interact_size.y);
            let name = ui
                .allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
                    ui.set_min_width(width);
                    ui.add(Label::new(&*element.name).truncate()).id
                })
                .inner;
            if old.len() > LONGEST || element.mesh.is_some() {
                ui.weak(words::LONG_TEXT);
                return;
            }
            let mut text = self.changes.get(&self.way).cloned().unwrap_or_else(|| old.to_owned());
            let colour = colour(&text).filter(|_| &*element.name == "rgb");
            // A colour's patch stands at the right, so that all fields begin at one edge.
            let patch = colour.map_or(0.0, |_| ui.spacing().interact_size.x + ui.spacing().item_spacing.x);
            let field = TextEdit::singleline(&mut text).desired_width(ui.available_width() - patch);
            ui.add(field).labelled_by(name);
            if let Some(mut colour) = colour
                && ui.color_edit_button_rgb(&mut colour).labelled_by(name).changed()
            {
                text = colour.map(|v| format!("{v:.4}")).join(" ");
            }
            if text == old {
                self.changes.remove(&self.way);
            } else {
                self.changes.insert(self.way.clone(), text);
            }
        });
    }
}

/// The kind of an element, and what tells it from others of its kind.
fn title(element: &Element) -> String {
    let texts = NAMES.iter().filter_map(|name| element.child(name)).map(|child| child.text.value.trim());
    let Some(name) = texts.into_iter().find(|text| !text.is_empty()) else { return element.name.to_string() };
    if name.chars().count() > LONGEST_NAME {
        let start: String = name.chars().take(LONGEST_NAME).collect();
        return format!("{} {start}…", element.name);
    }
    format!("{} {name}", element.name)
}

/// Three numbers within what a screen can show.
fn colour(text: &str) -> Option<[f32; 3]> {
    let numbers: Vec<f32> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
    <[f32; 3]>::try_from(numbers).ok().filter(|colour| colour.iter().all(|v| (0.0..=1.0).contains(v)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recent::Recent;
    use crate::theme;
    use eframe::egui::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use indigo_front::flags::Arguments;

    #[test]
    fn only_colours_get_a_picker() {
        assert_eq!(colour("0.5 0 1"), Some([0.5, 0.0, 1.0]));
        assert_eq!(colour("0.5 0"), None);
        assert_eq!(colour("0.5 0 7"), None);
        assert_eq!(colour("a b c"), None);
    }

    /// Models have no names of their own, and fields of all depths are one column.
    #[test]
    fn models_are_told_from_each_other_and_fields_stand_in_a_column() {
        let path = std::env::temp_dir().join(format!("indigo-tree-{}.igs", std::process::id()));
        let text = "<scene><model><mesh_name>cube</mesh_name><scale>1</scale></model>\
                    <model><mesh_name>cube</mesh_name></model>\
                    <model><mesh_name>sphere</mesh_name><pos>0 0 1</pos></model><top>7</top></scene>";
        std::fs::write(&path, text).unwrap();
        let mut state = State::new(Arguments::default(), Recent::default());
        state.file = Some(SceneFile::read(path.to_str().unwrap()).unwrap());
        std::fs::remove_file(&path).unwrap();
        let mut harness = Harness::builder().with_size(vec2(theme::SIDE, 600.0)).build_ui_state(tree, state);
        harness.run();
        harness.get_by_label("model cube").click();
        harness.run();
        assert!(harness.query_by_label("model cube (2)").is_some());
        assert!(harness.query_by_label("model sphere").is_some());
        let fields = harness.query_all_by_role(Role::TextInput).map(|field| field.rect().left());
        let lefts: Vec<f32> = fields.collect();
        assert_eq!(lefts, [lefts[0]; 3], "two of the model, and one beside it");
    }
}
