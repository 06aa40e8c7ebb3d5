//! `background`: light from everywhere.

use super::Distant;
use indigo_decl::{Block, Field, Kind, Presence};
use indigo_math::warp::{INV_PI, cosine_hemisphere, cosine_hemisphere_pdf, uniform_sphere};
use indigo_math::{Frame, Real, Vec3};
use indigo_spectrum::declare::SPECTRUM;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// The declaration of `background`.
pub static BLOCK: Block = Block::new(
    "background",
    "Lights the scene with the same radiance from all directions.",
    &[Field::new("spectrum", Kind::OneOf(&SPECTRUM), Presence::Required, "The radiance.")],
)
.with_ignored(&["radiance"])
.with_example(
    "<background>
    <spectrum>
        <blackbody><temperature>3500</temperature><gain>1.0</gain></blackbody>
    </spectrum>
</background>",
);

/// The same radiance from every direction, W m^-3 sr^-1.
#[derive(Clone, Debug)]
pub struct Background(pub Spectrum);

impl Background {
    /// For the laws.
    pub(super) fn examples() -> Vec<Self> {
        vec![Self(Spectrum::uniform(0.8))]
    }
}

impl Distant for Background {
    #[inline]
    fn radiance(&self, _towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.0.eval(lambda)
    }

    #[inline]
    fn sample(&self, n: Vec3, u: [Real; 2]) -> Option<Vec3> {
        if n == Vec3::ZERO {
            return Some(uniform_sphere(u.into()));
        }
        Some(Frame::from_normal(n).to_world(cosine_hemisphere(u.into())))
    }

    #[inline]
    fn pdf(&self, n: Vec3, towards: Vec3) -> Real {
        if n == Vec3::ZERO { 0.25 * INV_PI } else { cosine_hemisphere_pdf(n.dot(towards)) }
    }

    fn total_luminance(&self) -> f64 {
        4.0 * std::f64::consts::PI * self.0.luminance()
    }

    fn is_drawn(&self) -> bool {
        false
    }

    #[inline]
    fn portal_share(&self) -> Real {
        1.0
    }
}
