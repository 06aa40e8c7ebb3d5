//! What the author of a scattering model writes.

use indigo_math::{Real, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// How an event lies to the surface. The z coordinates of both directions agree with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// Both directions lie above: light is reflected.
    Reflect,
    /// The first direction lies above, the second below: light passes, seen from above.
    Down,
    /// The first direction lies below, the second above: the same seen from below.
    Up,
}

impl Crossing {
    /// The same event with its directions exchanged.
    #[inline]
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Reflect => Self::Reflect,
            Self::Down => Self::Up,
            Self::Up => Self::Down,
        }
    }
}

/// A scattering model with all its numbers baked for one point and one set of wavelengths.
///
/// Both directions point away from the surface. The local z axis is the shading normal on the side
/// from which the point was found, called *above*. Directions lie on the sides that the crossing says,
/// or in the surface: whatever geometry says otherwise,
/// [`ShadingPoint`](crate::ShadingPoint) settles beforehand. No cosine, no correction for shading normals and
/// no square of η belongs in here: it adds them, once for all models.
///
/// Models are symmetric: f(a, b) = f(b, a) with the crossing reversed. For light that passes between
/// indices η_a above and η_b below, that symmetric function is the usual BSDF for radiance that leaves
/// at b divided by η_b / η_a; Walter et al. 2007, equation 21, becomes
/// |i·h| |o·h| / (|i·n| |o·n|) · η_a η_b (1 − F) G D / (η_i (i·h) + η_o (o·h))².
pub trait Scatter {
    /// The part of the BSDF that is a function, in 1/sr; events of delta kind are left out.
    fn f(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> SampledSpectrum;

    /// Density of [`sample`](Self::sample) in solid angle (1/sr) for each lane, events of delta kind left out.
    fn pdf(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> LanePdf;

    /// Draws a direction for a `wo` above; `None` where the light is absorbed.
    fn sample(&self, wo: Vec3, u: [Real; 3]) -> Option<LocalSample>;

    /// The index of refraction below over that above; 1 where no light passes.
    fn eta(&self) -> SampledSpectrum {
        SampledSpectrum::ONE
    }

    /// Whether [`f`](Self::f) can be other than 0 where light passes to the other side.
    fn lets_through(&self) -> bool {
        false
    }

    /// Whether light is scattered into most directions, as by a matt surface, and not only into a lobe: then what a
    /// leaning shading normal sends to the wrong side may come out anywhere. Of the kind of material, and not of
    /// its numbers: all wavelengths must have the same answer.
    fn is_matt(&self) -> bool {
        false
    }

    /// Whether there is anything but events of delta kind: whether the point can be connected to others.
    fn is_connectable(&self) -> bool {
        true
    }
}

/// A direction drawn by a model, in its local frame.
#[derive(Clone, Copy, Debug)]
pub struct LocalSample {
    /// The direction.
    pub wi: Vec3,
    /// Whether it lies above ([`Crossing::Reflect`]) or below ([`Crossing::Down`]).
    pub crossing: Crossing,
    /// For an event of delta kind what [`Scatter::f`] and [`Scatter::pdf`] cannot tell.
    pub delta: Option<Delta>,
}

/// An event of delta kind: of a direction that only drawing can find.
#[derive(Clone, Copy, Debug)]
pub struct Delta {
    /// The reflectance, or for light that passes the transmittance times η_above / η_below (which makes
    /// it symmetric as `f` is: the radiance of light from below then changes by (η_above / η_below)² in all).
    pub factor: SampledSpectrum,
    /// The event's probability, which is 0 in the lanes that would have gone another way.
    pub probability: LanePdf,
    /// The probability of the same event with its directions exchanged.
    pub reverse: LanePdf,
}

impl LocalSample {
    /// A direction of a density.
    #[inline]
    pub fn smooth(wi: Vec3, crossing: Crossing) -> Self {
        Self { wi, crossing, delta: None }
    }

    /// The direction of an event of delta kind.
    #[inline]
    pub fn delta(wi: Vec3, crossing: Crossing, delta: Delta) -> Self {
        Self { wi, crossing, delta: Some(delta) }
    }
}
