//! Image maps: texels in the width they came in, read bilinearly with wrap-around.

use crate::curve::Curve;
use crate::mapping::Mapping;
use indigo_formats::image::{Image, Pixels};
use indigo_math::{Real, Vec2};
use std::sync::Arc;

/// A texture: an image and the curve that makes its texels linear.
///
/// The curve is applied to texels, before they are mixed: mixing is right in linear light only.
/// Integer texels keep their width and go through a table of the curve; floating-point texels are converted
/// once, unless the curve changes nothing. What textures of one file have in common they share.
#[derive(Clone, Debug)]
pub struct Texture {
    width: u32,
    height: u32,
    channels: usize,
    image: Arc<Image>,
    /// The curve's values for all integer texels; empty for floating-point ones.
    table: Arc<[f32]>,
    /// Which uv set of the mesh it is laid on by.
    pub uv_set: u32,
    mapping: Mapping,
}

impl Texture {
    /// From a decoded image.
    pub fn new(image: Arc<Image>, curve: Curve, uv_set: u32) -> Self {
        let table = |levels: u32| -> Arc<[f32]> {
            (0..levels).map(|i| curve.apply(f64::from(i) / f64::from(levels - 1)) as f32).collect()
        };
        let (image, table) = match &image.pixels {
            Pixels::U8(_) => (image, table(256)),
            Pixels::U16(_) => (image, table(65536)),
            Pixels::F32(_) if curve == Curve::IDENTITY => (image, Arc::default()),
            Pixels::F32(v) => {
                let converted = v.iter().map(|&x| curve.apply(f64::from(x)) as f32).collect();
                (Arc::new(Image { pixels: Pixels::F32(converted), notes: vec![], ..*image }), Arc::default())
            }
        };
        Self {
            width: image.width,
            height: image.height,
            channels: usize::from(image.channels),
            image,
            table,
            uv_set,
            mapping: Mapping::IDENTITY,
        }
    }

    /// The same laid on by transformed coordinates.
    #[must_use]
    pub fn with_mapping(self, mapping: Mapping) -> Self {
        Self { mapping, ..self }
    }

    /// How coordinates of the mesh become those of the map.
    pub fn mapping(&self) -> Mapping {
        self.mapping
    }

    /// Width and height in texels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Bytes of the texels and of the curve.
    pub fn memory_bytes(&self) -> usize {
        let texels = match &self.image.pixels {
            Pixels::U8(v) => v.len(),
            Pixels::U16(v) => 2 * v.len(),
            Pixels::F32(v) => 4 * v.len(),
        };
        texels + 4 * self.table.len()
    }

    /// Which share of the texels has a scalar of no more than `limit`. Goes through all of them.
    pub fn share_not_above(&self, limit: Real) -> f64 {
        self.share_of(|texel| texel.iter().sum::<Real>() <= 3.0 * limit)
    }

    /// Which share of the texels has a component below `low` or above `high`. Goes through all of them, unless integers
    /// cannot be there.
    pub fn share_beyond(&self, low: Real, high: Real) -> f64 {
        let is_within = |v: &f32| (low..=high).contains(&(*v as Real));
        if !self.table.is_empty() && self.table.iter().all(is_within) {
            return 0.0;
        }
        self.share_of(|texel| !texel.iter().all(|v| (low..=high).contains(v)))
    }

    /// Which share of the texels has a scalar below `low` or above `high`. Goes through all of them.
    pub fn share_of_scalars_beyond(&self, low: Real, high: Real) -> f64 {
        self.share_of(|texel| !(3.0 * low..=3.0 * high).contains(&texel.iter().sum::<Real>()))
    }

    fn share_of(&self, is_meant: impl Fn([Real; 3]) -> bool) -> f64 {
        let rows = 0..self.height;
        let texels = rows.flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let meant = texels.filter(|&(x, y)| is_meant(self.texel(x, y))).count();
        meant as f64 / (f64::from(self.width) * f64::from(self.height))
    }

    /// Linear RGB at texture coordinates of the mesh.
    ///
    /// Transformed, (0, 0) is the lower left corner of the image, and coordinates wrap round. Texels stand at
    /// the corners of a grid of `width` by `height` cells, and between them values are bilinear.
    #[inline]
    pub fn rgb(&self, uv: Vec2) -> [Real; 3] {
        let uv = self.mapping.of(uv);
        let (x0, x1, fx) = cell(uv.x, self.width);
        let (y0, y1, fy) = cell(uv.y, self.height);
        let (t00, t10) = (self.texel(x0, y0), self.texel(x1, y0));
        let (t01, t11) = (self.texel(x0, y1), self.texel(x1, y1));
        std::array::from_fn(|i| {
            let bottom = t00[i] + (t10[i] - t00[i]) * fx;
            let top = t01[i] + (t11[i] - t01[i]) * fx;
            bottom + (top - bottom) * fy
        })
    }

    /// The mean of the three components: what a map of scalars means.
    #[inline]
    pub fn scalar(&self, uv: Vec2) -> Real {
        let [r, g, b] = self.rgb(uv);
        (r + g + b) / 3.0
    }

    /// How the scalar of the map changes with u and with v of the mesh, per unit of each.
    ///
    /// Bilinear values have slopes that jump from texel to texel, and a bump map would show its grid. So the
    /// slope is that of the biquadratic B-spline of the texels, which is the bilinear surface averaged over the
    /// width of a texel each way: it runs on evenly, and ramps keep their slope exactly.
    #[inline]
    pub fn gradient(&self, uv: Vec2) -> [Real; 2] {
        let uv = self.mapping.of(uv);
        let (columns, x) = nearest(uv.x, self.width);
        let (rows, y) = nearest(uv.y, self.height);
        let (wx, wy) = (spline(x), spline(y));
        let (sx, sy) = (spline_slope(x), spline_slope(y));
        let mut slope = [0.0; 2];
        for (j, &row) in rows.iter().enumerate() {
            for (i, &column) in columns.iter().enumerate() {
                let [r, g, b] = self.texel(column, row);
                let value = (r + g + b) / 3.0;
                slope[0] += value * sx[i] * wy[j];
                slope[1] += value * wx[i] * sy[j];
            }
        }
        self.mapping.slope([slope[0] * self.width as Real, slope[1] * self.height as Real])
    }

    /// The texel of a column and of a row counted from the bottom.
    #[inline]
    fn texel(&self, x: u32, y: u32) -> [Real; 3] {
        let row = (self.height - 1 - y) as usize;
        let i = (row * self.width as usize + x as usize) * self.channels;
        let at = |k: usize| -> Real {
            let k = if self.channels == 1 { i } else { i + k };
            let v = match &self.image.pixels {
                Pixels::U8(v) => self.table[usize::from(v[k])],
                Pixels::U16(v) => self.table[usize::from(v[k])],
                Pixels::F32(v) => v[k],
            };
            v as Real
        };
        [at(0), at(1), at(2)]
    }
}

/// The two texels round a coordinate that wraps, and how far it lies towards the second.
#[inline]
fn cell(u: Real, n: u32) -> (u32, u32, Real) {
    // Not finite: treat as 0, since a broken uv must not panic.
    let u = if u.is_finite() { u - u.floor() } else { 0.0 };
    let x = u * n as Real;
    let i = (x as u32).min(n - 1);
    (i, if i + 1 == n { 0 } else { i + 1 }, (x - i as Real).min(1.0))
}

/// The texel nearest to a coordinate that wraps, between its two neighbours, and how far beyond it the
/// coordinate lies, from -1/2 to 1/2.
#[inline]
fn nearest(u: Real, n: u32) -> ([u32; 3], Real) {
    let (low, high, fraction) = cell(u, n);
    let (middle, beyond) = if fraction < 0.5 { (low, fraction) } else { (high, fraction - 1.0) };
    let before = if middle == 0 { n - 1 } else { middle - 1 };
    let after = if middle + 1 == n { 0 } else { middle + 1 };
    ([before, middle, after], beyond)
}

/// Weights of the quadratic B-spline for the texels before, at and after the nearest one, `d` beyond it.
#[inline]
fn spline(d: Real) -> [Real; 3] {
    let (a, b) = (0.5 - d, 0.5 + d);
    [0.5 * a * a, 0.75 - d * d, 0.5 * b * b]
}

/// Derivatives of [`spline`].
#[inline]
fn spline_slope(d: Real) -> [Real; 3] {
    [d - 0.5, -2.0 * d, d + 0.5]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(image: Image, curve: Curve) -> Texture {
        Texture::new(Arc::new(image), curve, 0)
    }

    fn ramp() -> Image {
        // Two by two, grey: top row 0, 100; bottom row 200, 40.
        Image {
            width: 2,
            height: 2,
            channels: 1,
            pixels: Pixels::U8(vec![0, 100, 200, 40]),
            primaries: None,
            notes: vec![],
        }
    }

    #[test]
    fn corners_are_texels_and_v_points_up() {
        let t = texture(ramp(), Curve::IDENTITY);
        let at = |u, v| t.scalar(Vec2::new(u, v)) * 255.0;
        for (u, v, value) in [(0.0, 0.0, 200.0), (0.5, 0.0, 40.0), (0.0, 0.5, 0.0), (0.5, 0.5, 100.0)] {
            assert!((at(u, v) - value).abs() < 1e-3, "({u}, {v}): {}", at(u, v));
        }
        // Halfway between, and wrapped round.
        assert!((at(0.25, 0.0) - 120.0).abs() < 1e-3);
        assert!((at(0.75, 0.0) - 120.0).abs() < 1e-3);
        assert!((at(-0.5, 1.0) - 40.0).abs() < 1e-3);
        assert!((at(7.5, -3.0) - 40.0).abs() < 1e-3);
    }

    #[test]
    fn the_curve_is_the_manuals() {
        let curve = Curve { exponent: 2.2, a: 0.5, b: 0.25, c: 0.125 };
        let t = texture(ramp(), curve);
        let x = (200.0f64 / 255.0).powf(2.2);
        let expected = 0.5 * x * x + 0.25 * x + 0.125;
        assert!((t.scalar(Vec2::new(0.0, 0.0)) as f64 - expected).abs() < 1e-6);
    }

    #[test]
    fn sixteen_bits_and_floats_agree_with_eight() {
        let as_u16 = Image { pixels: Pixels::U16(vec![0, 100 * 257, 200 * 257, 40 * 257]), ..ramp() };
        let as_f32 =
            Image { pixels: Pixels::F32([0.0f32, 100.0, 200.0, 40.0].map(|v| v / 255.0).to_vec()), ..ramp() };
        let curve = Curve { exponent: 1.8, a: 0.1, b: 0.7, c: 0.0 };
        let (t8, t16, tf) = (texture(ramp(), curve), texture(as_u16, curve), texture(as_f32, curve));
        for i in 0..100 {
            let uv = Vec2::new(i as Real * 0.137, i as Real * 0.071);
            assert!((t8.scalar(uv) - t16.scalar(uv)).abs() < 1e-5);
            assert!((t8.scalar(uv) - tf.scalar(uv)).abs() < 1e-5);
        }
    }

    #[test]
    fn slopes_are_those_of_the_heights() {
        // h = 0.01 (3 column + 2 row from the bottom) over 16 by 8 texels.
        let heights = |f: fn(u32, u32) -> f32| Image {
            width: 16,
            height: 8,
            channels: 1,
            pixels: Pixels::F32((0..8).rev().flat_map(|y| (0..16).map(move |x| f(x, y))).collect()),
            primaries: None,
            notes: vec![],
        };
        let ramp = texture(heights(|x, y| 0.01 * (3 * x + 2 * y) as f32), Curve::IDENTITY);
        // Away from the seam, where the ramp falls back.
        for (u, v) in [(0.3, 0.4), (0.5, 0.5), (0.61, 0.77)] {
            let [du, dv] = ramp.gradient(Vec2::new(u, v));
            assert!((du - 0.03 * 16.0).abs() < 1e-4 && (dv - 0.02 * 8.0).abs() < 1e-4, "{du} {dv}");
        }
        // A wave that repeats: slopes run on across the seam and sum up to nothing.
        let wave = texture(heights(|x, _| (x as f32 * std::f32::consts::TAU / 16.0).sin()), Curve::IDENTITY);
        let at = |u: Real| wave.gradient(Vec2::new(u, 0.3))[0];
        assert!((at(0.0) - at(1.0)).abs() < 1e-4 && (at(1e-4) - at(-1e-4)).abs() < 1e-2);
        let sum: Real = (0..160).map(|i| at(i as Real / 160.0)).sum();
        assert!(sum.abs() < 1e-3, "{sum}");
        // The spline is the wave averaged over a texel twice: its slope is lower by sinc² of 1/16.
        let lower = ((std::f64::consts::PI / 16.0).sin() / (std::f64::consts::PI / 16.0)).powi(2);
        let slope = at(0.0) as f64 / (std::f64::consts::TAU * lower);
        assert!((slope - 1.0).abs() < 0.02, "{slope}");
    }

    /// A map that is turned, sheared and moved is read there, and its slopes are those of its values.
    #[test]
    fn coordinates_are_transformed() {
        let waves = |x: u32, y: u32| (x as f32 / 3.0).sin() + (y as f32 / 5.0).cos();
        let image = Image {
            width: 64,
            height: 64,
            channels: 1,
            pixels: Pixels::F32((0..64 * 64).map(|i| waves(i % 64, i / 64)).collect()),
            primaries: None,
            notes: vec![],
        };
        let plain = texture(image, Curve::IDENTITY);
        let mapping = Mapping { matrix: [0.0, -0.5, 0.25, 0.125], translation: [0.5, 0.25] };
        let mapped = plain.clone().with_mapping(mapping);
        for (u, v) in [(0.5, 0.25), (0.3, 0.4), (0.9, 0.7)] {
            let expected = Vec2::new(-0.5 * v + 0.5, 0.25 * u + 0.125 * v + 0.25);
            assert_eq!(mapped.rgb(Vec2::new(u, v)), plain.rgb(expected));
            // Of a bilinear map slopes are smoothed, so it is the smooth slope that is compared.
            let [x, y] = plain.gradient(expected);
            assert_eq!(mapped.gradient(Vec2::new(u, v)), [0.25 * y, -0.5 * x + 0.125 * y]);
            let h = 0.05;
            let at = |u: Real, v: Real| mapped.scalar(Vec2::new(u, v));
            let numeric =
                [(at(u + h, v) - at(u - h, v)) / (2.0 * h), (at(u, v + h) - at(u, v - h)) / (2.0 * h)];
            for (slope, numeric) in mapped.gradient(Vec2::new(u, v)).into_iter().zip(numeric) {
                assert!((slope - numeric).abs() < 0.1 * numeric.abs() + 0.1, "{slope} and {numeric}");
            }
        }
    }

    /// A map of scalars in colour is the grey map of the means: its values and its slopes.
    #[test]
    fn a_scalar_is_the_mean_of_the_channels() {
        let colours: Vec<[f32; 3]> =
            (0..12).map(|i| [0.3, 1.7, -0.4].map(|c| c * (i * i % 7) as f32)).collect();
        let means = colours.iter().map(|[r, g, b]| (r + g + b) / 3.0).collect();
        let of = |channels, values| Image {
            width: 4,
            height: 3,
            channels,
            pixels: Pixels::F32(values),
            primaries: None,
            notes: vec![],
        };
        let colour = texture(of(3, colours.concat()), Curve::IDENTITY);
        let grey = texture(of(1, means), Curve::IDENTITY);
        for i in 0..50 {
            let uv = Vec2::new(i as Real * 0.137, i as Real * 0.071);
            assert!((colour.scalar(uv) - grey.scalar(uv)).abs() < 1e-5);
            let [a, b] = [&colour, &grey].map(|map| map.gradient(uv));
            assert!((a[0] - b[0]).abs() < 1e-4 && (a[1] - b[1]).abs() < 1e-4, "{a:?} and {b:?}");
        }
    }

    #[test]
    fn textures_of_one_file_share_its_texels() {
        let image = Arc::new(ramp());
        let half = Curve { b: 0.5, ..Curve::IDENTITY };
        let (a, b) = (Texture::new(image.clone(), Curve::IDENTITY, 0), Texture::new(image.clone(), half, 3));
        assert!(Arc::ptr_eq(&a.image, &b.image));
        assert_eq!(b.scalar(Vec2::new(0.0, 0.0)), 0.5 * a.scalar(Vec2::new(0.0, 0.0)));
        // A texel of eight bits takes a byte.
        assert_eq!(a.memory_bytes(), 4 + 4 * 256);
    }

    #[test]
    fn shares_of_texels_are_counted() {
        let of = |b: f64, c: f64| texture(ramp(), Curve { b, c, ..Curve::IDENTITY });
        // 0, 100, 200 and 40 of 255: times two the third is above 1, and less 0.5 all but the third are below 0.
        assert_eq!(of(1.0, 0.0).share_beyond(0.0, 1.0), 0.0);
        assert_eq!(of(2.0, 0.0).share_beyond(0.0, 1.0), 0.25);
        assert_eq!(of(1.0, -0.5).share_beyond(0.0, 1.0), 0.75);
        assert_eq!(of(1.0, -0.5).share_not_above(0.0), 0.75);
        let floats = Image { pixels: Pixels::F32(vec![0.0, 1.0, 1.5, -0.25]), ..ramp() };
        assert_eq!(texture(floats, Curve::IDENTITY).share_beyond(0.0, 1.0), 0.5);
    }

    #[test]
    fn broken_coordinates_are_harmless() {
        let t = texture(ramp(), Curve::IDENTITY);
        for u in [Real::NAN, Real::INFINITY, 1e30, -1e30] {
            assert!(t.scalar(Vec2::new(u, u)).is_finite());
            assert!(t.gradient(Vec2::new(u, u))[0].is_finite());
        }
    }
}
