//! What the scene holds, and what it takes.

use super::{fact, head};
use crate::state::State;
use crate::words;
use eframe::egui::Ui;
use indigo_front::messages::{clock, scaled};

/// See the module.
pub fn scene(ui: &mut Ui, state: &State) {
    let Some(facts) = &state.facts else {
        ui.add_space(8.0);
        ui.label(words::NOTHING_TO_RENDER);
        return;
    };
    head(ui, words::SCENE);
    let name = std::path::Path::new(&facts.path).file_name().map(|name| name.to_string_lossy().into_owned());
    fact(ui, words::FILE, name.unwrap_or_default());
    fact(ui, words::SIZE, words::size(facts.size));
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
        fact(ui, words::RATE, format!("{} /s", scaled(p.samples_per_second)));
        fact(ui, words::RAYS, scaled(p.rays as f64));
        fact(ui, words::TIME, clock(p.elapsed));
        fact(ui, words::TIME_LEFT, p.left.map_or_else(|| words::UNKNOWN.to_owned(), clock));
        let error = p.relative_error.map_or_else(|| words::NO_ESTIMATE.to_owned(), words::percent);
        fact(ui, words::ERROR, error);
    } else {
        ui.label(words::NOT_BEGUN);
    }
    head(ui, words::MACHINE);
    let memory = state.memory.map_or_else(|| words::UNKNOWN.to_owned(), words::memory);
    fact(ui, words::MEMORY, memory);
    if let Some(picture) = &state.picture {
        fact(ui, words::DEVELOPING, format!("{:.0} ms", picture.time.as_secs_f64() * 1e3));
    }
}
