//! A point at which a path is scattered: of a surface, or inside a medium.

use super::flight::Flight;
use super::media::World;
use super::visibility::Point;
use indigo_geom::SurfacePoint;
use indigo_light::Receiver;
use indigo_math::{Real, Vec3};
use indigo_scatter::phase::Lobe;
use indigo_scatter::{Evaluation, MediumStack, Mode, Phase, Scattered, ShadingPoint};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// A point at which a path is scattered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    /// Where, render space.
    pub point: Point,
    model: Model,
    /// The media on the side from which the path came, and on the other one; in a medium both are the same.
    above: MediumStack,
    below: MediumStack,
}

#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "a path uses no heap")]
enum Model {
    Surface(ShadingPoint),
    Medium { wo: Vec3, phase: Lobe, scattering: LanePdf },
}

impl Vertex {
    /// On a surface between media.
    #[inline]
    pub fn on_surface(
        at: &SurfacePoint,
        shading: &ShadingPoint,
        above: MediumStack,
        below: MediumStack,
    ) -> Self {
        Self { point: Point::of_surface(at), model: Model::Surface(*shading), above, below }
    }

    /// In a medium, reached by a flight that goes in direction `-wo`.
    #[inline]
    pub fn in_medium(world: &World, p: Vec3, wo: Vec3, media: MediumStack) -> Self {
        let medium = world.medium(media.current());
        let scattering = LanePdf(medium.scattering.0);
        let model = Model::Medium { wo, phase: medium.phase, scattering };
        Self { point: Point::free(p), model, above: media, below: media }
    }

    /// The point as the lights know it: on a surface lit from the side from which the path came.
    #[inline]
    pub fn receiver(&self) -> Receiver {
        let p = self.point.p;
        match &self.model {
            Model::Surface(s) if s.lets_through() => Receiver::lit_through(p, s.n_g()),
            Model::Surface(s) => Receiver::facing(p, s.n_g()),
            Model::Medium { .. } => Receiver::all_round(p),
        }
    }

    /// Whether it lies on a surface, and not in a medium.
    pub fn is_on_surface(&self) -> bool {
        matches!(self.model, Model::Surface(_))
    }

    /// The shading normal on the side from which the path came; none in a medium.
    pub fn normal(&self) -> Option<Vec3> {
        match &self.model {
            Model::Surface(s) => Some(s.n_s()),
            Model::Medium { .. } => None,
        }
    }

    /// The same on the side to which a direction leads.
    #[inline]
    pub fn receiver_towards(&self, direction: Vec3) -> Receiver {
        let receiver = self.receiver();
        if self.is_across(direction) { Receiver { n: -receiver.n, ..receiver } } else { receiver }
    }

    /// What turns a density in solid angle as seen from elsewhere, over squared distance, into that of this
    /// vertex: the cosine to the surface's normal, or the coefficient with which the medium scatters.
    #[inline]
    pub fn reach(&self, direction: Vec3) -> LanePdf {
        match &self.model {
            Model::Surface(s) => LanePdf::splat(direction.dot(s.n_g()).abs()),
            Model::Medium { scattering, .. } => *scattering,
        }
    }

    /// What is left of [`reach`](Self::reach) in the throughput: the medium's coefficient over the hero's.
    #[inline]
    pub fn collision(&self) -> Option<LanePdf> {
        match &self.model {
            Model::Surface(_) => None,
            Model::Medium { scattering, .. } => Some(*scattering / scattering.hero()),
        }
    }

    /// Whether light can be scattered into directions that are given.
    #[inline]
    pub fn is_connectable(&self) -> bool {
        match &self.model {
            Model::Surface(s) => s.is_connectable(),
            Model::Medium { .. } => true,
        }
    }

    /// The scattering function, times cosine on surfaces, and both densities for a direction.
    #[inline]
    pub fn eval(&self, wi: Vec3, mode: Mode) -> Evaluation {
        match &self.model {
            Model::Surface(s) => s.eval(wi, mode),
            Model::Medium { wo, phase, .. } => {
                let pdf = phase.pdf(*wo, wi);
                Evaluation { f_cos: SampledSpectrum(pdf.0), pdf, pdf_rev: pdf }
            }
        }
    }

    /// Draws a direction; `None` where the light is absorbed.
    #[inline]
    pub fn sample(&self, u: [Real; 3], mode: Mode) -> Option<Scattered> {
        match &self.model {
            Model::Surface(s) => s.sample(u, mode),
            Model::Medium { wo, phase, .. } => {
                let wi = phase.sample(*wo, [u[0], u[1]]);
                let pdf = phase.pdf(*wo, wi);
                let weight = SampledSpectrum((pdf / pdf.hero()).0);
                let (is_delta, is_transmitted) = (false, false);
                Some(Scattered { wi, weight, pdf, pdf_rev: pdf, is_delta, is_transmitted })
            }
        }
    }

    /// Whether a direction leads through the surface, away from the side from which the path came.
    #[inline]
    pub fn is_across(&self, direction: Vec3) -> bool {
        matches!(&self.model, Model::Surface(s) if direction.dot(s.n_g()) < 0.0)
    }

    /// The media into which a direction leads.
    #[inline]
    pub fn media_towards(&self, direction: Vec3) -> &MediumStack {
        if self.is_across(direction) { &self.below } else { &self.above }
    }

    /// By what refraction into a direction divides radiance, (η_there / η_here)²: light is not lost by it, so
    /// roulette must not take it for a loss. Of the hero.
    #[inline]
    pub fn compression(&self, world: &World, direction: Vec3) -> Real {
        let [here, there] = [self.above.current(), self.media_towards(direction).current()];
        if here == there {
            return 1.0;
        }
        let quotient = world.medium(there).eta.hero() / world.medium(here).eta.hero();
        quotient * quotient
    }

    /// Leaves in a direction.
    #[inline]
    pub fn leave(&self, world: &World, direction: Vec3) -> Flight {
        let media = *self.media_towards(direction);
        Flight::new(&self.point, self.point.spawn_into(world, direction, &media), media)
    }
}
