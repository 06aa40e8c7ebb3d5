//! What light loses on its way through media, and the density with which a path gets through them.
//!
//! Along a way of length d in a medium, a path is scattered at distance t with density σs e^(−σs t) and gets
//! through with probability e^(−σs d), where σs is the hero's scattering coefficient. Absorption is
//! never drawn but weighs the path: strong and coloured absorption makes no noise. Every lane's density
//! is kept as if it had been the hero (Wilkie et al. 2014, section 3), so strongly coloured scattering has
//! bounded weights: a lane's value is divided by the mean of all lanes' densities.

use indigo_geom::{Hit, Ray};
use indigo_math::{Real, Vec3, elementary};
use indigo_scatter::media::Coefficients;
use indigo_scatter::{Interface, MediumId, MediumStack};
use indigo_scene::Scene;
use indigo_spectrum::{LanePdf, SampledSpectrum, SampledWavelengths};
use std::cell::{Cell, OnceCell};

/// What a technique keeps from sample to sample of the scene that it looks at.
#[derive(Clone, Debug, Default)]
pub struct WorldMemory {
    media: Vec<OnceCell<Coefficients>>,
    rays: Cell<u64>,
}

/// A scene at the wavelengths of a sample.
#[derive(Clone, Copy)]
pub(super) struct World<'a> {
    pub scene: &'a Scene,
    pub lambda: &'a SampledWavelengths,
    /// When all of its rays are traced.
    pub time: Real,
    /// Each medium is baked when it is first asked for.
    media: &'a [OnceCell<Coefficients>],
    rays: &'a Cell<u64>,
}

impl WorldMemory {
    /// Rays traced so far.
    pub(super) fn rays(&self) -> u64 {
        self.rays.get()
    }

    /// The scene at some wavelengths and a time; what was known of others is forgotten.
    #[inline]
    pub(super) fn world<'a>(
        &'a mut self,
        scene: &'a Scene,
        lambda: &'a SampledWavelengths,
        time: Real,
    ) -> World<'a> {
        self.media.clear();
        self.media.resize(scene.media.len(), OnceCell::new());
        World { scene, lambda, time, media: &self.media, rays: &self.rays }
    }
}

impl World<'_> {
    /// A whole half-line at the sample's time.
    #[inline]
    pub fn ray(&self, o: Vec3, d: Vec3) -> Ray {
        Ray { time: self.time, ..Ray::new(o, d) }
    }

    /// The first surface on a ray's way, if any.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.rays.set(self.rays.get() + 1);
        self.scene.accel.intersect(ray)
    }

    /// Whether a surface is on a ray's way.
    #[inline]
    pub fn is_occluded(&self, ray: &Ray) -> bool {
        self.rays.set(self.rays.get() + 1);
        self.scene.accel.occluded(ray)
    }

    /// Whether any medium but air may be met.
    #[inline(always)]
    pub fn has_media(&self) -> bool {
        !self.media.is_empty()
    }

    /// A medium at the sample's wavelengths. Only where there are media.
    #[inline]
    pub fn medium(&self, id: MediumId) -> &Coefficients {
        self.media[id.index()].get_or_init(|| self.scene.media[id.index()].at(self.lambda))
    }

    /// The indices of refraction between two sides of a surface.
    #[inline]
    pub fn interface(&self, above: &MediumStack, below: &MediumStack) -> Interface {
        if !self.has_media() {
            return Interface::NONE;
        }
        Interface { above: self.medium(above.current()).eta, below: self.medium(below.current()).eta }
    }

    /// A way of some length, metres, that may be infinite, through the medium that is current.
    #[inline]
    pub fn passage(&self, media: &MediumStack, length: Real) -> Passage {
        if media.current() == MediumId::AIR {
            return Passage::CLEAR;
        }
        Passage::through(self.medium(media.current()), length)
    }
}

/// A way through media without being scattered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    /// The share of light that gets through.
    pub transmittance: SampledSpectrum,
    /// The probability with which a path is not scattered, in each lane.
    pub free: LanePdf,
}

impl Passage {
    /// A way through nothing.
    pub const CLEAR: Self = Self { transmittance: SampledSpectrum::ONE, free: LanePdf::ONE };

    #[inline]
    fn through(medium: &Coefficients, length: Real) -> Self {
        // A clear medium stays clear for ever: no 0 times infinity.
        let length = length.min(Real::MAX);
        let decay = |c: Real| elementary::exp(-c * length);
        let free =
            if medium.scattering.is_black() { LanePdf::ONE } else { LanePdf(medium.scattering.0.map(decay)) };
        let absorbed =
            if medium.absorption.is_black() { SampledSpectrum::ONE } else { medium.absorption.map(decay) };
        Self { transmittance: absorbed.times(free), free }
    }

    /// This way and then another.
    #[inline]
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self { transmittance: self.transmittance * next.transmittance, free: self.free * next.free }
    }

    /// What a path's throughput, over the hero's density, is multiplied by.
    #[inline]
    pub fn weight(&self) -> SampledSpectrum {
        self.transmittance / self.free.hero()
    }
}

/// The media on the two sides of a surface whose inside holds `medium`, for a path that comes with
/// `media` from the back, `from_inside`, or from the front.
///
/// From the back one is inside, even where the path does not know: then its surface is not closed or it began at
/// a place that no probe could tell. So it looks the same from both sides.
#[inline]
pub(super) fn sides(
    medium: Option<MediumId>,
    media: &MediumStack,
    from_inside: bool,
) -> (MediumStack, MediumStack) {
    match medium {
        None => (*media, *media),
        Some(m) if !from_inside => (*media, media.entered(m)),
        Some(m) if media.contains(m) => (*media, media.left(m)),
        Some(m) => (media.entered(m), *media),
    }
}
