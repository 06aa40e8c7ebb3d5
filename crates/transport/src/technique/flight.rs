//! A path on its way from one vertex to the next, through media and surfaces that are not to be seen.

use super::media::{Passage, World};
use indigo_geom::{Ray, SurfacePoint};
use indigo_math::{Real, Vec3, elementary};
use indigo_scatter::MediumStack;

/// A ray of unit direction on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    pub ray: Ray,
    /// The media round it.
    pub media: MediumStack,
    /// What it has passed since it left its vertex.
    pub passage: Passage,
    /// Where on the ray its vertex lies, and how far it has come.
    start: Real,
    passed: Real,
}

/// What a flight comes to.
pub(super) enum Arrival {
    /// Nothing for ever.
    Environment,
    /// A surface.
    Surface(SurfacePoint),
    /// A point of the medium at which it is scattered.
    Medium(Vec3),
}

impl Flight {
    /// From a point that the ray leaves a little way off: what it passes counts from the point itself.
    #[inline]
    pub fn new(from: Vec3, ray: Ray, media: MediumStack) -> Self {
        let start = (from - ray.o).dot(ray.d);
        Self { ray, media, passage: Passage::CLEAR, start, passed: start }
    }

    /// How far it has come from its vertex, metres. In dense media that may be less than the rounding of the
    /// points themselves.
    #[inline]
    pub fn length(&self) -> Real {
        self.passed - self.start
    }

    /// Goes on to whatever comes first. `u` in [0, 1) is asked for where the medium scatters.
    #[inline]
    pub fn advance(&mut self, world: &World, u: impl FnOnce() -> Real) -> Arrival {
        let mut ray = self.ray;
        let mut scattered = Real::INFINITY;
        if world.has_media() {
            let scattering = world.medium(self.media.current()).scattering.hero();
            if scattering > 0.0 {
                scattered = self.passed - elementary::ln(1.0 - u()) / scattering;
                ray.t_max = ray.t_max.min(scattered);
            }
        }
        let hit = world.scene.accel.intersect(&ray);
        let t = hit.as_ref().map_or(scattered, |hit| hit.t);
        if world.has_media() {
            self.passage = self.passage.then(world.passage(&self.media, t - self.passed));
            self.passed = t;
        }
        match hit {
            Some(hit) => {
                let at = world.scene.accel.surface(&ray, &hit);
                self.passed = hit.t;
                Arrival::Surface(at)
            }
            None if scattered < Real::INFINITY => Arrival::Medium(ray.at(scattered)),
            None => Arrival::Environment,
        }
    }

    /// Goes on beyond the surface that it came to, with other media round it.
    #[inline]
    pub fn pass(&mut self, world: &World, at: &SurfacePoint, media: MediumStack) {
        self.ray = self.ray.beyond(self.passed, at.p_error.length().max(world.scene.nudge_m));
        self.media = media;
    }
}
