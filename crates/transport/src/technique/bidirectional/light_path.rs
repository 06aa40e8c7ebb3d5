//! The path of light from a lamp or the environment, joined to the lens wherever it scatters.

use super::straight::join_source;
use super::{ROULETTE_FROM, Sample};
use crate::sampler::{Block, PrimarySample};
use crate::technique::flight::{Blocks, Flight};
use crate::technique::media::World;
use crate::technique::mis::{Prefix, Step, Weight};
use crate::technique::vertex::Vertex;
use crate::technique::visibility::{Point, way};
use crate::technique::{End, Part, Record, Splat};
use indigo_light::{Emission, Sender};
use indigo_math::{Real, Vec3};
use indigo_scatter::{MediumStack, Mode};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// What a sample's light path left behind.
#[derive(Clone, Debug)]
pub(super) struct LightPath {
    pub vertices: Vec<LightVertex>,
    splats: Vec<Splat>,
    /// The density with which light is drawn for the first vertex, over that of its emission: where the camera's path
    /// comes to it from the side of the light, and from across the surface.
    drawn: [Real; 2],
    /// Density of film positions, over that of the film as a whole.
    pub film_density: Real,
    /// Who sent the light, if there are vertices.
    pub sender: Sender,
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
        let (film_density, sender) = (1.0 / rendered, Sender::Lamp(0));
        Self { vertices: vec![], splats: vec![], drawn: [0.0; 2], film_density, sender }
    }

    /// What is known of a vertex where the path goes on from it in a direction. That light is drawn for the first
    /// one has the density of a receiver on the side to which it goes on, since there the camera's path comes from.
    #[inline]
    pub fn prefix_towards(&self, i: usize, direction: Vec3) -> Prefix {
        let light = &self.vertices[i];
        let mut prefix = light.prefix;
        if i == 0 {
            prefix.before *= self.drawn[usize::from(light.vertex.is_across(direction))];
        }
        prefix
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
        let Some(source) = scene.lights.sample_source(u) else { return };
        self.sender = source.sender();
        self.splats.extend(join_source(sample, &source, self.film_density, record));
        if sample.events.most == 0 {
            return;
        }
        let Some(emission) = scene.lights.emit(&source, [v0, v1], world.lambda) else { return };
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
            let arrival = flight.fly_to_vertex(world, numbers, Blocks::Light, &mut number, |_, _, _| {});
            let Some((vertex, u)) = arrival else { return };
            let (reach, free) = (vertex.reach(flight.back()), flight.passage.free);
            // Along the surface: such a vertex has no density.
            if reach.hero() == 0.0 {
                return;
            }
            events += 1;
            let is_first = events == 1;
            let prefix = if is_first && emission.point.is_none() {
                step.arrive_from_environment(reach, free)
            } else {
                step.arrive(flight.length() * flight.length(), reach, free)
            };
            if is_first {
                let receivers = [flight.back(), flight.ray.d].map(|d| vertex.receiver_towards(d));
                self.drawn =
                    receivers.map(|to| scene.lights.pdf_sample_of(&emission, &to) / emission.pdf.first);
            }
            beta = flight.arrived(beta, &vertex);
            record.vertex(End::Light, vertex.point.p, vertex.is_on_surface());
            self.vertices.push(LightVertex { vertex, beta, prefix });
            let last = self.vertices.len() - 1;
            if vertex.is_connectable() {
                self.splat(sample, last, record);
            }
            if events >= sample.events.most {
                return;
            }
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
            step = self.prefix_towards(last, next.wi).step(&next, vertex.reach(next.wi));
            flight = vertex.leave(world, next.wi);
            number += 1;
        }
    }

    /// Strategy (s, 1): joins a vertex of the light's path to the lens.
    fn splat(&mut self, sample: &Sample, i: usize, record: &mut impl Record) {
        let (light, events) = (&self.vertices[i], i as u32 + 1);
        if !sample.events.holds(events) {
            return;
        }
        let Sample { world, camera, .. } = sample;
        let scene = world.scene;
        let origin = sample.origin_towards(light.vertex.point.p);
        let to_lens = origin - light.vertex.point.p;
        let distance2 = to_lens.length2();
        if distance2 == 0.0 {
            return;
        }
        let distance = distance2.sqrt();
        let wi = to_lens / distance;
        // Only what falls on the film is worth a ray.
        let Some(film) = sample.on_film(origin, -wi) else { return };
        let position = film.position;
        let scattered = light.vertex.eval(wi, Mode::Importance);
        if scattered.f_cos.is_black() {
            return;
        }
        let Some(passage) = way(world, &light.vertex, wi, &Point::free(origin)) else { return };
        let pdf = scene.camera.pdf_direction(-wi, distance, world.time);
        let found = light.vertex.reach(wi) * passage.free * (pdf * self.film_density / distance2);
        let prefix = self.prefix_towards(i, wi);
        let others = prefix.others(found, scattered.pdf_rev);
        let weight = Weight::joint(prefix.ratio, others, camera.ratio, LanePdf::ZERO);
        let arrived = light.beta.times(camera.ratio) * passage.transmittance;
        let value = arrived * scattered.f_cos * (film.importance * pdf / distance2);
        let strategy = (events + 1, 1);
        record.contribution(strategy, Some(position), value / weight.mean_ratio, weight.weight, self.sender);
        self.splats.push(Splat {
            position,
            radiance: value * weight.factor(),
            part: Part::of(strategy, self.sender),
        });
    }
}

/// The way of light that leaves a lamp or enters the scene from its environment, where there is air.
fn leave_lamp(world: &World, emission: &Emission) -> Flight {
    let (Some(point), Some(lamp)) = (&emission.point, emission.lamp()) else {
        let origin =
            if world.scene.lights.portals().is_some() { entry(world, emission) } else { emission.origin };
        return Flight::new(&Point::free(origin), world.ray(origin, emission.direction), MediumStack::AIR);
    };
    let (start, direction) = (Point::of_light(point), emission.direction);
    let media = world.scene.media_at_lamp(lamp, start.spawn(world, direction).o, direction, world.time);
    Flight::new(&start, start.spawn_into(world, direction, &media), media)
}

/// A point before all that stands in the way of light from the environment, the light's own origin where that is one.
///
/// A point beyond the whole scene would do, but for rounding: from kilometres away single precision may miss the portal
/// by which the light was drawn, and only those rays are lost, none won. So the point is as near as can be.
fn entry(world: &World, emission: &Emission) -> Vec3 {
    let mut back = world.ray(emission.origin, -emission.direction);
    let mut origin = back.o;
    while let Some(hit) = world.intersect(&back) {
        // Beyond it by the magnitude of its coordinates: their rounding does not matter then.
        origin = back.at(hit.t + back.at(hit.t).length());
        back = back.beyond(hit.t, 0.0);
    }
    origin
}
