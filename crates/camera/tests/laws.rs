//! The lens is sampled evenly, and the film is a faithful map of directions.

use indigo_camera::{Aperture, Blades, Camera, CameraKind, GreyImage, ThinLens, ThinLensParameters};
use indigo_math::{Float, Motion, Pose, Real, Vec2, Vec3, Vec3d};
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
        lens_shift: [0.0; 2],
        vignetting: true,
    })
    .expect("a camera that looks somewhere")
}

fn camera(focus_distance: f64, aperture_radius: f64) -> Camera {
    Camera::new(lens(focus_distance, aperture_radius), Aperture::Circular)
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
    let lens = camera(5.0, 0.2);
    let result = Chi2::new(Domain::Disk).run(
        |rng| Some(on_disk(lens.ray(Vec2::new(0.2, 0.9), random(rng)).origin, 0.2)),
        |_| std::f64::consts::FRAC_1_PI,
    );
    assert!(result.passed(), "{result}");
}

/// Apertures of every kind.
fn apertures() -> Vec<(&'static str, Aperture)> {
    let blades = |n, offset, radius| {
        let blades = Blades::new(n, 0.4, offset, radius).expect("blades with an opening");
        Aperture::generated(&blades)
    };
    let spot = |x: usize, y: usize| 1.0 - ((x as f32 - 9.0).hypot(y as f32 - 4.0) / 12.0).min(1.0);
    let image = GreyImage { width: 16, height: 16, texels: (0..256).map(|i| spot(i % 16, i / 16)).collect() };
    vec![
        ("circle", Aperture::Circular),
        ("triangle", blades(3, 0.24, 1e6)),
        ("five curved blades", blades(5, 0.35, 0.6)),
        ("seven blades from the far side", blades(7, 0.5, 0.4)),
        ("a square that the square cuts", blades(4, 0.48, 1e6)),
        ("image", Aperture::image(&image).expect("an image that is not black")),
    ]
}

/// The density of lens points is the transmission over its integral, as drawn on cells; the domain is
/// the square in which apertures are drawn. False-alarm probability 1e-4 each.
#[test]
fn lens_points_follow_the_drawing_of_the_aperture() {
    const SIDE: usize = 64;
    for (name, aperture) in apertures() {
        let mask = aperture.draw(SIDE);
        let sum: f64 = mask.cells.iter().map(|&c| f64::from(c)).sum();
        let cell = |v: f64| ((v * SIDE as f64) as usize).min(SIDE - 1);
        // Cells of the test are whole cells of the drawing.
        let test = Chi2 { cells: [16, 16], ..Chi2::new(Domain::Square) };
        let result = test.run(
            |rng| {
                let p = aperture.sample(random(rng));
                Some([0.5 * (p.x.to_f64() + 1.0), 0.5 * (p.y.to_f64() + 1.0), 0.0])
            },
            |[x, y, _]| {
                let transmission = f64::from(mask.cells[(SIDE - 1 - cell(y)) * SIDE + cell(x)]);
                transmission * (SIDE * SIDE) as f64 / sum
            },
        );
        assert!(result.passed(), "{name}: {result}");
        let area = 4.0 * sum / (SIDE * SIDE) as f64;
        assert!((area / aperture.area() - 1.0).abs() < 1e-3, "{name}: {area} against {}", aperture.area());
    }
}

/// The map from the square is continuous almost everywhere and reaches the edges, so that even numbers
/// make even points, and none of them leaves the drawing.
#[test]
fn extreme_numbers_give_points_of_the_aperture() {
    const LAST: Real = 1.0 - Real::EPSILON / 2.0;
    for (name, aperture) in apertures() {
        for u in [0.0, 1e-7, 0.5, LAST] {
            for v in [0.0, 1e-7, 0.5, LAST] {
                let p = aperture.sample(Vec2::new(u, v));
                assert!(p.x.abs() <= 1.0 && p.y.abs() <= 1.0, "{name}: {p:?}");
            }
        }
    }
}

/// Where the rays of one film point cross a plane at a distance d they fill a disc of radius
/// r |1 - d / focus|: each coordinate has a quarter of its square as variance. False-alarm
/// probability 1e-4 for all six tests together.
#[test]
fn the_blur_disc_grows_with_the_distance_from_the_plane_of_focus() {
    let (radius, focus) = (0.05, 4.0);
    let lens = camera(focus, radius);
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
    let lens = camera(4.0, 0.05);
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
    let lens = camera(1.0, 1e-6);
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
        let lens = camera(focus, 1.0);
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

/// A camera of a kind that looks along x, with z up, from [`POSITION`].
fn without_lens(kind: CameraKind) -> Camera {
    let parameters = ThinLensParameters {
        position: POSITION.cast(),
        forwards: Vec3d::new(1.0, 0.0, 0.0),
        up: Vec3d::new(0.0, 0.0, 1.0),
        aperture_radius: 0.1,
        focus_distance: 2.0,
        sensor_width: 3.0,
        sensor_height: 2.0,
        lens_sensor_dist: 0.03,
        lens_shift: [0.0; 2],
        vignetting: true,
    };
    Camera::new(kind.optics(&parameters).expect("a camera that looks somewhere"), Aperture::Circular)
}

/// Cells of the sphere have the solid angle that the density tells, over all of it. False-alarm probability 1e-4.
#[test]
fn a_spherical_camera_sees_directions_by_its_density() {
    let camera = without_lens(CameraKind::Spherical);
    let result = Chi2::new(Domain::Sphere).run(
        |rng| {
            let d = camera.ray(random(rng), Vec2::new(0.5, 0.5)).direction;
            Some(d.to_array().map(Float::to_f64))
        },
        |d| {
            let d = Vec3d::from(d).cast();
            let at_distance = camera.pdf_direction(d, 7.0, 0.0);
            assert_eq!(at_distance, camera.pdf_direction(d, 1.0, 0.0));
            at_distance.to_f64()
        },
    );
    assert!(result.passed(), "{result}");
}

/// Rays of an orthographic camera fill the sensor evenly, and as evenly what lies before it: the density over area across them
/// is one over that of the sensor at any distance. False-alarm probability 1e-4.
#[test]
fn an_orthographic_camera_sees_by_area() {
    let camera = without_lens(CameraKind::Orthographic);
    let result = Chi2::new(Domain::Square).run(
        |rng| {
            let ray = camera.ray(random(rng), Vec2::new(0.5, 0.5));
            assert_eq!(ray.direction, camera.forwards());
            let p = ray.origin + ray.direction * (9.0 * rng.uniform_f32() as Real) - POSITION;
            Some([0.5 - p.y.to_f64() / 3.0, 0.5 + p.z.to_f64() / 2.0, 0.0])
        },
        |_| 1.0,
    );
    assert!(result.passed(), "{result}");
    for distance in [0.5, 1.0, 20.0] {
        let density = camera.pdf_direction(camera.forwards(), distance, 0.0) / (distance * distance);
        assert!((density * 6.0 - 1.0).abs() < 1e-6, "{density}");
    }
}

/// Whatever a ray of any kind of camera passes, is seen by one that begins where that one does, at its film position, be it
/// still or moving.
#[test]
fn what_is_seen_is_found_again() {
    let lens = camera(4.0, 0.05);
    let others = [CameraKind::Orthographic, CameraKind::Spherical].map(without_lens);
    let mut rng = Rng::new(6);
    let pose = |x: f64, angle: f64| Pose {
        pos: Vec3d::new(x, 2.0 * x, 0.0),
        turn: ((angle / 2.0).cos(), Vec3d::new(0.0, 0.6, 0.8) * (angle / 2.0).sin()),
    };
    let still: Vec<Camera> = [lens].into_iter().chain(others).collect();
    let moving = still.clone().into_iter().map(|camera| {
        camera.with_motion(Motion::new(vec![(0.0, pose(0.0, 0.3)), (1.0, pose(3.0, 1.0))]).expect("poses"))
    });
    for camera in still.iter().cloned().chain(moving) {
        for _ in 0..1000 {
            let film = Vec2::new(0.5, 0.5) + (random(&mut rng) - Vec2::new(0.5, 0.5)) * 0.98;
            let time = rng.uniform_f32() as Real;
            let ray = camera.ray_at(film, random(&mut rng), time);
            let seen = ray.origin + ray.direction * 3.0;
            let origin = camera.origin_towards(seen, ray.origin, time);
            assert!((origin - ray.origin).length() < 1e-5, "{ray:?} {origin:?}");
            let found =
                camera.film_position(origin, (seen - origin).normalized(), time).expect("before the camera");
            // Near the poles a turn is told by a hundredth of the direction.
            let way = found.position - film;
            assert!(way.x.abs() < 1e-4 && way.y.abs() < 1e-4, "{film:?} {found:?}");
            assert_eq!(found.importance > 0.0, ray.importance > 0.0);
        }
    }
}
