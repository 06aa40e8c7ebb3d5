//! What keys do in the picture: zoom, steps, and the cross that points at a pixel.

use crate::state::{Gesture, State, Tool, between};
use eframe::egui::{Color32, Painter, Rect, Stroke, StrokeKind, Vec2, vec2};

/// Two presses double the size.
const ZOOM_STEP: f32 = std::f32::consts::SQRT_2;
/// A step moves the picture by this part of its area, and a large one by that.
const PANS: [f32; 2] = [0.1, 0.5];
/// A step moves the cross by so many pixels, and a large one by so many.
const STEPS: [i32; 2] = [1, 10];
/// The ring round a pixel is no smaller than this, in points.
const LEAST_RING: f32 = 5.0;
/// Length of the arms of the cross, in points.
const ARM: f32 = 9.0;

/// Does what keys asked for; `unit` is the points of a pixel of the screen.
pub fn obey(state: &mut State, area: Rect, size: Vec2, unit: f32) {
    for gesture in std::mem::take(&mut state.gestures) {
        match gesture {
            Gesture::ZoomIn => zoom(state, ZOOM_STEP, area, size),
            Gesture::ZoomOut => zoom(state, 1.0 / ZOOM_STEP, area, size),
            Gesture::OneToOne => state.view.set_zoom(unit, area, size),
            Gesture::Step { to, is_far } if state.cross.is_none() && state.tool == Tool::Pan => {
                let part = PANS[usize::from(is_far)];
                state.view.pan(vec2(-to[0] as f32, -to[1] as f32) * part * area.size(), area, size);
            }
            Gesture::Step { to, is_far } => {
                step(state, to.map(|n| n * STEPS[usize::from(is_far)]), area, size);
            }
            Gesture::Cross if state.cross.is_some() => state.cross = None,
            Gesture::Cross => show(state, area, size),
            Gesture::Take if state.cross.is_none() && state.tool != Tool::Pan => show(state, area, size),
            Gesture::Take => state.take_at_cross(),
        }
    }
}

/// About the cross, or else the middle.
fn zoom(state: &mut State, factor: f32, area: Rect, size: Vec2) {
    let cross = state.cross.map(|at| state.view.place_of(between(at, at), area, size).center());
    state.view.zoom_at(factor, cross.unwrap_or(area.center()), area, size);
}

/// Moves the cross; the first step shows where it is.
fn step(state: &mut State, by: [i32; 2], area: Rect, size: Vec2) {
    let Some([x, y]) = state.cross else { return show(state, area, size) };
    let moved =
        |from: u32, by: i32, size: f32| from.saturating_add_signed(by).min((size as u32).saturating_sub(1));
    let at = [moved(x, by[0], size.x), moved(y, by[1], size.y)];
    state.cross = Some(at);
    state.view.reveal(at, area, size);
}

/// Puts the cross where the pointer is, or into the middle.
fn show(state: &mut State, area: Rect, size: Vec2) {
    state.cross = Some(state.hovered.unwrap_or_else(|| state.view.nearest(area.center(), area, size)));
}

/// Draws the cross, and the region that is begun.
pub fn draw(painter: &Painter, state: &State, area: Rect, size: Vec2) {
    if let (Some(corner), Some(at)) = (state.corner, state.pointed()) {
        let region = state.view.place_of(between(corner, at), area, size);
        painter.rect_stroke(region, 0.0, Stroke::new(1.5, Color32::WHITE), StrokeKind::Outside);
    }
    let Some(at) = state.cross else { return };
    let pixel = state.view.place_of(between(at, at), area, size);
    let ring = Rect::from_center_size(pixel.center(), pixel.size().max(Vec2::splat(LEAST_RING)));
    // White with a dark rim is seen on any picture.
    for stroke in [Stroke::new(3.0, Color32::from_black_alpha(160)), Stroke::new(1.0, Color32::WHITE)] {
        painter.rect_stroke(ring, 0.0, stroke, StrokeKind::Outside);
        for way in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
            let from = ring.center() + way * (ring.size() / 2.0 + Vec2::splat(2.0));
            painter.line_segment([from, from + way * ARM], stroke);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::action::Action;
    use crate::comparison::Layout;
    use crate::controls::Controls;
    use crate::engine::{BINS, Command, Histogram, Shown};
    use crate::panels::{Textures, keys, picture};
    use crate::recent::Recent;
    use crate::words;
    use crate::work::Work;
    use eframe::egui::accesskit::Live;
    use eframe::egui::{ColorImage, Key, Modifiers, Role, TextureOptions, Ui};
    use egui_kittest::Harness;
    use egui_kittest::kittest::{NodeT as _, Queryable as _};
    use indigo_film::{FilmSize, XyzImage};
    use indigo_front::flags::Arguments;
    use indigo_imaging::{Exposure, PictureSettings, ToneMapping};
    use std::sync::Arc;
    use std::time::Duration;

    const SIZE: [usize; 2] = [41, 21];

    /// A picture whose every pixel has a code of its own, in yellowish light.
    fn shown() -> Shown {
        let codes = (0..SIZE[0] * SIZE[1]).map(|i| Color32::from_gray((i % 251) as u8));
        let light = vec![[1.0, 1.0, 0.5, 1.0]; SIZE[0] * SIZE[1]];
        let size = FilmSize::new(SIZE[0] as u32, SIZE[1] as u32, 1).unwrap();
        let image = Arc::new(ColorImage::new(SIZE, codes.collect()));
        Shown {
            texture: Arc::clone(&image),
            image,
            histogram: Histogram([[0.0; BINS]; 3]),
            light: Arc::new(XyzImage { size, pixels: light, missing: vec![] }),
            lux_seconds_per_nit: 1.0,
            time: Duration::ZERO,
        }
    }

    fn harness() -> Harness<'static, State> {
        let mut state = State::new(Arguments::default(), Recent::default());
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let settings = PictureSettings::plain(ToneMapping::Linear { scale: 1.0 }, exposure);
        state.controls = Some(Controls::of(&settings));
        state.base = Some(settings);
        state.picture = Some(shown());
        state.work = Some(Work::endless());
        let ui = |ui: &mut Ui, state: &mut State| {
            let image = state.picture.as_ref().map(|picture| Arc::clone(&picture.image)).unwrap();
            let texture = ui.ctx().load_texture("render", image, TextureOptions::NEAREST);
            let render = Some((texture, SIZE));
            keys(ui.ctx(), state);
            picture(ui, state, &Textures { render, other: None });
        };
        let mut harness = Harness::builder().with_size(vec2(400.0, 300.0)).build_ui_state(ui, state);
        harness.run();
        harness
    }

    fn press(harness: &mut Harness<'_, State>, keys: &[(Modifiers, Key)]) {
        for (modifiers, key) in keys {
            harness.key_press_modifiers(*modifiers, *key);
            harness.run();
        }
    }

    const fn plain(key: Key) -> (Modifiers, Key) {
        (Modifiers::NONE, key)
    }

    const fn far(key: Key) -> (Modifiers, Key) {
        (Modifiers::SHIFT, key)
    }

    #[test]
    fn the_inspector_follows_the_cross() {
        let mut harness = harness();
        press(&mut harness, &[plain(Key::I)]);
        assert_eq!(harness.state().cross, Some([20, 10]), "the middle");
        press(&mut harness, &[plain(Key::ArrowRight), far(Key::ArrowUp), plain(Key::ArrowDown)]);
        assert_eq!(harness.state().cross, Some([21, 1]));
        assert!(harness.query_by_label("21, 1").is_some(), "its place is told");
        let code = (21 + SIZE[0]) % 251;
        let shown = format!("RGB {code:>3} {code:>3} {code:>3}");
        assert!(harness.query_by_label(&shown).is_some(), "{shown}");
        let said = words::at_cross([21, 1], [code as u8; 3], 1.0);
        let said = harness.query_by_label_contains(said.split(',').next().unwrap_or_default());
        let said = said.expect("a screen reader says it");
        assert_eq!(said.accesskit_node().live(), Live::Polite);
        // It stays within the picture.
        press(&mut harness, &[far(Key::ArrowUp), far(Key::ArrowRight), far(Key::ArrowRight)]);
        assert_eq!(harness.state().cross, Some([40, 0]));
        press(&mut harness, &[plain(Key::Escape)]);
        assert_eq!(harness.state().cross, None);
    }

    #[test]
    fn keys_zoom_and_move_the_picture() {
        let mut harness = harness();
        press(&mut harness, &[plain(Key::Plus), plain(Key::Equals)]);
        let area = Rect::from_min_size(eframe::egui::pos2(0.0, 0.0), vec2(100.0, 100.0));
        let size = vec2(SIZE[0] as f32, SIZE[1] as f32);
        let zoom = |harness: &Harness<'_, State>| harness.state().view.zoom(area, size);
        let twice = zoom(&harness);
        press(&mut harness, &[plain(Key::Minus), plain(Key::Minus)]);
        assert!((twice / zoom(&harness) - 2.0).abs() < 1e-5);
        let left = |harness: &Harness<'_, State>| harness.state().view.place(area, size).left();
        let before = left(&harness);
        press(&mut harness, &[plain(Key::ArrowRight)]);
        let step = before - left(&harness);
        assert!(step > 0.0, "what is on the right comes into sight");
        press(&mut harness, &[far(Key::ArrowLeft)]);
        assert!((left(&harness) - before - 4.0 * step).abs() < 1e-3);
        assert_eq!(harness.state().cross, None);
        press(&mut harness, &[plain(Key::F)]);
        assert!(harness.state().view.is_fitting());
    }

    #[test]
    fn a_grey_point_and_a_region_are_taken_by_keys() {
        let mut harness = harness();
        let white = |harness: &Harness<'_, State>| harness.state().controls.as_ref().map(|c| c.white);
        let before = white(&harness);
        press(&mut harness, &[plain(Key::G), plain(Key::ArrowRight), plain(Key::Enter)]);
        assert_ne!(white(&harness), before);
        assert_eq!((harness.state().tool, harness.state().cross), (Tool::Pan, None));
        press(&mut harness, &[plain(Key::R), plain(Key::Enter), plain(Key::Enter)]);
        assert_eq!(harness.state().corner, Some([20, 10]));
        press(&mut harness, &[far(Key::ArrowLeft), plain(Key::ArrowDown), plain(Key::Enter)]);
        let Some(Action::Command(Command::SetRegion(region, _))) = harness.state_mut().actions.pop() else {
            panic!("there is no region")
        };
        assert_eq!(region, Some([[10, 10], [21, 12]]));
        assert_eq!(harness.state().tool, Tool::Pan);
    }

    #[test]
    fn keys_choose_how_pictures_are_compared() {
        let mut harness = harness();
        press(&mut harness, &[plain(Key::C)]);
        assert!(matches!(harness.state_mut().actions.pop(), Some(Action::Ask(_))), "there is none yet");
        let image = harness.state().picture.as_ref().map(|picture| Arc::clone(&picture.image)).unwrap();
        harness.state_mut().comparison.picture = Some(("other.png".into(), image));
        press(&mut harness, &[plain(Key::C), plain(Key::C)]);
        assert_eq!(harness.state().comparison.layout, Layout::Wipe);
        press(&mut harness, &[plain(Key::Comma), plain(Key::Comma), plain(Key::Period)]);
        assert!((harness.state().comparison.wipe - 0.48).abs() < 1e-6);
    }

    #[test]
    fn arrows_are_for_the_control_that_has_the_focus() {
        let mut harness = harness();
        harness.get_by_role(Role::Image).focus();
        harness.run();
        press(&mut harness, &[plain(Key::I), plain(Key::ArrowRight)]);
        assert_eq!(harness.state().cross, Some([21, 10]), "the picture itself has it");
        assert!(harness.get_by_role(Role::Image).is_focused(), "and keeps it");
    }
}
