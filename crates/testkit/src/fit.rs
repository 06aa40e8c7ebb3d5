//! Where a measured curve is least.

/// The lowest point of the parabola that fits points (x, y) best, by least squares, among those no farther than `reach` from
/// `near`. `None` where it opens downwards, or there are too few points.
pub fn lowest_point(points: impl Iterator<Item = (f64, f64)>, near: f64, reach: f64) -> Option<f64> {
    // Moments of t = (x - near) / reach up to the fourth, and of y with t up to the second.
    let (mut n, mut t, mut y) = (0.0, [0.0; 4], [0.0; 3]);
    for (x, value) in points.filter(|(x, _)| (x - near).abs() <= reach) {
        let s = (x - near) / reach;
        n += 1.0;
        t.iter_mut().zip([s, s * s, s.powi(3), s.powi(4)]).for_each(|(sum, v)| *sum += v);
        y.iter_mut().zip([value, s * value, s * s * value]).for_each(|(sum, v)| *sum += v);
    }
    let ([t1, t2, t3, t4], [y0, y1, y2]) = (t.map(|v| v / n), y.map(|v| v / n));
    // Of y = a + b t + c t² with the means taken out.
    let (v11, v12, v22) = (t2 - t1 * t1, t3 - t1 * t2, t4 - t2 * t2);
    let (c1, c2) = (y1 - t1 * y0, y2 - t2 * y0);
    let determinant = v11 * v22 - v12 * v12;
    let (b, c) = ((c1 * v22 - c2 * v12) / determinant, (c2 * v11 - c1 * v12) / determinant);
    (c > 0.0).then_some(near - reach * 0.5 * b / c)
}

#[cfg(test)]
mod tests {
    use super::lowest_point;

    #[test]
    fn a_parabola_is_found_exactly() {
        let points =
            |c: f64| (0..50).map(move |i| f64::from(i) * 0.1).map(move |x| (x, 7.0 + c * (x - 2.3).powi(2)));
        let found = lowest_point(points(3.0), 2.0, 1.0).expect("it opens upwards");
        assert!((found - 2.3).abs() < 1e-9, "{found}");
        assert_eq!(lowest_point(points(-3.0), 2.0, 1.0), None);
        assert_eq!(lowest_point(points(3.0), 20.0, 1.0), None);
    }
}
