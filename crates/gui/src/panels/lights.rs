//! The groups of lights, each of which is turned up and down, or off.

use super::{head, named};
use crate::controls::Controls;
use crate::words;
use eframe::egui::{Slider, SliderClamping, Ui};

/// How much brighter a group can be made with the slider; by its number it may be more.
const MOST: f64 = 100.0;

/// See the module.
pub fn lights(ui: &mut Ui, controls: &mut Controls) {
    if controls.lights.0.is_empty() {
        return;
    }
    head(ui, words::LIGHT_GROUPS);
    for group in &mut controls.lights.0 {
        ui.horizontal(|ui| {
            let name = words::short(&group.name);
            let switch = named(ui, |ui| ui.checkbox(&mut group.is_on, name));
            let slider = Slider::new(&mut group.gain, 0.0..=MOST)
                .logarithmic(true)
                .smallest_positive(1e-3)
                .max_decimals(3)
                .clamping(SliderClamping::Never);
            let slider = ui.add_enabled(group.is_on, slider).labelled_by(switch.id);
            // A number that is typed may be anything.
            group.gain = group.gain.max(0.0);
            switch.on_hover_text(words::light_group(&group.name));
            slider.on_hover_text(words::LIGHT_GROUPS_HINT);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use indigo_film::{LightGroup, LightMix};
    use indigo_imaging::{Exposure, PictureSettings, ToneMapping};

    #[test]
    fn a_group_is_switched_off_and_on() {
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let group = |name: &str| LightGroup { name: name.to_owned(), gain: 2.0, is_on: true, layer: Some(0) };
        let settings = PictureSettings {
            lights: LightMix(vec![group("lamps"), group("the light of all the windows")]),
            ..PictureSettings::plain(ToneMapping::Linear { scale: 1.0 }, exposure)
        };
        let mut harness = Harness::builder().build_ui_state(lights, Controls::of(&settings));
        harness.run();
        harness.get_by_role_and_label(Role::CheckBox, "lamps").click();
        harness.run();
        let is_on = |harness: &Harness<Controls>| {
            harness.state().lights.0.iter().map(|g| g.is_on).collect::<Vec<_>>()
        };
        assert_eq!(is_on(&harness), [false, true]);
        assert_eq!(harness.state().apply(&settings).lights.gain("camera [lamps]"), 0.0);
        harness.get_by_role_and_label(Role::CheckBox, "lamps").click();
        harness.run();
        assert_eq!(is_on(&harness), [true, true]);
        assert_eq!(harness.state().lights, settings.lights);
    }
}
