//! A table of fits, for textures.
//!
//! What is tabulated is the sigmoid of a [`Reflectance`], whose colour always has a largest
//! component z of at least 1/2 and a smallest of at most 1 − z. It is looked up by which component
//! is largest, by z, and by the two others as fractions x, y of it (Jakob & Hanika 2019,
//! section 4). Nodes crowd where the coefficients bend most: at both ends of x and y, and at z = 1.

use std::sync::OnceLock;

use indigo_math::{Real, Vec3d};

use super::fit::{flat_start, minimise};
use super::nodes::COARSE;
use super::reflectance::Split;
use super::{Emission, Reflectance, SigmoidCoeffs, unit};

/// Nodes along x and y.
const NODES: usize = 36;
/// Nodes along z.
const DEPTH: usize = 18;
/// The residual at which a fit of the table is done: far below what interpolation costs.
const ENOUGH: f64 = 3e-5;

/// Reflectances of all colours, by interpolation between fits: the colour returns within 2e-3 in
/// each channel of linear RGB (1.3e-3 at most over 80,000 random ones, 3e-4 in the mean). 0.8 MiB.
pub struct RgbTable {
    /// Index: largest component, then z, then y, then x, the last fastest.
    coeffs: Vec<[Real; 3]>,
}

impl std::fmt::Debug for RgbTable {
    /// There is but one, and it is large.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("RgbTable")
    }
}

impl RgbTable {
    /// The table, built at the first call (about 0.05 s on one core). Ask for it when a scene is
    /// loaded, and keep the reference.
    pub fn get() -> &'static Self {
        static TABLE: OnceLock<RgbTable> = OnceLock::new();
        TABLE.get_or_init(Self::build)
    }

    fn build() -> Self {
        let mut coeffs = vec![[0.0; 3]; 3 * DEPTH * NODES * NODES];
        for largest in 0..3 {
            for y in 0..NODES {
                for x in 0..NODES {
                    fit_hue(&mut coeffs, largest, x, y);
                }
            }
        }
        Self { coeffs }
    }

    /// The reflectance of a linear Rec. 709 triple; each component is clamped to [0, 1], NaN to 0.
    #[inline]
    pub fn lookup(&self, rgb: [Real; 3]) -> Reflectance {
        match Split::of(rgb.map(unit)) {
            Split::Grey(v) => Reflectance::grey(v),
            Split::Colour { target, scale } => Reflectance { coeffs: self.interpolate(target), scale },
        }
    }

    /// The emission of a linear Rec. 709 triple, W m^-3 sr^-1; see [`Emission::fit`].
    #[inline]
    pub fn lookup_emission(&self, rgb: [Real; 3]) -> Emission {
        let rgb = rgb.map(|v| v.max(0.0));
        let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
        if scale > 0.0 && scale.is_finite() {
            Emission { coeffs: self.lookup(rgb.map(|v| v / scale)).coeffs, scale }
        } else {
            Emission::BLACK
        }
    }

    /// Coefficients of a colour in the table's range, by trilinear interpolation.
    #[inline]
    fn interpolate(&self, rgb: [Real; 3]) -> SigmoidCoeffs {
        let largest = if rgb[0] >= rgb[1] && rgb[0] >= rgb[2] {
            0
        } else if rgb[1] >= rgb[2] {
            1
        } else {
            2
        };
        let value = rgb[largest];
        let x = Place::between(both_ends(rgb[(largest + 1) % 3] / value), NODES);
        let y = Place::between(both_ends(rgb[(largest + 2) % 3] / value), NODES);
        let z = Place::between(far_end(value), DEPTH);
        let mut sum = [0.0; 3];
        for corner in 0..8 {
            let (i, wx) = x.end(corner & 1);
            let (j, wy) = y.end((corner >> 1) & 1);
            let (k, wz) = z.end(corner >> 2);
            let weight = wx * wy * wz;
            for (total, c) in sum.iter_mut().zip(self.coeffs[index(largest, i, j, k)]) {
                *total += weight * c;
            }
        }
        SigmoidCoeffs(sum)
    }
}

/// A place on an axis of the table, between two nodes.
struct Place {
    low: usize,
    fraction: Real,
}

impl Place {
    /// At a part, from 0 to 1, of an axis with `nodes` equal steps but one.
    #[inline(always)]
    fn between(part: Real, nodes: usize) -> Self {
        let steps = part * (nodes - 1) as Real;
        let low = (steps as usize).min(nodes - 2);
        Self { low, fraction: steps - low as Real }
    }

    /// Node and weight of the lower (0) or upper (1) end.
    #[inline(always)]
    fn end(&self, upper: usize) -> (usize, Real) {
        (self.low + upper, if upper == 1 { self.fraction } else { 1.0 - self.fraction })
    }
}

/// Part of the axis at which a coordinate v in [0, 1] lies: v = 2 s² up to 1/2, and its mirror image beyond.
#[inline(always)]
fn both_ends(v: Real) -> Real {
    if v < 0.5 { (0.5 * v).sqrt() } else { 1.0 - (0.5 * (1.0 - v)).max(0.0).sqrt() }
}

/// The inverse of [`both_ends`] at node `i`.
fn fraction_at(i: usize) -> f64 {
    let s = i as f64 / (NODES - 1) as f64;
    if s < 0.5 { 2.0 * s * s } else { 1.0 - 2.0 * (1.0 - s) * (1.0 - s) }
}

/// Part of the axis at which a largest component v in [1/2, 1] lies: v = 1 − (1 − s)² / 2.
#[inline(always)]
fn far_end(v: Real) -> Real {
    1.0 - (2.0 * (1.0 - v)).clamp(0.0, 1.0).sqrt()
}

/// The inverse of [`far_end`] at node `k`.
fn largest_at(k: usize) -> f64 {
    let s = k as f64 / (DEPTH - 1) as f64;
    1.0 - 0.5 * (1.0 - s) * (1.0 - s)
}

#[inline(always)]
fn index(largest: usize, x: usize, y: usize, z: usize) -> usize {
    ((largest * DEPTH + z) * NODES + y) * NODES + x
}

/// The fits of one hue from z = 1/2 up, as far as the table is used. Each begins where a parabola through the three before it
/// leads, which takes a third less time than to begin at the last of them.
fn fit_hue(coeffs: &mut [[Real; 3]], largest: usize, x: usize, y: usize) {
    // The least fraction that the cells about this node hold.
    let least = fraction_at(x.saturating_sub(1)).min(fraction_at(y.saturating_sub(1)));
    let mut before: [Option<Vec3d>; 3] = [None; 3];
    for k in (0..DEPTH).take_while(|k| largest_at(k.saturating_sub(1)) * (1.0 + least) <= 1.0) {
        let z = largest_at(k);
        let mut rgb = [z; 3];
        rgb[(largest + 1) % 3] = z * fraction_at(x);
        rgb[(largest + 2) % 3] = z * fraction_at(y);
        let start = match before {
            [Some(a), Some(b), Some(c)] => a + (c - b) * 3.0,
            [None, Some(b), Some(c)] => c + (c - b),
            [_, None, Some(c)] => c,
            _ => flat_start(rgb),
        };
        let fitted = minimise(&COARSE, Vec3d::from(rgb), start, ENOUGH);
        coeffs[index(largest, x, y, k)] = fitted.to_array().map(|c| c as Real);
        before = [before[1], before[2], Some(fitted)];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rgb::fit::rgb_under_d65;
    use crate::test_support::Uniform;

    type Colours = fn(&mut Uniform) -> [Real; 3];

    /// Largest and mean error of the colour that comes back, over random colours.
    fn round_trip(colours: Colours) -> (f64, f64) {
        const COUNT: usize = 5000;
        let table = RgbTable::get();
        let mut random = Uniform::new(7);
        let errors: Vec<f64> = (0..COUNT)
            .map(|_| {
                let rgb = colours(&mut random);
                let coeffs = table.lookup(rgb);
                let back = rgb_under_d65(|lambda| coeffs.at(lambda));
                (0..3).map(|c| (back[c] - rgb[c] as f64).abs()).fold(0.0, f64::max)
            })
            .collect();
        (errors.iter().copied().fold(0.0, f64::max), errors.iter().sum::<f64>() / COUNT as f64)
    }

    #[test]
    fn colours_return() {
        let kinds: [(&str, Colours); 4] = [
            ("even", |r| r.triple()),
            ("dark", |r| r.triple().map(|v| v.powi(4))),
            ("bright", |r| r.triple().map(|v| 1.0 - v.powi(4))),
            ("saturated", |r| {
                let mut rgb = r.triple();
                rgb[(3.0 * r.next()) as usize] = 0.0;
                rgb
            }),
        ];
        for (name, colours) in kinds {
            let (largest, mean) = round_trip(colours);
            assert!(largest < 2e-3 && mean < 5e-4, "{name}: largest {largest:.2e}, mean {mean:.2e}");
        }
    }

    /// However dark a colour is, its hue returns.
    #[test]
    fn dark_colours_return_in_proportion() {
        let table = RgbTable::get();
        let mut random = Uniform::new(11);
        let mut worst: f64 = 0.0;
        for scale in [1e-2, 1e-3, 1e-4, 1e-6] {
            for _ in 0..500 {
                let hue = random.triple();
                let most = hue[0].max(hue[1]).max(hue[2]);
                let rgb = hue.map(|v| v / most * scale);
                let coeffs = table.lookup(rgb);
                let back = rgb_under_d65(|lambda| coeffs.at(lambda));
                let error = (0..3).map(|c| (back[c] - rgb[c] as f64).abs()).fold(0.0, f64::max);
                worst = worst.max(error / scale as f64);
            }
        }
        assert!(worst < 2e-3, "largest error relative to the largest component: {worst:.2e}");
    }

    #[test]
    fn greys_are_flat_and_bad_numbers_harmless() {
        let table = RgbTable::get();
        for v in [0.0, 1e-5, 0.18, 0.5, 0.999, 1.0] {
            let coeffs = table.lookup([v; 3]);
            assert!([360.0, 500.0, 830.0].iter().all(|&l| (coeffs.at(l) - v as f64).abs() < 1e-6), "{v}");
        }
        for bad in [Real::NAN, Real::INFINITY, -1.0, 1e30] {
            let coeffs = table.lookup([bad, 0.5, 0.2]);
            assert!((0.0..=1.0).contains(&coeffs.at(600.0)), "{bad}");
        }
        assert_eq!(table.lookup_emission([Real::INFINITY, 1.0, 0.0]), Emission::BLACK);
        assert_eq!(table.lookup_emission([Real::NAN, -1.0, 0.0]), Emission::BLACK);
    }

    #[test]
    fn parts_of_an_axis_invert_its_nodes() {
        for i in 0..NODES {
            let part = both_ends(fraction_at(i) as Real) as f64;
            assert!((part * (NODES - 1) as f64 - i as f64).abs() < 2e-3, "{i}: {part}");
        }
        for k in 0..DEPTH {
            let part = far_end(largest_at(k) as Real) as f64;
            assert!((part * (DEPTH - 1) as f64 - k as f64).abs() < 2e-3, "{k}: {part}");
        }
    }
}
