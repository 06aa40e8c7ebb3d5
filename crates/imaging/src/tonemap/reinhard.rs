//! Reinhard's global operator: luminance is compressed, hue and saturation are kept.
//!
//! With L the white-balanced luminance and L̄ its log average, L_m = pre_scale · L / L̄ and
//! out = post_scale · L_m (1 + L_m / w²) / (1 + L_m) (equation 4 of the paper), where w is the
//! lesser of `burn` and the picture's largest L_m: the brightest pixel comes out as post_scale at
//! least.
//!
//! The log average is exp(mean of ln L) over the pixels with L > 0. The paper adds a small δ to
//! every luminance instead, against the logarithm of black; but what is small depends on the
//! scene's scale, and a black background would drag the average to δ. Without a lit pixel the
//! picture is black.

use crate::WhiteBalance;
use crate::white_balance::{Matrix, dot};
use rayon::prelude::*;

/// The operator for one picture.
pub(crate) struct Reinhard {
    matrix: Matrix,
    luminance: [f32; 3],
    /// pre_scale / L̄.
    scale: f32,
    post_scale: f32,
    /// 1 / w².
    inverse_white2: f32,
}

impl Reinhard {
    pub(super) fn new<'a, R>([pre, post, burn]: [f64; 3], white_balance: WhiteBalance, rows: R) -> Self
    where
        R: IndexedParallelIterator<Item = &'a [[f32; 4]]>,
    {
        let luminance = white_balance.luminance_row();
        let rows: Vec<Statistics> = rows.map(|row| Statistics::of_row(row, luminance)).collect();
        let all = rows.into_iter().fold(Statistics::default(), Statistics::join);
        let scale = all.log_average().map_or(0.0, |average| pre / average);
        let white = burn.min(all.largest * scale);
        Self {
            matrix: white_balance.to_rgb(),
            luminance,
            scale: scale as f32,
            post_scale: post as f32,
            inverse_white2: if white > 0.0 { (1.0 / (white * white)) as f32 } else { 0.0 },
        }
    }

    pub(super) fn map_row(&self, from: &[[f32; 4]], to: &mut [[f32; 4]]) {
        for (xyz, out) in from.iter().zip(to) {
            // out / L, the factor common to the three components.
            let l_m = dot(self.luminance, xyz).max(0.0) * self.scale;
            let factor = self.post_scale * self.scale * (1.0 + l_m * self.inverse_white2) / (1.0 + l_m);
            let [r, g, b] = self.matrix.apply(xyz).map(|v| v * factor);
            *out = [r, g, b, xyz[3]];
        }
    }
}

/// What the operator needs to know of a picture.
#[derive(Clone, Copy, Default)]
struct Statistics {
    sum_of_logs: f64,
    lit: u64,
    largest: f64,
}

impl Statistics {
    fn of_row(row: &[[f32; 4]], luminance: [f32; 3]) -> Self {
        row.iter().map(|xyz| dot(luminance, xyz)).filter(|&l| l > 0.0).fold(Self::default(), |s, l| Self {
            sum_of_logs: s.sum_of_logs + f64::from(l.ln()),
            lit: s.lit + 1,
            largest: s.largest.max(f64::from(l)),
        })
    }

    fn join(self, other: Self) -> Self {
        Self {
            sum_of_logs: self.sum_of_logs + other.sum_of_logs,
            lit: self.lit + other.lit,
            largest: self.largest.max(other.largest),
        }
    }

    fn log_average(&self) -> Option<f64> {
        (self.lit > 0).then(|| (self.sum_of_logs / self.lit as f64).exp())
    }
}
