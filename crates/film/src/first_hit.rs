//! What is first met in a pixel: data that goes with a picture, not light.

/// What the camera rays of an output pixel first meet, averaged over the pixel's area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FirstHit {
    /// Reflectance (and transmittance) under D65 as X, Y, Z; that of a perfect white has the luminance 1.
    pub albedo: [f32; 3],
    /// Mean unit shading normal on the side that is seen, in the directions of the world; shorter than 1 where the
    /// pixel sees several, 0 in media and where it sees none.
    pub normal: [f32; 3],
    /// Part of the rays that meet anything, from 0 to 1: by area, as the reflectance has it.
    pub coverage: f32,
    /// Mean depth along the viewing direction of what is met, in metres; [`FirstHit::FAR`] where nothing is.
    pub depth_m: f32,
    /// The object that most rays meet, counted from 1; 0 if most meet none.
    pub object: u32,
    /// The material that most rays meet, counted from 1; 0 if most meet none.
    pub material: u32,
}

impl FirstHit {
    /// The depth where nothing is met, as Blender writes it: an infinity would turn into NaN in compositing.
    pub const FAR: f32 = 1e10;
    /// Nothing at all.
    pub const NOTHING: Self = Self {
        albedo: [0.0; 3],
        normal: [0.0; 3],
        coverage: 0.0,
        depth_m: Self::FAR,
        object: 0,
        material: 0,
    };
}
