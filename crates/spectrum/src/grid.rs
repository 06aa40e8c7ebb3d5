//! The 1 nm grid from 360 to 830 nm on which the colour matching functions are published.

use indigo_math::Real;

/// First wavelength of the visible range, nm.
pub const FIRST_NM: f64 = 360.0;
/// Last wavelength of the visible range, nm.
pub const LAST_NM: f64 = 830.0;
/// Number of grid points: one each nanometre, both ends included.
pub const COUNT: usize = 471;

/// Cell and fraction within it of a wavelength in nm; a wavelength outside belongs to the nearest end.
#[inline(always)]
pub(crate) fn locate(lambda: Real) -> (usize, Real) {
    let x = (lambda - FIRST_NM as Real).max(0.0).min((COUNT - 1) as Real);
    let cell = (x as usize).min(COUNT - 2);
    (cell, x - cell as Real)
}

/// Linear interpolation in a table on the grid, at a wavelength in nm.
#[inline(always)]
pub(crate) fn lerp(table: &[Real; COUNT], lambda: Real) -> Real {
    let (cell, s) = locate(lambda);
    table[cell] + s * (table[cell + 1] - table[cell])
}

/// The wavelengths of the grid, nm.
pub(crate) fn wavelengths() -> impl Iterator<Item = f64> {
    (0..COUNT).map(|i| FIRST_NM + i as f64)
}
