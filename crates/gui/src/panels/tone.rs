//! How the picture is developed.

use super::{choice, head, lights, row};
use crate::action::Action;
use crate::controls::{Controls, Mapper};
use crate::engine::Histogram;
use crate::state::{State, Tool};
use crate::{theme, words};
use eframe::egui::{
    Align, Button, Checkbox, Color32, ComboBox, Mesh, Pos2, Rect, Response, Sense, Shape, Slider, Stroke, Ui,
    pos2, vec2,
};
use indigo_imaging::Response as Curves;

/// Whether a list of choices was not shown in the pass before: it opens where what is chosen can be seen.
fn has_just_opened(ui: &Ui) -> bool {
    let pass = ui.ctx().cumulative_pass_nr();
    let last = ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or(ui.scope_id(), 0), pass));
    last + 1 < pass
}

/// See the module.
pub fn tone(ui: &mut Ui, state: &mut State) {
    histogram(ui, state.picture.as_ref().map(|picture| &picture.histogram));
    let Some(mut controls) = state.controls.clone() else {
        ui.add_space(8.0);
        ui.label(words::NOTHING_OPEN);
        return;
    };
    mapping(ui, state, &mut controls);
    white(ui, state, &mut controls);
    optics(ui, state, &mut controls);
    lights::lights(ui, &mut controls);
    if state.controls.as_ref() != Some(&controls) {
        state.controls = Some(controls);
        state.controls_changed();
    }
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        let reset = if state.undo_of_reset().is_some() { words::UNDO_RESET } else { words::RESET };
        if ui.button(reset).on_hover_text(words::RESET_HINT).clicked() {
            state.reset_controls();
        }
        let write = Button::new(words::WRITE_SETTINGS);
        if ui.add_enabled(state.facts.is_some(), write).on_hover_text(words::WRITE_SETTINGS_HINT).clicked() {
            state.act(Action::WriteSettings);
        }
    });
}

fn mapping(ui: &mut Ui, state: &mut State, controls: &mut Controls) {
    head(ui, words::TONE_MAPPING);
    row(ui, words::MAPPER, |ui| {
        ComboBox::from_id_salt("mapper")
            .width(theme::CONTROL)
            .truncate()
            .selected_text(words::mapper(controls.mapper))
            .show_ui(ui, |ui| {
                for mapper in Mapper::ALL {
                    choice(ui, &mut controls.mapper, mapper, words::mapper(mapper));
                }
            })
            .response
    });
    match controls.mapper {
        Mapper::Linear => {
            scale(ui, words::SCALE, &mut controls.scale, 1e-4..=1e4);
        }
        Mapper::Reinhard => {
            scale(ui, words::PRE_SCALE, &mut controls.pre_scale, 1e-3..=1e3);
            scale(ui, words::POST_SCALE, &mut controls.post_scale, 1e-2..=1e2);
            scale(ui, words::BURN, &mut controls.burn, 1e-2..=1e3);
        }
        Mapper::Camera => {
            row(ui, words::EV, |ui| {
                ui.add(Slider::new(&mut controls.ev, -12.0..=12.0).step_by(0.1).fixed_decimals(1))
            })
            .on_hover_text(words::EV_HINT);
            scale(ui, words::ISO, &mut controls.iso, 10.0..=102_400.0);
            response(ui, state, controls);
            curve(ui, &controls.response);
        }
    }
}

/// A slider over powers of ten.
fn scale(ui: &mut Ui, name: &str, value: &mut f64, range: std::ops::RangeInclusive<f64>) -> Response {
    // A bound on the decimals would round the value itself, whenever it is shown.
    let shown = |value: f64, _| {
        let text = format!("{value:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    row(ui, name, |ui| ui.add(Slider::new(value, range).logarithmic(true).custom_formatter(shown)))
}

fn response(ui: &mut Ui, state: &mut State, controls: &mut Controls) {
    let mut chosen = None;
    row(ui, words::RESPONSE, |ui| {
        ComboBox::from_id_salt("response")
            .width(theme::CONTROL)
            .truncate()
            .selected_text(words::response(controls.response.name()))
            .show_ui(ui, |ui| {
                let display = std::sync::Arc::new(Curves::display());
                if ui.selectable_label(controls.response.name().is_empty(), words::response("")).clicked() {
                    ui.close();
                    controls.response = display;
                    state.awaited_response = None;
                }
                let is_new = has_just_opened(ui);
                for (name, path) in &state.responses {
                    let is_chosen = controls.response.name() == name;
                    let entry = ui.selectable_label(is_chosen, words::response(name));
                    if is_chosen && is_new {
                        entry.scroll_to_me(Some(Align::Center));
                    }
                    if entry.clicked() {
                        ui.close();
                        state.awaited_response = Some(name.clone());
                        chosen = Some(Action::ReadResponse(name.clone(), path.clone()));
                    }
                }
            })
            .response
    });
    state.actions.extend(chosen);
}

/// The response, from irradiance to brightness, for red, green and blue.
fn curve(ui: &mut Ui, response: &Curves) {
    const POINTS: u16 = 128;
    let (rect, area) = ui.allocate_exact_size(vec2(ui.available_width(), 96.0), Sense::hover());
    area.on_hover_text(words::CURVE_HINT);
    ui.painter().rect_filled(rect, 4.0, ui.visuals().extreme_bg_color);
    let inner = rect.shrink(6.0);
    for (channel, colour) in channel_colours(ui).into_iter().enumerate() {
        let points = (0..=POINTS).map(|i| {
            let x = f32::from(i) / f32::from(POINTS);
            let y = response.brightness(channel, x).clamp(0.0, 1.0);
            pos2(inner.left() + x * inner.width(), inner.bottom() - y * inner.height())
        });
        ui.painter().add(Shape::line(points.collect(), Stroke::new(1.5, colour)));
    }
}

/// Red, green and blue that can be told from the ground in both themes.
fn channel_colours(ui: &Ui) -> [Color32; 3] {
    if ui.visuals().dark_mode {
        [Color32::from_rgb(235, 90, 90), Color32::from_rgb(90, 200, 90), Color32::from_rgb(110, 150, 255)]
    } else {
        [Color32::from_rgb(190, 30, 30), Color32::from_rgb(20, 130, 20), Color32::from_rgb(40, 70, 210)]
    }
}

fn white(ui: &mut Ui, state: &mut State, controls: &mut Controls) {
    head(ui, words::WHITE_BALANCE);
    row(ui, words::WHITE, |ui| {
        ComboBox::from_id_salt("white")
            .width(theme::CONTROL)
            .truncate()
            .selected_text(controls.white_name())
            .show_ui(ui, |ui| {
                let is_new = has_just_opened(ui);
                for illuminant in indigo_spectrum::illuminant::ALL {
                    let is_chosen = controls.white == illuminant.white_xy;
                    let entry = choice(ui, &mut controls.white, illuminant.white_xy, illuminant.name);
                    if is_chosen && is_new {
                        entry.scroll_to_me(Some(Align::Center));
                    }
                }
            })
            .response
    });
    row(ui, "", |ui| {
        let picks = state.tool == Tool::Grey;
        let button = ui.add(Button::new(words::PICK_GREY).selected(picks)).on_hover_text(words::GREY_HINT);
        if button.clicked() {
            state.set_tool(if picks { Tool::Pan } else { Tool::Grey });
        }
        button
    });
}

fn optics(ui: &mut Ui, state: &State, controls: &mut Controls) {
    head(ui, words::OPTICS);
    let can_diffract = state.base.as_ref().is_some_and(|base| base.diffraction.is_some());
    let diffraction = Checkbox::new(&mut controls.diffraction, words::DIFFRACTION);
    ui.add_enabled(can_diffract, diffraction).on_disabled_hover_text(words::NO_DIFFRACTION);
    ui.checkbox(&mut controls.bloom, words::BLOOM);
    ui.add_enabled_ui(controls.bloom, |ui| {
        row(ui, words::BLOOM_WEIGHT, |ui| ui.add(Slider::new(&mut controls.bloom_weight, 0.0..=1.0)));
        row(ui, words::BLOOM_RADIUS, |ui| {
            ui.add(Slider::new(&mut controls.bloom_radius, 0.0005..=0.2).logarithmic(true))
        });
    });
}

/// How often each brightness is there.
fn histogram(ui: &mut Ui, histogram: Option<&Histogram>) {
    let (rect, area) = ui.allocate_exact_size(vec2(ui.available_width(), 84.0), Sense::hover());
    area.on_hover_text(words::HISTOGRAM_HINT);
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, 4.0, ui.visuals().extreme_bg_color);
    let Some(Histogram(channels)) = histogram else { return };
    let inner = rect.shrink(6.0);
    for (values, colour) in channels.iter().zip(channel_colours(ui)) {
        let at = |i: usize, value: f32| {
            let x = inner.left() + inner.width() * i as f32 / (values.len() - 1) as f32;
            // Roots, so that what is rare is seen, too.
            pos2(x, inner.bottom() - inner.height() * value.sqrt())
        };
        let line: Vec<Pos2> = values.iter().enumerate().map(|(i, &value)| at(i, value)).collect();
        painter.add(Shape::mesh(filled(&line, inner, colour.gamma_multiply(0.25))));
        painter.add(Shape::line(line, Stroke::new(1.0, colour)));
    }
}

/// What is below a line.
fn filled(line: &[Pos2], inner: Rect, colour: Color32) -> Mesh {
    let mut mesh = Mesh::default();
    for (i, point) in line.iter().enumerate() {
        mesh.colored_vertex(*point, colour);
        mesh.colored_vertex(pos2(point.x, inner.bottom()), colour);
        if i > 0 {
            let at = 2 * i as u32;
            mesh.add_triangle(at - 2, at - 1, at);
            mesh.add_triangle(at - 1, at, at + 1);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recent::Recent;
    use eframe::egui::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use indigo_front::flags::Arguments;
    use indigo_imaging::{Exposure, PictureSettings, ToneMapping};

    fn harness() -> Harness<'static, State> {
        let mut state = State::new(Arguments::default(), Recent::default());
        let response = std::sync::Arc::new(Curves::display());
        let tone_mapping = ToneMapping::Camera { response, ev_adjust: 0.0, film_iso: 100.0 };
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let settings = PictureSettings::plain(tone_mapping, exposure);
        state.controls = Some(Controls::of(&settings));
        state.base = Some(settings);
        Harness::builder().with_size(vec2(theme::SIDE, 900.0)).build_ui_state(tone, state)
    }

    #[test]
    fn controls_are_found_by_their_names_and_act() {
        let mut harness = harness();
        harness.run();
        for (name, role) in [
            (words::MAPPER, Role::ComboBox),
            (words::EV, Role::Slider),
            (words::ISO, Role::Slider),
            (words::RESPONSE, Role::ComboBox),
            (words::WHITE, Role::ComboBox),
        ] {
            // What a control is named by has that text, too: only its role tells them from each other.
            let found = harness.query_by_role_and_label(role, name);
            assert!(found.is_some(), "{name} has no name for a screen reader");
        }
        harness.get_by_label(words::BLOOM).click();
        harness.run();
        assert!(harness.state().controls.as_ref().is_some_and(|controls| controls.bloom));
        assert!(!harness.state().actions.is_empty(), "the picture is developed anew");
        harness.get_by_label(words::RESET).click();
        harness.run();
        let has_bloom = |harness: &Harness<'_, State>| harness.state().controls.as_ref().map(|c| c.bloom);
        assert_eq!(has_bloom(&harness), Some(false));
        // It may have been pressed by mistake.
        harness.get_by_label(words::UNDO_RESET).click();
        harness.run();
        assert_eq!(has_bloom(&harness), Some(true));
        harness.get_by_label(words::RESET).click();
        harness.run();
        harness.get_by_label(words::BLOOM).click();
        harness.run();
        assert!(harness.query_by_label(words::UNDO_RESET).is_none(), "what was moved since would be lost");
    }

    #[test]
    fn a_control_that_is_shown_keeps_its_value() {
        let mut harness = harness();
        let controls = harness.state_mut().controls.as_mut().expect("a film");
        (controls.mapper, controls.scale) = (Mapper::Linear, 0.3);
        for _ in 0..2 {
            harness.state_mut().brighten(0.5);
            harness.run();
        }
        let scale = harness.state().controls.as_ref().map_or(0.0, |controls| controls.scale);
        assert!((scale - 0.6).abs() < 1e-12, "{scale}");
        assert!(harness.query_by_value("0.6").is_some());
    }

    #[test]
    fn a_response_is_read_elsewhere_and_awaited() {
        let mut harness = harness();
        harness.run();
        harness.get_by_role_and_label(Role::ComboBox, words::RESPONSE).click();
        harness.run();
        harness.get_by_label("Film soft").click();
        harness.run();
        let state = harness.state_mut();
        let Some(Action::ReadResponse(name, _)) = state.actions.pop() else { panic!("it is not read") };
        assert_eq!(state.awaited_response.as_ref(), Some(&name));
        assert_eq!(state.controls.as_ref().map(|c| c.response.name().to_owned()).as_deref(), Some(""));
    }
}
