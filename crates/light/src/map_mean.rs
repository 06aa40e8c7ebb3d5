//! Means of a bilinear map over triangles in it, exact however fine the map is.
//!
//! Between four texels a map is a patch that is integrated by Gauss's two points each way, which is exact for
//! polynomials of degree 3. A triangle takes the patches that it covers wholly from sums along their row, and
//! integrates those on its border over the part inside it. So the work grows with a triangle's width and height in
//! texels, not with its area.

use indigo_math::Vec2;

/// Rows and columns of texels that all triangles together may cross: a second of work. A mesh of so many repeats of
/// its map gets the estimate that its caller has.
const BUDGET: f64 = (1 << 24) as f64;
/// Gauss's points are this far on both sides of an interval's middle: half of 1/√3.
const GAUSS: f64 = 0.288_675_134_594_812_9;

/// A corner, in texels.
type Point = [f64; 2];

/// A row of patches in which a triangle lies.
struct Crossing {
    /// The row in the map.
    row: u32,
    /// The row counted on over the map's repeats.
    y: f64,
    triangle: u32,
}

/// The mean over each triangle, of the map's coordinates, of a value at a place in texels; the map repeats after its
/// size. `None` where a triangle has no extent in the map, or is beyond what can be done.
pub(crate) fn means(
    size: [u32; 2],
    uvs: &[[Vec2<f64>; 3]],
    value: impl Fn(Point) -> f64,
) -> Vec<Option<f64>> {
    let triangles: Vec<Option<[Point; 3]>> = in_texels(size, uvs);
    let mut crossings = vec![];
    for (i, corners) in triangles.iter().enumerate() {
        let Some([_, [low, high]]) = corners.map(|c| extent(&c)) else { continue };
        let rows = (low.floor() as i64..high.ceil() as i64).map(|y| Crossing {
            row: y.rem_euclid(i64::from(size[1])) as u32,
            y: y as f64,
            triangle: i as u32,
        });
        crossings.extend(rows);
    }
    crossings.sort_by_key(|c| c.row);
    let mut sums = vec![0.0; uvs.len()];
    for group in crossings.chunk_by(|a, b| a.row == b.row) {
        let row = Row::new(size[0], f64::from(group[0].row), &value);
        for crossing in group {
            let corners = triangles[crossing.triangle as usize].as_ref().expect("only those cross");
            sums[crossing.triangle as usize] += row.integral(corners, crossing.y);
        }
    }
    let mean = |(corners, sum): (&Option<[Point; 3]>, f64)| corners.map(|c| sum / area(&c));
    triangles.iter().zip(sums).map(mean).collect()
}

/// The triangles that can be done, counter-clockwise.
fn in_texels([width, height]: [u32; 2], uvs: &[[Vec2<f64>; 3]]) -> Vec<Option<[Point; 3]>> {
    let mut left = BUDGET;
    let place = |uv: &[Vec2<f64>; 3]| {
        let [a, b, c] = uv.map(|v| [v.x * f64::from(width), v.y * f64::from(height)]);
        let corners = if area(&[a, b, c]) < 0.0 { [a, c, b] } else { [a, b, c] };
        let [across, up] = extent(&corners).map(|[low, high]| high - low);
        // Rounding leaves an area to a triangle whose corners lie in a line; far from the origin more of it.
        let far = corners.iter().flatten().fold(1.0, |far: f64, x| far.max(x.abs()));
        let is_flat = area(&corners) <= 1e3 * f64::EPSILON * far * (across + up);
        left -= across + up + 2.0;
        (!is_flat && left >= 0.0).then_some(corners)
    };
    uvs.iter().map(place).collect()
}

/// A row of patches.
struct Row<'a, F> {
    width: f64,
    /// Where its lower texels lie in the map.
    low: f64,
    /// Integrals of the patches before each.
    before: Vec<f64>,
    value: &'a F,
}

impl<'a, F: Fn(Point) -> f64> Row<'a, F> {
    fn new(width: u32, low: f64, value: &'a F) -> Self {
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
    fn integral(&self, corners: &[Point; 3], y: f64) -> f64 {
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

    /// Integral of the patches before a column, counted on over the map's repeats.
    fn up_to(&self, column: f64) -> f64 {
        let repeats = (column / self.width).floor();
        let rest = (column - repeats * self.width) as usize;
        let whole = self.before[self.before.len() - 1];
        repeats * whole + self.before[rest.min(self.before.len() - 1)]
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
fn area([a, b, c]: &[Point; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// Least and greatest of both coordinates.
fn extent(points: &[Point]) -> [[f64; 2]; 2] {
    [0, 1].map(|axis| {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        points.iter().fold(none, |[low, high], p| [low.min(p[axis]), high.max(p[axis])])
    })
}

/// From where to where a triangle covers a level line.
fn along(corners: &[Point; 3], y: f64) -> Option<[f64; 2]> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A map of 7 by 5 texels, and its value at a place in texels.
    const SIZE: [u32; 2] = [7, 5];

    fn value([x, y]: Point) -> f64 {
        let texel = |x: f64, y: f64| {
            let i = x.rem_euclid(7.0) + 7.0 * y.rem_euclid(5.0);
            (i * 37.0) % 11.0
        };
        let (x0, y0) = (x.floor(), y.floor());
        let (s, t) = (x - x0, y - y0);
        let row = |y: f64| texel(x0, y) * (1.0 - s) + texel(x0 + 1.0, y) * s;
        row(y0) * (1.0 - t) + row(y0 + 1.0) * t
    }

    fn uv(corners: [Point; 3]) -> [Vec2<f64>; 3] {
        corners.map(|[u, v]| Vec2::new(u, v))
    }

    /// Triangles that cut the map in every way, against the means of many even points.
    #[test]
    fn means_are_those_of_many_points() {
        let triangles = [
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
            [[0.1, 0.2], [0.15, 0.9], [0.12, 0.3]],
            [[-1.3, 0.4], [2.7, -2.2], [0.2, 3.9]],
            [[0.41, 0.42], [0.43, 0.42], [0.42, 0.44]],
            [[5.0, 5.1], [9.0, 5.11], [7.0, 5.12]],
        ];
        let found = means(SIZE, &triangles.map(uv), value);
        for (corners, found) in triangles.iter().zip(found) {
            const N: u32 = 3000;
            let [a, b, c] = corners.map(|[u, v]| [u * 7.0, v * 5.0]);
            let (mut sum, mut count) = (0.0, 0.0);
            for i in 0..N {
                for j in 0..N - i {
                    let (s, t) = (
                        (f64::from(i) + 1.0 / 3.0) / f64::from(N),
                        (f64::from(j) + 1.0 / 3.0) / f64::from(N),
                    );
                    sum += value([0, 1].map(|k| a[k] + (b[k] - a[k]) * s + (c[k] - a[k]) * t));
                    count += 1.0;
                }
            }
            let (found, expected) = (found.expect("a mean"), sum / count);
            // What the points leave out along the diagonal is a part of 1/N of the area.
            assert!((found / expected - 1.0).abs() < 1e-3, "{corners:?}: {found} {expected}");
        }
    }

    /// Two halves of the map, and of many repeats of it, have its texels' mean to rounding.
    #[test]
    fn a_whole_map_has_the_mean_of_its_texels() {
        let texels = (0..35).map(|i| f64::from(i * 37 % 11)).sum::<f64>() / 35.0;
        for n in [1.0, 40.0] {
            let halves = [[[0.0, 0.0], [n, 0.0], [n, n]], [[0.0, 0.0], [0.0, n], [n, n]]];
            let found = means(SIZE, &halves.map(uv), value);
            let mean: f64 = found.iter().map(|m| 0.5 * m.expect("a mean")).sum();
            assert!((mean / texels - 1.0).abs() < 1e-12, "{mean} {texels}");
        }
    }

    #[test]
    fn what_has_no_extent_or_too_much_has_no_mean() {
        let flat = [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]];
        let point = [[0.5, 0.5]; 3];
        let huge = [[0.0, 0.0], [1e9, 0.0], [0.0, 1e9]];
        let none = [[f64::NAN, 0.0], [1.0, 0.0], [0.0, f64::INFINITY]];
        let small = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]];
        let found = means(SIZE, &[small, flat, point, none, huge].map(uv), value);
        assert!(found[0].is_some() && found[1..].iter().all(Option::is_none), "{found:?}");
    }
}
