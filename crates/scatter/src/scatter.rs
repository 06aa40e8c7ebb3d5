//! What the author of a scattering model writes.

use indigo_math::{Real, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// A scattering model with all its numbers baked for one point and one set of wavelengths.
///
/// Both directions point away from the surface; z is the shading normal, on the side of `wo`. No
/// cosine, no correction for shading normals and no η² belongs in here: [`ShadingPoint`](crate::ShadingPoint)
/// adds them, once for all models. Models are symmetric: `f(a, b) = f(b, a)`.
pub trait Scatter {
    /// The BSDF in 1/sr.
    fn f(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum;

    /// Density of [`sample`](Self::sample) in solid angle (1/sr), for each lane.
    fn pdf(&self, wo: Vec3, wi: Vec3) -> LanePdf;

    /// Draws a direction; `None` where the light is absorbed.
    fn sample(&self, wo: Vec3, u: [Real; 3]) -> Option<LocalSample>;
}

/// A direction drawn by a model, in its local frame.
#[derive(Clone, Copy, Debug)]
pub struct LocalSample {
    /// The direction.
    pub wi: Vec3,
    /// The BSDF in 1/sr.
    pub f: SampledSpectrum,
    /// Density in solid angle (1/sr), for each lane.
    pub pdf: LanePdf,
}
