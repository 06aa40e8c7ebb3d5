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
//! The lens is no surface that light could meet by chance, so there is no t = 0. What shines straight
//! into the lens is left to (0, 2). Weights are those of [`mis`](super::mis).

use super::flight::{Arrival, Flight};
use super::media::{MediaMemory, World};
use super::mis::{Prefix, Step, Weight};
use super::surface::{Surface, emitter_hit, shade};
use super::vertex::Vertex;
use super::visibility::{Point, way, way_to_light};
use super::{Events, PathSample, Record, Splat};
use crate::sampler::{Block, PrimarySample};
use indigo_camera::CameraRay;
use indigo_geom::Ray;
use indigo_light::{Emission, Receiver};
use indigo_math::Real;
use indigo_scatter::{MediumStack, Mode, Scattered};
use indigo_scene::Scene;
use indigo_spectrum::{LanePdf, SampledSpectrum, SampledWavelengths};

/// Vertices before roulette sets in: short paths carry most of the light.
const ROULETTE_FROM: u32 = 3;
/// A vertex of the camera's path is joined to about this many of the light's path at most, so that
/// very long paths cost no more than their length.
const JOINTS: usize = 16;

/// Bidirectional path tracing, with the memory that it needs.
#[derive(Clone, Debug)]
pub struct Bidirectional {
    media: MediaMemory,
    light_path: LightPath,
}

/// What a sample's light path left behind.
#[derive(Clone, Debug)]
struct LightPath {
    vertices: Vec<LightVertex>,
    splats: Vec<Splat>,
    /// Density of film positions, over that of the film as a whole.
    film_density: Real,
}

/// A vertex of the light's path from its second one on.
#[derive(Clone, Copy, Debug)]
struct LightVertex {
    vertex: Vertex,
    /// Light that arrives, over the hero's density.
    beta: SampledSpectrum,
    prefix: Prefix,
}

/// What does not change along a sample.
struct Sample<'a> {
    world: World<'a>,
    camera: &'a CameraRay,
    events: Events,
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
        let light_path = LightPath { vertices: vec![], splats: vec![], film_density: 1.0 / rendered };
        Self { media: MediaMemory::default(), light_path }
    }

    /// What the last sample put elsewhere on the film than where its camera ray came from.
    pub fn splats(&self) -> &[Splat] {
        &self.light_path.splats
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
        let sample = Sample { world: self.media.world(scene, lambda), camera, events };
        self.light_path.trace(&sample, numbers, record);
        self.light_path.trace_camera(&sample, numbers, record)
    }
}

impl LightPath {
    fn trace(&mut self, sample: &Sample, numbers: &mut impl PrimarySample, record: &mut impl Record) {
        self.vertices.clear();
        self.splats.clear();
        let world = &sample.world;
        let scene = world.scene;
        let [u0, u1, u2, _] = numbers.block(Block::EMISSION);
        let [_, _, v0, v1] = numbers.block(Block::LENS);
        let Some(emission) = scene.lights.sample_emission([u0, u1, u2], [v0, v1], world.lambda) else {
            return;
        };
        let mut beta = emission.throughput();
        let initial = beta.max_lane();
        if beta.is_black() {
            return;
        }
        let cos = emission.point.map_or(1.0, |p| emission.direction.dot(p.n));
        let mut step = Step::from_light(emission.pdf.first, emission.pdf.second, cos);
        let mut flight = leave_lamp(world, &emission);
        let (mut events, mut number) = (0, 0);
        loop {
            let arrival = flight.advance(world, || numbers.block(Block::connect(number))[3]);
            let wo = -flight.ray.d;
            let (vertex, u) = match &arrival {
                Arrival::Environment => return,
                Arrival::Medium(p) => {
                    let u = numbers.block(Block::light_scatter(number));
                    (Vertex::in_medium(world, *p, wo, flight.media), u)
                }
                Arrival::Surface(at) => {
                    let u = numbers.block(Block::light_scatter(number));
                    match shade(world, at, wo, &flight.media, u[3]) {
                        Surface::Scatters(vertex) => (vertex, u),
                        Surface::Unseen(media) => {
                            flight.pass(world, at, media);
                            number += 1;
                            continue;
                        }
                    }
                }
            };
            let (reach, free) = (vertex.reach(wo), flight.passage.free);
            // Along the surface: such a vertex has no density.
            if reach.hero() == 0.0 {
                return;
            }
            events += 1;
            let is_first = events == 1;
            let mut prefix = if is_first && emission.point.is_none() {
                step.arrive_from_environment(reach, free)
            } else {
                step.arrive(flight.length() * flight.length(), reach, free)
            };
            if is_first {
                let drawn = scene.lights.pdf_sample_of(&emission, &vertex.receiver());
                prefix.before *= drawn / emission.pdf.first;
            }
            beta *= flight.passage.weight();
            if let Some(collision) = vertex.collision() {
                beta = beta.times(collision);
            }
            let light = LightVertex { vertex, beta, prefix };
            if vertex.is_connectable() {
                self.splat(sample, &light, events, record);
            }
            if events >= sample.events.most {
                return;
            }
            self.vertices.push(light);
            if events >= ROULETTE_FROM {
                let [u, ..] = numbers.block(Block::connect(number));
                let chance = (beta.max_lane() / (prefix.ratio.mean() * initial)).min(1.0);
                if u >= chance {
                    return;
                }
                beta *= 1.0 / chance;
            }
            let Some(next) = vertex.sample([u[0], u[1], u[2]], Mode::Importance) else { return };
            beta *= next.weight;
            if beta.is_black() {
                return;
            }
            step = go_on(&prefix, &next, &vertex);
            flight = vertex.leave(world, next.wi);
            number += 1;
        }
    }

    /// Strategy (s, 1): joins a vertex of the light's path to the lens.
    fn splat(&mut self, sample: &Sample, light: &LightVertex, events: u32, record: &mut impl Record) {
        if !sample.events.holds(events) {
            return;
        }
        let Sample { world, camera, .. } = sample;
        let scene = world.scene;
        let to_lens = camera.origin - light.vertex.point.p;
        let distance2 = to_lens.length2();
        if distance2 == 0.0 {
            return;
        }
        let wi = to_lens / distance2.sqrt();
        let Some(film) = scene.camera.film_position(camera.origin, -wi) else { return };
        // Where the light falls that the lens sends to `film.position` when it is deflected.
        let position = film.position - camera.offset;
        // Only what falls on the film is worth a ray.
        if !(position.x >= 0.0 && position.x <= 1.0 && position.y >= 0.0 && position.y <= 1.0) {
            return;
        }
        let scattered = light.vertex.eval(wi, Mode::Importance);
        if scattered.f_cos.is_black() {
            return;
        }
        let Some(passage) = way(world, &light.vertex, wi, &Point::free(camera.origin)) else { return };
        let pdf = scene.camera.pdf_direction(-wi);
        let found = light.vertex.reach(wi) * passage.free * (pdf * self.film_density / distance2);
        let others = light.prefix.others(found, scattered.pdf_rev);
        let weight = Weight::joint(light.prefix.ratio, others, camera.ratio, LanePdf::ZERO);
        let arrived = light.beta.times(camera.ratio) * passage.transmittance;
        let value = arrived * scattered.f_cos * (film.importance * pdf / distance2);
        record.contribution((events + 1, 1), Some(position), value / weight.mean_ratio, weight.weight);
        self.splats.push(Splat { position, radiance: value * weight.factor() });
    }

    fn trace_camera(
        &self,
        sample: &Sample,
        numbers: &mut impl PrimarySample,
        record: &mut impl Record,
    ) -> PathSample {
        let Sample { world, camera, events } = sample;
        let scene = world.scene;
        let mut radiance = SampledSpectrum::ZERO;
        let mut beta = SampledSpectrum::splat(camera.importance).times(camera.ratio);
        let pdf = scene.camera.pdf_direction(camera.direction) * self.film_density;
        let mut step = Step::from_camera(pdf, camera.ratio);
        let mut from = Receiver::all_round(camera.origin);
        let ray = Ray::new(camera.origin, camera.direction);
        let mut flight = Flight::new(ray.o, ray, scene.camera_media);
        let (mut alpha, mut depth, mut number) = (0.0, 0, 0);
        // By what roulette divides the throughput, so that it sees losses alone.
        let mut expected = camera.importance;
        loop {
            let arrival = flight.advance(world, || numbers.block(Block::connect(number))[2]);
            let wo = -flight.ray.d;
            let free = flight.passage.free;
            let arrived = beta * flight.passage.weight();
            let (vertex, u) = match &arrival {
                Arrival::Environment => {
                    let light = scene.lights.environment(-wo, world.lambda).filter(|_| events.holds(depth));
                    if let Some(light) = light {
                        let prefix = step.arrive_at_environment(free);
                        let drawn = scene.lights.pdf_environment(&from, -wo);
                        let pdf = scene.lights.pdf_emission_environment(-wo, from.p);
                        let densities = [drawn, pdf.first, pdf.second];
                        radiance += found(&prefix, arrived * light, depth, densities, record);
                    }
                    break;
                }
                Arrival::Medium(p) => {
                    (Vertex::in_medium(world, *p, wo, flight.media), numbers.block(Block::scatter(number)))
                }
                Arrival::Surface(at) => {
                    let cos = wo.dot(at.n_g).abs();
                    if cos == 0.0 {
                        break;
                    }
                    let emitter = emitter_hit(at);
                    if events.holds(depth)
                        && let Some(light) = scene.lights.emitted(&emitter, wo, world.lambda)
                    {
                        let distance2 = (at.p - from.p).length2();
                        let prefix = step.arrive(distance2, LanePdf::splat(cos), free);
                        let drawn = scene.lights.pdf_object(&emitter, &from) * cos / distance2;
                        let pdf = scene.lights.pdf_emission_object(&emitter, wo);
                        let densities = [drawn, pdf.first, pdf.second];
                        radiance += found(&prefix, arrived * light, depth, densities, record);
                    }
                    let u = numbers.block(Block::scatter(number));
                    match shade(world, at, wo, &flight.media, u[3]) {
                        Surface::Scatters(vertex) => (vertex, u),
                        Surface::Unseen(media) => {
                            flight.pass(world, at, media);
                            number += 1;
                            continue;
                        }
                    }
                }
            };
            alpha = 1.0;
            if depth == events.most {
                break;
            }
            let length = flight.length();
            let prefix = step.arrive(length * length, vertex.reach(wo), free);
            beta = arrived;
            if let Some(collision) = vertex.collision() {
                beta = beta.times(collision);
            }
            let lights = numbers.block(Block::light(number));
            if vertex.is_connectable() {
                let end = CameraVertex { vertex: &vertex, beta, prefix: &prefix, depth };
                radiance += draw_light(sample, &end, lights, record);
                radiance += self.join(sample, &end, number, numbers, record);
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
            step = go_on(&prefix, &next, &vertex);
            from = vertex.receiver();
            expected /= vertex.compression(world, next.wi);
            flight = vertex.leave(world, next.wi);
            depth += 1;
            number += 1;
        }
        PathSample { radiance, alpha }
    }

    /// Strategies (s, t) with s and t of at least 2: joins a vertex of the camera's path to those of
    /// the light's, or to every `stride`-th of them where they are many.
    fn join(
        &self,
        sample: &Sample,
        end: &CameraVertex,
        number: u32,
        numbers: &mut impl PrimarySample,
        record: &mut impl Record,
    ) -> SampledSpectrum {
        let stride = self.vertices.len().div_ceil(JOINTS).max(1);
        let first = if stride == 1 {
            0
        } else {
            let [_, u, ..] = numbers.block(Block::connect(number));
            ((u * stride as Real) as usize).min(stride - 1)
        };
        let mut sum = SampledSpectrum::ZERO;
        for (i, light) in self.vertices.iter().enumerate().skip(first).step_by(stride) {
            let events = end.depth + 2 + i as u32;
            if events > sample.events.most {
                break;
            }
            if sample.events.holds(events) && light.vertex.is_connectable() {
                sum += join_pair(sample, end, light, i as u32 + 2, record);
            }
        }
        sum * stride as Real
    }
}

/// The way of light that leaves a lamp or enters the scene from its environment, where there is air.
fn leave_lamp(world: &World, emission: &Emission) -> Flight {
    let (Some(point), Some(lamp)) = (&emission.point, emission.lamp()) else {
        let ray = Ray::new(emission.origin, emission.direction);
        return Flight::new(ray.o, ray, MediumStack::AIR);
    };
    let ray = Point::of_light(point).spawn(world.scene, emission.direction);
    Flight::new(point.p, ray, world.scene.media_at_lamp(lamp, ray.o, ray.d))
}

/// Strategy (1, t): draws light towards a vertex of the camera's path.
fn draw_light(
    sample: &Sample,
    end: &CameraVertex,
    u: [Real; 4],
    record: &mut impl Record,
) -> SampledSpectrum {
    let Sample { world, events, .. } = sample;
    let lights = &world.scene.lights;
    if !events.holds(end.depth + 1) {
        return SampledSpectrum::ZERO;
    }
    let p = end.vertex.point.p;
    let Some(light) = lights.sample(&end.vertex.receiver(), [u[0], u[1], u[2]], world.lambda) else {
        return SampledSpectrum::ZERO;
    };
    let response = end.vertex.eval(light.wi, Mode::Radiance);
    let value = end.beta * response.f_cos * light.radiance / light.pdf;
    if value.is_black() {
        return SampledSpectrum::ZERO;
    }
    let Some(passage) = way_to_light(world, end.vertex, &light) else { return SampledSpectrum::ZERO };
    let value = value * passage.transmittance;
    let reach = end.vertex.reach(light.wi) * passage.free;
    // Densities of the light's own point or direction, and of this vertex seen from there.
    let (drawn, reach) = match &light.point {
        Some(to) => {
            let distance2 = (to.p - p).length2();
            (light.pdf * -light.wi.dot(to.n) / distance2, reach / distance2)
        }
        None => (light.pdf, reach),
    };
    let others_camera = end.prefix.others(reach * light.pdf_emission.second, response.pdf_rev);
    let weight = Weight::drawn_light(
        end.prefix.ratio,
        response.pdf * passage.free / light.pdf,
        others_camera,
        light.pdf_emission.first / drawn,
    );
    record.contribution((1, end.depth + 2), None, value / weight.mean_ratio, weight.weight);
    value * weight.factor()
}

fn join_pair(
    sample: &Sample,
    end: &CameraVertex,
    light: &LightVertex,
    s: u32,
    record: &mut impl Record,
) -> SampledSpectrum {
    let to_light = light.vertex.point.p - end.vertex.point.p;
    let distance2 = to_light.length2();
    if distance2 == 0.0 {
        return SampledSpectrum::ZERO;
    }
    let wi = to_light / distance2.sqrt();
    let here = end.vertex.eval(wi, Mode::Radiance);
    if here.f_cos.is_black() {
        return SampledSpectrum::ZERO;
    }
    let there = light.vertex.eval(-wi, Mode::Importance);
    let value = end.beta * light.beta * here.f_cos * there.f_cos / distance2;
    if value.is_black() {
        return SampledSpectrum::ZERO;
    }
    let Some(passage) = way(&sample.world, end.vertex, wi, &light.vertex.point) else {
        return SampledSpectrum::ZERO;
    };
    let value = value * passage.transmittance;
    let free = passage.free / distance2;
    let others_light = light.prefix.others(here.pdf * light.vertex.reach(wi) * free, there.pdf_rev);
    let others_camera = end.prefix.others(there.pdf * end.vertex.reach(wi) * free, here.pdf_rev);
    let weight = Weight::joint(light.prefix.ratio, others_light, end.prefix.ratio, others_camera);
    record.contribution((s, end.depth + 2), None, value / weight.mean_ratio, weight.weight);
    value * weight.factor()
}

/// Strategy (0, t): light that the camera's path met by itself, with the densities of drawing it and of
/// its emission.
fn found(
    prefix: &Prefix,
    value: SampledSpectrum,
    depth: u32,
    [drawn, first, second]: [Real; 3],
    record: &mut impl Record,
) -> SampledSpectrum {
    let weight = if depth == 0 {
        Weight::only(prefix.ratio)
    } else {
        Weight::new(prefix.ratio, prefix.others_at_light(drawn, first, second))
    };
    record.contribution((0, depth + 2), None, value / weight.mean_ratio, weight.weight);
    value * weight.factor()
}

#[inline]
fn go_on(prefix: &Prefix, next: &Scattered, vertex: &Vertex) -> Step {
    prefix.step(next, vertex.reach(next.wi))
}
