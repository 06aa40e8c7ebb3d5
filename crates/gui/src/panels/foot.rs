//! What was said, and what was found in the files of the scene.

use crate::log::SourceView;
use crate::state::{Foot, State};
use crate::{theme, words};
use eframe::egui::{Button, RichText, ScrollArea, TextEdit, TextStyle, Ui, vec2};

/// See the module.
pub fn foot(ui: &mut Ui, state: &mut State) {
    // As high as it was made, however little it holds.
    ui.take_available_space();
    ui.horizontal(|ui| {
        ui.selectable_value(&mut state.foot, Foot::Log, words::LOG);
        let findings = words::findings(state.findings.len(), state.facts.is_some());
        ui.selectable_value(&mut state.foot, Foot::Findings, findings);
        if let Some(status) = &state.slaves {
            ui.selectable_value(&mut state.foot, Foot::Slaves, words::slaves(status.present));
        }
        let Some(read) = state.read().map(str::to_owned) else { return };
        if ui.button(words::BACK).clicked() {
            state.reading = None;
        }
        if ui.button(words::COPY).on_hover_text(words::COPY_HINT).clicked() {
            ui.copy_text(read);
        }
    });
    if let Some(text) = state.read() {
        return whole(ui, text, state.source_view.as_ref().filter(|_| state.foot == Foot::Findings));
    }
    let read = match state.foot {
        Foot::Log => log(ui, state),
        Foot::Findings => findings(ui, state),
        Foot::Slaves => super::slaves::slaves(ui, state.slaves.as_deref(), state.is_under_way()),
    };
    if let Some(text) = read {
        state.reading = Some((state.foot, text));
    }
}

/// A line that is read as a whole when it is pressed, since it may be longer than there is room.
pub(super) fn readable(ui: &mut Ui, line: RichText, whole: &str) -> bool {
    ui.add(Button::new(line).frame(false).truncate()).on_hover_text(whole).clicked()
}

/// The lines of the log; the text of the one that is to be read.
fn log(ui: &mut Ui, state: &State) -> Option<String> {
    let height = ui.text_style_height(&TextStyle::Body);
    let rows = state.log.lines().len();
    let mut read = None;
    let area = ScrollArea::vertical().id_salt("log").auto_shrink(false).stick_to_bottom(true);
    area.show_rows(ui, height, rows, |ui, range| {
        // As high as its text.
        ui.spacing_mut().interact_size.y = height;
        ui.spacing_mut().button_padding = vec2(0.0, 0.0);
        for line in state.log.lines().skip(range.start).take(range.len()) {
            let text = line.text.lines().next().unwrap_or_default();
            let text = RichText::new(text).color(theme::of_weight(line.weight, ui.visuals()));
            if readable(ui, text, &line.text) {
                read = Some(line.text.clone());
            }
        }
    });
    read
}

/// What was found; the text of what is to be read, whose place in the file is shown besides.
fn findings(ui: &mut Ui, state: &mut State) -> Option<String> {
    if state.findings.is_empty() {
        ui.weak(if state.facts.is_some() { words::NO_FINDINGS } else { words::NOTHING_TO_RENDER });
        return None;
    }
    let mut read = None;
    if let Some(path) = state.findings_of.as_deref().filter(|path| state.path.as_deref() != Some(path)) {
        ui.weak(words::not_open(path));
    }
    ScrollArea::vertical().id_salt("findings").auto_shrink(false).show(ui, |ui| {
        for finding in &state.findings {
            let text = RichText::new(&finding.head).color(theme::of_weight(finding.weight, ui.visuals()));
            if readable(ui, text, &finding.full) {
                read = Some(finding);
            }
        }
    });
    let finding = read?;
    state.source_view = finding.span.map(|span| SourceView::of(&state.sources, span));
    Some(finding.full.clone())
}

/// All of a text, which can be marked and copied, and the place that it is about.
fn whole(ui: &mut Ui, mut text: &str, view: Option<&SourceView>) {
    let area = ScrollArea::both().id_salt("whole").auto_shrink(false);
    area.show(ui, |ui| {
        let field = TextEdit::multiline(&mut text).font(TextStyle::Monospace).desired_rows(1);
        ui.add(field.desired_width(f32::INFINITY));
        if let Some(view) = view {
            source(ui, view);
        }
    });
}

fn source(ui: &mut Ui, view: &SourceView) {
    ui.weak(words::place(&view.name, view.line));
    for (i, line) in view.lines.iter().enumerate() {
        let number = view.first + i;
        let text = RichText::new(format!("{number:>5}  {line}")).monospace();
        if number == view.line {
            ui.label(text.strong().background_color(ui.visuals().selection.bg_fill));
        } else {
            ui.label(text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{Finding, Line, Weight};
    use crate::panels::tests;
    use crate::recent::Recent;
    use eframe::egui::{Key, Role};
    use egui_kittest::Harness;
    use egui_kittest::kittest::{NodeT as _, Queryable as _};
    use indigo_front::flags::Arguments;

    fn harness(state: State) -> Harness<'static, State> {
        let ui = |ui: &mut Ui, state: &mut State| {
            super::super::keys(ui.ctx(), state);
            foot(ui, state);
        };
        let mut harness = Harness::builder().with_size(vec2(400.0, 150.0)).build_ui_state(ui, state);
        harness.run();
        harness
    }

    /// Text that is seen in a field.
    fn field(harness: &Harness<'_, State>) -> Option<String> {
        let field = harness.query_by_role(Role::MultilineTextInput)?;
        field.accesskit_node().value()
    }

    #[test]
    fn a_long_line_is_read_by_keys_and_left_by_escape() {
        let mut state = State::new(Arguments::default(), Recent::default());
        let long = format!("first {}\nsecond", "word ".repeat(100));
        state.log.add(Line { weight: Weight::Error, text: long.clone() });
        let mut harness = harness(state);
        harness.get_by_label_contains("first word").focus();
        harness.run();
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(field(&harness), Some(long));
        assert!(harness.query_by_label(words::COPY).is_some());
        harness.key_press(Key::Escape);
        harness.run();
        assert_eq!(field(&harness), None);
    }

    #[test]
    fn nothing_is_said_of_a_scene_that_is_not_there() {
        for (state, is_open) in
            [(State::new(Arguments::default(), Recent::default()), false), (tests::full(), true)]
        {
            let harness = harness(State { foot: Foot::Findings, findings: vec![], ..state });
            assert_eq!(harness.query_by_label(words::NO_FINDINGS).is_some(), is_open);
        }
    }

    #[test]
    fn a_finding_without_a_place_can_be_read_too() {
        let full = "warning: odd\n  here".to_owned();
        let finding =
            Finding { weight: Weight::Warning, head: "odd".to_owned(), full: full.clone(), span: None };
        let state = State::new(Arguments::default(), Recent::default());
        let mut harness = harness(State { foot: Foot::Findings, findings: vec![finding], ..state });
        harness.get_by_label("odd").click();
        harness.run();
        assert_eq!(field(&harness), Some(full));
    }
}
