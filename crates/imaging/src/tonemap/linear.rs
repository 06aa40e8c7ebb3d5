//! The linear tone mapping: a factor.

use crate::PictureSettings;
use crate::white_balance::Matrix;

/// From XYZ to RGB, the factor included.
pub(crate) struct Linear {
    matrix: Matrix,
}

impl Linear {
    pub(super) fn new(scale: f64, settings: &PictureSettings) -> Self {
        let factor = scale * settings.exposure.lux_seconds_per_nit();
        Self { matrix: settings.white_balance.to_rgb().scaled(factor as f32) }
    }

    pub(super) fn map_row(&self, from: &[[f32; 4]], to: &mut [[f32; 4]]) {
        for (xyz, out) in from.iter().zip(to) {
            let [r, g, b] = self.matrix.apply(xyz);
            *out = [r, g, b, xyz[3]];
        }
    }
}
