use super::*;
use crate::recent::Recent;
use crate::theme;
use eframe::egui::accesskit::Toggled;
use eframe::egui::{Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _, by};
use indigo_front::flags::Arguments;

fn harness(name: &str, text: &str) -> Harness<'static, State> {
    let path = std::env::temp_dir().join(format!("indigo-tree-{}-{name}.igs", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let mut state = State::new(Arguments::default(), Recent::default());
    state.file = Some(SceneFile::read(path.to_str().unwrap()).unwrap());
    std::fs::remove_file(&path).unwrap();
    let builder = Harness::builder().with_size(vec2(theme::SIDE, 600.0)).with_context_setup(theme::set);
    let panel = |ui: &mut Ui, state: &mut State| {
        bar(ui, state);
        tree(ui, state);
    };
    let mut harness = builder.build_ui_state(panel, state);
    harness.run();
    harness
}

fn open(harness: &mut Harness<'_, State>, titles: &[&str]) {
    for title in titles {
        harness.get_by_label(title).click();
        harness.run();
    }
}

fn changes<'h>(harness: &'h Harness<'_, State>) -> &'h Changes {
    &harness.state().file.as_ref().expect("it is shown").changes
}

/// Puts a text into the field that has a name.
fn set(harness: &mut Harness<'_, State>, name: &str, text: &str) {
    let field = harness.get_by_role_and_label(Role::TextInput, name);
    field.focus();
    field.type_text(text);
    harness.run();
}

/// Models have no names of their own, and fields of all depths are one column.
#[test]
fn models_are_told_from_each_other_and_fields_stand_in_a_column() {
    let text = "<scene><model><mesh_name>cube</mesh_name><scale>1</scale></model>\
                <model><mesh_name>cube</mesh_name></model>\
                <model><mesh_name>sphere</mesh_name><pos>0 0 1</pos></model><top>7</top></scene>";
    let mut harness = harness("models", text);
    open(&mut harness, &["model cube"]);
    assert!(harness.query_by_label("model cube (2)").is_some());
    assert!(harness.query_by_label("model sphere").is_some());
    let fields = harness.query_all_by_role(Role::TextInput).map(|field| field.rect().left());
    let lefts: Vec<f32> = fields.collect();
    assert_eq!(lefts, [lefts[0]; 3], "two of the model, and one beside it");
}

const CAMERA: &str = "<scene><camera><pos>0 0 0</pos><aperture_radius>1</aperture_radius>\
                      <vignetting>true</vignetting></camera></scene>";

#[test]
fn a_value_is_checked_before_it_can_be_saved() {
    let mut harness = harness("checked", CAMERA);
    open(&mut harness, &["camera"]);
    assert!(harness.get_by_label(words::SAVE_CHANGES).accesskit_node().is_disabled(), "nothing is changed");
    set(&mut harness, "aperture_radius", "-");
    assert_eq!(changes(&harness).len(), 1);
    let told = harness
        .query_by_label_contains("must be > 0 (m)")
        .or_else(|| harness.query_by_label_contains("expected a number (m)"));
    assert!(told.is_some(), "what is wrong stands beside it");
    assert!(harness.get_by_label(words::SAVE_CHANGES).accesskit_node().is_disabled());
    let state = harness.state_mut();
    let changes = &mut state.file.as_mut().unwrap().changes;
    changes.texts.values_mut().for_each(|text| *text = "2".to_owned());
    harness.run();
    assert!(harness.query_by_label_contains("must be").is_none());
    harness.get_by_label(words::SAVE_CHANGES).click();
    harness.run();
    assert!(matches!(harness.state_mut().actions.pop(), Some(Action::SaveElements(_))));
}

#[test]
fn a_value_tells_what_is_declared_of_it() {
    let mut harness = harness("declared", CAMERA);
    open(&mut harness, &["camera"]);
    let field = harness.get_by_role_and_label(Role::TextInput, "aperture_radius");
    let told = field.accesskit_node().description().unwrap_or_default();
    assert!(told.contains("(m)") && told.contains("must be"), "{told}");
    harness.ctx.all_styles_mut(|style| {
        style.interaction.tooltip_delay = 0.0;
        style.interaction.show_tooltips_only_when_still = false;
    });
    let name = by().role(Role::Label).label("aperture_radius").include_labels();
    harness.get(name).hover();
    harness.run();
    assert!(harness.query_by_label_contains(&told).is_some(), "and where the pointer is");
}

#[test]
fn a_switch_is_one() {
    let mut harness = harness("switch", CAMERA);
    open(&mut harness, &["camera"]);
    let switch = |harness: &Harness<'_, State>| {
        harness.get_by_role_and_label(Role::CheckBox, "vignetting").accesskit_node().toggled()
    };
    assert_eq!(switch(&harness), Some(Toggled::True));
    harness.get_by_role_and_label(Role::CheckBox, "vignetting").click();
    harness.run();
    assert_eq!(changes(&harness).texts.get(&vec![0, 2]).map(String::as_str), Some("false"));
    harness.get_by_role_and_label(Role::CheckBox, "vignetting").click();
    harness.run();
    assert!(changes(&harness).is_empty(), "it is as it was");
}

#[test]
fn what_has_a_default_can_be_added_and_taken_back() {
    let mut harness = harness("added", CAMERA);
    open(&mut harness, &["camera", words::ADD_ELEMENT]);
    assert!(harness.query_by_label_contains("sensor_width").is_none(), "it has no default");
    harness.get_by_label_contains("exposure_duration").click();
    harness.run();
    let added = changes(&harness).added.get(&vec![0]).and_then(|added| added.get("exposure_duration"));
    assert_eq!(added.map(String::as_str), Some("0.01"));
    assert!(harness.query_by_role_and_label(Role::TextInput, "exposure_duration").is_some());
    open(&mut harness, &[words::ADD_ELEMENT]);
    assert!(harness.query_by_label_contains("white_balance").is_some(), "the list is open");
    // A label that names a control is not found beside it.
    let found = harness.query_all_by_label_contains("exposure_duration").count();
    assert_eq!(found, 2, "its field and its removal: it is not offered again");
    harness.key_press(eframe::egui::Key::Escape);
    harness.run();
    harness.get_by_label(&words::take_back("exposure_duration")).click();
    harness.run();
    assert!(changes(&harness).is_empty());
}

#[test]
fn every_colour_has_a_picker_and_a_factor_beyond_what_a_screen_shows() {
    let spectrum =
        "<background><spectrum><rgb><rgb>4 2 1</rgb><gamma>2</gamma></rgb></spectrum></background>";
    let mut harness = harness("colour", &format!("<scene>{spectrum}</scene>"));
    open(&mut harness, &["background", "spectrum", "rgb"]);
    let patch = harness.get_by_role(Role::ColorWell);
    // 1, 1/2 and 1/4 squared, as codes of sRGB.
    assert_eq!(patch.accesskit_node().value().as_deref(), Some("#ff8947"));
    patch.click();
    harness.run();
    let factor = harness.get_by_role_and_label(Role::SpinButton, words::COLOUR_FACTOR);
    assert_eq!(factor.accesskit_node().numeric_value(), Some(4.0));
    factor.set_value_accesskit(8.0);
    harness.run();
    let text = changes(&harness).texts.get(&vec![0, 0, 0, 0]).cloned().expect("it is changed");
    assert_eq!(text, "8 4 2");
}

#[test]
fn a_white_is_chosen_among_those_that_are_known() {
    let text = "<scene><camera><pos>0 0 0</pos><white_balance>D65</white_balance></camera></scene>";
    let mut harness = harness("white", text);
    open(&mut harness, &["camera"]);
    harness.get_by_role_and_label(Role::ComboBox, "white_balance").click();
    harness.run();
    harness.get_by_label("D50").click();
    harness.run();
    assert_eq!(changes(&harness).texts.values().collect::<Vec<_>>(), ["D50"]);
}
