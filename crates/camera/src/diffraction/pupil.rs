//! What diffracts: an aperture and what stands before it.

// tidy: load-time mathematics

use super::far_field::{FarField, SIDE};
use crate::{Aperture, GreyImage, Mask};

/// What an opening lets through, together with what stands before it.
#[derive(Clone, Debug)]
pub struct Pupil {
    aperture: Aperture,
    obstacles: Option<GreyImage>,
}

impl Pupil {
    /// An aperture and, laid over its square, an image of how much light obstacles let through; values outside
    /// [0, 1] count as the nearest of the two, NaN as 0.
    pub fn new(aperture: Aperture, obstacles: Option<GreyImage>) -> Self {
        Self { aperture, obstacles: obstacles.map(GreyImage::clamped) }
    }

    /// Whether there is no obstacle: none is known, or all of them let the same through. Then the light goes where the
    /// aperture alone would send it.
    pub fn is_unobstructed(&self) -> bool {
        self.obstacles.as_ref().is_none_or(|o| o.texels.windows(2).all(|pair| pair[0] == pair[1]))
    }

    /// The amplitude behind it, drawn on `side` × `side` cells; `side` is a power of two.
    pub fn draw_amplitude(&self, side: usize) -> Mask {
        let mut mask = self.aperture.draw_amplitude(side);
        if let Some(obstacles) = &self.obstacles {
            let before = obstacles.resized(side, f32::sqrt);
            mask.cells.iter_mut().zip(before.cells).for_each(|(a, b)| *a *= b);
        }
        mask
    }

    /// Its far field; `None` where no light passes.
    pub fn far_field(&self) -> Option<FarField> {
        match (&self.aperture, &self.obstacles) {
            (Aperture::Circular, None) => Some(FarField::of_circle()),
            _ => FarField::new(&self.draw_amplitude(SIDE)),
        }
    }

    /// Whether no light passes.
    pub fn is_dark(&self) -> bool {
        // Means over the cells of a drawing are 0 only if all of it is.
        self.draw_amplitude(64).cells.iter().all(|&t| t <= 0.0)
    }
}
