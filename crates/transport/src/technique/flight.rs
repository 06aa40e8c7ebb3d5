//! A path on its way from one vertex to the next, through media and surfaces that are not to be seen.

use super::media::{Passage, World};
use super::surface::{Surface, shade};
use super::vertex::Vertex;
use super::visibility::{Point, plane_distance};
use crate::sampler::{Block, PrimarySample};
use indigo_geom::{Ray, SurfacePoint};
use indigo_math::{Real, Vec3, elementary};
use indigo_scatter::MediumStack;
use indigo_spectrum::SampledSpectrum;

/// A ray of unit direction on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    pub ray: Ray,
    /// The media round it.
    pub media: MediumStack,
    /// What it has passed since it left its vertex.
    pub passage: Passage,
    /// Its vertex, if that is on a surface, until it has passed another.
    from: Option<Vec3>,
    /// Where on the ray its vertex is nearest, and how far it has come.
    start: Real,
    passed: Real,
}

/// Whose numbers decide about a path: the camera's or the light's.
#[derive(Clone, Copy, Debug)]
pub(super) enum Blocks {
    Camera,
    Light,
}

impl Blocks {
    #[inline(always)]
    fn scatter(self, number: u32) -> Block {
        match self {
            Self::Camera => Block::scatter(number),
            Self::Light => Block::light_scatter(number),
        }
    }

    /// Which of the numbers of [`Block::connect`] is the distance at which a medium scatters.
    #[inline(always)]
    fn distance(self) -> usize {
        match self {
            Self::Camera => 2,
            Self::Light => 3,
        }
    }
}

/// What a flight comes to.
enum Arrival {
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
    pub fn new(from: &Point, ray: Ray, media: MediumStack) -> Self {
        let start = from.behind(&ray);
        Self { ray, media, passage: Passage::CLEAR, from: from.on_surface(), start, passed: start }
    }

    /// How far it has come from its vertex, metres. In dense media that may be less than the rounding of the
    /// points themselves.
    #[inline]
    pub fn length(&self) -> Real {
        self.passed - self.start
    }

    /// The direction back to where it came from.
    #[inline]
    pub fn back(&self) -> Vec3 {
        -self.ray.d
    }

    /// Flies until it is scattered; `None` if it leaves the scene. Of every surface that it meets, seen or unseen,
    /// `met` is told first. `number` counts the vertices and what is not seen between them, since each has a
    /// choice of its own where it is part of a blend; a surface that is not seen is no scattering event.
    ///
    /// Gives the vertex, and the numbers by which it scatters.
    #[inline(always)]
    pub fn fly_to_vertex(
        &mut self,
        world: &World,
        numbers: &mut impl PrimarySample,
        blocks: Blocks,
        number: &mut u32,
        mut met: impl FnMut(&Passage, &SurfacePoint, Vec3),
    ) -> Option<(Vertex, [Real; 4])> {
        loop {
            let arrival = self.advance(world, || numbers.block(Block::connect(*number))[blocks.distance()]);
            let wo = self.back();
            match &arrival {
                Arrival::Environment => return None,
                Arrival::Medium(p) => {
                    let vertex = Vertex::in_medium(world, *p, wo, self.media);
                    return Some((vertex, numbers.block(blocks.scatter(*number))));
                }
                Arrival::Surface(at) => {
                    met(&self.passage, at, wo);
                    let u = numbers.block(blocks.scatter(*number));
                    match shade(world, at, wo, &self.media, u[3]) {
                        Surface::Scatters(vertex) => return Some((vertex, u)),
                        Surface::Unseen(media) => self.pass(at, media),
                    }
                    *number += 1;
                }
            }
        }
    }

    /// What a throughput over the hero's density becomes on arrival at a vertex.
    #[inline]
    pub fn arrived(&self, beta: SampledSpectrum, vertex: &Vertex) -> SampledSpectrum {
        let beta = beta * self.passage.weight();
        vertex.collision().map_or(beta, |collision| beta.times(collision))
    }

    /// Goes on to whatever comes first. `u` in [0, 1) is asked for where the medium scatters.
    #[inline]
    fn advance(&mut self, world: &World, u: impl FnOnce() -> Real) -> Arrival {
        let mut ray = self.ray;
        let mut scattered = Real::INFINITY;
        if world.has_media() {
            let scattering = world.medium(self.media.current()).scattering.hero();
            if scattering > 0.0 {
                scattered = self.passed - elementary::ln(1.0 - u()) / scattering;
                ray.t_max = ray.t_max.min(scattered);
            }
        }
        let Some(hit) = world.intersect(&ray) else {
            if world.has_media() {
                self.pass_media(world, scattered - self.passed);
                self.passed = scattered;
            }
            let is_scattered = scattered < Real::INFINITY;
            return if is_scattered { Arrival::Medium(ray.at(scattered)) } else { Arrival::Environment };
        };
        let at = world.scene.accel.surface(&ray, &hit);
        if world.has_media() {
            // Where nothing is scattered the way is that of the ray that leaves the vertex itself.
            let from = self.from.filter(|_| scattered == Real::INFINITY);
            let way = from.and_then(|from| plane_distance(from, ray.d, &at));
            self.pass_media(world, way.unwrap_or(hit.t - self.passed));
        }
        self.passed = hit.t;
        Arrival::Surface(at)
    }

    #[inline]
    fn pass_media(&mut self, world: &World, way: Real) {
        self.passage = self.passage.then(world.passage(&self.media, way));
    }

    /// Goes on beyond the surface that it came to, with other media round it.
    #[inline]
    fn pass(&mut self, at: &SurfacePoint, media: MediumStack) {
        self.ray = self.ray.beyond(self.passed, at.p_error.length());
        self.media = media;
        self.from = None;
    }
}
