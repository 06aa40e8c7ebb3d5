//! The linear tone mapping: a factor.

use crate::PictureSettings;
use crate::white_balance::Matrix;

/// From XYZ to RGB, and the factor: by itself, since a factor beyond all numbers would leave nothing of the differences that
/// the matrix takes.
pub(crate) struct Linear {
    matrix: Matrix,
    factor: f32,
}

impl Linear {
    pub(super) fn new(scale: f64, settings: &PictureSettings) -> Self {
        let factor = scale * settings.exposure.lux_seconds_per_nit();
        Self { matrix: settings.white_balance.to_rgb(), factor: factor as f32 }
    }

    pub(super) fn map_row(&self, from: &[[f32; 4]], to: &mut [[f32; 4]]) {
        for (xyz, out) in from.iter().zip(to) {
            let [r, g, b] = self.matrix.apply(xyz).map(|v| v * self.factor);
            *out = [r, g, b, xyz[3]];
        }
    }
}
