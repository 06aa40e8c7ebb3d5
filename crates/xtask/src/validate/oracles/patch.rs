//! What is seen of a floor: a patch, over which light differs.

use super::super::shapes::{Point, add, cross, sub, unit};

/// Half the width that a look at a floor has, at the distance 1.
pub const TANGENT: f64 = 2e-3;

/// Where a point of a floor is looked at from.
pub fn seen_from(target: Point) -> Point {
    add(target, [3.0, 1.0, 1.2])
}

/// The mean over the pixels of a look at a point of the floor z = 0.
pub fn patch_mean(target: Point, of: impl Fn(Point) -> f64) -> f64 {
    /// Places along a side: what bends by 10⁻³ over the patch is then known to 10⁻⁵ of that.
    const PLACES: i32 = 16;
    let eye = seen_from(target);
    let forwards = unit(sub(target, eye));
    let right = unit(cross(forwards, [0.0, 0.0, 1.0]));
    let up = cross(right, forwards);
    let place = |i: i32| TANGENT * (2.0 * (f64::from(i) + 0.5) / f64::from(PLACES) - 1.0);
    let seen = |i: i32, j: i32| {
        let d = [0, 1, 2].map(|k| forwards[k] + place(i) * right[k] + place(j) * up[k]);
        let way = -eye[2] / d[2];
        of([0, 1, 2].map(|k| eye[k] + way * d[k]))
    };
    let sum: f64 = (0..PLACES).flat_map(|i| (0..PLACES).map(move |j| (i, j))).map(|(i, j)| seen(i, j)).sum();
    sum / f64::from(PLACES * PLACES)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of what is even, the same; of what rises, the middle; of a square, more than there by what it bends.
    #[test]
    fn patches_have_their_mean() {
        let target = [1.0, 2.0, 0.0];
        assert!((patch_mean(target, |_| 7.0) - 7.0).abs() < 1e-12);
        let bent = patch_mean(target, |p| (p[0] - 1.0).powi(2) + (p[1] - 2.0).powi(2));
        // Half widths of the patch: across the look, and along it, which the floor stretches.
        let distance = 11.44_f64.sqrt();
        let across = TANGENT * distance;
        let along = across * distance / 1.2;
        assert!((bent / ((across * across + along * along) / 3.0) - 1.0).abs() < 1e-2, "{bent}");
    }
}
