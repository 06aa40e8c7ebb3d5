//! What is asked of lights, and what they answer.

use indigo_math::{Real, Vec3};
use indigo_spectrum::SampledSpectrum;

/// Where light is gathered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Render-space position.
    pub p: Vec3,
    /// Unit normal on the side from which light counts; zero where it counts from all sides.
    pub n: Vec3,
    /// Whether light counts from behind, too.
    pub is_lit_through: bool,
}

impl Receiver {
    /// A surface that is lit on the side of a unit normal alone.
    #[inline]
    pub fn facing(p: Vec3, n: Vec3) -> Self {
        Self { p, n, is_lit_through: false }
    }

    /// A surface that lets light through. Distant lights may leave out what comes from behind it, which scattering
    /// finds.
    #[inline]
    pub fn lit_through(p: Vec3, n: Vec3) -> Self {
        Self { p, n, is_lit_through: true }
    }

    /// A point that is lit from all sides: in a medium.
    #[inline]
    pub fn all_round(p: Vec3) -> Self {
        Self { p, n: Vec3::ZERO, is_lit_through: true }
    }

    /// Cosine under which light from a unit direction arrives, below 0 where it does not count; `None` where it is the
    /// same from everywhere.
    #[inline]
    pub(crate) fn cos_arriving(&self, from: Vec3) -> Option<Real> {
        if self.n == Vec3::ZERO {
            return None;
        }
        let cos = self.n.dot(from);
        Some(if self.is_lit_through { cos.abs() } else { cos })
    }
}

/// A point of an object that may be a lamp, as a ray met it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterHit {
    /// The object.
    pub object: u32,
    /// The triangle of its mesh.
    pub triangle: u32,
    /// Barycentric coordinates of vertices 1 and 2.
    pub bary: (Real, Real),
    /// Render-space position.
    pub p: Vec3,
    /// Unit normal of the front.
    pub n: Vec3,
}

/// A point drawn on a lamp.
#[derive(Clone, Copy, Debug)]
pub struct EmitterPoint {
    /// Render-space position.
    pub p: Vec3,
    /// Bound on the error of `p` and of where a ray finds the lamp, for each axis.
    pub p_error: Vec3,
    /// Unit normal of the emitting side.
    pub n: Vec3,
    /// The triangle of the lamp's mesh.
    pub triangle: u32,
    /// Barycentric coordinates of vertices 1 and 2.
    pub bary: (Real, Real),
}

/// Light that could arrive at a point, visibility not yet known.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// The point on a lamp and its surroundings; `None` for the environment.
    pub point: Option<EmitterPoint>,
    /// Radiance, W m^-3 sr^-1.
    pub radiance: SampledSpectrum,
    /// Density in solid angle (1/sr), the choice of the light included.
    pub pdf: Real,
    /// Densities with which [`LightTable::sample_emission`](crate::LightTable::sample_emission) would
    /// send the same light here.
    pub pdf_emission: EmissionPdf,
    /// Who sends it.
    pub sender: Sender,
}

/// Who sends light: that is all that its group depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sender {
    /// The lamp of a number.
    Lamp(u32),
    /// The environment, in a unit direction towards it.
    Environment(Vec3),
}

/// Where a light path begins: at a point of a lamp, or in a direction of the environment.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    /// Its place.
    pub(crate) place: Place,
    /// Density over the lamp's area (1/m²), or of the direction (1/sr); the choice of the light included.
    pub(crate) pdf: Real,
    /// Probability that a light path begins on the lamp, or in the environment.
    pub chance: Real,
}

impl Source {
    /// Who sends the light.
    #[inline]
    pub fn sender(&self) -> Sender {
        match self.place {
            Place::Lamp(number, _) => Sender::Lamp(number),
            Place::Environment(towards, _) => Sender::Environment(towards),
        }
    }

    /// The point of the lamp; `None` for the environment.
    #[inline]
    pub fn point(&self) -> Option<Vec3> {
        match &self.place {
            Place::Lamp(_, point) => Some(point.p),
            Place::Environment(..) => None,
        }
    }
}

/// A [`Source`] as it is seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct SourceView {
    /// Unit direction towards it.
    pub wi: Vec3,
    /// The point on a lamp, with the normal of the side that is seen; `None` for the environment.
    pub point: Option<EmitterPoint>,
    /// The source's density in solid angle (1/sr).
    pub pdf: Real,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Place {
    /// Number of the lamp, and a point whose normal is that of the front.
    Lamp(u32, EmitterPoint),
    /// Unit direction towards the light, and a fresh number in [0, 1) to choose where it enters.
    Environment(Vec3, f64),
}

/// Light that leaves a lamp or enters the scene from its environment.
///
/// The two densities are of the first two vertices of a light path. Of a lamp they are those of the
/// point, over area (1/m²), and of the direction (1/sr). The environment lies in directions: there the
/// first density is that of the direction (1/sr), and the second that of where its light enters, over
/// area across the direction (1/m²).
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// Where the light begins, render space; for the environment a point on its way, beyond the scene unless
    /// there are portals ([`LightTable::portals`](crate::LightTable::portals)): then things may stand before it.
    pub origin: Vec3,
    /// The point on a lamp; `None` for the environment.
    pub point: Option<EmitterPoint>,
    /// Unit direction of the light's travel.
    pub direction: Vec3,
    /// Radiance, W m^-3 sr^-1.
    pub radiance: SampledSpectrum,
    /// Both densities.
    pub pdf: EmissionPdf,
    /// Number of the lamp; of no meaning for the environment.
    pub(crate) lamp: u32,
}

/// Densities of [`Emission`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionPdf {
    /// Of the point of a lamp (1/m²), or of the direction towards the environment (1/sr); the choice
    /// of the light included.
    pub first: Real,
    /// Of the direction from a lamp (1/sr), or of the place across it (1/m²).
    pub second: Real,
}

impl EmissionPdf {
    /// Of what is never drawn.
    pub const NEVER: Self = Self { first: 0.0, second: 0.0 };
}

impl Emission {
    /// Number of the lamp; none for the environment.
    #[inline]
    pub fn lamp(&self) -> Option<u32> {
        self.point.as_ref().map(|_| self.lamp)
    }

    /// What a light path carries at first: radiance times cosine over both densities.
    #[inline]
    pub fn throughput(&self) -> SampledSpectrum {
        let cos = self.point.map_or(1.0, |p| self.direction.dot(p.n));
        self.radiance * (cos / (self.pdf.first * self.pdf.second))
    }
}
