//! From the values of a picture to those of a texture.

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
    /// Changes nothing.
    pub const IDENTITY: Self = Self { exponent: 1.0, a: 0.0, b: 1.0, c: 0.0 };

    /// The final value for a component.
    pub fn apply(&self, x: f64) -> f64 {
        let g = if self.exponent == 1.0 { x } else { x.max(0.0).powf(self.exponent) };
        (self.a * g + self.b) * g + self.c
    }
}
