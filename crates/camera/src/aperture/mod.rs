//! The shape of the opening through which light reaches the lens.
//!
//! Shapes are drawn in the square [-1, 1]², whose half side is the aperture radius: x to the right and y up
//! as the camera looks. Points of the lens are chosen in proportion to how much light they let through,
//! by continuous maps of the unit square, so that even numbers make even points.

mod blades;
mod image;
mod outline;

pub use blades::{Blades, BladesError};
pub use image::{GreyImage, NothingOpen, Transmission};

use indigo_math::Vec2;
use indigo_math::warp::concentric_disk;
use outline::Outline;

/// The shape of an opening.
#[derive(Clone, Debug)]
pub enum Aperture {
    /// The circle of radius 1.
    Circular,
    /// What blades leave open, as a convex polygon.
    Generated(Outline),
    /// A picture of how much light each point lets through.
    Image(Box<Transmission>),
}

/// A drawing of an opening: `side` rows of `side` cells from the top left, each with the mean of what it
/// lets through, from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// Cells along each side.
    pub side: usize,
    /// Rows from the top, cells from the left.
    pub cells: Vec<f32>,
}

impl Aperture {
    /// What blades leave open.
    pub fn generated(blades: &Blades) -> Self {
        Self::Generated(blades.outline())
    }

    /// A picture of how much light each point lets through.
    ///
    /// # Errors
    /// Where all of it is black.
    pub fn image(image: &GreyImage) -> Result<Self, NothingOpen> {
        Ok(Self::Image(Box::new(Transmission::new(image)?)))
    }

    /// A point of the opening for two numbers in [0, 1), with a density in proportion to the
    /// transmission there.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec2 {
        match self {
            Self::Circular => concentric_disk(u),
            Self::Generated(outline) => outline.sample(u),
            Self::Image(transmission) => transmission.sample(u),
        }
    }

    /// Area of the opening where the square's half side is 1: the integral of the transmission.
    pub fn area(&self) -> f64 {
        match self {
            Self::Circular => std::f64::consts::PI,
            Self::Generated(outline) => outline.area(),
            Self::Image(transmission) => transmission.area(),
        }
    }

    /// Draws the share of light that passes each cell. `side` is a power of two.
    pub fn draw(&self, side: usize) -> Mask {
        match self {
            Self::Circular => Outline::circle().draw(side),
            Self::Generated(outline) => outline.draw(side),
            Self::Image(transmission) => transmission.image().resized(side, |t| t),
        }
    }

    /// Draws the mean amplitude of the light behind each cell: the square root of the transmission, which
    /// is a share of power. `side` is a power of two.
    pub fn draw_amplitude(&self, side: usize) -> Mask {
        match self {
            // Open or closed: both numbers are one.
            Self::Circular | Self::Generated(_) => self.draw(side),
            Self::Image(transmission) => transmission.image().resized(side, f32::sqrt),
        }
    }
}
