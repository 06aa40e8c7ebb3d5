//! Means of a bilinear map over triangles in it, exact however fine the map is.
//!
//! Between four texels a map is a patch that is integrated by Gauss's two points each way, which is exact for
//! polynomials of degree 3. A triangle takes the patches that it covers wholly from sums along their row, and
//! integrates those on its border over the part inside it. So the work grows with a triangle's width and height in
//! texels, not with its area.
//!
//! Where that is too much for all triangles of a mesh, because each spans much of a fine map or many repeats of it,
//! those that span most see the map in coarser cells of one value. What two neighbours share of a cell they share out
//! by area, so that nothing is lost or counted twice on a surface that they cover together.

use crate::map_row::{Point, Row, Triangle, area, extent};
use indigo_math::Vec2;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Rows and columns of texels that all triangles together may cross: some seconds of work. It is enough for 100,000
/// triangles that share a map of 4096 by 4096 texels.
const BUDGET: f64 = (1 << 22) as f64;

/// A row of patches in which a triangle lies, counted on over the map's repeats.
struct Crossing {
    y: u32,
    triangle: u32,
}

/// The mean over each triangle, of the map's coordinates, of a value at a place in texels; the map repeats after its
/// size. `None` where a triangle has no extent in the map.
pub(crate) fn means(
    size: [u32; 2],
    uvs: &[[Vec2<f64>; 3]],
    value: impl Fn(Point) -> f64,
) -> Vec<Option<f64>> {
    let (triangles, of_each) = distinct(uvs);
    let found = means_within(BUDGET, size, &triangles, value);
    of_each.into_iter().map(|i| i.map(|i| found[i])).collect()
}

/// The triangles that have an extent, counter-clockwise, those that whole repeats of the map lie between only once;
/// and which of them each is.
fn distinct(uvs: &[[Vec2<f64>; 3]]) -> (Vec<Triangle>, Vec<Option<usize>>) {
    let mut triangles = vec![];
    let mut known = HashMap::new();
    let mut number = |uv: &[Vec2<f64>; 3]| {
        let corners = counter_clockwise(uv.map(|v| [v.x, v.y]))?;
        let first = extent(&corners).map(|[low, _]| low.floor());
        // Adding 0 makes a negative zero positive.
        let moved = corners.map(|c| [c[0] - first[0] + 0.0, c[1] - first[1] + 0.0]);
        Some(match known.entry(moved.map(|c| c.map(f64::to_bits))) {
            Entry::Occupied(entry) => *entry.get(),
            Entry::Vacant(entry) => {
                triangles.push(moved);
                *entry.insert(triangles.len() - 1)
            }
        })
    };
    let of_each = uvs.iter().map(&mut number).collect();
    (triangles, of_each)
}

/// The triangle turned so that its area is positive; `None` where it has none.
fn counter_clockwise([a, b, c]: Triangle) -> Option<Triangle> {
    let corners = if area(&[a, b, c]) < 0.0 { [a, c, b] } else { [a, b, c] };
    let [across, up] = extent(&corners).map(|[low, high]| high - low);
    // Rounding leaves an area to a triangle whose corners lie in a line; far from the origin more of it.
    let far = corners.iter().flatten().fold(across.max(up), |far: f64, x| far.max(x.abs()));
    (area(&corners) > 1e3 * f64::EPSILON * far * (across + up)).then_some(corners)
}

/// The means over triangles; those that would cross too many rows and columns see the map in coarser cells.
fn means_within(
    budget: f64,
    size: [u32; 2],
    triangles: &[Triangle],
    value: impl Fn(Point) -> f64,
) -> Vec<f64> {
    let is_within = |size, list: &[Triangle]| list.iter().map(|t| crossed(size, t)).sum::<f64>() <= budget;
    if is_within(size, triangles) {
        return exact_means(size, triangles, value);
    }
    let share = budget / triangles.len() as f64;
    let (fine, wide): (Vec<Triangle>, Vec<Triangle>) =
        triangles.iter().partition(|t| crossed(size, t) <= share);
    let mut cells = size;
    while cells != [1, 1] && !is_within(cells, &wide) {
        cells = cells.map(|n| n.div_ceil(2));
    }
    let coarse = coarser(size, cells, &value);
    let mut of_fine = exact_means(size, &fine, value).into_iter();
    let in_cell = |[x, y]: Point| {
        let [x, y] = [(x as u32).min(cells[0] - 1), (y as u32).min(cells[1] - 1)];
        coarse[(x + y * cells[0]) as usize]
    };
    // Who spans so many repeats that even one cell for each is too much sees as much of all of the map.
    let of_wide =
        if cells == [1, 1] { vec![coarse[0]; wide.len()] } else { exact_means(cells, &wide, in_cell) };
    let mut of_wide = of_wide.into_iter();
    let of_each = |t| if crossed(size, t) <= share { of_fine.next() } else { of_wide.next() };
    triangles.iter().filter_map(of_each).collect()
}

/// How many rows and columns of a map of some size a triangle crosses.
fn crossed(size: [u32; 2], triangle: &Triangle) -> f64 {
    let [across, up] = extent(triangle).map(|[low, high]| high - low);
    across * f64::from(size[0]) + up * f64::from(size[1])
}

/// The means of a map's cells, fewer than its patches, of which each counts where it lies.
fn coarser(size: [u32; 2], cells: [u32; 2], value: &impl Fn(Point) -> f64) -> Vec<f64> {
    let [across, up] = [0, 1].map(|axis| f64::from(cells[axis]) / f64::from(size[axis]));
    let mut means = vec![0.0; cells[0] as usize * cells[1] as usize];
    for y in 0..size[1] {
        let row = Row::new(size[0], f64::from(y), value);
        let columns: Vec<f64> = (0..=cells[0]).map(|x| row.up_to(f64::from(x) / across)).collect();
        let [low, high] = [y, y + 1].map(|y| f64::from(y) * up);
        for k in low as u32..(high.ceil() as u32).min(cells[1]) {
            let part = high.min(f64::from(k + 1)) - low.max(f64::from(k));
            let cells = means[(k * cells[0]) as usize..].iter_mut();
            for (mean, ends) in cells.zip(columns.windows(2)) {
                *mean += part * across * (ends[1] - ends[0]);
            }
        }
    }
    means
}

/// The means over triangles, that begin in the first repeat, by all the map's patches.
fn exact_means(size: [u32; 2], triangles: &[Triangle], value: impl Fn(Point) -> f64) -> Vec<f64> {
    let in_texels = |t: &Triangle| t.map(|c| [c[0] * f64::from(size[0]), c[1] * f64::from(size[1])]);
    let triangles: Vec<Triangle> = triangles.iter().map(in_texels).collect();
    let rows = |(triangle, corners): (u32, &Triangle)| {
        let [_, [low, high]] = extent(corners);
        (low as u32..high.ceil() as u32).map(move |y| Crossing { y, triangle })
    };
    let mut crossings: Vec<Crossing> = (0..).zip(&triangles).flat_map(rows).collect();
    let row_of = |c: &Crossing| c.y % size[1];
    crossings.sort_unstable_by_key(|c| (row_of(c), c.triangle));
    let mut sums = vec![0.0; triangles.len()];
    for group in crossings.chunk_by(|a, b| row_of(a) == row_of(b)) {
        let row = Row::new(size[0], f64::from(row_of(&group[0])), &value);
        for crossing in group {
            let i = crossing.triangle as usize;
            sums[i] += row.integral(&triangles[i], f64::from(crossing.y));
        }
    }
    triangles.iter().zip(sums).map(|(t, sum)| sum / area(t)).collect()
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

    /// A square of `n` by `n` repeats, cut into as many squares of two triangles each way as is asked for.
    fn quilt(squares: u32, n: f64) -> Vec<[Vec2<f64>; 3]> {
        let at = |k: u32| n * f64::from(k) / f64::from(squares);
        let square = |i: u32| {
            let [u0, u1] = [i % squares, i % squares + 1].map(at);
            let [v0, v1] = [i / squares, i / squares + 1].map(at);
            [uv([[u0, v0], [u1, v0], [u1, v1]]), uv([[u0, v0], [u1, v1], [u0, v1]])]
        };
        (0..squares * squares).flat_map(square).collect()
    }

    /// However little may be done, all of a surface together keeps its mean to rounding, and parts of it that span some
    /// repeats stay within some hundredths of theirs.
    #[test]
    fn coarser_means_lose_nothing() {
        let triangles: Vec<Triangle> = quilt(8, 21.0).iter().map(|t| t.map(|v| [v.x, v.y])).collect();
        let exact = exact_means(SIZE, &triangles, value);
        let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
        let whole = mean(&exact);
        for budget in [4e3, 1.5e3, 1.0] {
            let found = means_within(budget, SIZE, &triangles, value);
            assert!((mean(&found) / whole - 1.0).abs() < 1e-12, "{budget}: {} {whole}", mean(&found));
            let off = exact.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off > 0.0 && off < 0.06 * whole, "{budget}: {}", off / whole);
        }
    }

    /// The value is asked for a bounded number of times, of any number of triangles and repeats; the same part of the
    /// map is worked on once.
    #[test]
    fn work_is_bounded() {
        let asked = |uvs: &[[Vec2<f64>; 3]]| {
            let count = std::cell::Cell::new(0u64);
            let found = means(SIZE, uvs, |p| {
                count.set(count.get() + 1);
                value(p)
            });
            assert!(found.iter().all(Option::is_some));
            count.get()
        };
        let one = quilt(1, 1.0);
        let copies: Vec<_> = (0..1000)
            .flat_map(|k| one.iter().map(move |t| t.map(|p| p + Vec2::new(f64::from(k), -5.0))))
            .collect();
        assert_eq!(asked(&copies), asked(&one));
        // All the map's patches twice by four values, and some for each of a budget's rows and columns.
        for (squares, repeats) in [(1, 1e9), (30, 3e6)] {
            assert!(asked(&quilt(squares, repeats)) < 2 * 4 * 35 + 5 * BUDGET as u64);
        }
    }

    #[test]
    fn what_has_no_extent_has_no_mean() {
        let flat = [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]];
        let point = [[0.5, 0.5]; 3];
        let none = [[f64::NAN, 0.0], [1.0, 0.0], [0.0, f64::INFINITY]];
        let endless = [[0.0, 0.0], [1e200, 0.0], [0.0, 1e200]];
        let huge = [[0.0, 0.0], [1e9, 0.0], [0.0, 1e9]];
        let small = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]];
        let found = means(SIZE, &[small, huge, flat, point, none, endless].map(uv), value);
        assert!(
            found[..2].iter().all(Option::is_some) && found[2..].iter().all(Option::is_none),
            "{found:?}"
        );
    }
}
