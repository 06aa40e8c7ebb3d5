//! The picture, what the pointer does in it, and the pixel under it.

use super::cross;
use crate::comparison::Layout;
use crate::engine::Phase;
use crate::state::{State, Tool};
use crate::{theme, words};
use eframe::egui::accesskit::Live;
use eframe::egui::{
    Align2, Color32, CursorIcon, EventFilter, FontId, Id, Painter, PointerButton, Pos2, Rect, Response,
    RichText, Role, Sense, Stroke, StrokeKind, TextureHandle, Ui, Vec2, WidgetInfo, pos2, vec2,
};

/// How much a step of the wheel zooms.
const ZOOM_PER_POINT: f32 = 0.004;

/// The pictures as the graphics card has them.
#[derive(Default)]
pub struct Textures {
    /// The render, and the size of its picture: more than that of the texture where the card takes none so large.
    pub render: Option<(TextureHandle, [usize; 2])>,
    /// What it is compared with.
    pub other: Option<TextureHandle>,
}

/// By which the focus is told.
pub fn picture_id() -> Id {
    Id::unique("picture")
}

/// See the module.
pub fn picture(ui: &mut Ui, state: &mut State, textures: &Textures) {
    let whole = ui.available_rect_before_wrap();
    let (area, line) = whole.split_top_bottom_at_y(whole.bottom() - theme::LINE);
    ui.painter().rect_filled(area, 0.0, theme::surround(ui.visuals().dark_mode));
    ui.advance_cursor_after_rect(whole);
    let response = ui.interact(area, picture_id(), Sense::click_and_drag());
    let name = state.path.clone().unwrap_or_else(|| words::NOTHING_OPEN.to_owned());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, words::picture_of(&name)));
    if response.has_focus() {
        // Arrows are for the picture, and do not lead to another control.
        let arrows = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    }
    match textures.render.as_ref().filter(|_| state.picture.is_some()) {
        Some((render, size)) => {
            let size = vec2(size[0] as f32, size[1] as f32);
            let panes = Panes::of(area, state);
            interact(ui, state, &response, panes.render, size);
            state.view.is_drawn(panes.render, size, ui.ctx().pixels_per_point());
            draw(ui, state, &panes, size, render, textures.other.as_ref());
        }
        None => {
            state.gestures.clear();
            welcome(ui, area, state);
        }
    }
    if response.has_focus() {
        ui.painter().rect_stroke(area, 0.0, ui.visuals().selection.stroke, StrokeKind::Inside);
    }
    announce(ui, state, area);
    let mut line = ui.new_child(eframe::egui::UiBuilder::new().max_rect(line.shrink2(vec2(8.0, 0.0))));
    inspector(&mut line, state);
}

/// Where both pictures are.
struct Panes {
    /// The render, and what of it is seen.
    render: Rect,
    render_clip: Rect,
    /// The other picture, and what of it is seen.
    other: Option<(Rect, Rect)>,
}

impl Panes {
    fn of(area: Rect, state: &State) -> Self {
        let comparison = &state.comparison;
        match comparison.layout {
            _ if comparison.picture.is_none() => Self { render: area, render_clip: area, other: None },
            Layout::Off => Self { render: area, render_clip: area, other: None },
            Layout::Side => {
                let (left, right) = area.split_left_right_at_fraction(0.5);
                Self { render: left, render_clip: left, other: Some((right, right)) }
            }
            Layout::Wipe => {
                let (left, right) = area.split_left_right_at_fraction(comparison.wipe);
                Self { render: area, render_clip: left, other: Some((area, right)) }
            }
        }
    }
}

fn interact(ui: &Ui, state: &mut State, response: &Response, area: Rect, size: Vec2) {
    let pointer = response.hover_pos();
    state.hovered = pointer.and_then(|at| state.view.pixel(at, area, size));
    cross::obey(state, area, size, 1.0 / ui.ctx().pixels_per_point());
    // What was moved last points.
    if state.hovered.is_some() && ui.input(|input| input.pointer.delta() != Vec2::ZERO) {
        state.cross = None;
    }
    if let Some(at) = pointer {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        let factor = (scroll * ZOOM_PER_POINT).exp() * pinch;
        if factor != 1.0 {
            state.view.zoom_at(factor, at, area, size);
        }
    }
    let wipes = state.comparison.layout == Layout::Wipe && state.comparison.picture.is_some();
    let pans = response.dragged_by(PointerButton::Middle)
        || response.dragged_by(PointerButton::Primary) && state.tool != Tool::Region;
    if wipes && response.dragged_by(PointerButton::Secondary) {
        let at = response.interact_pointer_pos().map_or(0.5, |at| (at.x - area.left()) / area.width());
        state.comparison.wipe = at.clamp(0.0, 1.0);
    } else if pans {
        state.view.pan(response.drag_delta(), area, size);
    }
    match state.tool {
        Tool::Pan => {}
        Tool::Grey if response.clicked() => {
            if let Some(pixel) = state.hovered {
                state.take_grey(pixel);
            }
        }
        Tool::Region => draw_region(state, response, area, size),
        Tool::Grey => {}
    }
    if response.hovered() {
        ui.ctx().set_cursor_icon(match state.tool {
            Tool::Pan if response.dragged() => CursorIcon::Grabbing,
            Tool::Pan => CursorIcon::Default,
            Tool::Grey | Tool::Region => CursorIcon::Crosshair,
        });
    }
}

fn draw_region(state: &mut State, response: &Response, area: Rect, size: Vec2) {
    if response.drag_started_by(PointerButton::Primary) {
        // Not where the pointer was when it had moved so far that this is no click.
        state.drag_from = response.ctx.input(|input| input.pointer.press_origin());
        state.corner = None;
    }
    if !response.drag_stopped() {
        return;
    }
    let (Some(from), Some(to)) = (state.drag_from.take(), response.interact_pointer_pos()) else { return };
    if let Some(region) = state.view.region([from, to], area, size) {
        state.set_region(region);
    }
}

fn draw(
    ui: &Ui,
    state: &State,
    panes: &Panes,
    size: Vec2,
    render: &TextureHandle,
    other: Option<&TextureHandle>,
) {
    let clipped = |clip: Rect| ui.painter().with_clip_rect(clip);
    let place = state.view.place(panes.render, size);
    image(&clipped(panes.render_clip), render, place);
    if let (Some((area, clip)), Some(other)) = (panes.other, other) {
        // In the same place, whatever its size, so that the same things are seen.
        image(&clipped(clip), other, state.view.place(area, size));
        let x = clip.left();
        clipped(panes.render_clip.union(clip)).vline(x, clip.y_range(), Stroke::new(2.0, Color32::WHITE));
        label(&clipped(panes.render_clip), panes.render_clip.left_top(), Align2::LEFT_TOP, words::THE_RENDER);
        let name = state.comparison.name().unwrap_or_default();
        label(&clipped(clip), clip.right_top(), Align2::RIGHT_TOP, &name);
    }
    let frame = |rect: Rect, stroke: Stroke| {
        clipped(panes.render).rect_stroke(rect, 0.0, stroke, StrokeKind::Outside);
    };
    let accent = ui.visuals().selection.bg_fill;
    if let Some(region) = state.facts.as_ref().and_then(|facts| facts.region) {
        frame(state.view.place_of(region, panes.render, size), Stroke::new(1.0, accent));
    }
    if let (Some(from), Some(to)) = (state.drag_from, ui.input(|input| input.pointer.latest_pos())) {
        frame(Rect::from_two_pos(from, to), Stroke::new(1.5, Color32::WHITE));
    }
    cross::draw(&clipped(panes.render), state, panes.render, size);
}

/// Says at a corner which of two pictures it is.
fn label(painter: &Painter, corner: Pos2, align: Align2, text: &str) {
    let inwards = if align == Align2::LEFT_TOP { vec2(12.0, 10.0) } else { vec2(-12.0, 10.0) };
    let text = painter.layout_no_wrap(text.to_owned(), FontId::proportional(12.0), Color32::WHITE);
    let place = align.anchor_size(corner + inwards, text.size());
    painter.rect_filled(place.expand2(vec2(6.0, 3.0)), 4.0, Color32::from_black_alpha(160));
    painter.galley(place.min, text, Color32::WHITE);
}

fn image(painter: &Painter, texture: &TextureHandle, place: Rect) {
    let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.image(texture.id(), place, all, Color32::WHITE);
}

fn welcome(ui: &Ui, area: Rect, state: &State) {
    let text = match (&state.phase, &state.wanted) {
        (Phase::Loading, Some(path)) => words::loading(path),
        _ => words::in_empty_picture(&state.phase).to_owned(),
    };
    let colour = if ui.visuals().dark_mode { Color32::from_gray(170) } else { Color32::from_gray(30) };
    let font = FontId::proportional(16.0);
    ui.painter().text(area.center(), Align2::CENTER_CENTER, text, font, colour);
}

/// Has a screen reader say what is at the cross, whenever that is something else.
fn announce(ui: &Ui, state: &State, area: Rect) {
    let (Some(at), Some(picture)) = (state.cross, &state.picture) else { return };
    if is_outside(state, at) {
        return;
    }
    let index = at[1] as usize * picture.image.size[0] + at[0] as usize;
    let (Some(shown), Some(light)) = (picture.image.pixels.get(index), picture.light.pixels.get(index))
    else {
        return;
    };
    let text = words::at_cross(at, [shown.r(), shown.g(), shown.b()], light[1]);
    let node = ui.interact(Rect::from_min_size(area.min, Vec2::ZERO), Id::unique("cross"), Sense::hover());
    node.widget_info(|| WidgetInfo::labeled(Role::Status, true, &text));
    ui.ctx().accesskit_node_builder(node.id, |node| node.set_live(Live::Polite));
}

/// Whether a pixel is outside the part that is rendered: what is known of it may be of the render before.
fn is_outside(state: &State, at: [u32; 2]) -> bool {
    let region = state.facts.as_ref().and_then(|facts| facts.region);
    region.is_some_and(|[start, end]| (0..2).any(|axis| at[axis] < start[axis] || at[axis] >= end[axis]))
}

/// What is known of the pixel that is pointed at: in two lines, where there is no room for one.
fn inspector(ui: &mut Ui, state: &State) {
    const ONE_LINE: f32 = 700.0;
    let Some(picture) = &state.picture else { return };
    let zoom = words::zoom(state.view.shown());
    let mut cells = vec![(56.0, zoom)];
    match state.pointed() {
        None => cells.push((400.0, words::view(state.view.is_fitting()).to_owned())),
        Some(at) if is_outside(state, at) => {
            cells.extend([(72.0, words::pixel(at)), (400.0, words::OUTSIDE.to_owned())]);
        }
        Some(at) => {
            let index = at[1] as usize * picture.image.size[0] + at[0] as usize;
            cells.push((72.0, words::pixel(at)));
            let shown = picture.image.pixels.get(index);
            cells.extend(shown.map(|shown| (116.0, words::code([shown.r(), shown.g(), shown.b()]))));
            if let Some([x, y, z, _]) = picture.light.pixels.get(index) {
                let exposure = f64::from(*y) * picture.lux_seconds_per_nit;
                cells.extend([
                    (200.0, words::xyz([*x, *y, *z])),
                    (100.0, words::luminance(*y)),
                    (110.0, words::exposure(exposure)),
                ]);
            }
        }
    }
    let lines = if ui.available_width() < ONE_LINE { 3 } else { cells.len() };
    let height = theme::LINE / if lines < cells.len() { 2.0 } else { 1.0 };
    // Lines are no higher than that.
    (ui.spacing_mut().item_spacing.y, ui.spacing_mut().interact_size.y) = (0.0, height);
    ui.vertical(|ui| {
        for line in cells.chunks(lines) {
            ui.horizontal(|ui| {
                for (width, text) in line {
                    ui.allocate_ui_with_layout(
                        vec2(*width, height),
                        eframe::egui::Layout::left_to_right(eframe::egui::Align::Center),
                        |ui| {
                            ui.set_min_width(*width);
                            ui.label(RichText::new(text).monospace().size(11.0));
                        },
                    );
                }
            });
        }
    });
}
