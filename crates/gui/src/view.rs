//! Where the picture is on the screen: zoom and position.

use eframe::egui::{Pos2, Rect, Vec2, pos2, vec2};

/// The least and most screen pixels for a pixel of the picture.
const ZOOMS: std::ops::RangeInclusive<f32> = 1.0 / 32.0..=64.0;

/// What part of the picture is shown, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Points on the screen for a pixel of the picture; `None`: as large as fits.
    zoom: Option<f32>,
    /// The point of the picture that is in the middle.
    centre: Pos2,
    /// Pixels of the screen for a pixel of the picture, as it was drawn last.
    shown: f32,
}

impl Default for View {
    fn default() -> Self {
        Self { zoom: None, centre: Pos2::ZERO, shown: 1.0 }
    }
}

impl View {
    /// As large as fits from now on.
    pub fn fit(&mut self) {
        self.zoom = None;
    }

    /// So many points for a pixel from now on.
    pub fn set_zoom(&mut self, zoom: f32, area: Rect, size: Vec2) {
        self.zoom_at(zoom / self.zoom(area, size), area.center(), area, size);
    }

    /// Points on the screen for a pixel of the picture.
    pub fn zoom(&self, area: Rect, size: Vec2) -> f32 {
        let fitting = (area.width() / size.x.max(1.0)).min(area.height() / size.y.max(1.0));
        self.zoom.unwrap_or(fitting.max(*ZOOMS.start()))
    }

    /// Whether the picture is as large as fits.
    pub fn is_fitting(&self) -> bool {
        self.zoom.is_none()
    }

    /// Remembers how large the picture is drawn, on a screen of so many pixels for a point.
    pub fn is_drawn(&mut self, area: Rect, size: Vec2, pixels_per_point: f32) {
        self.shown = self.zoom(area, size) * pixels_per_point;
    }

    /// Pixels of the screen for a pixel of the picture, as it was drawn last.
    pub fn shown(&self) -> f32 {
        self.shown
    }

    /// Whether a pixel of the picture is one of the screen by wish.
    pub fn is_one_to_one(&self) -> bool {
        !self.is_fitting() && (self.shown - 1.0).abs() < 1e-3
    }

    /// Where a picture of a size is in an area.
    pub fn place(&self, area: Rect, size: Vec2) -> Rect {
        let zoom = self.zoom(area, size);
        let centre = if self.zoom.is_some() { self.centre } else { (size / 2.0).to_pos2() };
        Rect::from_min_size(area.center() - centre.to_vec2() * zoom, size * zoom)
    }

    /// Zooms by a factor about a point of the screen, which keeps its pixel.
    pub fn zoom_at(&mut self, factor: f32, at: Pos2, area: Rect, size: Vec2) {
        let place = self.place(area, size);
        let old = self.zoom(area, size);
        let new = (old * factor).clamp(*ZOOMS.start(), *ZOOMS.end());
        let pixel = (at - place.min) / old;
        self.centre = (pixel + (area.center() - at) / new).to_pos2();
        self.zoom = Some(new);
        self.keep_in_sight(size);
    }

    /// Moves the picture by so many points.
    pub fn pan(&mut self, by: Vec2, area: Rect, size: Vec2) {
        let zoom = self.zoom(area, size);
        if self.zoom.is_none() {
            self.centre = (size / 2.0).to_pos2();
            self.zoom = Some(zoom);
        }
        self.centre -= by / zoom;
        self.keep_in_sight(size);
    }

    fn keep_in_sight(&mut self, size: Vec2) {
        self.centre = pos2(self.centre.x.clamp(0.0, size.x), self.centre.y.clamp(0.0, size.y));
    }

    /// The pixel of the picture under a point of the screen.
    pub fn pixel(&self, at: Pos2, area: Rect, size: Vec2) -> Option<[u32; 2]> {
        let pixel = (at - self.place(area, size).min) / self.zoom(area, size);
        let is_inside = pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < size.x && pixel.y < size.y;
        is_inside.then_some([pixel.x as u32, pixel.y as u32])
    }

    /// The pixel of the picture that is nearest to a point of the screen.
    pub fn nearest(&self, at: Pos2, area: Rect, size: Vec2) -> [u32; 2] {
        let pixel = (at - self.place(area, size).min) / self.zoom(area, size);
        let last = (size - Vec2::splat(1.0)).max(Vec2::ZERO);
        let pixel = pixel.floor().clamp(Vec2::ZERO, last);
        [pixel.x as u32, pixel.y as u32]
    }

    /// Moves the picture no further than is needed for a pixel to be seen.
    pub fn reveal(&mut self, [x, y]: [u32; 2], area: Rect, size: Vec2) {
        // Where it fits all of it is seen, but for rounding.
        if self.is_fitting() {
            return;
        }
        let pixel = self.place_of([[x, y], [x + 1, y + 1]], area, size);
        let by = (area.min - pixel.min).max(Vec2::ZERO) + (area.max - pixel.max).min(Vec2::ZERO);
        if by != Vec2::ZERO {
            self.pan(by, area, size);
        }
    }

    /// The rectangle of pixels between two points of the screen: first column and row, and those after the last; `None`
    /// where it would be empty.
    pub fn region(&self, ends: [Pos2; 2], area: Rect, size: Vec2) -> Option<[[u32; 2]; 2]> {
        let (place, zoom) = (self.place(area, size), self.zoom(area, size));
        let rect = Rect::from_two_pos(ends[0], ends[1]);
        let start = ((rect.min - place.min) / zoom).round().clamp(Vec2::ZERO, size);
        let end = ((rect.max - place.min) / zoom).round().clamp(Vec2::ZERO, size);
        let whole = |v: Vec2| [v.x as u32, v.y as u32];
        (end.x > start.x && end.y > start.y).then(|| [whole(start), whole(end)])
    }

    /// Where a rectangle of pixels is on the screen.
    pub fn place_of(&self, [start, end]: [[u32; 2]; 2], area: Rect, size: Vec2) -> Rect {
        let (place, zoom) = (self.place(area, size), self.zoom(area, size));
        let at = |[x, y]: [u32; 2]| place.min + vec2(x as f32, y as f32) * zoom;
        Rect::from_min_max(at(start), at(end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Vec2 = vec2(200.0, 100.0);

    fn area() -> Rect {
        Rect::from_min_size(pos2(10.0, 20.0), vec2(400.0, 400.0))
    }

    #[test]
    fn it_fits_in_the_middle() {
        let view = View::default();
        assert_eq!(view.zoom(area(), SIZE), 2.0);
        assert_eq!(view.place(area(), SIZE), Rect::from_min_size(pos2(10.0, 120.0), vec2(400.0, 200.0)));
        assert_eq!(view.pixel(pos2(11.0, 121.0), area(), SIZE), Some([0, 0]));
        assert_eq!(view.pixel(pos2(11.0, 119.0), area(), SIZE), None);
    }

    #[test]
    fn zooming_keeps_the_pixel_under_the_pointer() {
        let mut view = View::default();
        let at = pos2(150.0, 200.0);
        let before = view.pixel(at, area(), SIZE);
        view.zoom_at(3.0, at, area(), SIZE);
        assert_eq!(view.zoom(area(), SIZE), 6.0);
        assert_eq!(view.pixel(at, area(), SIZE), before);
        view.zoom_at(1e9, at, area(), SIZE);
        assert_eq!(view.zoom(area(), SIZE), 64.0);
        view.fit();
        assert_eq!(view.zoom(area(), SIZE), 2.0);
    }

    #[test]
    fn what_is_drawn_is_told_in_pixels_of_the_screen() {
        let mut view = View::default();
        view.is_drawn(area(), vec2(400.0, 200.0), 1.0);
        assert_eq!((view.shown(), view.is_one_to_one()), (1.0, false), "it fits by chance");
        for (zoom, is_one_to_one) in [(0.5, true), (1.0, false)] {
            view.set_zoom(zoom, area(), SIZE);
            view.is_drawn(area(), SIZE, 2.0);
            assert_eq!((view.shown(), view.is_one_to_one()), (2.0 * zoom, is_one_to_one));
        }
    }

    #[test]
    fn panning_moves_the_picture_with_the_pointer() {
        let mut view = View::default();
        let at = pos2(200.0, 200.0);
        let before = view.pixel(at, area(), SIZE);
        view.pan(vec2(30.0, -10.0), area(), SIZE);
        assert_eq!(view.pixel(at + vec2(30.0, -10.0), area(), SIZE), before);
        view.pan(vec2(1e6, 0.0), area(), SIZE);
        assert_eq!(
            view.pixel(area().center(), area(), SIZE).map(|p| p[0]),
            Some(0),
            "some of it stays in sight"
        );
    }

    #[test]
    fn a_pixel_is_brought_into_sight_by_the_shortest_way() {
        let mut view = View::default();
        let before = view;
        view.reveal([199, 99], area(), SIZE);
        assert_eq!(view, before, "it is in sight");
        assert_eq!(view.nearest(pos2(1e6, -1e6), area(), SIZE), [199, 0]);
        view.zoom_at(8.0, area().center(), area(), SIZE);
        view.reveal([199, 50], area(), SIZE);
        let seen = view.place_of([[199, 50], [200, 51]], area(), SIZE);
        assert!((seen.right() - area().right()).abs() < 1e-3, "{seen:?}");
        assert!(area().expand(1e-3).contains_rect(seen));
    }

    #[test]
    fn a_region_has_whole_pixels_within_the_picture() {
        let view = View::default();
        let region = view.region([pos2(30.4, 140.6), pos2(9.0, 90.0)], area(), SIZE);
        assert_eq!(region, Some([[0, 0], [10, 10]]));
        assert_eq!(view.region([pos2(30.0, 140.0); 2], area(), SIZE), None);
        assert_eq!(view.place_of([[0, 0], [10, 10]], area(), SIZE).max, pos2(30.0, 140.0));
    }
}
