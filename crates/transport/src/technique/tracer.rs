//! The techniques behind one door.

use super::bidirectional::Bidirectional;
use super::first_event::first_event;
use super::path::PathTracer;
use super::{Events, PathSample, Record, Splat};
use crate::sampler::{Block, PrimarySample};
use indigo_film::Sensor;
use indigo_math::{Real, Vec2};
use indigo_scene::Scene;

/// A technique with the memory that it needs.
#[derive(Clone, Debug)]
pub enum Tracer {
    /// Path tracing.
    Path(PathTracer),
    /// Bidirectional path tracing.
    Bidirectional(Box<Bidirectional>),
}

/// What a sample found, and how to make it a colour.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// Light along the camera ray.
    pub path: PathSample,
    /// The sensor at the sample's wavelengths.
    pub sensor: Sensor,
}

impl Tracer {
    /// The technique that a scene asks for. The part `rendered` of its film gets camera paths.
    pub fn new(is_bidirectional: bool, rendered: Real) -> Self {
        if is_bidirectional {
            Self::Bidirectional(Box::new(Bidirectional::new(rendered)))
        } else {
            Self::Path(PathTracer::default())
        }
    }

    /// Traces the paths of a primary sample whose camera ray comes from a position on the film, from
    /// (0, 0), top left, to (1, 1).
    #[inline]
    pub fn trace(
        &mut self,
        scene: &Scene,
        numbers: &mut impl PrimarySample,
        position: Vec2,
        events: Events,
        record: &mut impl Record,
    ) -> Found {
        let [.., wavelength, time] = numbers.block(Block::FILM);
        let lambda = scene.wavelengths.sample(wavelength);
        record.begin(position, &lambda);
        let [x, y, ..] = numbers.block(Block::LENS);
        let [d0, d1, ..] = numbers.block(Block::DIFFRACTION);
        let camera = scene.camera.sample(position, Vec2::new(x, y), Vec2::new(d0, d1), &lambda, time);
        let path = match self {
            Self::Path(path) => path.trace(scene, numbers, &lambda, &camera, events, record),
            Self::Bidirectional(b) => b.trace(scene, numbers, &lambda, &camera, events, record),
        };
        Found { path, sensor: Sensor::new(&lambda) }
    }

    /// Whether something hides the background from a position on the film, seen through the same point of the lens as by
    /// [`trace`](Self::trace), but without diffraction.
    ///
    /// Coverage is a fact of geometry, the part of a pixel's rays that meet something. It has no wavelength, so there
    /// is no pattern of diffraction that it could be spread by; what composes pictures over each other spreads the light
    /// of both, not the boundary between them. So it is the same whether light is deflected, filtered or neither.
    pub fn covers(&mut self, scene: &Scene, numbers: &mut impl PrimarySample, position: Vec2) -> bool {
        let [.., wavelength, time] = numbers.block(Block::FILM);
        let lambda = scene.wavelengths.sample(wavelength);
        let [x, y, ..] = numbers.block(Block::LENS);
        let camera = scene.camera.ray_at(position, Vec2::new(x, y), time);
        let memory = match self {
            Self::Path(path) => path.memory(),
            Self::Bidirectional(b) => b.memory(),
        };
        first_event(memory, scene, numbers, &lambda, &camera).is_some()
    }

    /// Rays traced so far.
    pub fn rays(&self) -> u64 {
        match self {
            Self::Path(path) => path.rays(),
            Self::Bidirectional(b) => b.rays(),
        }
    }

    /// What the last sample put elsewhere on the film than where its camera ray came from.
    #[inline]
    pub fn splats(&self) -> &[Splat] {
        match self {
            Self::Path(_) => &[],
            Self::Bidirectional(b) => b.splats(),
        }
    }
}
