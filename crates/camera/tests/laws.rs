//! The lens is sampled evenly, and the film is a faithful map of directions.

use indigo_camera::{ThinLens, ThinLensParameters};
use indigo_math::{Float, Real, Vec2, Vec3, Vec3d};
use indigo_testkit::chi2::{Chi2, Domain};
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_testkit::ztest::mean_against;

const POSITION: Vec3 = Vec3 { x: 3.0, y: -1.0, z: 2.0 };

fn lens(focus_distance: f64, aperture_radius: f64) -> ThinLens {
    ThinLens::new(&ThinLensParameters {
        position: POSITION.cast(),
        forwards: Vec3d::new(1.0, 0.0, 0.0),
        up: Vec3d::new(0.0, 0.0, 1.0),
        aperture_radius,
        focus_distance,
        sensor_width: 0.036,
        sensor_height: 0.024,
        lens_sensor_dist: 0.03,
        vignetting: true,
    })
    .expect("a camera that looks somewhere")
}

fn random(rng: &mut Rng) -> Vec2 {
    Vec2::new(rng.uniform_f32() as Real, rng.uniform_f32() as Real)
}

/// Looking along x with z up, the picture's right is -y.
fn on_disk(at: Vec3, radius: f64) -> [f64; 3] {
    let offset = at - POSITION;
    [-offset.y.to_f64() / radius, offset.z.to_f64() / radius, 0.0]
}

/// False-alarm probability 1e-4.
#[test]
fn rays_start_evenly_over_the_aperture() {
    let lens = lens(5.0, 0.2);
    let result = Chi2::new(Domain::Disk).run(
        |rng| Some(on_disk(lens.ray(Vec2::new(0.2, 0.9), random(rng)).origin, 0.2)),
        |_| std::f64::consts::FRAC_1_PI,
    );
    assert!(result.passed(), "{result}");
}

/// Where the rays of one film point cross a plane at a distance d they fill a disc of radius
/// r |1 - d / focus|: each coordinate has a quarter of its square as variance. False-alarm
/// probability 1e-4 for all six tests together.
#[test]
fn the_blur_disc_grows_with_the_distance_from_the_plane_of_focus() {
    let (radius, focus) = (0.05, 4.0);
    let lens = lens(focus, radius);
    for distance in [1.0, 2.5, 20.0] {
        let mut rng = Rng::new(3);
        let (mut right, mut up) = (Moments::default(), Moments::default());
        for _ in 0..100_000 {
            let ray = lens.ray(Vec2::new(0.75, 0.5), random(&mut rng));
            let t = distance as Real / ray.direction.x;
            let p = ray.origin + ray.direction * t - POSITION;
            // The film point lies at 0.25 · 0.036 / 0.03 = 0.3 to the right.
            right.add((-p.y.to_f64() - 0.3 * distance).powi(2));
            up.add(p.z.to_f64().powi(2));
        }
        let disc = radius * (1.0 - distance / focus).abs();
        for squares in [right, up] {
            let test = mean_against(&squares, 0.25 * disc * disc).at(1.6e-5);
            assert!(test.passed(), "distance {distance}: {test}");
        }
    }
}

/// In the plane of focus there is no blur.
#[test]
fn the_plane_of_focus_is_sharp() {
    let lens = lens(4.0, 0.05);
    let mut rng = Rng::new(4);
    for _ in 0..1000 {
        let ray = lens.ray(Vec2::new(0.75, 0.25), random(&mut rng));
        let p = ray.origin + ray.direction * (4.0 / ray.direction.x) - POSITION;
        assert!((p - Vec3::new(4.0, -1.2, 0.8)).length() < 1e-5, "{p:?}");
    }
}

/// The film is flat: a step on it is the same step in tangents everywhere, so evenly drawn film
/// positions have the variance 1/12 of the angles' tangents.
#[test]
fn film_positions_map_to_tangents() {
    let lens = lens(1.0, 1e-6);
    let mut rng = Rng::new(5);
    let (mut across, mut along) = (Moments::default(), Moments::default());
    for _ in 0..100_000 {
        let d = lens.ray(random(&mut rng), Vec2::new(0.5, 0.5)).direction;
        across.add((d.y / d.x).to_f64().powi(2));
        along.add((d.z / d.x).to_f64().powi(2));
    }
    for (what, m, width) in [("width", across, 1.2f64), ("height", along, 0.8)] {
        let test = mean_against(&m, width * width / 12.0).at(5e-5);
        assert!(test.passed(), "{what}: {test}");
    }
}

/// Edges of the lens's unit square, and film positions outside the picture, give unit directions.
#[test]
fn extreme_numbers_give_rays() {
    for focus in [1e-3, 1.0, f64::INFINITY] {
        let lens = lens(focus, 1.0);
        for film in [Vec2::new(0.0, 0.0), Vec2::new(-0.1, 1.1), Vec2::new(0.999_999_94, 0.5)] {
            for corner in [Vec2::new(0.0, 0.0), Vec2::new(0.999_999_94, 0.0), Vec2::new(0.5, 0.5)] {
                let ray = lens.ray(film, corner);
                let unit = (ray.direction.length() - 1.0).abs() < 1e-5;
                assert!(
                    unit && ray.origin.is_finite() && ray.importance > 0.0 && ray.importance <= 1.0,
                    "{ray:?}"
                );
            }
        }
    }
}
