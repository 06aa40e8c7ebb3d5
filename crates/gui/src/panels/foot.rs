//! What was said, and what was found in the files of the scene.

use crate::log::SourceView;
use crate::state::{Foot, State};
use crate::{theme, words};
use eframe::egui::{Button, RichText, ScrollArea, Ui};

/// See the module.
pub fn foot(ui: &mut Ui, state: &mut State) {
    // As high as it was made, however little it holds.
    ui.take_available_space();
    ui.horizontal(|ui| {
        ui.selectable_value(&mut state.foot, Foot::Log, words::LOG);
        ui.selectable_value(&mut state.foot, Foot::Findings, words::findings(state.findings.len()));
        if let Some(status) = &state.slaves {
            ui.selectable_value(&mut state.foot, Foot::Slaves, words::slaves(status.present));
        }
        if state.foot == Foot::Findings && state.source_view.is_some() && ui.button(words::BACK).clicked() {
            state.source_view = None;
        }
    });
    match (state.foot, &state.source_view) {
        (Foot::Log, _) => log(ui, state),
        (Foot::Findings, Some(view)) => source(ui, view),
        (Foot::Findings, None) => findings(ui, state),
        (Foot::Slaves, _) => super::slaves::slaves(ui, state.slaves.as_deref()),
    }
}

fn log(ui: &mut Ui, state: &State) {
    let height = ui.text_style_height(&eframe::egui::TextStyle::Body);
    let rows = state.log.lines().len();
    ScrollArea::vertical().id_salt("log").auto_shrink(false).stick_to_bottom(true).show_rows(
        ui,
        height,
        rows,
        |ui, range| {
            for line in state.log.lines().skip(range.start).take(range.len()) {
                let text = line.text.lines().next().unwrap_or_default();
                let text = RichText::new(text).color(theme::of_weight(line.weight, ui.visuals()));
                ui.add(eframe::egui::Label::new(text).truncate()).on_hover_text(&line.text);
            }
        },
    );
}

fn findings(ui: &mut Ui, state: &mut State) {
    if state.findings.is_empty() {
        ui.weak(words::NO_FINDINGS);
        return;
    }
    let mut looked_at = None;
    ScrollArea::vertical().id_salt("findings").auto_shrink(false).show(ui, |ui| {
        for finding in &state.findings {
            let text = RichText::new(&finding.head).color(theme::of_weight(finding.weight, ui.visuals()));
            let button = Button::new(text).frame(false).truncate();
            if ui.add(button).on_hover_text(&finding.full).clicked() {
                looked_at = finding.span;
            }
        }
    });
    if let Some(span) = looked_at {
        state.source_view = Some(SourceView::of(&state.sources, span));
    }
}

fn source(ui: &mut Ui, view: &SourceView) {
    ui.weak(words::place(&view.name, view.line));
    ScrollArea::both().id_salt("source").auto_shrink(false).show(ui, |ui| {
        for (i, line) in view.lines.iter().enumerate() {
            let number = view.first + i;
            let text = RichText::new(format!("{number:>5}  {line}")).monospace();
            if number == view.line {
                ui.label(text.strong().background_color(ui.visuals().selection.bg_fill)).scroll_to_me(None);
            } else {
                ui.label(text);
            }
        }
    });
}
