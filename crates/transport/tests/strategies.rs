//! Drawing lights, letting scattered rays find them, and both weighted together: one expectation.
//!
//! The path tracer mixes the two strategies; here each stands alone, made from the parts that the
//! path tracer is made of. A weight that does not sum to one, or a density that is reported wrongly
//! on one side only, shows in the difference.

#[path = "../../render/tests/common/mod.rs"]
mod common;

use common::judge::assert_same;
use common::shapes::{Mesh, mesh_light, model};
use common::text::{flat_camera, grey, null, scene_file, settings, uniform};
use common::{scene, scene_with};
use indigo_camera::CameraRay;
use indigo_film::Sensor;
use indigo_geom::{Ray, SurfacePoint, offset_origin};
use indigo_light::{EmitterHit, Receiver};
use indigo_math::{Real, Vec2, Vec3};
use indigo_scatter::{Interface, Mode, ShadingPoint};
use indigo_scene::Scene;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_transport::sampler::{Block, PrimarySample, SobolSample};
use indigo_transport::technique::Events;
use indigo_transport::technique::path::PathTracer;

/// Batches, and samples in each.
const BATCHES: u64 = 24;
const SAMPLES: u32 = 16_384;

/// Independent numbers, so that batches are too.
struct Random {
    seed: u64,
}

impl PrimarySample for Random {
    fn block(&mut self, block: Block) -> [Real; 4] {
        // The name of a block is its Debug text: good enough to keep blocks apart.
        let name =
            format!("{block:?}").bytes().fold(0u64, |h, b| h.wrapping_mul(31).wrapping_add(u64::from(b)));
        let mut rng = Rng::new(self.seed ^ name.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        [0; 4].map(|_| rng.uniform_f32() as Real)
    }
}

/// The first surface along a camera ray, and how it scatters.
fn first_surface(
    scene: &Scene,
    camera: &CameraRay,
    lambda: &SampledWavelengths,
) -> Option<(SurfacePoint, ShadingPoint)> {
    let ray = Ray::new(camera.origin, camera.direction);
    let hit = scene.accel.intersect(&ray)?;
    let at = scene.accel.surface(&ray, &hit);
    let context = scene.material_context(lambda, Interface::NONE, 0.5);
    let leaf = scene.material_at(&at).leaf(&context, |set| scene.accel.uv(&at, set))?;
    Some((at, ShadingPoint::new(leaf, at.n_g, at.n_s, -ray.d)))
}

fn leave(scene: &Scene, at: &SurfacePoint, direction: Vec3) -> Vec3 {
    offset_origin(at.p, at.p_error, at.n_g, direction, scene.nudge_m)
}

/// Direct light by drawing lights alone.
fn drawn(
    scene: &Scene,
    at: &SurfacePoint,
    shading: &ShadingPoint,
    u: [Real; 4],
    lambda: &SampledWavelengths,
) -> SampledSpectrum {
    let Some(light) = scene.lights.sample(&Receiver::facing(at.p, shading.n_g()), u, lambda) else {
        return SampledSpectrum::ZERO;
    };
    let origin = leave(scene, at, light.wi);
    let ray = match &light.point {
        None => Ray::new(origin, light.wi),
        // A thousandth short of the light's own surface.
        Some(to) => Ray { t_max: 0.999, ..Ray::new(origin, to.p - origin) },
    };
    if scene.accel.occluded(&ray) {
        return SampledSpectrum::ZERO;
    }
    shading.eval(light.wi, Mode::Radiance).f_cos * light.radiance / light.pdf
}

/// Direct light by scattering alone.
fn found(
    scene: &Scene,
    at: &SurfacePoint,
    shading: &ShadingPoint,
    u: [Real; 4],
    lambda: &SampledWavelengths,
) -> SampledSpectrum {
    let Some(next) = shading.sample([u[0], u[1], u[2]], Mode::Radiance) else { return SampledSpectrum::ZERO };
    let ray = Ray::new(leave(scene, at, next.wi), next.wi);
    let light = match scene.accel.intersect(&ray) {
        None => scene.lights.environment(next.wi, lambda),
        Some(hit) => {
            let there = scene.accel.surface(&ray, &hit);
            let hit = EmitterHit {
                object: there.object,
                triangle: there.primitive,
                bary: there.bary,
                p: there.p,
                n: there.n_g,
            };
            scene.lights.emitted(&hit, -next.wi, lambda)
        }
    };
    next.weight * light.unwrap_or(SampledSpectrum::ZERO)
}

/// Luminances by the three ways: drawing, finding, and the path tracer at one scattering event less
/// what is seen directly.
fn measure(scene: &Scene) -> [Moments; 3] {
    let mut moments = [Moments::default(); 3];
    let mut tracer = PathTracer::default();
    for batch in 0..BATCHES {
        let mut sums = [0.0; 3];
        for i in 0..SAMPLES {
            let mut sample = Random { seed: batch << 32 | u64::from(i) };
            let [x, y, u, _] = sample.block(Block::FILM);
            let lambda = SampledWavelengths::sample(u);
            let camera = scene.camera.ray(Vec2::new(x, y), Vec2::new(0.5, 0.5));
            let luminance = |s: &SampledSpectrum| f64::from(Sensor::new(&lambda).xyz(s)[1]);
            let (lights, scattering) = (sample.block(Block::light(0)), sample.block(Block::scatter(0)));
            if let Some((at, shading)) = first_surface(scene, &camera, &lambda) {
                sums[0] += luminance(&drawn(scene, &at, &shading, lights, &lambda));
                sums[1] += luminance(&found(scene, &at, &shading, scattering, &lambda));
            }
            // The same path cut before it scatters holds what shines straight into the lens.
            let mut traced = |depth| {
                tracer.trace(scene, &mut sample, &lambda, &camera, Events::up_to(depth), &mut ()).radiance()
            };
            sums[2] += luminance(&(traced(1) - traced(0)));
        }
        for (m, sum) in moments.iter_mut().zip(sums) {
            m.add(sum / f64::from(SAMPLES));
        }
    }
    moments
}

fn assert_one_expectation(what: &str, text: &str) {
    let [drawn, found, weighted] = measure(&scene_with(text, [("sky.float", sky_file())]));
    assert!(
        weighted.mean() > 0.0 && weighted.std_error() < 1e-2 * weighted.mean(),
        "{what}: nothing is seen"
    );
    assert_same(&format!("{what}: lights drawn and both"), &drawn, &weighted);
    assert_same(&format!("{what}: lights found and both"), &found, &weighted);
    // Weighting must pay: it is never much worse than the better strategy alone.
    let better = drawn.variance().min(found.variance());
    assert!(weighted.variance() < 3.0 * better, "{what}: {} against {better}", weighted.variance());
}

const EYE: [f64; 3] = [0.0, -4.0, 2.0];

fn over_floor(lamps: &[String]) -> String {
    scene_file(&[
        settings(8, ""),
        flat_camera(EYE, [0.0, 4.0, -2.0], 0.3),
        grey("grey", 0.6),
        Mesh::square(6.0, 0.0).text("ground", "grey"),
        model("ground"),
        lamps.concat(),
    ])
}

fn rectangle(pos: &str, side: f64, value: f64) -> String {
    format!(
        "<rectanglelight><pos>{pos}</pos><width>{side}</width><height>{side}</height><spectrum>{}</spectrum></rectanglelight>",
        uniform(value)
    )
}

#[test]
fn a_large_and_near_rectangle() {
    assert_one_expectation("rectangle", &over_floor(&[rectangle("0 0 0.6", 2.0, 1e5)]));
}

/// Texels of a side of the sky.
const SKY: usize = 8;

/// A sky that is brighter in the middle and has some bright texels: a background would not be drawn.
fn sky_file() -> Vec<u8> {
    let value = |i: usize| {
        let from_middle = (i % SKY).abs_diff(SKY / 2) + (i / SKY).abs_diff(SKY / 2);
        if i.is_multiple_of(7) { 9.0f32 } else { 4.0 / (1.0 + from_middle as f32) }
    };
    (0..SKY * SKY).flat_map(|i| [value(i); 3]).flat_map(f32::to_le_bytes).collect()
}

fn sky(gain: f64) -> String {
    format!(
        "<env_map><spherical><path>sky.float</path><width>{SKY}</width><gain>{gain}</gain></spherical></env_map>"
    )
}

#[test]
fn the_sky_with_something_in_the_way() {
    let ball =
        "<sphere><center>0 0 0.5</center><radius>0.5</radius><material_name>grey</material_name></sphere>";
    assert_one_expectation("sky", &over_floor(&[sky(1e5), ball.to_owned()]));
}

#[test]
fn lights_of_several_kinds_at_once() {
    let ball =
        Mesh::ball(2).text("ball", "grey") + &mesh_light("ball", &uniform(5e5), [0.5, 0.0, 0.8], 0.5, "");
    let lamps = [sky(2e4), rectangle("-1 0 1", 1.0, 2e5), rectangle("1 1.5 2", 0.7, 1e5), ball];
    assert_one_expectation("several lights", &over_floor(&lamps));
}

/// A pane that is not there must not disturb either strategy, nor the weights between them.
#[test]
fn the_path_tracer_weighs_through_invisible_surfaces() {
    let bare = over_floor(&[rectangle("0 0 0.6", 2.0, 1e5)]);
    let pane = null("nothing") + &Mesh::square(5.0, 0.3).text("pane", "nothing") + &model("pane");
    let covered = over_floor(&[rectangle("0 0 0.6", 2.0, 1e5), pane]);
    let [bare, covered] = [bare, covered].map(|text| {
        let scene = scene(&text);
        Moments::of((0..BATCHES).map(|batch| luminance_of_paths(&scene, batch)))
    });
    assert_same("with and without the pane", &bare, &covered);
}

/// Mean luminance of whole paths in low-discrepancy order.
fn luminance_of_paths(scene: &Scene, seed: u64) -> f64 {
    let mut sum = 0.0;
    let mut tracer = PathTracer::default();
    for i in 0..SAMPLES {
        let mut sample = SobolSample::new(seed, 0, i);
        let [x, y, u, _] = sample.block(Block::FILM);
        let lambda = SampledWavelengths::sample(u);
        let camera = scene.camera.ray(Vec2::new(x, y), Vec2::new(0.5, 0.5));
        let found = tracer.trace(scene, &mut sample, &lambda, &camera, Events::up_to(100), &mut ());
        sum += f64::from(Sensor::new(&lambda).xyz(&found.radiance())[1]);
    }
    sum / f64::from(SAMPLES)
}
