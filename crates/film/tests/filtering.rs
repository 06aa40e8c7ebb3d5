//! The splat filter: what it samples, and the image that sampling and splatting form.

use indigo_film::{FilmFilter, FilmSize, FilmState, Filter, LayerKind};
use indigo_math::rng::Rng;
use indigo_math::{Real, Vec2};
use indigo_testkit::chi2::{Chi2, Domain};

const FILTERS: [Filter; 5] = [
    Filter::Box,
    Filter::Gaussian,
    Filter::MN_DEFAULT,
    Filter::MitchellNetravali { blur: 1.0, ring: 0.0 },
    Filter::MitchellNetravali { blur: 0.0, ring: 1.0 },
];

fn film_filter(filter: Filter, width: u32, height: u32) -> FilmFilter {
    FilmFilter::new(filter, FilmSize::new(width, height, 1).unwrap()).unwrap()
}

/// ∫|f| over an interval by the midpoint rule.
fn absolute_integral(filter: Filter, from: f64, to: f64) -> f64 {
    let n = 20_000;
    let h = (to - from) / f64::from(n);
    (0..n).map(|i| filter.eval(from + (f64::from(i) + 0.5) * h).abs()).sum::<f64>() * h
}

/// Film positions of a pixel follow |f| around its centre, cut off at the film's edge. The family
/// of tests raises a false alarm with probability 1e-4.
#[test]
fn positions_follow_the_filter() {
    let (width, height) = (9u32, 3u32);
    for filter in FILTERS {
        let fitted = film_filter(filter, width, height);
        for (x, len) in [(0, width), (1, width), (4, width), (8, width), (2, height)] {
            let centre = f64::from(x) + 0.5;
            let lo = (-centre).max(-filter.radius());
            let hi = (f64::from(len) - centre).min(filter.radius());
            let mass = absolute_integral(filter, lo, hi);
            let result = Chi2::new(Domain::Interval(lo, hi)).among(5 * FILTERS.len()).run(
                |rng| {
                    let u = [rng.uniform() as Real, rng.uniform() as Real];
                    let at = if len == width {
                        fitted.sample(x, 1, u).position.x
                    } else {
                        fitted.sample(4, x, u).position.y
                    };
                    Some([f64::from(at) - centre, 0.0, 0.0])
                },
                |p| filter.eval(p[0]).abs() / mass,
            );
            assert!(result.passed(), "{filter:?}, pixel {x} of {len}: {result}");
        }
    }
}

/// Moments of the weighted offset: mass 1, mean 0, and the filter's variance: 1/12 for the box,
/// 0.35² for the Gaussian but for its cut-off tails, and B/3 for Mitchell-Netravali (C drops out).
#[test]
fn moments_are_the_filters() {
    for (filter, variance) in [
        (Filter::Box, 1.0 / 12.0),
        (Filter::Gaussian, 0.1225),
        (Filter::MN_DEFAULT, second_moment(Filter::MN_DEFAULT)),
        (Filter::MitchellNetravali { blur: 1.0, ring: 0.0 }, 1.0 / 3.0),
        (Filter::MitchellNetravali { blur: 0.0, ring: 0.5 }, 0.0),
    ] {
        let fitted = film_filter(filter, 9, 9);
        let n = 100_000;
        let mut moments = [0.0; 3];
        for i in 0..n {
            let s = fitted.sample(4, 4, [(i as Real + 0.5) / n as Real, 0.5]);
            // The other axis is held at its median, where its weight is a constant: divide it out.
            let weight = f64::from(s.weight);
            let x = f64::from(s.position.x) - 4.5;
            for (moment, power) in moments.iter_mut().zip([1.0, x, x * x]) {
                *moment += weight * power / f64::from(n);
            }
        }
        let [mass, mean, second] = moments;
        assert!((mean / mass).abs() < 1e-4, "{filter:?}: mean {mean}");
        assert!((second / mass - variance).abs() < 2e-4, "{filter:?}: variance {}", second / mass);
    }
}

fn second_moment(filter: Filter) -> f64 {
    let n = 100_000;
    let h = 2.0 * filter.radius() / f64::from(n);
    let at = |i: i32| -filter.radius() + (f64::from(i) + 0.5) * h;
    (0..n).map(|i| at(i) * at(i) * filter.eval(at(i))).sum::<f64>() * h
}

/// A weight of exactly 1 is what makes a constant image exactly constant.
#[test]
fn non_negative_filters_weigh_one() {
    for filter in [Filter::Box, Filter::Gaussian, Filter::MitchellNetravali { blur: 1.0, ring: 0.0 }] {
        let fitted = film_filter(filter, 3, 1);
        for i in 0..1000 {
            let u = i as Real / 1000.0;
            for x in 0..3 {
                let sample = fitted.sample(x, 0, [u, 1.0 - u - 1e-4]);
                assert_eq!(sample.weight, 1.0, "{filter:?}");
                assert!((0.0..=3.0).contains(&sample.position.x) && (0.0..=1.0).contains(&sample.position.y));
            }
        }
    }
}

/// Radiance that both ways must image alike: a slanted gradient and an edge.
fn radiance(p: Vec2) -> f32 {
    let gradient = 0.3 * p.x + 0.2 * p.y;
    f64::from(if p.x > 2.3 { gradient + 4.0 } else { gradient }) as f32
}

/// The expected image of splatting, by a fine regular grid of film positions.
fn splatted(fitted: &FilmFilter, size: FilmSize, per_pixel: u32, radiance: impl Fn(Vec2) -> f32) -> Vec<f32> {
    let mut film = FilmState::new(size, &[(LayerKind::PerScreen, "splats")]);
    let mut delta = film.delta();
    let step = 1.0 / per_pixel as Real;
    for j in 0..size.internal_height() * per_pixel {
        for i in 0..size.internal_width() * per_pixel {
            let p = Vec2::new((i as Real + 0.5) * step, (j as Real + 0.5) * step);
            delta.splat(0, p, [0.0, radiance(p), 0.0], fitted);
        }
        delta.add_samples(0, u64::from(size.internal_width() * per_pixel));
        film.merge(&delta).unwrap();
        delta.clear();
    }
    film.develop().pixels.iter().map(|p| p[1]).collect()
}

/// The expected image of camera samples, by jittered random numbers.
fn sampled(fitted: &FilmFilter, size: FilmSize, radiance: impl Fn(Vec2) -> f32) -> Vec<f32> {
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
    let mut delta = film.delta();
    let n = 300;
    let mut rng = Rng::new(5);
    for y in 0..size.internal_height() {
        for x in 0..size.internal_width() {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let u = [i, j].map(|v| (v as Real + rng.next_real()) / n as Real);
                let s = fitted.sample(x, y, u);
                delta.add_sample(0, x, y, [0.0, radiance(s.position) * f64::from(s.weight) as f32, 0.0], 1.0);
            }
            film.merge(&delta).unwrap();
            delta.clear();
        }
    }
    film.develop().pixels.iter().map(|p| p[1]).collect()
}

#[test]
fn sampling_and_splatting_form_the_same_image() {
    let size = FilmSize::new(6, 4, 1).unwrap();
    for filter in FILTERS {
        let fitted = FilmFilter::new(filter, size).unwrap();
        let (a, b) = (splatted(&fitted, size, 100, radiance), sampled(&fitted, size, radiance));
        for (i, (a, b)) in a.iter().zip(&b).enumerate() {
            // What is jittered is smooth but for jumps of up to 5 along four lines (the edge and
            // the filter's changes of sign, where weights of ±1.1 meet), each of which crosses 300
            // of the 90,000 cells: standard deviation below 11 · √1200 / 2 / 90,000 = 0.0021. The
            // bound is at six of them and the splats' own quadrature (1e-4): no false alarm.
            assert!((a - b).abs() < 0.013, "{filter:?}, pixel {i}: {a} splatted, {b} sampled");
        }
    }
}

#[test]
fn a_constant_image_stays_constant() {
    for (width, height) in [(5, 3), (1, 1), (1, 4), (2, 1)] {
        let size = FilmSize::new(width, height, 1).unwrap();
        for filter in FILTERS {
            let fitted = FilmFilter::new(filter, size).unwrap();
            for value in splatted(&fitted, size, 200, |_| 2.0) {
                // Where the border cuts the filter the grid's midpoint rule errs by h²/24 · |f'| at
                // each end: 8e-6 on a film of one pixel.
                assert!((value / 2.0 - 1.0).abs() < 1e-5, "{filter:?} {width} x {height}: {value}");
            }
        }
    }
}

/// Each position belongs to one pixel of the box, its edges included, and none outside the film.
#[test]
fn the_box_touches_one_pixel() {
    let fitted = film_filter(Filter::Box, 7, 5);
    for i in 0..=28 {
        let x = i as Real / 4.0;
        let footprint = fitted.footprint(Vec2::new(x, 2.0));
        assert_eq!(footprint.extent, [1, 1]);
        assert_eq!(footprint.origin, [(x.floor() as u32).min(6), 2]);
        assert_eq!((footprint.columns[0], footprint.rows[0]), (1.0, 1.0));
    }
    for outside in [-0.01, 7.01] {
        assert_eq!(fitted.footprint(Vec2::new(outside, 2.0)).extent[0], 0);
        assert_eq!(fitted.footprint(Vec2::new(2.0, outside)).extent[1], 0);
    }
}
