//! Rays are deflected as the far field says, for every wavelength.

use indigo_camera::{Aperture, Blades, Camera, FarField, Pupil, ThinLens, ThinLensParameters};
use indigo_math::{Float, Real, Vec2, Vec3d};
use indigo_spectrum::{LANES, SampledWavelengths};
use indigo_testkit::fit::lowest_point;
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_testkit::ztest::mean_against;

/// f/10 before a sensor of 36 mm.
const DISTANCE: f64 = 0.02;
const RADIUS: f64 = 0.001;
const WIDTH: f64 = 0.036;

fn camera(aperture: &Aperture) -> (Camera, FarField) {
    let lens = ThinLens::new(&ThinLensParameters {
        position: Vec3d::ZERO,
        forwards: Vec3d::new(1.0, 0.0, 0.0),
        up: Vec3d::new(0.0, 0.0, 1.0),
        aperture_radius: RADIUS,
        focus_distance: 3.0,
        sensor_width: WIDTH,
        sensor_height: WIDTH,
        lens_sensor_dist: DISTANCE,
        lens_shift: [0.0; 2],
        vignetting: true,
    });
    let field = Pupil::new(aperture.clone(), None).far_field().expect("an opening");
    let camera = Camera::new(lens.expect("it looks somewhere"), aperture.clone());
    (camera.with_diffraction(&field), field)
}

fn random(rng: &mut Rng) -> Vec2 {
    Vec2::new(rng.uniform_f32() as Real, rng.uniform_f32() as Real)
}

/// For each lane: a function of the offset in cycles, averaged over rays, each with the weight that
/// the lane has in an estimate: its density over the mean of all lanes'.
fn averages(camera: &Camera, n: u32, f: impl Fn(f64, f64) -> f64) -> [Moments; LANES] {
    let mut rng = Rng::new(9);
    let mut moments = [Moments::default(); LANES];
    for _ in 0..n {
        // All heroes take their turn, so that each lane's estimate is balanced over them.
        let lambda = SampledWavelengths::sample(rng.uniform_f32() as Real);
        let ray = camera.sample(Vec2::new(0.5, 0.5), random(&mut rng), random(&mut rng), &lambda, 0.0);
        assert!(ray.ratio[0] == 1.0 && ray.direction.is_finite() && ray.offset.x.is_finite());
        let metres = [ray.offset.x.to_f64() * WIDTH, -ray.offset.y.to_f64() * WIDTH];
        for (lane, m) in moments.iter_mut().enumerate() {
            let cycle = 1e-9 * lambda.lambda[lane].to_f64() * DISTANCE / (2.0 * RADIUS);
            let weight = (ray.ratio[lane] / ray.ratio.mean()).to_f64();
            m.add(weight * f(metres[0] / cycle, metres[1] / cycle));
        }
    }
    moments
}

/// The mean of a lane is that of the far field only if all lanes are taken together, as each of them is
/// hero now and then: what the balance heuristic promises is the sum.
fn assert_mean(camera: &Camera, what: &str, exact: f64, f: impl Fn(f64, f64) -> f64) {
    let lanes = averages(camera, 200_000, f);
    // Lanes of one ray go together: their mean is one number a ray.
    let mean = lanes.iter().map(Moments::mean).sum::<f64>() / LANES as f64;
    let error = lanes.iter().map(Moments::std_error).fold(0.0, f64::max);
    assert!(error < 0.02 * exact.max(0.05), "{what}: {error} is too much to tell");
    // 4.4 standard errors: a false alarm in 1e-5.
    assert!((mean - exact).abs() < 4.4 * error, "{what}: {mean} instead of {exact} ± {error}");
}

#[test]
fn offsets_have_the_distances_of_the_far_field_in_every_lane() {
    let (camera, field) = camera(&Aperture::Circular);
    for r in [0.5, 1.22, 3.0, 10.0, 40.0] {
        assert_mean(&camera, &format!("beyond {r}"), field.beyond(r), |x, y| {
            f64::from(u8::from(x.hypot(y) > r))
        });
    }
}

/// The picture of a lamp by deflected rays, pixel by pixel: since the pattern is the same all over the film, a ray that is
/// deflected by an offset shows the lamp at a pixel that lies by as much beside it. `lamp` gives a point of it in pixels;
/// `to_pixels` brings an offset in metres at a wavelength to pixels from the middle.
fn picture(
    camera: &Camera,
    side: usize,
    n: u32,
    mut lamp: impl FnMut(&mut Rng) -> [f64; 2],
    to_pixels: impl Fn([f64; 2], f64) -> [f64; 2],
) -> Vec<f64> {
    let mut rng = Rng::new(21);
    let mut pixels = vec![0.0; side * side];
    for _ in 0..n {
        let lambda = SampledWavelengths::sample(rng.uniform_f32() as Real);
        let ray = camera.sample(Vec2::new(0.5, 0.5), random(&mut rng), random(&mut rng), &lambda, 0.0);
        let metres = [ray.offset.x.to_f64() * WIDTH, -ray.offset.y.to_f64() * WIDTH];
        let of_lamp = lamp(&mut rng);
        for lane in 0..LANES {
            let offset = to_pixels(metres, lambda.lambda[lane].to_f64());
            let [x, y] = [0, 1].map(|a| (offset[a] + of_lamp[a] + side as f64 / 2.0).floor());
            let inside = 0.0..side as f64;
            if inside.contains(&x) && inside.contains(&y) {
                pixels[y as usize * side + x as usize] += (ray.ratio[lane] / ray.ratio.mean()).to_f64();
            }
        }
    }
    pixels
}

/// Distance from the middle of a picture's pixel, and its direction in turns.
fn polar(i: usize, side: usize) -> [f64; 2] {
    let [x, y] = [i % side, i / side].map(|v| v as f64 + 0.5 - side as f64 / 2.0);
    [x.hypot(y), (y.atan2(x) / std::f64::consts::TAU).rem_euclid(1.0)]
}

/// The first two dark rings of a point in the picture lie at the zeros of J1 over π cycles; sixteen pixels are a
/// cycle of each wavelength.
#[test]
fn the_pictures_rings_have_their_radii() {
    let (camera, _) = camera(&Aperture::Circular);
    let (side, scale) = (96, 16.0);
    let picture = picture(
        &camera,
        side,
        2_000_000,
        |_| [0.0; 2],
        |metres, lambda| metres.map(|m| scale * m / (1e-9 * lambda * DISTANCE / (2.0 * RADIUS))),
    );
    for radius in [1.21967, 2.23313] {
        // r³ takes out that rings become darker with the distance.
        let points = picture.iter().enumerate().map(|(i, v)| {
            let [r, _] = polar(i, side);
            (r, r.powi(3) * v)
        });
        let found = lowest_point(points, radius * scale, 0.2 * scale).expect("a dark ring") / scale;
        assert!((found / radius - 1.0).abs() < 0.02, "dark at {found} cycles instead of {radius}");
    }
}

/// The sun, in white light: a disc four pixels wide, with streaks across each edge of the opening to both sides.
#[test]
fn the_sun_has_as_many_streaks_as_its_aperture() {
    for (n, count) in [(5, 10), (6, 6), (7, 14)] {
        let blades = Blades::new(n, 0.1, 0.4, 1e6).expect("an opening");
        let (camera, _) = camera(&Aperture::generated(&blades));
        let side = 128;
        let disc = |rng: &mut Rng| {
            let (r, phi) = (2.0 * rng.uniform().sqrt(), std::f64::consts::TAU * rng.uniform());
            [r * phi.cos(), r * phi.sin()]
        };
        // A pixel is a cycle of green light wide.
        let pixel = 550e-9 * DISTANCE / (2.0 * RADIUS);
        let sun = picture(&camera, side, 1_000_000, disc, |metres, _| metres.map(|m| m / pixel));
        let mut bins = [0.0; 120];
        for (i, v) in sun.iter().enumerate() {
            let [r, turn] = polar(i, side);
            if (24.0..60.0).contains(&r) {
                bins[(turn * 120.0) as usize % 120] += v;
            }
        }
        let mean = bins.iter().sum::<f64>() / 120.0;
        let is_peak = |i: usize| {
            bins[i] > 1.5 * mean
                && (1..4).all(|k| bins[i] >= bins[(i + k) % 120] && bins[i] > bins[(i + 120 - k) % 120])
        };
        assert_eq!((0..120).filter(|&i| is_peak(i)).count(), count, "{n} blades: {bins:?}");
    }
}

/// Bits of light in a quarter turn and along the streaks of a triangle.
#[test]
fn offsets_have_the_directions_of_the_far_field_in_every_lane() {
    let blades = Blades::new(3, 0.3, 0.24, 1e6).expect("a triangle");
    let (camera, field) = camera(&Aperture::generated(&blades));
    let along_streaks = |x: f64, y: f64| {
        let turn = (y.atan2(x) - 0.3) / (std::f64::consts::PI / 3.0);
        (turn - turn.round()).abs() < 0.1
    };
    let mut exact = 0.0;
    let radii = field.radii();
    for i in 0..radii.len() - 1 {
        if radii[i] < 2.0 {
            continue;
        }
        let (row, _) = field.at_radius(0.5 * (radii[i] + radii[i + 1]));
        for (j, &d) in row.iter().enumerate() {
            let [x, y] = indigo_camera::diffraction::far_field::direction(j as f64 + 0.5);
            if along_streaks(x, y) {
                let width = field.sector_widths()[j];
                exact += f64::from(d) * width * (radii[i + 1].powi(2) - radii[i].powi(2));
            }
        }
    }
    let last = *radii.last().expect("rings");
    assert_mean(&camera, "streaks", exact, |x, y| {
        f64::from(u8::from((2.0..last).contains(&x.hypot(y)) && along_streaks(x, y)))
    });
}

/// Without companions the hero alone decides: no weight, and the pattern of its wavelength.
#[test]
fn the_pattern_grows_with_the_wavelength() {
    let (camera, field) = camera(&Aperture::Circular);
    let mut rng = Rng::new(2);
    for u in [0.02, 0.5, 0.95] {
        let lambda = SampledWavelengths::sample(u);
        let radius = 1.22 * 1e-9 * lambda.lambda[0].to_f64() * DISTANCE / (2.0 * RADIUS);
        let mut beyond = Moments::default();
        for _ in 0..100_000 {
            let ray = camera.sample(Vec2::new(0.5, 0.5), random(&mut rng), random(&mut rng), &lambda, 0.0);
            let metres = ray.offset.x.to_f64().hypot(ray.offset.y.to_f64()) * WIDTH;
            beyond.add(f64::from(u8::from(metres > radius)));
        }
        let test = mean_against(&beyond, field.beyond(1.22)).at(1e-5);
        assert!(test.passed(), "{u}: {test}");
    }
}

/// The ray is that of the place to which it is deflected, and its inverse finds that place.
#[test]
fn a_deflected_ray_belongs_to_another_film_position() {
    let (camera, _) = camera(&Aperture::Circular);
    let mut rng = Rng::new(3);
    let lambda = SampledWavelengths::sample(0.4);
    for _ in 0..1000 {
        let film = random(&mut rng);
        let ray = camera.sample(film, random(&mut rng), random(&mut rng), &lambda, 0.0);
        let found = camera.film_position(ray.origin, ray.direction, 0.0).expect("it looks forwards").position;
        let off = found - ray.offset - film;
        let size = ray.offset.x.abs().max(ray.offset.y.abs()).max(1.0);
        assert!(off.x.abs().max(off.y.abs()) < 1e-4 * size, "{off:?}");
    }
}

/// Numbers at both ends of [0, 1) give finite offsets.
#[test]
fn extreme_numbers_are_deflected_too() {
    const LAST: Real = 1.0 - Real::EPSILON / 2.0;
    let (camera, _) = camera(&Aperture::Circular);
    let lambda = SampledWavelengths::sample(0.9);
    for u in [0.0, 1e-8, 0.25, 0.5, LAST] {
        for v in [0.0, 0.499_999_97, 0.5, LAST] {
            let ray = camera.sample(Vec2::new(0.5, 0.5), Vec2::new(0.1, 0.2), Vec2::new(u, v), &lambda, 0.0);
            assert!(ray.direction.is_finite() && ray.ratio.is_finite(), "{u} {v}: {ray:?}");
            assert!(ray.importance > 0.0 && ray.importance <= 1.0, "{u} {v}: {ray:?}");
        }
    }
}

/// The density of an offset that weights go by does not depend on which of the wavelengths is the hero, whose own does.
#[test]
fn the_mean_density_of_an_offset_is_that_of_any_hero() {
    let (camera, _) = camera(&Aperture::Circular);
    let film = Vec2::new(0.5, 0.5);
    let mut rng = Rng::new(3);
    for _ in 0..20 {
        let (u, lens) = (random(&mut rng), random(&mut rng));
        let lambda = SampledWavelengths::sample(rng.uniform_f32() as Real);
        let first = camera.sample(film, lens, u, &lambda, 0.0);
        for turn in 1..LANES {
            let mut turned = lambda;
            turned.lambda.rotate_left(turn);
            turned.pdf.rotate_left(turn);
            // The number that leads this hero just as far: the larger, the farther or the nearer.
            let at = |x: Real| camera.sample(film, lens, Vec2::new(x, u.y), &turned, 0.0);
            let [near, far] = [0.01, 0.99].map(|x: Real| at(x).offset_disc);
            let (mut lo, mut hi): (Real, Real) = (0.0, 1.0);
            for _ in 0..40 {
                let middle = 0.5 * (lo + hi);
                let goes_on = (at(middle).offset_disc < first.offset_disc) == (near < far);
                if goes_on { lo = middle } else { hi = middle }
            }
            let same = at(lo);
            let quotient = same.offset_density / first.offset_density;
            assert!((quotient - 1.0).abs() < 1e-3, "{u:?}, turn {turn}: {quotient}");
            assert!((same.offset_disc / first.offset_disc - 1.0).abs() < 1e-3);
        }
    }
}
