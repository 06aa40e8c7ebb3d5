//! White balance: chromatic adaptation from the scene's white to the display's.

use crate::ImagingError;
use indigo_math::Mat3;
use indigo_spectrum::adaptation::{D65_XY, XYZ_TO_RGB, bradford_to_d65};
use indigo_spectrum::illuminant;
use std::fmt;

/// The Bradford adaptation from a named white to D65. It acts when a picture is developed, never
/// on the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WhiteBalance {
    adaptation: Mat3<f64>,
    white_xy: [f64; 2],
}

impl fmt::Display for WhiteBalance {
    /// As scenes name it: an illuminant, or a chromaticity.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.white_xy;
        match illuminant::ALL.iter().find(|illuminant| illuminant.white_xy == self.white_xy) {
            Some(illuminant) => f.write_str(illuminant.name),
            None => write!(f, "{x} {y}"),
        }
    }
}

impl Default for WhiteBalance {
    fn default() -> Self {
        Self::NONE
    }
}

impl WhiteBalance {
    /// The display's own white, D65: nothing is adapted.
    pub const NONE: Self = Self { adaptation: Mat3::IDENTITY, white_xy: D65_XY };

    /// Light of the CIE 1931 chromaticity (x, y) becomes a neutral grey. Errors: no white has that
    /// chromaticity.
    pub fn from_white([x, y]: [f64; 2]) -> Result<Self, ImagingError> {
        let possible = x > 0.0 && y > 0.0 && x + y <= 1.0;
        match bradford_to_d65([x, y]) {
            Some(adaptation) if possible => Ok(Self { adaptation, white_xy: [x, y] }),
            _ => Err(ImagingError::NotAWhite { x, y }),
        }
    }

    /// The CIE 1931 chromaticity (x, y) of the white.
    pub fn white_xy(&self) -> [f64; 2] {
        self.white_xy
    }

    /// From XYZ of the film to white-balanced linear Rec. 709.
    pub(crate) fn to_rgb(self) -> Matrix {
        Matrix::new(&(Mat3::from_rows(XYZ_TO_RGB) * self.adaptation))
    }

    /// The row that gives the white-balanced luminance of XYZ.
    pub(crate) fn luminance_row(self) -> [f32; 3] {
        self.adaptation.rows[1].to_array().map(|v| v as f32)
    }
}

/// From XYZ to linear Rec. 709 without white balance.
pub(crate) fn plain_rgb() -> Matrix {
    WhiteBalance::NONE.to_rgb()
}

/// A colour matrix in single precision, for pixel loops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Matrix([[f32; 3]; 3]);

impl Matrix {
    fn new(m: &Mat3<f64>) -> Self {
        Self(m.rows.map(|row| row.to_array().map(|v| v as f32)))
    }

    /// The matrix times the first three components of a pixel.
    #[inline]
    pub(crate) fn apply(&self, p: &[f32; 4]) -> [f32; 3] {
        self.0.map(|row| dot(row, p))
    }
}

/// Scalar product with the first three components of a pixel.
#[inline]
pub(crate) fn dot(row: [f32; 3], p: &[f32; 4]) -> f32 {
    row[0] * p[0] + row[1] * p[1] + row[2] * p[2]
}
