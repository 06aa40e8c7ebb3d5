//! Colours, which are picked as a screen shows them, times a factor.

use crate::words;
use eframe::egui::color_picker::{Alpha, color_picker_hsva_2d};
use eframe::egui::ecolor::{Hsva, Rgba};
use eframe::egui::{
    Color32, DragValue, Id, Popup, PopupCloseBehavior, Response, Role, Sense, StrokeKind, Ui, WidgetInfo,
};

/// Width of what a colour is picked by.
const PICKER: f32 = 240.0;

/// A colour as three numbers of a scene say it: linear light within what a screen shows, times a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Colour {
    shown: [f64; 3],
    /// By which the numbers are larger, 1 where all are within 0 and 1.
    factor: f64,
}

impl Colour {
    /// Of three numbers that are not negative, each of which is raised to a power.
    fn of(text: &str, gamma: f64) -> Option<Self> {
        let numbers: Vec<f64> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
        let numbers = <[f64; 3]>::try_from(numbers).ok()?;
        if !numbers.iter().all(|v| v.is_finite() && *v >= 0.0) {
            return None;
        }
        let factor = numbers.iter().fold(1.0, |largest: f64, v| largest.max(*v));
        Some(Self { shown: numbers.map(|v| (v / factor).powf(gamma)), factor })
    }

    fn to_text(self, gamma: f64) -> String {
        self.shown.map(|v| number(v.powf(gamma.recip()) * self.factor)).join(" ")
    }

    fn rgba(self) -> Rgba {
        let [r, g, b] = self.shown.map(|v| v as f32);
        Rgba::from_rgb(r, g, b)
    }
}

/// As many digits as are seen in a colour.
fn number(v: f64) -> String {
    const DIGITS: usize = 4;
    let rounded: f64 = format!("{v:.*e}", DIGITS - 1).parse().unwrap_or(v);
    rounded.to_string()
}

/// A patch of the colour that a text says, by which it can be picked; nothing where it says none.
pub fn patch(ui: &mut Ui, text: &mut String, gamma: f64, name: Id) {
    let Some(mut colour) = Colour::of(text, gamma) else { return };
    let button = button(ui, colour.rgba()).labelled_by(name);
    let id = button.id.with("picked");
    let popup = Popup::menu(&button).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let is_open = popup
        .show(|ui| {
            ui.spacing_mut().slider_width = PICKER;
            // Greys have no hue of their own: the one that was picked stays while the list is open.
            let mut picked =
                ui.data(|data| data.get_temp::<(Hsva, String)>(id)).filter(|(_, of)| *of == *text);
            let hsva = &mut picked.get_or_insert_with(|| (Hsva::from(colour.rgba()), text.clone())).0;
            let is_picked = color_picker_hsva_2d(ui, hsva, Alpha::Opaque);
            let hsva = *hsva;
            if is_picked {
                colour.shown = hsva.to_rgb().map(f64::from);
            }
            let is_scaled = factor(ui, &mut colour.factor);
            if is_picked || is_scaled {
                *text = colour.to_text(gamma);
                ui.data_mut(|data| data.insert_temp(id, (hsva, text.clone())));
            }
        })
        .is_some();
    if !is_open {
        ui.data_mut(|data| data.remove_temp::<(Hsva, String)>(id));
    }
}

/// What the colour is multiplied by.
fn factor(ui: &mut Ui, factor: &mut f64) -> bool {
    ui.horizontal(|ui| {
        let name = ui.label(words::COLOUR_FACTOR).id;
        let speed = 0.01 * *factor;
        // Below 1 the colour itself is darker.
        let value = DragValue::new(factor).speed(speed).range(1.0..=f64::from(f32::MAX)).max_decimals(4);
        ui.add(value).labelled_by(name).on_hover_text(words::COLOUR_FACTOR_HINT).changed()
    })
    .inner
}

fn button(ui: &mut Ui, colour: Rgba) -> Response {
    let (rect, response) = ui.allocate_exact_size(ui.spacing().interact_size, Sense::click());
    let colour = Color32::from(colour);
    let is_enabled = ui.is_enabled();
    response.widget_info(|| {
        let code = format!("#{:02x}{:02x}{:02x}", colour.r(), colour.g(), colour.b());
        let info = WidgetInfo::labeled(Role::ColorWell, is_enabled, words::COLOUR);
        WidgetInfo { current_text_value: Some(code), ..info }
    });
    let visuals = ui.style().interact(&response);
    ui.painter().rect_filled(rect, visuals.corner_radius, colour);
    let stroke = if response.has_focus() { ui.visuals().selection.stroke } else { visuals.fg_stroke };
    ui.painter().rect_stroke(rect, visuals.corner_radius, stroke, StrokeKind::Inside);
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_whatever_their_power() {
        for (text, gamma, shown, factor) in [
            ("0.5 0 1", 1.0, [0.5, 0.0, 1.0], 1.0),
            ("0.5 0 1", 2.0, [0.25, 0.0, 1.0], 1.0),
            ("8 4 2", 2.0, [1.0, 0.25, 0.0625], 8.0),
            ("0 0 0", 2.2, [0.0; 3], 1.0),
        ] {
            let colour = Colour::of(text, gamma).expect(text);
            assert_eq!((colour.shown, colour.factor), (shown, factor), "{text}");
            assert_eq!(colour.to_text(gamma), text);
        }
        for text in ["0.5 0", "1 1 -1", "a b c", "1 1 1 1", "inf 0 0"] {
            assert_eq!(Colour::of(text, 1.0), None, "{text}");
        }
    }

    #[test]
    fn small_numbers_keep_their_digits() {
        assert_eq!((number(1.234_56e-7), number(0.1 + 0.2)), ("0.0000001235".into(), "0.3".into()));
    }
}
