//! `uniform`: scattering into all directions alike.

use super::Phase;
use indigo_decl::{Block, Node};
use indigo_diag::Sink;
use indigo_math::warp::{INV_PI, uniform_sphere};
use indigo_math::{Real, Vec3};
use indigo_spectrum::{LanePdf, SampledWavelengths};

/// The declaration of `uniform`.
pub static BLOCK: Block =
    Block::new("uniform", "Light is scattered into all directions alike. It has no parameters.", &[])
        .with_example("<uniform/>");

/// Scattering into all directions alike.
#[derive(Clone, Copy, Debug)]
pub struct Uniform;

impl Uniform {
    /// From its element.
    pub fn build(node: &Node, _sink: &mut Sink) -> Self {
        node.mark_used();
        Self
    }

    /// 0.
    pub fn mean_cosine(&self, _nm: f64) -> f64 {
        0.0
    }

    /// The phase function at some wavelengths.
    #[inline]
    pub fn at(&self, _lambda: &SampledWavelengths) -> UniformLobe {
        UniformLobe
    }
}

/// The constant 1 / 4π.
#[derive(Clone, Copy, Debug)]
pub struct UniformLobe;

impl Phase for UniformLobe {
    #[inline]
    fn pdf(&self, _wo: Vec3, _wi: Vec3) -> LanePdf {
        LanePdf::splat(0.25 * INV_PI)
    }

    #[inline]
    fn sample(&self, _wo: Vec3, u: [Real; 2]) -> Vec3 {
        uniform_sphere(u.into())
    }
}
