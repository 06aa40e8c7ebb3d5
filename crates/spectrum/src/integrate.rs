//! Integration of functions that are smooth between known wavelengths.

/// Integrals of N functions over consecutive intervals, by the two-point Gauss rule in each: exact
/// for cubics (so for the product of two piecewise linear functions), and blind to what happens at
/// the ends, where a function may jump.
pub fn piecewise<const N: usize>(points: &[f64], f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    /// Half the distance of the Gauss points in an interval of length 1: 1 / (2 √3).
    const REACH: f64 = 0.288_675_134_594_812_9;
    let mut sums = [0.0; N];
    for interval in points.windows(2) {
        let (middle, width) = (f64::midpoint(interval[0], interval[1]), interval[1] - interval[0]);
        let (low, high) = (f(middle - REACH * width), f(middle + REACH * width));
        for i in 0..N {
            sums[i] += 0.5 * width * (low[i] + high[i]);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_and_jumps_are_exact() {
        let points = [0.0, 0.7, 2.0];
        let [cubic, jump] = piecewise(&points, |x| [x.powi(3) - x, if x < 0.7 { 5.0 } else { -1.0 }]);
        assert!((cubic - 2.0).abs() < 1e-14);
        assert!((jump - 2.2).abs() < 1e-14);
    }
}
