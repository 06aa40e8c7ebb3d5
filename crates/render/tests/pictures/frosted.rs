//! Frosted glass: bodies of it against a walk that has the model alone.

use super::common::judge::{NITS_PER_UNIFORM, assert_same};
use super::common::text::{
    ONE_PIXEL, background, basic, flat_camera, medium, scene_file, settings, sphere, uniform,
};
use super::common::{measure, scene};
use super::materials::RADIANCE;
use indigo_geom::Ray;
use indigo_math::{Real, Vec3};
use indigo_scatter::{Interface, Mode, ShadingPoint};
use indigo_scene::Scene;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;

/// A ball of rough glass shows of even light what a walk through a unit sphere says that knows nothing of scenes and media:
/// whether light is reflected or refracted at each end of a chord is all that its model decides.
#[test]
fn frosted_glass_loses_what_its_model_loses_and_makes_no_light() {
    for exponent in [1e6, 100.0, 5.0] {
        let walked = walked_ball(exponent);
        let around = RADIANCE * NITS_PER_UNIFORM;
        assert!(exponent < 1e6 || (walked.mean() / around - 1.0).abs() < 1e-3, "{walked:?}");
        for bidirectional in [false, true] {
            let mut scene = glass_ball(exponent);
            scene.transport.bidirectional = bidirectional;
            let measured = measure(&scene, 16, 160);
            let shown = measured.luminance();
            assert!(shown.std_error() < 1.5e-3 * shown.mean(), "{exponent}: {shown:?}");
            assert_same(&format!("{exponent}, bidirectional {bidirectional}"), shown, &walked);
        }
    }
}

const GLASS_INDEX: f64 = 1.5;

/// Of unit radius, four metres before the camera, which sees no more than its middle.
fn glass_ball(exponent: f64) -> Scene {
    let text = scene_file(&[
        settings(8, ONE_PIXEL),
        flat_camera([0.0; 3], [0.0, 1.0, 0.0], BALL_TANGENT),
        medium("glass", 10, &basic(GLASS_INDEX, &uniform(0.0), "")),
        format!(
            "<material><name>m</name><glossy_transparent><internal_medium_name>glass</internal_medium_name>\
             <exponent>{exponent}</exponent></glossy_transparent></material>"
        ),
        sphere([0.0, BALL_DISTANCE, 0.0], 1.0, "m"),
        background(&uniform(RADIANCE)),
    ]);
    scene(&text)
}

const BALL_DISTANCE: f64 = 4.0;
const BALL_TANGENT: f64 = 0.1;

/// The luminance of the ball.
fn walked_ball(exponent: f64) -> Moments {
    let scene = glass_ball(exponent);
    let lambda = SampledWavelengths::sample(0.5);
    let glass = SampledSpectrum::splat(GLASS_INDEX as Real);
    let outside = Interface { below: glass, ..Interface::NONE };
    let inside = Interface { above: glass, ..Interface::NONE };
    let ray = Ray::new(Vec3::ZERO, Vec3::new(0.0, 1.0, 0.0));
    let at = scene.accel.surface(&ray, &scene.accel.intersect(&ray).expect("the ball"));
    let material = scene.material_at(&at);
    let [leaf_outside, leaf_inside] = [outside, inside].map(|interface| {
        let context = scene.material_context(&lambda, interface, 0.5);
        material.leaf(&context, |set| scene.accel.uv(&at, set)).expect("a rough surface")
    });
    let mut rng = Rng::new(5);
    Moments::of((0..150_000).map(|_| {
        let [x, z] = [0; 2].map(|_| BALL_TANGENT * (2.0 * rng.uniform() - 1.0));
        let mut d = Vec3::from([x, 1.0, z].map(|c| c as Real)).normalized();
        let from = Vec3::new(0.0, -BALL_DISTANCE as Real, 0.0);
        let middle = -from.dot(d);
        let mut p = from + d * (middle - (middle * middle - from.dot(from) + 1.0).sqrt());
        let (mut leaf, mut is_inside, mut throughput) = (leaf_outside, false, 1.0);
        loop {
            let u = [0; 3].map(|_| rng.uniform_f32() as Real);
            let n = p.normalized();
            let Some(on) = ShadingPoint::new(leaf, n, n, -d).sample(u, Mode::Radiance) else { return 0.0 };
            throughput *= on.weight.hero() as f64;
            if on.is_transmitted == is_inside {
                return RADIANCE * NITS_PER_UNIFORM * throughput;
            }
            (leaf, is_inside, d) = (leaf_inside, true, on.wi);
            // The other end of the chord.
            p = n - d * (2.0 * n.dot(d));
        }
    }))
}
