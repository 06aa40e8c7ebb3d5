//! The path of light from a lamp or the environment, joined to the lens wherever it scatters.

use super::{ROULETTE_FROM, Sample, go_on};
use crate::sampler::{Block, PrimarySample};
use crate::technique::flight::{Arrival, Flight};
use crate::technique::media::World;
use crate::technique::mis::{Prefix, Step, Weight};
use crate::technique::surface::{Surface, shade};
use crate::technique::vertex::Vertex;
use crate::technique::visibility::{Point, way};
use crate::technique::{DIRECT, Record, Splat};
use indigo_geom::Ray;
use indigo_light::Emission;
use indigo_math::Real;
use indigo_scatter::{MediumStack, Mode};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// What a sample's light path left behind.
#[derive(Clone, Debug)]
pub(super) struct LightPath {
    pub vertices: Vec<LightVertex>,
    splats: Vec<Splat>,
    /// Density of film positions, over that of the film as a whole.
    pub film_density: Real,
}

/// A vertex of the light's path from its second one on.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightVertex {
    pub vertex: Vertex,
    /// Light that arrives, over the hero's density.
    pub beta: SampledSpectrum,
    pub prefix: Prefix,
}

impl LightPath {
    /// Without vertices, for a film of which the part `rendered` gets camera paths.
    pub fn new(rendered: Real) -> Self {
        Self { vertices: vec![], splats: vec![], film_density: 1.0 / rendered }
    }

    /// What the last path put on the film.
    pub fn splats(&self) -> &[Splat] {
        &self.splats
    }

    /// Traces the path of a sample.
    pub fn trace(&mut self, sample: &Sample, numbers: &mut impl PrimarySample, record: &mut impl Record) {
        self.vertices.clear();
        self.splats.clear();
        let world = &sample.world;
        let scene = world.scene;
        let u = numbers.block(Block::EMISSION);
        let [_, _, v0, v1] = numbers.block(Block::LENS);
        let Some(emission) = scene.lights.sample_emission(u, [v0, v1], world.lambda) else {
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
        self.splats.push(Splat { position, radiance: value * weight.factor(), is_indirect: events > DIRECT });
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
