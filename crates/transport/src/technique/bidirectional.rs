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

use super::mis::{Prefix, Step, Weight};
use super::surface::{emitter_hit, shade};
use super::visibility::{Point, continue_beyond, is_lit, is_unblocked, spawn};
use super::{Events, PathSample, Record, Splat};
use crate::sampler::{Block, PrimarySample};
use indigo_camera::CameraRay;
use indigo_geom::{Ray, SurfacePoint};
use indigo_light::Receiver;
use indigo_math::Real;
use indigo_scatter::{Mode, Scattered, ShadingPoint};
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
    vertices: Vec<LightVertex>,
    splats: Vec<Splat>,
    /// Density of film positions, over that of the film as a whole.
    film_density: Real,
}

/// A vertex of the light's path from its second one on.
#[derive(Clone, Copy, Debug)]
struct LightVertex {
    at: SurfacePoint,
    shading: ShadingPoint,
    /// Light that arrives, over the hero's density.
    beta: SampledSpectrum,
    prefix: Prefix,
}

/// What does not change along a sample.
struct Sample<'a> {
    scene: &'a Scene,
    lambda: &'a SampledWavelengths,
    camera: &'a CameraRay,
    events: Events,
}

/// A vertex of the camera's path.
struct CameraVertex<'a> {
    at: &'a SurfacePoint,
    shading: &'a ShadingPoint,
    beta: SampledSpectrum,
    prefix: &'a Prefix,
    /// Scattering events before this vertex.
    depth: u32,
}

impl Bidirectional {
    /// For a film of which the part `rendered` (1: all of it) gets camera paths.
    pub fn new(rendered: Real) -> Self {
        Self { vertices: vec![], splats: vec![], film_density: 1.0 / rendered }
    }

    /// What the last sample put elsewhere on the film than where its camera ray came from.
    pub fn splats(&self) -> &[Splat] {
        &self.splats
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
        let sample = Sample { scene, lambda, camera, events };
        self.vertices.clear();
        self.splats.clear();
        self.trace_light(&sample, numbers, record);
        self.trace_camera(&sample, numbers, record)
    }

    fn trace_light(&mut self, sample: &Sample, numbers: &mut impl PrimarySample, record: &mut impl Record) {
        let scene = sample.scene;
        let [u0, u1, u2, _] = numbers.block(Block::EMISSION);
        let [_, _, v0, v1] = numbers.block(Block::LENS);
        let Some(emission) = scene.lights.sample_emission([u0, u1, u2], [v0, v1], sample.lambda) else {
            return;
        };
        let mut beta = emission.throughput();
        let initial = beta.max_lane();
        if beta.is_black() {
            return;
        }
        let cos = emission.point.map_or(1.0, |p| emission.direction.dot(p.n));
        let mut step = Step::from_light(emission.pdf.first, emission.pdf.second, cos);
        let mut from = emission.origin;
        let mut ray = match &emission.point {
            Some(point) => Point::of_light(point).spawn(scene, emission.direction),
            None => Ray::new(emission.origin, emission.direction),
        };
        let (mut events, mut vertex) = (0, 0);
        while let Some(hit) = scene.accel.intersect(&ray) {
            let at = scene.accel.surface(&ray, &hit);
            let [w0, w1, w2, choice] = numbers.block(Block::light_scatter(vertex));
            let Some(shading) = shade(scene, &at, -ray.d, sample.lambda, choice) else {
                ray = continue_beyond(scene, &ray, &hit, &at);
                vertex += 1;
                continue;
            };
            // Along the surface: such a vertex has no density.
            let cos = ray.d.dot(at.n_g).abs();
            if cos == 0.0 {
                return;
            }
            events += 1;
            let is_first = events == 1;
            let mut prefix = if is_first && emission.point.is_none() {
                step.arrive_from_environment(cos)
            } else {
                step.arrive((at.p - from).length2(), cos)
            };
            if is_first {
                let drawn = scene.lights.pdf_sample_of(&emission, &Receiver::facing(at.p, shading.n_g()));
                prefix.before *= drawn / emission.pdf.first;
            }
            let light = LightVertex { at, shading, beta, prefix };
            if shading.is_connectable() {
                self.splat(sample, &light, events, record);
            }
            if events >= sample.events.most {
                return;
            }
            self.vertices.push(light);
            if events >= ROULETTE_FROM {
                let [u, ..] = numbers.block(Block::connect(vertex));
                let chance = (beta.max_lane() / (prefix.ratio.mean() * initial)).min(1.0);
                if u >= chance {
                    return;
                }
                beta *= 1.0 / chance;
            }
            let Some(next) = shading.sample([w0, w1, w2], Mode::Importance) else { return };
            beta *= next.weight;
            if beta.is_black() {
                return;
            }
            step = go_on(&prefix, &next, &at);
            from = at.p;
            ray = spawn(scene, &at, next.wi);
            vertex += 1;
        }
    }

    /// Strategy (s, 1): joins a vertex of the light's path to the lens.
    fn splat(&mut self, sample: &Sample, light: &LightVertex, events: u32, record: &mut impl Record) {
        if !sample.events.holds(events) {
            return;
        }
        let Sample { scene, camera, .. } = sample;
        let to_lens = camera.origin - light.at.p;
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
        let scattered = light.shading.eval(wi, Mode::Importance);
        if scattered.f_cos.is_black() {
            return;
        }
        let pdf = scene.camera.pdf_direction(-wi);
        let cos = wi.dot(light.at.n_g).abs();
        let found = LanePdf::splat(pdf * self.film_density * cos / distance2);
        let others = light.prefix.others(found, scattered.pdf_rev);
        let weight = Weight::joint(light.prefix.ratio, others, camera.ratio, LanePdf::ZERO);
        let value = light.beta.times(camera.ratio) * scattered.f_cos * (film.importance * pdf / distance2);
        if is_unblocked(scene, &Point::of_surface(&light.at), &Point::free(camera.origin)) {
            let unweighted = value / weight.mean_ratio;
            record.contribution((events + 1, 1), Some(position), unweighted, weight.weight);
            self.splats.push(Splat { position, radiance: value * weight.factor() });
        }
    }

    fn trace_camera(
        &self,
        sample: &Sample,
        numbers: &mut impl PrimarySample,
        record: &mut impl Record,
    ) -> PathSample {
        let Sample { scene, lambda, camera, events } = sample;
        let mut radiance = SampledSpectrum::ZERO;
        let mut beta = SampledSpectrum::splat(camera.importance).times(camera.ratio);
        let pdf = scene.camera.pdf_direction(camera.direction) * self.film_density;
        let mut step = Step::from_camera(pdf, camera.ratio);
        let mut from = Receiver::all_round(camera.origin);
        let mut ray = Ray::new(camera.origin, camera.direction);
        let (mut alpha, mut depth, mut vertex) = (0.0, 0, 0);
        loop {
            let Some(hit) = scene.accel.intersect(&ray) else {
                if let Some(light) = scene.lights.environment(ray.d, lambda).filter(|_| events.holds(depth)) {
                    let prefix = step.arrive_at_environment();
                    let drawn = scene.lights.pdf_environment(&from, ray.d);
                    let pdf = scene.lights.pdf_emission_environment(ray.d, from.p);
                    radiance += found(&prefix, beta * light, depth, [drawn, pdf.first, pdf.second], record);
                }
                break;
            };
            let at = scene.accel.surface(&ray, &hit);
            let wo = -ray.d;
            let cos = wo.dot(at.n_g);
            if cos == 0.0 {
                break;
            }
            let distance2 = (at.p - from.p).length2();
            let prefix = step.arrive(distance2, cos.abs());
            let emitter = emitter_hit(&at);
            if events.holds(depth)
                && let Some(light) = scene.lights.emitted(&emitter, wo, lambda)
            {
                let drawn = scene.lights.pdf_object(&emitter, &from) * cos / distance2;
                let pdf = scene.lights.pdf_emission_object(&emitter, wo);
                radiance += found(&prefix, beta * light, depth, [drawn, pdf.first, pdf.second], record);
            }
            let [u0, u1, u2, choice] = numbers.block(Block::scatter(vertex));
            let Some(shading) = shade(scene, &at, wo, lambda, choice) else {
                ray = continue_beyond(scene, &ray, &hit, &at);
                vertex += 1;
                continue;
            };
            alpha = 1.0;
            if depth == events.most {
                break;
            }
            let u = numbers.block(Block::light(vertex));
            if shading.is_connectable() {
                let end = CameraVertex { at: &at, shading: &shading, beta, prefix: &prefix, depth };
                radiance += Self::draw_light(sample, &end, u, record);
                radiance += self.join(sample, &end, vertex, numbers, record);
            }
            if depth >= ROULETTE_FROM {
                let chance = (beta.max_lane() / (prefix.ratio.mean() * camera.importance)).min(1.0);
                if u[3] >= chance {
                    break;
                }
                beta *= 1.0 / chance;
            }
            let Some(next) = shading.sample([u0, u1, u2], Mode::Radiance) else { break };
            beta *= next.weight;
            if beta.is_black() {
                break;
            }
            step = go_on(&prefix, &next, &at);
            from = Receiver::facing(at.p, shading.n_g());
            ray = spawn(scene, &at, next.wi);
            depth += 1;
            vertex += 1;
        }
        PathSample { radiance, alpha }
    }

    /// Strategy (1, t): draws light towards a vertex of the camera's path.
    fn draw_light(
        sample: &Sample,
        end: &CameraVertex,
        u: [Real; 4],
        record: &mut impl Record,
    ) -> SampledSpectrum {
        let Sample { scene, lambda, events, .. } = sample;
        if !events.holds(end.depth + 1) {
            return SampledSpectrum::ZERO;
        }
        let to = Receiver::facing(end.at.p, end.shading.n_g());
        let Some(light) = scene.lights.sample(&to, [u[0], u[1], u[2]], lambda) else {
            return SampledSpectrum::ZERO;
        };
        let response = end.shading.eval(light.wi, Mode::Radiance);
        let value = end.beta * response.f_cos * light.radiance / light.pdf;
        if value.is_black() || !is_lit(scene, end.at, &light) {
            return SampledSpectrum::ZERO;
        }
        let cos = light.wi.dot(end.at.n_g).abs();
        // Densities of the light's own point or direction, and of this vertex seen from there.
        let (drawn, reach) = match &light.point {
            Some(to) => {
                let distance2 = (to.p - end.at.p).length2();
                (light.pdf * -light.wi.dot(to.n) / distance2, cos / distance2)
            }
            None => (light.pdf, cos),
        };
        let found = LanePdf::splat(light.pdf_emission.second * reach);
        let others_camera = end.prefix.others(found, response.pdf_rev);
        let weight = Weight::drawn_light(
            end.prefix.ratio,
            response.pdf / light.pdf,
            others_camera,
            light.pdf_emission.first / drawn,
        );
        let unweighted = value / weight.mean_ratio;
        record.contribution((1, end.depth + 2), None, unweighted, weight.weight);
        value * weight.factor()
    }

    /// Strategies (s, t) with s and t of at least 2: joins a vertex of the camera's path to those of
    /// the light's, or to every `stride`-th of them where they are many.
    fn join(
        &self,
        sample: &Sample,
        end: &CameraVertex,
        vertex: u32,
        numbers: &mut impl PrimarySample,
        record: &mut impl Record,
    ) -> SampledSpectrum {
        let stride = self.vertices.len().div_ceil(JOINTS).max(1);
        let first = if stride == 1 {
            0
        } else {
            let [_, u, ..] = numbers.block(Block::connect(vertex));
            ((u * stride as Real) as usize).min(stride - 1)
        };
        let mut sum = SampledSpectrum::ZERO;
        for (i, light) in self.vertices.iter().enumerate().skip(first).step_by(stride) {
            let events = end.depth + 2 + i as u32;
            if events > sample.events.most {
                break;
            }
            if sample.events.holds(events) && light.shading.is_connectable() {
                sum += join_pair(sample, end, light, i as u32 + 2, record);
            }
        }
        sum * stride as Real
    }
}

fn join_pair(
    sample: &Sample,
    end: &CameraVertex,
    light: &LightVertex,
    s: u32,
    record: &mut impl Record,
) -> SampledSpectrum {
    let to_light = light.at.p - end.at.p;
    let distance2 = to_light.length2();
    if distance2 == 0.0 {
        return SampledSpectrum::ZERO;
    }
    let wi = to_light / distance2.sqrt();
    let here = end.shading.eval(wi, Mode::Radiance);
    if here.f_cos.is_black() {
        return SampledSpectrum::ZERO;
    }
    let there = light.shading.eval(-wi, Mode::Importance);
    let value = end.beta * light.beta * here.f_cos * there.f_cos / distance2;
    if value.is_black() {
        return SampledSpectrum::ZERO;
    }
    if !is_unblocked(sample.scene, &Point::of_surface(end.at), &Point::of_surface(&light.at)) {
        return SampledSpectrum::ZERO;
    }
    let (cos_here, cos_there) = (wi.dot(end.at.n_g).abs(), wi.dot(light.at.n_g).abs());
    let others_light = light.prefix.others(here.pdf * (cos_there / distance2), there.pdf_rev);
    let others_camera = end.prefix.others(there.pdf * (cos_here / distance2), here.pdf_rev);
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
fn go_on(prefix: &Prefix, next: &Scattered, at: &SurfacePoint) -> Step {
    prefix.step(next, next.wi.dot(at.n_g).abs())
}
