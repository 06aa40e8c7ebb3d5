//! Unidirectional path tracing with next-event estimation.
//!
//! At every vertex light is gathered in two ways, by drawing a point of a light and by letting the
//! scattered ray find one, and both are weighted by multiple importance sampling with the power
//! heuristic (Veach 1997, section 9.2). All densities are kept for each wavelength: the path
//! carries `beta`, its throughput over the *hero's* density, and `ratio`, each lane's density over the
//! hero's; a lane's estimate is `beta / mean(ratio)` (Wilkie et al. 2014, equation 12). Weights
//! between strategies use densities averaged over the lanes.

use super::flight::{Blocks, Flight};
use super::media::{Passage, World, WorldMemory};
use super::surface::emitter_hit;
use super::vertex::Vertex;
use super::visibility::{Point, way_to_light};
use super::{DIRECT, End, Events, PathSample, Record};
use crate::sampler::{Block, PrimarySample};
use indigo_camera::CameraRay;
use indigo_geom::SurfacePoint;
use indigo_light::{Receiver, Sender};
use indigo_math::{Real, Vec3};
use indigo_scatter::Mode;
use indigo_scene::Scene;
use indigo_spectrum::{LanePdf, SampledSpectrum, SampledWavelengths};

/// Vertices before roulette sets in: short paths carry most of the light.
const ROULETTE_FROM: u32 = 3;

/// A path on its way from the camera.
pub(super) struct Path {
    pub beta: SampledSpectrum,
    pub ratio: LanePdf,
    radiance: SampledSpectrum,
    /// By what refraction has divided the radiance that is carried.
    compression: Real,
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
    /// Weight of having found a light by scattering and a passage, where `pdf_light` is the density
    /// (1/sr) of having drawn it.
    #[inline]
    fn weight(&self, passage: &Passage, pdf_light: Real) -> Real {
        power_heuristic((self.pdf * passage.free).mean(), self.prefix * pdf_light)
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
    pub fn new(ratio: LanePdf) -> Self {
        Self {
            beta: SampledSpectrum::ONE.times(ratio),
            ratio,
            radiance: SampledSpectrum::ZERO,
            compression: 1.0,
            last: None,
        }
    }

    /// Adds light that the ray itself met after a passage, which light sampling would draw with
    /// `pdf_light` (1/sr). Gives it as if there were no other strategy, and its weight.
    #[inline]
    fn add_found(
        &mut self,
        passage: &Passage,
        light: SampledSpectrum,
        pdf_light: impl FnOnce(&LastScatter) -> Real,
    ) -> Contribution {
        let weight = self.last.map_or(1.0, |l| l.weight(passage, pdf_light(&l)));
        let ratio = self.ratio * passage.free.ratio_to_hero();
        let value = self.beta * passage.weight() * light;
        self.radiance += value * (weight / ratio.mean());
        (value / ratio.mean(), weight)
    }

    /// Adds light that was drawn from the lights at a vertex, with density `pdf_light`, and comes by a passage; gives the
    /// same.
    #[inline]
    fn add_drawn(
        &mut self,
        value: SampledSpectrum,
        passage: &Passage,
        pdf_light: Real,
        pdf: LanePdf,
    ) -> Contribution {
        let prefix = self.ratio.mean();
        let weight = power_heuristic(prefix * pdf_light, (self.ratio * pdf * passage.free).mean());
        let value = self.beta * value * passage.transmittance;
        self.radiance += value * (weight / (prefix * pdf_light));
        (value / (prefix * pdf_light), weight)
    }

    /// Arrives at a vertex.
    #[inline]
    pub fn arrive(&mut self, flight: &Flight, vertex: &Vertex) {
        self.beta = flight.arrived(self.beta, vertex);
        self.ratio *= flight.passage.free.ratio_to_hero();
        if let Some(collision) = vertex.collision() {
            self.ratio *= collision;
        }
    }

    /// Goes on with some chance and makes up for the rest, by the largest lane's throughput.
    #[inline]
    fn survives_roulette(&mut self, u: Real) -> bool {
        let chance = (self.compression * self.beta.max_lane() / self.ratio.mean()).min(1.0);
        if u >= chance {
            return false;
        }
        self.beta *= 1.0 / chance;
        true
    }
}

/// Path tracing, with the memory that it needs.
#[derive(Clone, Debug, Default)]
pub struct PathTracer {
    memory: WorldMemory,
}

impl PathTracer {
    /// Rays traced so far.
    pub fn rays(&self) -> u64 {
        self.memory.rays()
    }

    /// Its memory, for rays of other kinds.
    pub(super) fn memory(&mut self) -> &mut WorldMemory {
        &mut self.memory
    }

    /// Traces the path of a camera ray.
    pub fn trace(
        &mut self,
        scene: &Scene,
        sample: &mut impl PrimarySample,
        lambda: &SampledWavelengths,
        camera: &CameraRay,
        events: Events,
        record: &mut impl Record,
    ) -> PathSample {
        trace(&self.memory.world(scene, lambda, camera.time), sample, camera, events, record)
    }
}

fn trace(
    world: &World,
    sample: &mut impl PrimarySample,
    camera: &CameraRay,
    events: Events,
    record: &mut impl Record,
) -> PathSample {
    let scene = world.scene;
    let mut path = Path::new(camera.ratio);
    let ray = world.ray(camera.origin, camera.direction);
    let mut flight = Flight::new(&Point::free(ray.o), ray, scene.camera_media_along(&ray));
    let mut alpha = 0.0;
    let mut background = SampledSpectrum::ZERO;
    let mut direct = None;
    let mut depth = 0;
    let mut number = 0;
    loop {
        let arrival = flight.fly_to_vertex(world, sample, Blocks::Camera, &mut number, |passage, at, wo| {
            if events.holds(depth)
                && let Some((value, weight, sender)) = add_emission(world, &mut path, passage, at, wo)
            {
                record.contribution((0, depth + 2), None, value * camera.importance, weight, sender);
            }
        });
        let Some((vertex, u)) = arrival else {
            // That of surfaces which are not to be seen, met before, is kept apart.
            let met = (depth == 0).then(|| std::mem::replace(&mut path.radiance, SampledSpectrum::ZERO));
            if events.holds(depth)
                && let Some((value, weight)) = add_environment(world, &mut path, &flight)
            {
                let sender = Sender::Environment(flight.ray.d);
                record.contribution((0, depth + 2), None, value * camera.importance, weight, sender);
            }
            if let Some(met) = met {
                background = std::mem::replace(&mut path.radiance, met);
            }
            break;
        };
        alpha = 1.0;
        record.vertex(End::Camera, vertex.point.p, vertex.is_on_surface());
        if depth == DIRECT {
            // What comes from here on is scattered once more.
            direct = Some(std::mem::replace(&mut path.radiance, SampledSpectrum::ZERO));
        }
        if depth == events.most {
            break;
        }
        path.arrive(&flight, &vertex);
        let lights = sample.block(Block::light(number));
        if events.holds(depth + 1)
            && vertex.is_connectable()
            && let Some((value, weight, sender)) = add_direct_light(world, &mut path, &vertex, lights)
        {
            record.contribution((1, depth + 2), None, value * camera.importance, weight, sender);
        }
        if depth >= ROULETTE_FROM && !path.survives_roulette(lights[3]) {
            break;
        }
        let Some(next) = vertex.sample([u[0], u[1], u[2]], Mode::Radiance) else { break };
        path.last = Some(LastScatter {
            at: vertex.receiver(),
            pdf: path.ratio * next.pdf,
            // Light drawn at this vertex does not go the way of an event of delta kind.
            prefix: if next.is_delta { 0.0 } else { path.ratio.mean() },
        });
        path.beta *= next.weight;
        path.ratio *= next.pdf.ratio_to_hero();
        if path.beta.is_black() {
            break;
        }
        path.compression *= vertex.compression(world, next.wi);
        flight = vertex.leave(world, next.wi);
        depth += 1;
        number += 1;
    }
    let (direct, indirect) =
        direct.map_or((path.radiance, SampledSpectrum::ZERO), |direct| (direct, path.radiance));
    let [background, direct, indirect] =
        [background, direct, indirect].map(|light| light * camera.importance);
    PathSample { background, direct, indirect, alpha }
}

/// A contribution as if there were no other strategy, and its weight.
type Contribution = (SampledSpectrum, Real);

#[inline]
fn add_emission(
    world: &World,
    path: &mut Path,
    passage: &Passage,
    at: &SurfacePoint,
    wo: Vec3,
) -> Option<(SampledSpectrum, Real, Sender)> {
    let lights = &world.scene.lights;
    let hit = emitter_hit(at);
    let light = lights.emitted(&hit, wo, world.lambda)?;
    let (value, weight) = path.add_found(passage, light, |last| lights.pdf_object(&hit, &last.at));
    Some((value, weight, lights.sender_of_object(hit.object)?))
}

#[inline]
fn add_environment(world: &World, path: &mut Path, flight: &Flight) -> Option<Contribution> {
    let (lights, towards) = (&world.scene.lights, flight.ray.d);
    let light = lights.environment(towards, world.lambda)?;
    Some(path.add_found(&flight.passage, light, |last| lights.pdf_environment(&last.at, towards)))
}

#[inline]
fn add_direct_light(
    world: &World,
    path: &mut Path,
    vertex: &Vertex,
    u: [Real; 4],
) -> Option<(SampledSpectrum, Real, Sender)> {
    let light = world.scene.lights.sample(&vertex.receiver(), u, world.lambda)?;
    let response = vertex.eval(light.wi, Mode::Radiance);
    let value = response.f_cos * light.radiance;
    if value.is_black() {
        return None;
    }
    let passage = way_to_light(world, vertex, &light)?;
    let (value, weight) = path.add_drawn(value, &passage, light.pdf, response.pdf);
    Some((value, weight, light.sender))
}
