//! A convex opening as a polygon round the centre.
//!
//! Arcs become chords that leave them by less than single precision can tell, so that choosing a point of
//! the polygon is choosing one of the shape: a triangle from the centre to a chord, and a point in it.

// tidy: load-time mathematics

use super::Mask;
use indigo_math::{Real, Vec2};
use rayon::prelude::*;

/// How far a chord may leave its arc, in half sides of the square: about the step of an `f32` near 1.
const SAGITTA: f64 = 1e-7;
/// Scan lines through each row of cells of a drawing. Along a line the drawing is exact.
const LINES: usize = 16;

/// A convex polygon that holds the centre of the square [-1, 1]² and does not leave the square.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Corners, counter-clockwise; the last one is the first one again.
    points: Vec<[f32; 2]>,
    /// Part of the area of the triangles up to each corner, from 0 to 1.
    cumulative: Vec<f32>,
    area: f64,
}

impl Outline {
    /// Chords for an angle seen from the centre of an arc of radius `r` that lies at a distance of up to
    /// `distance` from it. The sagitta of a chord that spans an angle of γ at its circle is r γ²/8.
    pub(super) fn chords(angle: f64, r: f64, distance: f64) -> usize {
        let span = (angle * distance / r).min(std::f64::consts::TAU);
        ((span * (r / (8.0 * SAGITTA)).sqrt()).ceil() as usize).max(1)
    }

    /// The polygon of some corners round the centre, cut off by the square.
    pub(super) fn new(corners: Vec<[f64; 2]>) -> Self {
        let mut corners = cut_by_square(corners);
        corners.extend(corners.first().copied());
        let doubles = corners.windows(2).map(|w| w[0][0] * w[1][1] - w[0][1] * w[1][0]);
        let mut sum = 0.0;
        let mut sums = vec![0.0];
        sums.extend(doubles.map(|double| {
            sum += double;
            sum
        }));
        Self {
            points: corners.iter().map(|p| p.map(|v| v as f32)).collect(),
            cumulative: sums.iter().map(|s| (s / sum) as f32).collect(),
            area: 0.5 * sum,
        }
    }

    /// The circle of radius 1.
    pub(super) fn circle() -> Self {
        let steps = Self::chords(std::f64::consts::TAU, 1.0, 1.0);
        let point = |i: usize| {
            let (s, c) = (std::f64::consts::TAU * i as f64 / steps as f64).sin_cos();
            [c, s]
        };
        Self::new((0..steps).map(point).collect())
    }

    /// Its area.
    pub(super) fn area(&self) -> f64 {
        self.area
    }

    /// A point for two numbers in [0, 1), evenly over the area: one of them goes round, the other outwards.
    #[inline]
    pub(super) fn sample(&self, u: Vec2) -> Vec2 {
        let i = self.cumulative.partition_point(|&c| Real::from(c) <= u.x).clamp(1, self.points.len() - 1);
        let (lo, hi) = (Real::from(self.cumulative[i - 1]), Real::from(self.cumulative[i]));
        let t = if hi > lo { ((u.x - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 };
        let (a, b) = (self.points[i - 1].map(Real::from), self.points[i].map(Real::from));
        let r = u.y.sqrt();
        Vec2::new(r * (a[0] + t * (b[0] - a[0])), r * (a[1] + t * (b[1] - a[1])))
    }

    /// Draws how much of each cell it covers.
    pub(super) fn draw(&self, side: usize) -> Mask {
        let mut spans = vec![[f64::MAX, f64::MIN]; side * LINES];
        for pair in self.points.windows(2) {
            widen(&mut spans, pair[0].map(f64::from), pair[1].map(f64::from));
        }
        let mut cells = vec![0.0; side * side];
        // Lines are counted upwards, rows downwards.
        cells.par_chunks_mut(side).zip(spans.par_chunks(LINES).rev()).for_each(|(row, spans)| {
            let spans = spans.iter().filter(|[lo, hi]| lo < hi);
            cover(row, spans.map(|span| span.map(|x| 0.5 * (x + 1.0) * side as f64)));
        });
        Mask { side, cells }
    }

    /// Its corners.
    #[cfg(test)]
    pub(super) fn points(&self) -> &[[f32; 2]] {
        &self.points
    }
}

/// Widens the spans of the scan lines that an edge crosses.
fn widen(spans: &mut [[f64; 2]], a: [f64; 2], b: [f64; 2]) {
    let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
    let lines = spans.len() as f64;
    // Line k lies at the height 2 (k + 1/2) / lines - 1.
    let first = (0.5 * (low[1] + 1.0) * lines - 0.5).ceil().max(0.0) as usize;
    for (line, span) in spans.iter_mut().enumerate().skip(first) {
        let y = 2.0 * (line as f64 + 0.5) / lines - 1.0;
        if y > high[1] {
            break;
        }
        let t = if high[1] > low[1] { (y - low[1]) / (high[1] - low[1]) } else { 0.0 };
        let x = low[0] + t * (high[0] - low[0]);
        *span = [span[0].min(x), span[1].max(x)];
    }
}

/// Fills a row of zeros with how much of each cell the spans of its scan lines, in cells, cover.
fn cover(row: &mut [f32], spans: impl Iterator<Item = [f64; 2]> + Clone) {
    let add = |row: &mut [f32], cell: f64, share: f64| {
        if let Some(v) = row.get_mut(cell as usize) {
            *v += (share / LINES as f64) as f32;
        }
    };
    // Cells that a line covers whole, as changes from each cell to the next: multiples of 1 / LINES, which are exact.
    for [lo, hi] in spans.clone().filter(|[lo, hi]| lo.ceil() < hi.floor()) {
        add(row, lo.ceil(), 1.0);
        add(row, hi.floor(), -1.0);
    }
    let mut sum = 0.0;
    for v in &mut *row {
        sum += *v;
        *v = sum;
    }
    // The ends, which may lie in one cell.
    for [lo, hi] in spans {
        add(row, lo.floor(), lo.ceil().min(hi) - lo);
        if lo.ceil() <= hi.floor() {
            add(row, hi.floor(), hi - hi.floor());
        }
    }
}

/// Cuts a convex polygon off at the sides of the square, one after the other (Sutherland & Hodgman 1974).
fn cut_by_square(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        let inside = |p: &[f64; 2]| sign * p[axis] <= 1.0;
        if corners.iter().all(inside) {
            continue;
        }
        let mut kept = Vec::with_capacity(corners.len() + 2);
        for (i, b) in corners.iter().enumerate() {
            let a = corners[(i + corners.len() - 1) % corners.len()];
            if inside(&a) != inside(b) {
                let t = (sign - a[axis]) / (b[axis] - a[axis]);
                kept.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
            }
            if inside(b) {
                kept.push(*b);
            }
        }
        corners = kept;
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_circle_is_one_to_single_precision() {
        let circle = Outline::circle();
        assert!((circle.area() / std::f64::consts::PI - 1.0).abs() < 2e-7);
    }

    #[test]
    fn a_drawing_has_the_area_of_the_outline() {
        for outline in [Outline::circle(), Outline::new(vec![[0.7, -0.6], [0.1, 0.9], [-0.8, -0.5]])] {
            for side in [16, 256] {
                let mask = outline.draw(side);
                let sum: f64 = mask.cells.iter().map(|&c| f64::from(c)).sum();
                let area = sum * 4.0 / (side * side) as f64;
                // 16 lines a row: the ends of each are off by no more than its share of the outline's height.
                assert!((area / outline.area() - 1.0).abs() < 2e-3 / side as f64 * 16.0, "{side}: {area}");
                assert!(mask.cells.iter().all(|c| (0.0..=1.000_01).contains(c)));
            }
        }
    }

    #[test]
    fn a_drawing_has_its_top_row_first() {
        let triangle = Outline::new(vec![[0.9, -0.9], [0.0, 0.9], [-0.9, -0.9]]);
        let mask = triangle.draw(16);
        let row = |y: usize| mask.cells[y * 16..(y + 1) * 16].iter().sum::<f32>();
        assert!(row(2) < row(13), "{} {}", row(2), row(13));
    }
}
