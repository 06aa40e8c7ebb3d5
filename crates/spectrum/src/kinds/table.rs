//! Values at equal steps of wavelength.

use std::sync::Arc;

use indigo_math::{Float, Real};

use crate::error::SpectrumError;
use crate::grid::{self, FIRST_NM, LAST_NM};

/// The smallest step of a table, nm: the kernel's wavelengths are no finer.
const SMALLEST_STEP_NM: f64 = 1e-6;

/// Values at equal steps of wavelength, linear between them, the end values held outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    start_nm: f64,
    step_nm: f64,
    steps_per_nm: f64,
    /// At least two.
    values: Arc<[Real]>,
}

impl Table {
    /// Values from `start_nm` to `end_nm`.
    ///
    /// # Errors
    /// Fewer than two values, bad ends, a step under a millionth of a nanometre, or a value that
    /// the kernel's scalar cannot hold.
    pub fn new(start_nm: f64, end_nm: f64, values: &[f64]) -> Result<Self, SpectrumError> {
        if values.len() < 2 {
            return Err(SpectrumError::TooFewValues { count: values.len() });
        }
        let step_nm = (end_nm - start_nm) / (values.len() - 1) as f64;
        if !(start_nm.is_finite() && end_nm.is_finite() && step_nm >= SMALLEST_STEP_NM) {
            return Err(SpectrumError::BadRange { start_nm, end_nm });
        }
        if let Some(index) = values.iter().position(|v| !Real::from_f64(*v).is_finite()) {
            return Err(SpectrumError::ValueOutOfRange { index, value: values[index] });
        }
        Ok(Self::of(start_nm, step_nm, values.iter().copied()))
    }

    /// A function of wavelength in nm, tabulated at 1 nm over the visible range.
    pub(crate) fn on_grid(f: impl Fn(f64) -> f64) -> Self {
        Self::of(FIRST_NM, 1.0, grid::wavelengths().map(f))
    }

    /// At least two values from `start_nm` at a positive step.
    pub(crate) fn of(start_nm: f64, step_nm: f64, values: impl Iterator<Item = f64>) -> Self {
        Self { start_nm, step_nm, steps_per_nm: 1.0 / step_nm, values: values.map(Real::from_f64).collect() }
    }

    /// The table with a function applied to each of its values.
    #[must_use]
    pub fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        Self::of(self.start_nm, self.step_nm, self.values.iter().map(|v| f(v.to_f64())))
    }

    /// The wavelengths of the values, nm, as far as they lie within the visible range.
    pub fn wavelengths(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.values.len())
            .map(|i| self.start_nm + i as f64 * self.step_nm)
            .filter(|lambda| (FIRST_NM..=LAST_NM).contains(lambda))
    }

    /// The value at a wavelength in nm.
    #[inline(always)]
    pub fn eval(&self, lambda: Real) -> Real {
        // The position is found in double precision: a fine table has steps near the rounding of
        // a single-precision wavelength.
        let (cell, s) = self.locate(lambda.to_f64());
        let (a, b) = (self.values[cell], self.values[cell + 1]);
        a + Real::from_f64(s) * (b - a)
    }

    /// The value at a wavelength in nm, in double precision.
    pub fn at(&self, lambda_nm: f64) -> f64 {
        let (cell, s) = self.locate(lambda_nm);
        let (a, b) = (self.values[cell].to_f64(), self.values[cell + 1].to_f64());
        a + s * (b - a)
    }

    #[inline(always)]
    fn locate(&self, lambda_nm: f64) -> (usize, f64) {
        let last = self.values.len() - 1;
        let x = ((lambda_nm - self.start_nm) * self.steps_per_nm).max(0.0).min(last as f64);
        let cell = (x as usize).min(last - 1);
        (cell, x - cell as f64)
    }
}
