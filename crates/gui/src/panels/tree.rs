//! The elements of the scene as they are declared: what is in its files, and what could be.

mod colour;
mod field;

use crate::action::Action;
use crate::scene_file::{Changes, SceneFile};
use crate::state::State;
use crate::words;
use eframe::egui::{Button, CollapsingHeader, RichText, ScrollArea, Ui};
use field::Row;
use indigo_decl::{Element, Meaning};
use indigo_scene::schema::SCENE;
use std::collections::HashMap;

/// The most children of an element that are listed.
const MOST_CHILDREN: usize = 300;
/// The longest name in the head of an element, in characters.
const LONGEST_NAME: usize = 28;
/// How much further to the right children stand.
const INDENT: f32 = 12.0;
/// Height of the list of what can be added, at most.
const LIST: f32 = 360.0;
/// Its width.
const LIST_WIDTH: f32 = 300.0;
/// Children by which elements of one kind are told from each other, the best first.
const NAMES: [&str; 5] = ["name", "mesh_name", "material_name", "pathname", "uid"];

/// What is done with all changes.
pub fn bar(ui: &mut Ui, state: &mut State) {
    let Some(mut file) = state.file.take() else {
        if ui.button(words::READ_ELEMENTS).on_hover_text(words::READ_ELEMENTS_HINT).clicked() {
            state.act(Action::ReadElements);
        }
        return;
    };
    let (n, faults) = (file.changes.len(), file.faults());
    ui.horizontal(|ui| {
        let save = ui.add_enabled(n > 0 && faults == 0, Button::new(words::SAVE_CHANGES));
        let save = save.on_hover_text(words::SAVE_CHANGES_HINT);
        if faults > 0 {
            save.on_disabled_hover_text(words::faulty(faults));
        } else if save.clicked() {
            state.wanted.clone_from(&state.path);
            state.act(Action::SaveElements(Action::Restart.into()));
        }
        if ui.add_enabled(n > 0, Button::new(words::DISCARD)).clicked() {
            file.changes.clear();
        }
        ui.weak(words::changes(n));
    });
    ui.add_space(4.0);
    state.file = Some(file);
}

/// See the module.
pub fn tree(ui: &mut Ui, state: &mut State) {
    let Some(mut file) = state.file.take() else { return };
    ui.spacing_mut().indent = INDENT;
    let SceneFile { root, changes, .. } = &mut file;
    let mut tree = Tree { left: ui.cursor().left(), way: vec![], changes };
    tree.children(ui, root, Meaning::Block(&SCENE, None));
    state.file = Some(file);
}

/// What is known on the way through the elements.
struct Tree<'f> {
    /// The left edge of the panel.
    left: f32,
    /// The numbers of the children on the way here.
    way: Vec<usize>,
    changes: &'f mut Changes,
}

impl Tree<'_> {
    fn children(&mut self, ui: &mut Ui, element: &Element, meaning: Meaning) {
        let mut titles = HashMap::new();
        let gamma = self.gamma(element);
        for (index, child) in element.children.iter().take(MOST_CHILDREN).enumerate() {
            self.way.push(index);
            let of_child = meaning.child(&child.name);
            if child.children.is_empty() && of_child.defaults(child).is_empty() {
                self.leaf(ui, child, of_child, gamma);
            } else {
                let title = title(child);
                let same = titles.entry(title.clone()).and_modify(|n| *n += 1).or_insert(1);
                // Two models of one mesh, say.
                let title = if *same > 1 { words::one_of_many(&title, *same) } else { title };
                let header = CollapsingHeader::new(title).id_salt(self.way.as_slice());
                let header = header.show(ui, |ui| self.children(ui, child, of_child)).header_response;
                header.on_hover_ui(|ui| drop(ui.label(words::meaning(of_child))));
            }
            self.way.pop();
        }
        if element.children.len() > MOST_CHILDREN {
            ui.weak(words::more_elements(element.children.len() - MOST_CHILDREN));
        }
        self.added(ui, meaning);
        self.add(ui, element, meaning);
    }

    /// What is to be added to an element.
    fn added(&mut self, ui: &mut Ui, meaning: Meaning) {
        let Some(texts) = self.changes.added.get_mut(&self.way) else { return };
        let mut removed = None;
        for (name, text) in texts.iter_mut() {
            let row = Row { is_changed: true, ..Row::new(name, meaning.child(name), self.left) };
            if row.show_added(ui, text) {
                removed = Some(*name);
            }
        }
        if let Some(name) = removed {
            self.changes.take_back(&self.way, name);
        }
    }

    /// Offers what can be added, with what holds without it.
    fn add(&mut self, ui: &mut Ui, element: &Element, meaning: Meaning) {
        let mut defaults = meaning.defaults(element);
        let added = self.changes.added.get(&self.way);
        defaults.retain(|(field, _)| added.is_none_or(|added| !added.contains_key(field.name)));
        if defaults.is_empty() {
            return;
        }
        let menu = ui.menu_button(words::ADD_ELEMENT, |ui| {
            ui.set_min_width(LIST_WIDTH);
            ScrollArea::vertical().max_height(LIST).show(ui, |ui| {
                for (field, text) in &defaults {
                    let item =
                        Button::new(field.name).right_text(RichText::new(words::default(field, text)).weak());
                    if ui.add(item).on_hover_text(words::declared(field)).clicked() {
                        let added = self.changes.added.entry(self.way.clone()).or_default();
                        added.insert(field.name, (*text).to_owned());
                        ui.close();
                    }
                }
            });
        });
        menu.response.on_hover_text(words::add_to(&element.name));
    }

    fn leaf(&mut self, ui: &mut Ui, element: &Element, meaning: Meaning, gamma: f64) {
        let old = &*element.text.value;
        let mut text = self.changes.texts.get(&self.way).cloned().unwrap_or_else(|| old.to_owned());
        let row = Row {
            is_changed: text != old,
            is_long: field::is_long(old) || element.mesh.is_some(),
            gamma,
            ..Row::new(&element.name, meaning, self.left)
        };
        row.show(ui, &mut text, old);
        if text == old {
            self.changes.texts.remove(&self.way);
        } else {
            self.changes.insert(self.way.clone(), text);
        }
    }

    /// The power to which the components of a colour among the children of an element are raised.
    fn gamma(&self, element: &Element) -> f64 {
        let at = element.children.iter().position(|child| &*child.name == "gamma");
        let in_file = at.map(|at| {
            let way: Vec<usize> = self.way.iter().copied().chain([at]).collect();
            let in_file = &element.children[at].text.value;
            self.changes.texts.get(&way).map_or(&**in_file, String::as_str)
        });
        let added = || self.changes.added.get(&self.way)?.get("gamma").map(|text| &**text);
        let gamma = in_file.or_else(added).and_then(|text| text.trim().parse().ok());
        gamma.filter(|gamma: &f64| gamma.is_finite() && *gamma > 0.0).unwrap_or(1.0)
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

#[cfg(test)]
mod tests;
