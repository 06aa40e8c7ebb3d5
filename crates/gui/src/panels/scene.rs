//! What the scene holds, and what it takes; or its elements.

use super::tree;
use super::{fact, head};
use crate::action::Action;
use crate::state::State;
use crate::words;
use eframe::egui::Ui;
use indigo_front::messages::{clock, scaled};

/// What stays in sight, whatever is scrolled to.
pub fn bar(ui: &mut Ui, state: &mut State) {
    if state.facts.is_none() {
        return;
    }
    ui.horizontal(|ui| {
        ui.selectable_value(&mut state.shows_elements, false, words::OVERVIEW);
        let elements = ui.selectable_value(&mut state.shows_elements, true, words::ELEMENTS);
        if elements.on_hover_text(words::READ_ELEMENTS_HINT).clicked() && state.file.is_none() {
            state.act(Action::ReadElements);
        }
    });
    ui.add_space(4.0);
    if state.shows_elements {
        tree::bar(ui, state);
    }
}

/// See the module.
pub fn scene(ui: &mut Ui, state: &mut State) {
    if state.facts.is_none() {
        ui.add_space(8.0);
        ui.label(words::NOTHING_TO_RENDER);
    } else if state.shows_elements {
        tree::tree(ui, state);
    } else {
        overview(ui, state);
    }
}

fn overview(ui: &mut Ui, state: &State) {
    let Some(facts) = &state.facts else { return };
    head(ui, words::SCENE);
    let name = std::path::Path::new(&facts.path).file_name().map(|name| name.to_string_lossy().into_owned());
    fact(ui, words::FILE, name.unwrap_or_default());
    fact(ui, words::SIZE, words::size(facts.size));
    fact(ui, words::SUPER_SAMPLING, words::super_sampling(facts.size.super_sample()));
    let stats = &facts.stats;
    let number = |n: usize| scaled(n as f64);
    fact(ui, words::TRIANGLES, scaled(stats.geometry.triangles as f64));
    fact(ui, words::OBJECTS, number(stats.objects));
    fact(ui, words::LIGHTS, number(stats.lights));
    fact(ui, words::MATERIALS, number(stats.materials));
    fact(ui, words::MEDIA, number(facts.media));
    fact(ui, words::TEXTURES, number(stats.textures));
    head(ui, words::PROGRESS);
    if let Some(p) = &state.progress {
        fact(ui, words::SAMPLES, scaled(p.samples as f64));
        fact(ui, words::SPP, format!("{:.1}", p.samples_per_pixel));
        fact(ui, words::RATE, words::per_second(&scaled(p.samples_per_second)));
        fact(ui, words::RAYS, scaled(p.rays as f64));
        fact(ui, words::TIME, clock(p.elapsed));
        let left = state.time_left().map(clock);
        fact(ui, words::TIME_LEFT, left.unwrap_or_else(|| words::no_time_left(&state.phase).to_owned()));
        let error = p.relative_error.map_or_else(|| words::NO_ESTIMATE.to_owned(), words::percent);
        fact(ui, words::ERROR, error);
    } else {
        ui.label(words::NOT_BEGUN);
    }
    head(ui, words::MACHINE);
    let memory = state.memory.map_or_else(|| words::UNKNOWN.to_owned(), words::memory);
    fact(ui, words::MEMORY, memory);
    if let Some(picture) = &state.picture {
        fact(ui, words::DEVELOPING, words::milliseconds(picture.time));
    }
}
