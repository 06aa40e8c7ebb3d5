//! The tone mapping of a camera: exposure, speed of the film, and the measured response of film or sensor.
//!
//! A channel's relative irradiance is H · film_iso / 78 · 2^ev_adjust, with H the white-balanced exposure in
//! lux·s: by its saturation-based speed S (ISO 12232:2006, 6.2) a sensor saturates at 78 / S lux·s. The response
//! curve tells the brightness for it, and the end of the curve is as bright as it gets.
//!
//! Response curves are measured on finished pictures, so they hold the display's transfer function. It is
//! taken out here, since the picture is downsized in display-linear light, and comes back when the picture is
//! encoded: a brightness B ends as the code 255 · B.

use crate::PictureSettings;
use crate::srgb;
use crate::white_balance::Matrix;
use std::sync::Arc;

/// Film speed times exposure of a saturated sensor (ISO 12232:2006, 6.2), lux·s.
const SATURATION: f64 = 78.0;
/// Cells of the table that undoes the display's transfer function: with straight lines between them the error is
/// at most h²/8 · max|f''| = 2e-8, half a rounding of `f32`.
const DECODE_CELLS: usize = 4096;

/// Cells of a curve's guide for each of its points: where points lie evenly, three of four hold none, and nothing is searched.
const GUIDE_CELLS: usize = 4;

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    irradiance: f32,
    brightness: f32,
    /// How the brightness changes from here to the next point; 0 where that is at the same place, and at the end.
    slope: f32,
}

/// The response of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    points: Vec<Point>,
    /// Cells per unit of irradiance.
    cells: f32,
    /// For each of the even cells over [first, last] irradiance, the last point in a cell before it.
    guide: Vec<u32>,
}

/// The response of red, green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    curves: [Curve; 3],
    decode: Vec<f32>,
    name: String,
}

impl Response {
    /// From the points of three curves: irradiances that never decrease, and as many brightnesses, all finite and
    /// at least two. `None` where they are not.
    pub fn new(points: [(&[f32], &[f32]); 3]) -> Option<Self> {
        let [r, g, b] = points.map(|(irradiance, brightness)| Curve::new(irradiance, brightness));
        Some(Self::of([r?, g?, b?]))
    }

    fn of(curves: [Curve; 3]) -> Self {
        let decode = (0..=DECODE_CELLS).map(|i| srgb::decode(i as f64 / DECODE_CELLS as f64) as f32);
        Self { curves, decode: decode.collect(), name: String::new() }
    }

    /// The same with the name of its file, which pictures tell.
    #[must_use]
    pub fn named(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }

    /// The name of its file; empty where there is none.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The brightness in [0, 1] that a channel (red, green, blue) gives for a relative irradiance, as its file has it:
    /// with the display's transfer function.
    pub fn brightness(&self, channel: usize, irradiance: f32) -> f32 {
        self.curves[channel.min(2)].eval(irradiance)
    }

    /// The response of a display: what the sensor gathers is shown as it is, up to saturation.
    pub fn display() -> Self {
        const POINTS: u16 = 1024;
        let irradiance: Vec<f32> = (0..POINTS).map(|i| f32::from(i) / f32::from(POINTS - 1)).collect();
        let brightness: Vec<f32> = irradiance.iter().map(|&v| srgb::encode(f64::from(v)) as f32).collect();
        let curve = Curve::new(&irradiance, &brightness);
        let curve = curve.unwrap_or_else(|| unreachable!("the points above are in order"));
        Self::of([curve.clone(), curve.clone(), curve])
    }

    /// Display-linear light of a brightness in [0, 1].
    #[inline]
    fn decoded(&self, brightness: f32) -> f32 {
        let at = brightness.clamp(0.0, 1.0) * DECODE_CELLS as f32;
        let cell = (at as usize).min(DECODE_CELLS - 1);
        let (a, b) = (self.decode[cell], self.decode[cell + 1]);
        a + (b - a) * (at - cell as f32)
    }
}

impl Curve {
    fn new(irradiance: &[f32], brightness: &[f32]) -> Option<Self> {
        let n = irradiance.len();
        let [first, .., last] = irradiance else { return None };
        let is_sound = n == brightness.len()
            && irradiance.iter().chain(brightness).all(|v| v.is_finite())
            && irradiance.is_sorted()
            && first < last;
        if !is_sound {
            return None;
        }
        let point = |i: usize| {
            let (x, y) = (irradiance[i], brightness[i]);
            let slope = irradiance.get(i + 1).map_or(0.0, |next| (brightness[i + 1] - y) / (next - x));
            // A step, at one place or as good as one.
            Point { irradiance: x, brightness: y, slope: if slope.is_finite() { slope } else { 0.0 } }
        };
        let cells = (GUIDE_CELLS * n) as f32 / (last - first);
        let mut guide = vec![];
        for cell in 0..=GUIDE_CELLS * n {
            let before = irradiance.partition_point(|x| cell_of(*x, *first, cells) < cell);
            guide.push(before.saturating_sub(1) as u32);
        }
        Some(Self { points: (0..n).map(point).collect(), cells, guide })
    }

    /// The brightness of an irradiance: straight lines between the points, constant beyond the ends.
    #[inline]
    fn eval(&self, irradiance: f32) -> f32 {
        let [first, .., last] = &self.points[..] else { return 0.0 };
        if irradiance >= last.irradiance {
            return last.brightness;
        }
        // What is no number is dark.
        if irradiance <= first.irradiance || irradiance.is_nan() {
            return first.brightness;
        }
        // Cells rise with irradiance, so that a point in one before lies before this value, rounding or not.
        let cell = cell_of(irradiance, first.irradiance, self.cells);
        let mut i = self.guide[cell.min(self.guide.len() - 1)] as usize;
        while self.points[i + 1].irradiance <= irradiance {
            i += 1;
        }
        let point = &self.points[i];
        point.brightness + point.slope * (irradiance - point.irradiance)
    }
}

/// The guide's cell of an irradiance.
#[inline(always)]
fn cell_of(irradiance: f32, first: f32, cells: f32) -> usize {
    ((irradiance - first) * cells) as usize
}

/// The operator for one picture.
pub(crate) struct Camera {
    matrix: Matrix,
    /// By itself: a factor beyond all numbers would leave nothing of the differences that the matrix takes.
    factor: f32,
    response: Arc<Response>,
}

impl Camera {
    pub(super) fn new(
        response: &Arc<Response>,
        ev_adjust: f64,
        film_iso: f64,
        settings: &PictureSettings,
    ) -> Self {
        let factor = settings.exposure.lux_seconds_per_nit() * film_iso / SATURATION * ev_adjust.exp2();
        Self {
            matrix: settings.white_balance.to_rgb(),
            factor: factor as f32,
            response: Arc::clone(response),
        }
    }

    pub(super) fn map_row(&self, from: &[[f32; 4]], to: &mut [[f32; 4]]) {
        let response = &*self.response;
        for (xyz, out) in from.iter().zip(to) {
            let rgb = self.matrix.apply(xyz).map(|v| v * self.factor);
            let [r, g, b] = std::array::from_fn(|c| response.decoded(response.curves[c].eval(rgb[c])));
            *out = [r, g, b, xyz[3]];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_straight_between_their_points() {
        // Points very close together, a step, and a wide gap.
        let x = [0.0, 1e-6, 2e-6, 0.1, 0.1, 0.9, 1.0];
        let y = [0.0, 0.1, 0.3, 0.4, 0.6, 0.7, 1.0];
        let curve = Curve::new(&x, &y).unwrap();
        for i in 0..x.len() - 1 {
            if x[i] == x[i + 1] {
                continue;
            }
            for t in [0.0, 0.25, 0.5, 0.75] {
                let at = x[i] + t * (x[i + 1] - x[i]);
                let want = y[i] + t * (y[i + 1] - y[i]);
                assert!((curve.eval(at) - want).abs() < 1e-5, "{at}: {} instead of {want}", curve.eval(at));
            }
        }
        let ends = [f32::NAN, -1.0, f32::NEG_INFINITY, 1.0, 7.0, f32::INFINITY].map(|v| curve.eval(v));
        assert_eq!(ends, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
        for i in 0..=100_000 {
            let at = i as f32 / 1e5;
            let value = curve.eval(at);
            assert!((0.0..=1.0).contains(&value), "{at}: {value}");
        }
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        for (x, y) in [
            (&[0.0][..], &[0.0][..]),
            (&[0.0, 1.0], &[0.0]),
            (&[0.5, 0.5], &[0.0, 1.0]),
            (&[1.0, 0.0], &[0.0, 1.0]),
            (&[0.0, f32::NAN], &[0.0, 1.0]),
        ] {
            assert_eq!(Curve::new(x, y), None);
        }
    }

    #[test]
    fn the_display_shows_what_the_sensor_gathers() {
        let display = Response::display();
        for i in 0..=1000 {
            let light = i as f32 / 1000.0;
            let shown = display.decoded(display.curves[0].eval(light));
            // 1024 points leave straight lines that much off where the transfer function bends most.
            assert!((shown - light).abs() < 2e-4, "{light}: {shown}");
        }
    }
}
