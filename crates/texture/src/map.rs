//! Image maps: texels in the width they came in, read bilinearly with wrap-around.

use indigo_formats::image::{Image, Pixels};
use indigo_math::{Real, Vec2};
use std::sync::Arc;

/// The quadratic of a texture: `f = a g² + b g + c` with `g = x^exponent`, for each component `x` in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Exponent that undoes the picture's gamma.
    pub exponent: f64,
    /// Quadratic coefficient.
    pub a: f64,
    /// Linear coefficient.
    pub b: f64,
    /// Constant.
    pub c: f64,
}

impl Curve {
    /// The final value for a component.
    pub fn apply(&self, x: f64) -> f64 {
        let g = if self.exponent == 1.0 { x } else { x.max(0.0).powf(self.exponent) };
        (self.a * g + self.b) * g + self.c
    }
}

/// A texture: an image and the curve that makes its texels linear.
///
/// The curve is applied to texels, before they are mixed: mixing is right in linear light only.
/// Integer texels keep their width and go through a table; floating-point texels are converted once.
#[derive(Clone, Debug)]
pub struct Texture {
    width: u32,
    height: u32,
    channels: usize,
    texels: Arc<Texels>,
    /// Which uv set of the mesh it is laid on by.
    pub uv_set: u32,
}

#[derive(Debug)]
enum Texels {
    U8(Vec<u8>, Box<[f32]>),
    U16(Vec<u16>, Box<[f32]>),
    F32(Vec<f32>),
}

impl Texture {
    /// From a decoded image.
    pub fn new(image: Image, curve: Curve, uv_set: u32) -> Self {
        let table = |levels: u32| -> Box<[f32]> {
            (0..levels).map(|i| curve.apply(f64::from(i) / f64::from(levels - 1)) as f32).collect()
        };
        let texels = match image.pixels {
            Pixels::U8(v) => Texels::U8(v, table(256)),
            Pixels::U16(v) => Texels::U16(v, table(65536)),
            Pixels::F32(mut v) => {
                for x in &mut v {
                    *x = curve.apply(f64::from(*x)) as f32;
                }
                Texels::F32(v)
            }
        };
        Self {
            width: image.width,
            height: image.height,
            channels: usize::from(image.channels),
            texels: Arc::new(texels),
            uv_set,
        }
    }

    /// The same image laid on by another uv set; the texels are shared.
    #[must_use]
    pub fn with_uv_set(&self, uv_set: u32) -> Self {
        Self { uv_set, ..self.clone() }
    }

    /// Width and height in texels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Bytes of the texels.
    pub fn memory_bytes(&self) -> usize {
        match &*self.texels {
            Texels::U8(v, t) => v.len() + 4 * t.len(),
            Texels::U16(v, t) => 2 * v.len() + 4 * t.len(),
            Texels::F32(v) => 4 * v.len(),
        }
    }

    /// Linear RGB at texture coordinates.
    ///
    /// (0, 0) is the lower left corner of the image, and coordinates wrap round. Texels stand at
    /// the corners of a grid of `width` by `height` cells, and between them values are bilinear.
    #[inline]
    pub fn rgb(&self, uv: Vec2) -> [Real; 3] {
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

    /// The texel of a column and of a row counted from the bottom.
    #[inline]
    fn texel(&self, x: u32, y: u32) -> [Real; 3] {
        let row = (self.height - 1 - y) as usize;
        let i = (row * self.width as usize + x as usize) * self.channels;
        let at = |k: usize| -> Real {
            let k = if self.channels == 1 { i } else { i + k };
            let v = match &*self.texels {
                Texels::U8(v, table) => table[usize::from(v[k])],
                Texels::U16(v, table) => table[usize::from(v[k])],
                Texels::F32(v) => v[k],
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

#[cfg(test)]
mod tests {
    use super::*;

    const LINEAR: Curve = Curve { exponent: 1.0, a: 0.0, b: 1.0, c: 0.0 };

    fn ramp() -> Image {
        // Two by two, grey: top row 0, 100; bottom row 200, 40.
        Image { width: 2, height: 2, channels: 1, pixels: Pixels::U8(vec![0, 100, 200, 40]) }
    }

    #[test]
    fn corners_are_texels_and_v_points_up() {
        let t = Texture::new(ramp(), LINEAR, 0);
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
        let t = Texture::new(ramp(), curve, 0);
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
        let (t8, t16, tf) =
            (Texture::new(ramp(), curve, 0), Texture::new(as_u16, curve, 0), Texture::new(as_f32, curve, 0));
        for i in 0..100 {
            let uv = Vec2::new(i as Real * 0.137, i as Real * 0.071);
            assert!((t8.scalar(uv) - t16.scalar(uv)).abs() < 1e-5);
            assert!((t8.scalar(uv) - tf.scalar(uv)).abs() < 1e-5);
        }
    }

    #[test]
    fn broken_coordinates_are_harmless() {
        let t = Texture::new(ramp(), LINEAR, 0);
        for u in [Real::NAN, Real::INFINITY, 1e30, -1e30] {
            assert!(t.scalar(Vec2::new(u, u)).is_finite());
        }
    }
}
