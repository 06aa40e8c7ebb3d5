//! The line at the bottom: what the engine is at, and how far.

use crate::engine::Phase;
use crate::state::State;
use crate::words;
use eframe::egui::{Label, ProgressBar, Spinner, Ui, vec2};
use indigo_front::messages::{clock, scaled};

/// See the module. Each part has its place, so that nothing moves when numbers grow.
pub fn status(ui: &mut Ui, state: &State) {
    ui.horizontal_centered(|ui| {
        let cell = |ui: &mut Ui, width: f32, text: String| {
            ui.allocate_ui(vec2(width, ui.available_height()), |ui| {
                ui.set_min_width(width);
                ui.add(Label::new(text).truncate());
            });
        };
        cell(ui, 150.0, words::status(&state.phase, state.path.as_deref(), state.wanted.as_deref()));
        ui.allocate_ui(vec2(18.0, 18.0), |ui| {
            ui.set_min_width(18.0);
            if matches!(state.phase, Phase::Loading | Phase::Ending) {
                ui.add(Spinner::new().size(16.0));
            }
        });
        let progress = state.progress.as_ref();
        let fraction = progress.and_then(|p| p.fraction);
        match fraction {
            Some(part) => {
                let text = words::whole_percent(part);
                ui.add(ProgressBar::new(part as f32).desired_width(140.0).text(text));
            }
            // Without a halting condition there is no end to be near to.
            None => ui.add_space(140.0),
        }
        let Some(p) = progress else { return };
        cell(ui, 110.0, words::samples_per_pixel(p.samples_per_pixel));
        // A film that was opened has no rate.
        let rate =
            (p.samples_per_second > 0.0).then(|| words::samples_per_second(&scaled(p.samples_per_second)));
        cell(ui, 120.0, rate.unwrap_or_default());
        cell(ui, 110.0, words::elapsed(&clock(p.elapsed)));
        cell(ui, 100.0, state.time_left().map(|left| words::left(&clock(left))).unwrap_or_default());
        cell(ui, 110.0, p.relative_error.map(words::error).unwrap_or_default());
    });
}
