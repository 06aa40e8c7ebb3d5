//! One row of a bilinear map: integrals over what parts of triangles lie in it.

/// Gauss's points are this far on both sides of an interval's middle: half of 1/√3.
const GAUSS: f64 = 0.288_675_134_594_812_9;

/// A corner, in repeats of the map or in its texels.
pub(crate) type Point = [f64; 2];
pub(crate) type Triangle = [Point; 3];

/// A row of patches.
pub(crate) struct Row<'a, F> {
    width: f64,
    /// Where its lower texels lie in the map.
    low: f64,
    /// Integrals of the patches before each.
    before: Vec<f64>,
    value: &'a F,
}

impl<'a, F: Fn(Point) -> f64> Row<'a, F> {
    pub fn new(width: u32, low: f64, value: &'a F) -> Self {
        let mut before = Vec::with_capacity(width as usize + 1);
        let mut sum = 0.0;
        before.push(sum);
        for x in 0..width {
            let at = |dx: f64, dy: f64| value([f64::from(x) + 0.5 + dx, low + 0.5 + dy]);
            sum += 0.25 * (at(-GAUSS, -GAUSS) + at(GAUSS, -GAUSS) + at(-GAUSS, GAUSS) + at(GAUSS, GAUSS));
            before.push(sum);
        }
        Self { width: f64::from(width), low, before, value }
    }

    /// Integral over the part of a triangle between two rows of texels, of which `y` is the lower.
    pub fn integral(&self, corners: &Triangle, y: f64) -> f64 {
        let strip = clip(&clip(corners, 1, y, 1.0), 1, y + 1.0, -1.0);
        if strip.len() < 3 {
            return 0.0;
        }
        let [across, _] = extent(&strip);
        let (first, end) = (across[0].floor(), across[1].ceil());
        // Whole patches have all four corners inside: they lie between what both rows of texels are inside.
        let whole = match (along(corners, y), along(corners, y + 1.0)) {
            (Some([a, b]), Some([c, d])) => [a.max(c).ceil(), b.min(d).floor()],
            _ => [end, end],
        };
        let [from, to] = if whole[1] > whole[0] { whole } else { [end, end] };
        let mut sum = if to > from { self.up_to(to) - self.up_to(from) } else { 0.0 };
        let mut x = first;
        while x < end {
            if x == from && to > from {
                x = to;
                continue;
            }
            let part = clip(&clip(&strip, 0, x, 1.0), 0, x + 1.0, -1.0);
            sum += self.over(&part, [x, y]);
            x += 1.0;
        }
        sum
    }

    /// Integral of the patches before a column, counted on over the map's repeats, and of the part of a patch.
    pub fn up_to(&self, column: f64) -> f64 {
        let last = self.before.len() - 1;
        let repeats = (column / self.width).floor();
        let rest = column - repeats * self.width;
        let i = (rest as usize).min(last - 1);
        let part = (rest - i as f64).min(1.0);
        repeats * self.before[last] + self.before[i] + part * (self.before[i + 1] - self.before[i])
    }

    /// Integral over a convex part of the patch at a corner: a fan of triangles, by the three points that are exact
    /// for polynomials of degree 2 (Strang & Fix 1973, table 4.1).
    fn over(&self, part: &[Point], [x, y]: Point) -> f64 {
        let in_map = (x - (x / self.width).floor() * self.width, self.low);
        let mut sum = 0.0;
        for i in 2..part.len() {
            let fan = [part[0], part[i - 1], part[i]];
            let at = |k: usize| {
                let mean =
                    |axis: usize| (fan[0][axis] + fan[1][axis] + fan[2][axis]) / 6.0 + 0.5 * fan[k][axis];
                (self.value)([mean(0) - x + in_map.0, mean(1) - y + in_map.1])
            };
            sum += area(&fan) * (at(0) + at(1) + at(2)) / 3.0;
        }
        sum
    }
}

/// Signed area.
pub(crate) fn area([a, b, c]: &Triangle) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// Least and greatest of both coordinates.
pub(crate) fn extent(points: &[Point]) -> [[f64; 2]; 2] {
    [0, 1].map(|axis| {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        points.iter().fold(none, |[low, high], p| [low.min(p[axis]), high.max(p[axis])])
    })
}

/// From where to where a triangle covers a level line.
fn along(corners: &Triangle, y: f64) -> Option<[f64; 2]> {
    let mut found: Option<[f64; 2]> = None;
    for i in 0..3 {
        let (p, q) = (corners[i], corners[(i + 1) % 3]);
        if (p[1] <= y) != (q[1] <= y) {
            let x = p[0] + (q[0] - p[0]) * ((y - p[1]) / (q[1] - p[1]));
            found = Some(found.map_or([x, x], |[low, high]| [low.min(x), high.max(x)]));
        }
    }
    found
}

/// The part of a convex polygon where `side` times a coordinate's excess over `at` is not negative (Sutherland &
/// Hodgman 1974).
fn clip(points: &[Point], axis: usize, at: f64, side: f64) -> Vec<Point> {
    let mut kept = Vec::with_capacity(points.len() + 1);
    for (i, &p) in points.iter().enumerate() {
        let q = points[(i + 1) % points.len()];
        let (dp, dq) = (side * (p[axis] - at), side * (q[axis] - at));
        if dp >= 0.0 {
            kept.push(p);
        }
        if (dp < 0.0) != (dq < 0.0) {
            let t = dp / (dp - dq);
            let mut cut = [p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t];
            cut[axis] = at;
            kept.push(cut);
        }
    }
    kept
}
