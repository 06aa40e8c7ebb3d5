//! Joints of a camera path's vertex: to a light, and to vertices of the light's path.

use super::light_path::LightVertex;
use super::{CameraVertex, Sample};
use crate::sampler::{Block, PrimarySample};
use crate::technique::Record;
use crate::technique::mis::{Prefix, Weight};
use crate::technique::visibility::{way, way_to_light};
use indigo_math::Real;
use indigo_scatter::Mode;
use indigo_spectrum::SampledSpectrum;

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
    record.contribution((1, end.depth + 2), None, value / weight.mean_ratio, weight.weight);
    value * weight.factor()
}

/// Strategies (s, t) with s and t of at least 2: joins a vertex of the camera's path to those of
/// the light's, or to every `stride`-th of them where they are many.
pub(super) fn join(
    sample: &Sample,
    vertices: &[LightVertex],
    end: &CameraVertex,
    number: u32,
    numbers: &mut impl PrimarySample,
    record: &mut impl Record,
) -> SampledSpectrum {
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
            sum += join_pair(sample, end, light, i as u32 + 2, record);
        }
    }
    sum * stride as Real
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
pub(super) fn found(
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
