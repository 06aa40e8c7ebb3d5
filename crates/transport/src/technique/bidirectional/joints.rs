//! Joints of a camera path's vertex: to a light, and to vertices of the light's path.

use super::light_path::LightPath;
use super::straight::Seen;
use super::{CameraVertex, Sample};
use crate::sampler::{Block, PrimarySample};
use crate::technique::Record;
use crate::technique::media::Passage;
use crate::technique::mis::{Prefix, Step, Weight};
use crate::technique::surface::emitter_hit;
use crate::technique::visibility::{way, way_to_light};
use indigo_geom::SurfacePoint;
use indigo_light::{Receiver, Sender};
use indigo_math::{Real, Vec3};
use indigo_scatter::Mode;
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// A vertex of the camera's path is joined to about this many of the light's path at most, so that
/// very long paths cost no more than their length.
const JOINTS: usize = 16;

/// Strategy (1, t): draws light towards a vertex of the camera's path.
pub(super) fn draw_light(
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
    let Some(light) = lights.sample(&end.vertex.receiver(), u, world.lambda) else {
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
    record.contribution((1, end.depth + 2), None, value / weight.mean_ratio, weight.weight, light.sender);
    value * weight.factor()
}

/// Strategies (s, t) with s and t of at least 2: joins a vertex of the camera's path to those of
/// the light's, or to every `stride`-th of them where they are many.
pub(super) fn join(
    sample: &Sample,
    light_path: &LightPath,
    end: &CameraVertex,
    number: u32,
    numbers: &mut impl PrimarySample,
    record: &mut impl Record,
) -> SampledSpectrum {
    let vertices = &light_path.vertices;
    let stride = vertices.len().div_ceil(JOINTS).max(1);
    let first = if stride == 1 {
        0
    } else {
        let [_, u, ..] = numbers.block(Block::connect(number));
        ((u * stride as Real) as usize).min(stride - 1)
    };
    let mut sum = SampledSpectrum::ZERO;
    for (i, light) in vertices.iter().enumerate().skip(first).step_by(stride) {
        let events = end.depth + 2 + i as u32;
        if events > sample.events.most {
            break;
        }
        if sample.events.holds(events) && light.vertex.is_connectable() {
            sum += join_pair(sample, end, light_path, i, stride as Real, record);
        }
    }
    sum
}

/// Vertex `i` of the light's path, which stands for `stride` of them.
fn join_pair(
    sample: &Sample,
    end: &CameraVertex,
    light_path: &LightPath,
    i: usize,
    stride: Real,
    record: &mut impl Record,
) -> SampledSpectrum {
    let light = &light_path.vertices[i];
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
    let value = end.beta * light.beta * here.f_cos * there.f_cos * (stride / distance2);
    if value.is_black() {
        return SampledSpectrum::ZERO;
    }
    let Some(passage) = way(&sample.world, end.vertex, wi, &light.vertex.point) else {
        return SampledSpectrum::ZERO;
    };
    let value = value * passage.transmittance;
    let free = passage.free / distance2;
    let prefix = light_path.prefix_towards(i, -wi);
    let others_light = prefix.others(here.pdf * light.vertex.reach(wi) * free, there.pdf_rev);
    let others_camera = end.prefix.others(there.pdf * end.vertex.reach(wi) * free, here.pdf_rev);
    let weight = Weight::joint(prefix.ratio, others_light, end.prefix.ratio, others_camera);
    let strategy = (i as u32 + 2, end.depth + 2);
    record.contribution(strategy, None, value / weight.mean_ratio, weight.weight, light_path.sender);
    value * weight.factor()
}

/// The camera's path where it meets something that may shine.
pub(super) struct Arrived<'a> {
    pub step: &'a Step,
    /// The vertex that it left, as lights know it.
    pub from: &'a Receiver,
    /// Its throughput there.
    pub beta: SampledSpectrum,
    /// The way since.
    pub passage: &'a Passage,
    /// Scattering events so far.
    pub depth: u32,
}

/// Strategy (0, t): the path meets a surface that may be a lamp's.
pub(super) fn meet_lamp(
    sample: &Sample,
    path: &Arrived,
    at: &SurfacePoint,
    wo: Vec3,
    record: &mut impl Record,
) -> SampledSpectrum {
    let world = &sample.world;
    let lights = &world.scene.lights;
    let cos = wo.dot(at.n_g).abs();
    let hit = emitter_hit(at);
    let light = lights.emitted(&hit, wo, world.lambda).filter(|_| cos > 0.0);
    let Some(light) = light.zip(lights.sender_of_object(hit.object)) else { return SampledSpectrum::ZERO };
    let distance2 = (at.p - path.from.p).length2();
    let prefix = path.step.arrive(distance2, LanePdf::splat(cos), path.passage.free);
    let pdf = lights.pdf_emission_object(&hit, wo);
    let over_area = cos / distance2;
    let drawn = if path.depth == 0 {
        let (pdf, chance) = (pdf.first / over_area, lights.chance_of_object(hit.object));
        Seen { wi: -wo, distance: distance2.sqrt(), pdf, chance }.counted_pdf(sample)
    } else {
        lights.pdf_object(&hit, path.from)
    };
    found(path, &prefix, light, [drawn * over_area, pdf.first, pdf.second], record)
}

/// Strategy (0, t): the path leaves the scene.
pub(super) fn meet_environment(
    sample: &Sample,
    path: &Arrived,
    towards: Vec3,
    record: &mut impl Record,
) -> SampledSpectrum {
    let world = &sample.world;
    let lights = &world.scene.lights;
    let Some(light) = lights.environment(towards, world.lambda) else { return SampledSpectrum::ZERO };
    let light = (light, Sender::Environment(towards));
    let prefix = path.step.arrive_at_environment(path.passage.free);
    let pdf = lights.pdf_emission_environment(towards, path.from.p);
    let drawn = if path.depth == 0 {
        let chance = lights.chance_of_environment();
        Seen { wi: towards, distance: Real::INFINITY, pdf: pdf.first, chance }.counted_pdf(sample)
    } else {
        lights.pdf_environment(path.from, towards)
    };
    found(path, &prefix, light, [drawn, pdf.first, pdf.second], record)
}

/// Light that the camera's path met by itself, with the densities of drawing it and of its emission.
fn found(
    path: &Arrived,
    prefix: &Prefix,
    (light, sender): (SampledSpectrum, Sender),
    [drawn, first, second]: [Real; 3],
    record: &mut impl Record,
) -> SampledSpectrum {
    let value = path.beta * path.passage.weight() * light;
    let others = if path.depth == 0 {
        prefix.others_at_seen_light(drawn)
    } else {
        prefix.others_at_light(drawn, first, second)
    };
    let weight = Weight::new(prefix.ratio, others);
    record.contribution((0, path.depth + 2), None, value / weight.mean_ratio, weight.weight, sender);
    value * weight.factor()
}
