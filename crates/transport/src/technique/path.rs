//! Unidirectional path tracing with next-event estimation.
//!
//! At every vertex light is gathered in two ways, by drawing a point of a light and by letting the
//! scattered ray find one, and both are weighted by multiple importance sampling with the power
//! heuristic (Veach 1997, section 9.2). All densities are kept for each wavelength: the path
//! carries `beta`, its throughput over the *hero's* density, and `ratio`, each lane's density over the
//! hero's; a lane's estimate is `beta / mean(ratio)` (Wilkie et al. 2014, equation 12). Weights
//! between strategies use densities averaged over the lanes.

use super::surface::{emitter_hit, shade};
use super::visibility::{continue_beyond, is_lit, spawn};
use super::{Events, PathSample};
use crate::sampler::{Block, PrimarySample};
use indigo_camera::CameraRay;
use indigo_geom::{Ray, SurfacePoint};
use indigo_light::Receiver;
use indigo_math::{Real, Vec3};
use indigo_scatter::{Mode, ShadingPoint};
use indigo_scene::Scene;
use indigo_spectrum::{LanePdf, SampledSpectrum, SampledWavelengths};

/// Vertices before roulette sets in: short paths carry most of the light.
const ROULETTE_FROM: u32 = 3;

/// A path on its way from the camera.
struct Path {
    beta: SampledSpectrum,
    ratio: LanePdf,
    radiance: SampledSpectrum,
    /// How the last direction was drawn; none for the camera's own.
    last: Option<LastScatter>,
}

/// The last scattering event, as multiple importance sampling needs it.
#[derive(Clone, Copy)]
struct LastScatter {
    at: Receiver,
    /// Densities of the direction over the *path's* hero density: `ratio` before times the lanes' pdf.
    pdf: LanePdf,
    /// The same for drawing light here: `mean(ratio)` before the direction was drawn, or 0.
    prefix: Real,
}

impl LastScatter {
    /// Weight of having found a light by scattering, where `pdf_light` is the density (1/sr) of
    /// having drawn it.
    #[inline]
    fn weight(&self, pdf_light: Real) -> Real {
        power_heuristic(self.pdf.mean(), self.prefix * pdf_light)
    }
}

#[inline]
fn power_heuristic(a: Real, b: Real) -> Real {
    // Divided by the larger first, so that squares neither overflow nor vanish.
    if a <= 0.0 {
        return 0.0;
    }
    if a >= b {
        let r = b / a;
        1.0 / (1.0 + r * r)
    } else {
        let r = a / b;
        r * r / (1.0 + r * r)
    }
}

impl Path {
    /// From the camera, whose direction has a density for each wavelength of its own: `ratio`, over
    /// the hero's.
    fn new(ratio: LanePdf) -> Self {
        Self { beta: SampledSpectrum::ONE.times(ratio), ratio, radiance: SampledSpectrum::ZERO, last: None }
    }

    /// Adds light that the ray itself met, which light sampling would draw with `pdf_light` (1/sr).
    #[inline]
    fn add_found(&mut self, light: SampledSpectrum, pdf_light: impl FnOnce(&LastScatter) -> Real) {
        let weight = self.last.map_or(1.0, |l| l.weight(pdf_light(&l)));
        self.radiance += self.beta * light * (weight / self.ratio.mean());
    }

    /// Adds light that was drawn from the lights at a vertex.
    #[inline]
    fn add_drawn(&mut self, f_cos: SampledSpectrum, light: SampledSpectrum, pdf_light: Real, pdf: LanePdf) {
        let prefix = self.ratio.mean();
        let weight = power_heuristic(prefix * pdf_light, (self.ratio * pdf).mean());
        self.radiance += self.beta * f_cos * light * (weight / (prefix * pdf_light));
    }

    /// Goes on with some chance and makes up for the rest, by the largest lane's throughput.
    #[inline]
    fn survives_roulette(&mut self, u: Real) -> bool {
        let chance = (self.beta.max_lane() / self.ratio.mean()).min(1.0);
        if u >= chance {
            return false;
        }
        self.beta *= 1.0 / chance;
        true
    }
}

/// Traces the path of a camera ray.
pub fn trace(
    scene: &Scene,
    sample: &mut impl PrimarySample,
    lambda: &SampledWavelengths,
    camera: &CameraRay,
    events: Events,
) -> PathSample {
    let mut path = Path::new(camera.ratio);
    let mut ray = Ray::new(camera.origin, camera.direction);
    let mut alpha = 0.0;
    let mut depth = 0;
    // Counts invisible surfaces, too: each has a choice of its own where it is part of a blend.
    let mut vertex = 0;
    loop {
        let Some(hit) = scene.accel.intersect(&ray) else {
            if let Some(light) = scene.lights.environment(ray.d, lambda).filter(|_| events.holds(depth)) {
                path.add_found(light, |last| scene.lights.pdf_environment(&last.at, ray.d));
            }
            break;
        };
        let at = scene.accel.surface(&ray, &hit);
        let wo = -ray.d;
        if events.holds(depth) {
            add_emission(scene, &mut path, &at, wo, lambda);
        }
        let [u0, u1, u2, choice] = sample.block(Block::scatter(vertex));
        let Some(shading) = shade(scene, &at, wo, lambda, choice) else {
            // Not a scattering event: the path goes on as if nothing were here.
            ray = continue_beyond(scene, &ray, &hit, &at);
            vertex += 1;
            continue;
        };
        alpha = 1.0;
        if depth == events.most {
            break;
        }
        let lights = sample.block(Block::light(vertex));
        if events.holds(depth + 1) {
            add_direct_light(scene, &mut path, &at, &shading, lights, lambda);
        }
        if depth >= ROULETTE_FROM && !path.survives_roulette(lights[3]) {
            break;
        }
        let Some(next) = shading.sample([u0, u1, u2], Mode::Radiance) else { break };
        path.last = Some(LastScatter {
            at: Receiver::facing(at.p, shading.n_g()),
            pdf: path.ratio * next.pdf,
            // Light drawn at this vertex does not go the way of an event of delta kind.
            prefix: if next.is_delta { 0.0 } else { path.ratio.mean() },
        });
        path.beta *= next.weight;
        path.ratio *= next.pdf.ratio_to_hero();
        if path.beta.is_black() {
            break;
        }
        ray = spawn(scene, &at, next.wi);
        depth += 1;
        vertex += 1;
    }
    PathSample { radiance: path.radiance * camera.importance, alpha }
}

#[inline]
fn add_emission(scene: &Scene, path: &mut Path, at: &SurfacePoint, wo: Vec3, lambda: &SampledWavelengths) {
    let hit = emitter_hit(at);
    if let Some(light) = scene.lights.emitted(&hit, wo, lambda) {
        path.add_found(light, |last| scene.lights.pdf_object(&hit, &last.at));
    }
}

#[inline]
fn add_direct_light(
    scene: &Scene,
    path: &mut Path,
    at: &SurfacePoint,
    shading: &ShadingPoint,
    u: [Real; 4],
    lambda: &SampledWavelengths,
) {
    let to = Receiver::facing(at.p, shading.n_g());
    let Some(light) = scene.lights.sample(&to, [u[0], u[1], u[2]], lambda) else { return };
    let response = shading.eval(light.wi, Mode::Radiance);
    if response.f_cos.is_black() || light.radiance.is_black() {
        return;
    }
    if is_lit(scene, at, &light) {
        path.add_drawn(response.f_cos, light.radiance, light.pdf, response.pdf);
    }
}
