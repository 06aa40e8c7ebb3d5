//! What developing yields.

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
