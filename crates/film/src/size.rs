//! Output and internal resolution of a film.

use crate::FilmError;
use std::fmt;

/// The resolution of a picture and of the film behind it, which holds `super_sample`² internal
/// pixels for each output pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilmSize {
    width: u32,
    height: u32,
    super_sample: u32,
}

impl FilmSize {
    /// The longest side of a film in internal pixels: `f32` film positions still tell 1/64 of a
    /// pixel apart there.
    pub const MAX_SIDE: u64 = 1 << 17;
    /// The most internal pixels of a film: 40 GiB of sums in a single layer.
    pub const MAX_PIXELS: u64 = 1 << 30;

    /// A picture of `width` × `height` output pixels, super-sampled `super_sample` times along
    /// each axis. Errors: nothing may be zero, nor the film larger than the limits above.
    pub fn new(width: u32, height: u32, super_sample: u32) -> Result<Self, FilmError> {
        if width == 0 || height == 0 || super_sample == 0 {
            return Err(FilmError::Empty { width, height, super_sample });
        }
        let (w, h) =
            (u64::from(width) * u64::from(super_sample), u64::from(height) * u64::from(super_sample));
        if w > Self::MAX_SIDE || h > Self::MAX_SIDE || w * h > Self::MAX_PIXELS {
            return Err(FilmError::TooLarge { width, height, super_sample });
        }
        Ok(Self { width, height, super_sample })
    }

    /// Width of the picture in output pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height of the picture in output pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Internal pixels per output pixel along one axis.
    pub fn super_sample(&self) -> u32 {
        self.super_sample
    }

    /// Width of the film in internal pixels.
    pub fn internal_width(&self) -> u32 {
        self.width * self.super_sample
    }

    /// Height of the film in internal pixels.
    pub fn internal_height(&self) -> u32 {
        self.height * self.super_sample
    }

    /// Number of output pixels.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Number of internal pixels.
    pub fn internal_pixels(&self) -> usize {
        self.internal_width() as usize * self.internal_height() as usize
    }
}

impl fmt::Display for FilmSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} x {} (super-sampled {})", self.width, self.height, self.super_sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked() {
        let size = FilmSize::new(600, 450, 2).unwrap();
        assert_eq!((size.internal_width(), size.internal_height()), (1200, 900));
        assert_eq!((size.pixels(), size.internal_pixels()), (270_000, 1_080_000));
        for (w, h, s) in [(0, 1, 1), (1, 0, 1), (1, 1, 0)] {
            assert!(matches!(FilmSize::new(w, h, s), Err(FilmError::Empty { .. })));
        }
        for (w, h, s) in [(u32::MAX, 1, u32::MAX), (131_073, 1, 1), (60_000, 60_000, 1)] {
            assert!(matches!(FilmSize::new(w, h, s), Err(FilmError::TooLarge { .. })));
        }
    }
}
