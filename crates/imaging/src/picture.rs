//! What developing yields.

use crate::srgb::Encoder8;
use rayon::prelude::*;

/// A picture in display-linear light, ready to be encoded.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Linear Rec. 709 red, green and blue in [0, 1], and coverage by the foreground in [0, 1];
    /// rows from top to bottom.
    pub pixels: Vec<[f32; 4]>,
}

impl Picture {
    /// What a screen shows: sRGB codes of red, green and blue, and opaque. Not dithered, since it is looked at while it
    /// changes. Runs on the caller's rayon pool.
    pub fn to_screen(&self) -> Vec<[u8; 4]> {
        let encoder = Encoder8::new();
        let code = |&[r, g, b, _]: &[f32; 4]| [encoder.encode(r), encoder.encode(g), encoder.encode(b), 255];
        self.pixels.par_iter().map(code).collect()
    }
}

/// A picture in scene-linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearImage {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Linear Rec. 709 red, green and blue in cd/m² (equal values v are D65 light of the luminance
    /// v), and coverage by the foreground; not clamped: colours outside the gamut have negative
    /// components. Rows from top to bottom.
    pub pixels: Vec<[f32; 4]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_screen_gets_codes() {
        let pixels = vec![[0.0, 0.18, 1.0, 0.0], [0.5, 0.0031308, 0.0, 1.0]];
        let picture = Picture { width: 2, height: 1, pixels };
        assert_eq!(picture.to_screen(), [[0, 118, 255, 255], [188, 10, 0, 255]]);
    }
}
