//! A value of the scene: its name, a control of its kind with its unit, and what is wrong with it.

use super::colour;
use crate::log::Weight;
use crate::{theme, words};
use eframe::egui::accesskit::Node;
use eframe::egui::{
    Align, Button, Checkbox, ComboBox, Id, Label, Layout, Response, RichText, Role, TextEdit, Ui, WidgetInfo,
    vec2,
};
use indigo_decl::meaning::fault;
use indigo_decl::{Field, Kind, Meaning, Value, value};
use indigo_spectrum::illuminant::{ALL, find};

/// The longest text that is edited here, in bytes.
const LONGEST: usize = 400;
/// All fields begin this far from the left, however deep their elements are.
const EDGE: f32 = 150.0;
/// Unless their names would get less than this.
const LEAST_NAME: f32 = 56.0;
/// The power of colours that are written as they are picked on a screen.
const GAMMA_OF_SCREENS: f64 = 2.2;

/// Whether a text is too long to be edited here.
pub fn is_long(text: &str) -> bool {
    text.len() > LONGEST
}

/// What is known of a value beside its text.
pub struct Row<'r> {
    /// The name of its element.
    pub name: &'r str,
    /// What is declared of it.
    pub meaning: Meaning,
    /// The left edge of the panel.
    pub left: f32,
    /// Whether it is not what the file says.
    pub is_changed: bool,
    /// Whether it is too long to be edited here.
    pub is_long: bool,
    /// To what power the components of a colour are raised.
    pub gamma: f64,
}

impl<'r> Row<'r> {
    /// A value as the file says it.
    pub fn new(name: &'r str, meaning: Meaning, left: f32) -> Self {
        Self { name, meaning, left, is_changed: false, is_long: false, gamma: 1.0 }
    }

    /// Shows a text that was another in the file.
    pub fn show(&self, ui: &mut Ui, text: &mut String, old: &str) {
        ui.horizontal(|ui| {
            let name = self.label(ui);
            self.control(ui, text, old, name, 0.0);
        });
        self.complain(ui, text);
    }

    /// Shows a text that the file does not hold; whether it is not to be added any more.
    pub fn show_added(&self, ui: &mut Ui, text: &mut String) -> bool {
        let room = ui.spacing().interact_size.y + ui.spacing().item_spacing.x;
        let is_removed = ui.horizontal(|ui| {
            let name = self.label(ui);
            let old = text.clone();
            self.control(ui, text, &old, name, room);
            let words = words::take_back(self.name);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let button = ui.add(Button::new(words::REMOVE).small()).on_hover_text(&words);
                button.widget_info(|| WidgetInfo::labeled(Role::Button, true, &words));
                button.clicked()
            })
            .inner
        });
        self.complain(ui, text);
        is_removed.inner
    }

    /// The name, in as much room as all have; what names the control.
    fn label(&self, ui: &mut Ui) -> Id {
        let size = vec2(self.indent(ui), ui.spacing().interact_size.y);
        let label = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(size.x);
            let text = RichText::new(self.name);
            let text = match self.meaning {
                Meaning::Unknown | Meaning::Later(_) => text.weak(),
                _ if self.is_changed => text.strong(),
                _ => text,
            };
            ui.add(Label::new(text).truncate())
        });
        label.inner.on_hover_ui(|ui| drop(ui.label(words::meaning(self.meaning)))).id
    }

    fn indent(&self, ui: &Ui) -> f32 {
        (EDGE - (ui.cursor().left() - self.left)).max(LEAST_NAME)
    }

    fn control(&self, ui: &mut Ui, text: &mut String, old: &str, name: Id, room: f32) {
        if self.is_long {
            ui.weak(words::LONG_TEXT);
            return;
        }
        let width = ui.available_width() - room;
        let field = self.meaning.value();
        let control = match (field, field.map(|field| &field.kind)) {
            (_, Some(Kind::Flag)) => ui.weak(words::FLAG),
            (Some(field), Some(Kind::Bool)) if fault(field, text).is_none() => switch(ui, field, text, old),
            (Some(field), Some(Kind::Choice(choices))) => choice(ui, field, choices, text, width),
            (Some(field), Some(Kind::Text))
                if field.name == "white_balance" && find(text.trim()).is_some() =>
            {
                let names: Vec<&str> = ALL.iter().map(|illuminant| illuminant.name).collect();
                choice(ui, field, &names, text, width)
            }
            (None, _) if matches!(self.meaning, Meaning::Block(..) | Meaning::OneOf(..)) => return,
            _ => self.line(ui, field, text, name, width),
        };
        let control = control.labelled_by(name);
        // What the pointer shows over the name.
        let describe = |node: &mut Node| node.set_description(words::meaning(self.meaning));
        control.ctx.accesskit_node_builder(control.id, describe);
    }

    /// A line to type in, and a patch where it is a colour.
    fn line(&self, ui: &mut Ui, field: Option<&Field>, text: &mut String, name: Id, width: f32) -> Response {
        let gamma = field.and_then(|field| gamma(field, self.gamma));
        // All fields end at one edge, but where a colour's patch follows.
        let patch = gamma.map_or(0.0, |_| ui.spacing().interact_size.x + ui.spacing().item_spacing.x);
        let line = TextEdit::singleline(text).desired_width(width - patch);
        let unit = field.map_or("", words::unit_beside);
        let line = if unit.is_empty() { line } else { line.suffix(RichText::new(unit).weak()) };
        let response = ui.add(line);
        if let Some(gamma) = gamma {
            colour::patch(ui, text, gamma, name);
        }
        response
    }

    /// What is wrong with the text, below it.
    fn complain(&self, ui: &mut Ui, text: &str) {
        let Some(wrong) = self.meaning.value().filter(|_| !self.is_long).and_then(|field| fault(field, text))
        else {
            return;
        };
        ui.horizontal_top(|ui| {
            ui.add_space(self.indent(ui) + ui.spacing().item_spacing.x);
            let colour = theme::of_weight(Weight::Error, ui.visuals());
            ui.add(Label::new(RichText::new(wrong).color(colour)).wrap());
        });
    }
}

fn switch(ui: &mut Ui, field: &Field, text: &mut String, old: &str) -> Response {
    let is_on = |text: &str| value::parse(field, text).0 == Value::Bool(true);
    let mut on = is_on(text);
    let response = ui.add(Checkbox::without_text(&mut on));
    if response.changed() {
        // As it was written, where it says that.
        *text = if fault(field, old).is_none() && is_on(old) == on { old.to_owned() } else { on.to_string() };
    }
    response
}

fn choice(ui: &mut Ui, field: &Field, choices: &[&str], text: &mut String, width: f32) -> Response {
    let chosen = |text: &str| (fault(field, text).is_none()).then(|| value::parse(field, text).0);
    let now = chosen(text);
    ComboBox::from_id_salt("choice")
        .width(width)
        .selected_text(&**text)
        .show_ui(ui, |ui| {
            for word in choices {
                if ui.selectable_label(now == chosen(word), *word).clicked() {
                    ui.close();
                    if now != chosen(word) {
                        (*word).clone_into(text);
                    }
                }
            }
        })
        .response
}

/// To what power the components of a colour are raised, if a field holds one.
fn gamma(field: &Field, of_rgb: f64) -> Option<f64> {
    match (field.kind, field.name) {
        (Kind::Vec3, "rgb") => Some(of_rgb),
        // Of materials as they were written before version 1.0.
        (Kind::Vec3, "colour" | "diffuse") => Some(GAMMA_OF_SCREENS),
        _ => None,
    }
}
