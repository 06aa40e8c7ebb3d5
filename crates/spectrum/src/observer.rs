//! The observer: CIE 1931 2-degree colour matching functions, and the weights that turn the lanes
//! of a path into an estimate of XYZ.

use indigo_math::Real;

use crate::grid::{self, COUNT};
use crate::lanes::LANES;
use crate::wavelengths::SampledWavelengths;

/// Luminous efficacy of 555 nm, lm/W (the SI's 683 at 540 THz, referred to 555 nm in air).
pub const LUMENS_PER_WATT: f64 = 683.002;

/// What turns W m^-3 sr^-1 integrated over nm against a colour matching function into cd/m^2.
pub const NITS_PER_UNIT: f64 = LUMENS_PER_WATT * 1e-9;

/// The colour matching functions x, y, z (each dimensionless) from 360 to 830 nm at 1 nm.
pub static CMF: [[f64; 3]; COUNT] = include!("../data/cie1931_2deg_xyz_1nm.in");

/// The same numbers, one table per function, in the kernel's precision.
static CMF_TABLES: [[Real; COUNT]; 3] = {
    let mut tables = [[0.0; COUNT]; 3];
    let mut i = 0;
    while i < COUNT {
        tables[0][i] = CMF[i][0] as Real;
        tables[1][i] = CMF[i][1] as Real;
        tables[2][i] = CMF[i][2] as Real;
        i += 1;
    }
    tables
};

/// The colour matching functions at a wavelength in nm, linear between the published values and
/// 0 outside 360 to 830 nm.
pub fn cmf(lambda_nm: f64) -> [f64; 3] {
    if !(grid::FIRST_NM..=grid::LAST_NM).contains(&lambda_nm) {
        return [0.0; 3];
    }
    let x = lambda_nm - grid::FIRST_NM;
    let cell = (x as usize).min(COUNT - 2);
    let s = x - cell as f64;
    std::array::from_fn(|c| CMF[cell][c] + s * (CMF[cell + 1][c] - CMF[cell][c]))
}

/// Weights w such that the sum over lanes of L·w is an unbiased estimate of XYZ in cd/m^2, for a
/// spectral radiance L in W m^-3 sr^-1 carried by these wavelengths. First index X, Y, Z.
#[inline]
pub fn xyz_weights(wavelengths: &SampledWavelengths) -> [[Real; LANES]; 3] {
    let scale = (NITS_PER_UNIT / LANES as f64) as Real;
    let mut weights = [[0.0; LANES]; 3];
    for lane in 0..LANES {
        let (cell, s) = grid::locate(wavelengths.lambda[lane]);
        let w = scale / wavelengths.pdf[lane];
        for (table, row) in CMF_TABLES.iter().zip(&mut weights) {
            row[lane] = w * (table[cell] + s * (table[cell + 1] - table[cell]));
        }
    }
    weights
}
