//! Looks: spacing, and colours of both themes that carry a meaning.

use crate::log::Weight;
use eframe::egui::{Color32, Context, CornerRadius, Theme, Visuals, vec2};

/// Height of the tool bar.
pub const TOOL_BAR: f32 = 40.0;
/// Width of the panel on the right.
pub const SIDE: f32 = 324.0;
/// Height of the panel with log and findings at first.
pub const FOOT: f32 = 152.0;
/// The least and the greatest height that it can be given.
pub const FOOT_HEIGHTS: std::ops::RangeInclusive<f32> = 90.0..=420.0;
/// Height of the line with the state, and of that with the pixel under the pointer.
pub const LINE: f32 = 30.0;
/// Height of a line that only tells something.
pub const FACT: f32 = 16.0;
/// Width of the names of controls.
pub const NAME: f32 = 130.0;
/// Width of the controls behind them: what the panel leaves, less its margins of 8 points and the space between the two.
pub const CONTROL: f32 = SIDE - 16.0 - NAME - SPACE;
/// Width of numbers among them.
pub const VALUE: f32 = 64.0;
/// How far beyond what it scrolls the bar of the panel on the right ends: it is 2 points wide while the pointer is elsewhere,
/// and stands in the middle of the panel's margin, where it covers no control.
pub const BAR: f32 = 5.0;
/// The space between what stands side by side.
const SPACE: f32 = 8.0;

/// Sets both themes.
pub fn set(context: &Context) {
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = vec2(SPACE, 6.0);
        style.spacing.button_padding = vec2(8.0, 4.0);
        // With its number as wide as any other control.
        style.spacing.slider_width = CONTROL - SPACE - VALUE;
        style.spacing.interact_size.y = 22.0;
        // Texts that are read are not taken for something to be dragged.
        style.interaction.selectable_labels = false;
    });
    for theme in [Theme::Dark, Theme::Light] {
        let mut visuals = match theme {
            Theme::Dark => Visuals::dark(),
            Theme::Light => Visuals::light(),
        };
        let radius = CornerRadius::same(4);
        let widgets = &mut visuals.widgets;
        for state in [
            &mut widgets.noninteractive,
            &mut widgets.inactive,
            &mut widgets.hovered,
            &mut widgets.active,
            &mut widgets.open,
        ] {
            state.corner_radius = radius;
        }
        if theme == Theme::Dark {
            // A little more contrast than the usual for what is read.
            visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(190);
        } else {
            visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(50);
            // Boxes and circles that are not ticked, and what is only hinted at, are faint otherwise.
            visuals.widgets.inactive.bg_fill = Color32::from_gray(200);
            visuals.weak_text_color = Some(Color32::from_gray(95));
        }
        context.set_visuals_of(theme, visuals);
    }
}

/// The colour behind the picture: a grey without hue, so that the eye judges the picture by itself.
pub fn surround(is_dark: bool) -> Color32 {
    Color32::from_gray(if is_dark { 38 } else { 150 })
}

/// The colour of a line of the log.
pub fn of_weight(weight: Weight, visuals: &Visuals) -> Color32 {
    match weight {
        // Pure red is hard to read in small letters on a dark ground.
        Weight::Error if visuals.dark_mode => Color32::from_rgb(255, 110, 100),
        Weight::Error => Color32::from_rgb(190, 20, 20),
        Weight::Warning if visuals.dark_mode => Color32::from_rgb(240, 180, 70),
        Weight::Warning => Color32::from_rgb(150, 85, 0),
        Weight::Info => visuals.text_color(),
    }
}
