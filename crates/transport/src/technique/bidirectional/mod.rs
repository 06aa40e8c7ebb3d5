//! Bidirectional path tracing (Lafortune & Willems 1993; Veach & Guibas 1994).
//!
//! A light path y_0 y_1 … begins at a lamp, a camera path x_0 x_1 … at the lens. Strategy (s, t) joins s
//! vertices of the one and t of the other:
//!
//! - (0, t): the camera's path meets a light by itself;
//! - (1, t): light is drawn towards a vertex of the camera's path, anew for each;
//! - (s, t): a vertex of each is joined to one of the other;
//! - (s, 1): a vertex of the light's path is joined to the lens and falls anywhere on the film.
//!
//! The lens is no surface that light could meet by chance, so there is no t = 0. Weights are those of `mis`, and of
//! `straight` for light that shines straight into the lens.

mod joints;
mod light_path;
mod straight;

use super::flight::{Blocks, Flight};
use super::media::{World, WorldMemory};
use super::mis::{Prefix, Step};
use super::vertex::Vertex;
use super::visibility::Point;
use super::{DIRECT, End, Events, PathSample, Record, Splat};
use crate::sampler::{Block, PrimarySample};
use indigo_camera::{CameraRay, FilmPosition};
use indigo_light::Receiver;
use indigo_math::{Real, Vec3};
use indigo_scatter::Mode;
use indigo_scene::Scene;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};
use joints::{Arrived, draw_light, join, meet_environment, meet_lamp};
use light_path::LightPath;

/// Vertices before roulette sets in: short paths carry most of the light.
const ROULETTE_FROM: u32 = 3;

/// Bidirectional path tracing, with the memory that it needs.
#[derive(Clone, Debug)]
pub struct Bidirectional {
    memory: WorldMemory,
    light_path: LightPath,
}

/// What does not change along a sample.
struct Sample<'a> {
    world: World<'a>,
    camera: &'a CameraRay,
    events: Events,
}

impl Sample<'_> {
    /// Where the camera's ray begins that sees a point: at the sample's point of the lens, if there is one.
    #[inline]
    fn origin_towards(&self, p: Vec3) -> Vec3 {
        self.world.scene.camera.origin_towards(p, self.camera.origin, self.camera.time)
    }

    /// Where light falls that comes from a unit direction to a point where rays begin, and is deflected there;
    /// `None` where that is beside the film.
    #[inline]
    fn on_film(&self, origin: Vec3, from: Vec3) -> Option<FilmPosition> {
        let film = self.world.scene.camera.film_position(origin, from, self.camera.time)?;
        let position = film.position - self.camera.offset;
        let is_on = |x: Real| (0.0..=1.0).contains(&x);
        (is_on(position.x) && is_on(position.y)).then_some(FilmPosition { position, ..film })
    }
}

/// A vertex of the camera's path.
struct CameraVertex<'a> {
    vertex: &'a Vertex,
    beta: SampledSpectrum,
    prefix: &'a Prefix,
    /// Scattering events before this vertex.
    depth: u32,
}

impl Bidirectional {
    /// For a film of which the part `rendered` (1: all of it) gets camera paths.
    pub fn new(rendered: Real) -> Self {
        let light_path = LightPath::new(rendered);
        Self { memory: WorldMemory::default(), light_path }
    }

    /// Rays traced so far.
    pub fn rays(&self) -> u64 {
        self.memory.rays()
    }

    /// Its memory, for rays of other kinds.
    pub(super) fn memory(&mut self) -> &mut WorldMemory {
        &mut self.memory
    }

    /// What the last sample put elsewhere on the film than where its camera ray came from.
    pub fn splats(&self) -> &[Splat] {
        self.light_path.splats()
    }

    /// Traces the paths of a sample.
    pub fn trace(
        &mut self,
        scene: &Scene,
        numbers: &mut impl PrimarySample,
        lambda: &SampledWavelengths,
        camera: &CameraRay,
        events: Events,
        record: &mut impl Record,
    ) -> PathSample {
        let sample = Sample { world: self.memory.world(scene, lambda, camera.time), camera, events };
        self.light_path.trace(&sample, numbers, record);
        trace_camera(&sample, &self.light_path, numbers, record)
    }
}

fn trace_camera(
    sample: &Sample,
    light_path: &LightPath,
    numbers: &mut impl PrimarySample,
    record: &mut impl Record,
) -> PathSample {
    let Sample { world, camera, events } = sample;
    let scene = world.scene;
    let mut background = SampledSpectrum::ZERO;
    // Direct and indirect.
    let mut radiance = [SampledSpectrum::ZERO; 2];
    let kind = |events: u32| usize::from(events > DIRECT);
    let mut beta = SampledSpectrum::splat(camera.importance).times(camera.ratio);
    // At a distance of 1 a density over area is the same number as one over solid angle.
    let pdf = scene.camera.pdf_direction(camera.direction, 1.0, camera.time) * light_path.film_density;
    let mut step = Step::from_camera(pdf, camera.ratio, scene.camera.is_parallel());
    let mut from = Receiver::all_round(camera.origin);
    let ray = world.ray(camera.origin, camera.direction);
    let mut flight = Flight::new(&Point::free(ray.o), ray, scene.camera_media_along(&ray));
    let (mut alpha, mut depth, mut number) = (0.0, 0, 0);
    // By what roulette divides the throughput, so that it sees losses alone.
    let mut expected = camera.importance;
    loop {
        let arrival = flight.fly_to_vertex(world, numbers, Blocks::Camera, &mut number, |passage, at, wo| {
            if events.holds(depth) {
                let arrived = Arrived { step: &step, from: &from, beta, passage, depth };
                radiance[kind(depth)] += meet_lamp(sample, &arrived, at, wo, record);
            }
        });
        let arrived = Arrived { step: &step, from: &from, beta, passage: &flight.passage, depth };
        let Some((vertex, u)) = arrival else {
            if events.holds(depth) {
                let met = if depth == 0 { &mut background } else { &mut radiance[kind(depth)] };
                *met += meet_environment(sample, &arrived, flight.ray.d, record);
            }
            break;
        };
        alpha = 1.0;
        record.vertex(End::Camera, vertex.point.p, vertex.is_on_surface());
        if depth == events.most {
            break;
        }
        let (length, reach) = (flight.length(), vertex.reach(flight.back()));
        // Along the surface: such a vertex has no density.
        if reach.hero() == 0.0 {
            break;
        }
        let prefix = step.arrive(length * length, reach, flight.passage.free);
        beta = flight.arrived(beta, &vertex);
        let lights = numbers.block(Block::light(number));
        if vertex.is_connectable() {
            let end = CameraVertex { vertex: &vertex, beta, prefix: &prefix, depth };
            radiance[kind(depth + 1)] += draw_light(sample, &end, lights, record);
            // Scattered at least once on each side.
            radiance[1] += join(sample, light_path, &end, number, numbers, record);
        }
        if depth >= ROULETTE_FROM {
            let chance = (beta.max_lane() / (prefix.ratio.mean() * expected)).min(1.0);
            if lights[3] >= chance {
                break;
            }
            beta *= 1.0 / chance;
        }
        let Some(next) = vertex.sample([u[0], u[1], u[2]], Mode::Radiance) else { break };
        beta *= next.weight;
        if beta.is_black() {
            break;
        }
        step = prefix.step(&next, vertex.reach(next.wi));
        from = vertex.receiver();
        expected /= vertex.compression(world, next.wi);
        flight = vertex.leave(world, next.wi);
        depth += 1;
        number += 1;
    }
    let [direct, indirect] = radiance;
    PathSample { background, direct, indirect, alpha }
}
