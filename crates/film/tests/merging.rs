//! Films combine by addition: the order and grouping of what is merged do not matter, nor the
//! number of threads that merge.

use indigo_film::{FilmDelta, FilmError, FilmFilter, FilmSize, FilmState, Filter, LayerKind, MasterFilm};
use indigo_math::rng::Rng;
use indigo_math::{Real, Vec2};
use proptest::prelude::*;

const LAYERS: [(LayerKind, &str); 2] = [(LayerKind::PerPixel, "camera"), (LayerKind::PerScreen, "splats")];

fn size() -> FilmSize {
    FilmSize::new(50, 41, 2).unwrap()
}

/// A delta of random samples and splats, brightness estimates and one refused contribution.
fn delta(seed: u64, samples: u32) -> FilmDelta {
    let size = size();
    let filter = FilmFilter::new(Filter::MN_DEFAULT, size).unwrap();
    let mut delta = FilmDelta::new(size, LAYERS.map(|l| l.0));
    let mut rng = Rng::new(seed);
    for _ in 0..samples {
        let p = Vec2::new(rng.next_real() * 100.0, rng.next_real() * 82.0);
        let xyz = [0, 1, 2].map(|_| (rng.next_f64() * 10.0) as f32);
        delta.add_sample(0, (p.x as u32).min(99), (p.y as u32).min(81), xyz, 0.5);
        delta.splat(1, p, xyz, &filter);
        delta.add_brightness(1, rng.next_f64(), 1);
    }
    delta.add_samples(1, u64::from(samples));
    delta.add_sample(0, 0, 0, [f32::NAN, 0.0, 0.0], 1.0);
    delta
}

fn merged(deltas: &[&FilmDelta]) -> FilmState {
    let mut film = FilmState::new(size(), &LAYERS);
    for delta in deltas {
        film.merge(delta).unwrap();
    }
    film
}

/// Equal but for the rounding of a few additions of numbers up to some thousands.
fn assert_close(a: &FilmState, b: &FilmState) {
    assert_eq!(a.refused, b.refused);
    for (a, b) in a.layers.iter().zip(&b.layers) {
        assert_eq!((&a.counts, a.totals.n_samples), (&b.counts, b.totals.n_samples));
        assert!((a.totals.b_sum - b.totals.b_sum).abs() < 1e-10);
        for (a, b) in a.sums.iter().flatten().zip(b.sums.iter().flatten()) {
            assert!((a - b).abs() < 1e-10, "{a} and {b}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn order_and_grouping_do_not_matter(seed in 0u64..1000, n in 0u32..2000) {
        let [a, b, c] = [seed, seed + 1000, seed + 2000].map(|s| delta(s, n));
        let forwards = merged(&[&a, &b, &c]);
        assert_close(&forwards, &merged(&[&c, &a, &b]));

        let mut left = merged(&[&a, &b]);
        left.merge_state(&merged(&[&c])).unwrap();
        let mut right = merged(&[&a]);
        right.merge_state(&merged(&[&b, &c])).unwrap();
        assert_close(&left, &right);
        assert_close(&left, &forwards);
    }
}

#[test]
fn threads_merge_what_one_would() {
    let deltas: Vec<FilmDelta> = (0..8).map(|seed| delta(seed, 3000)).collect();
    let master = MasterFilm::new(size(), &LAYERS).unwrap();
    std::thread::scope(|scope| {
        for pair in deltas.chunks(2) {
            let master = &master;
            scope.spawn(move || pair.iter().for_each(|delta| master.merge(delta).unwrap()));
        }
    });
    let state = merged(&deltas.iter().collect::<Vec<_>>());
    assert_close(&master.snapshot(), &state);
    assert_eq!(master.samples_per_pixel(), state.samples_per_pixel());
    assert_eq!(master.memory_bytes(), state.memory_bytes());
    assert_eq!(master.refused(), 8);
}

#[test]
fn the_same_order_gives_the_same_bits() {
    let deltas: Vec<FilmDelta> = (0..4).map(|seed| delta(seed, 2000)).collect();
    let master = MasterFilm::new(size(), &LAYERS).unwrap();
    for delta in &deltas {
        master.merge(delta).unwrap();
    }
    let state = merged(&deltas.iter().collect::<Vec<_>>());
    assert_eq!(master.snapshot(), state);
    assert_eq!(master.develop(&indigo_film::LightMix::default()), state.develop());

    let resumed = MasterFilm::new(size(), &LAYERS).unwrap();
    resumed.merge_state(&state).unwrap();
    assert_eq!(resumed.snapshot(), state);
}

#[test]
fn a_film_without_memory_for_it_says_how_much_it_needs() {
    let kinds = LAYERS.map(|l| l.0);
    let bytes = MasterFilm::bytes_needed(FilmSize::new(32_768, 16_384, 1).unwrap(), kinds);
    // Two layers of four doubles, and a count.
    assert_eq!(bytes, (1 << 29) * 72);
    let error = FilmError::OutOfMemory { width: 32_768, height: 16_384, super_sample: 1, bytes };
    let said = error.to_string();
    for part in ["width 32768", "height 16384", "super_sample_factor 1", "36864 MiB"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn foreign_films_are_refused() {
    let mut film = FilmState::new(size(), &LAYERS);
    let master = MasterFilm::new(size(), &LAYERS).unwrap();
    let other_size = FilmSize::new(50, 41, 1).unwrap();
    let other = FilmState::new(other_size, &LAYERS);
    assert_eq!(film.merge_state(&other), Err(FilmError::SizeMismatch(size(), other_size)));
    assert_eq!(master.merge_state(&other), Err(FilmError::SizeMismatch(size(), other_size)));
    assert_eq!(film.merge(&other.delta()), Err(FilmError::SizeMismatch(size(), other_size)));
    for layers in [&LAYERS[..1], &[LAYERS[1], LAYERS[0]], &[LAYERS[0], (LayerKind::PerScreen, "light")]] {
        let other = FilmState::new(size(), layers);
        assert_eq!(film.merge_state(&other), Err(FilmError::LayerMismatch));
        assert_eq!(master.merge_state(&other), Err(FilmError::LayerMismatch));
    }
    assert_eq!(film.merge(&FilmDelta::new(size(), [LayerKind::PerPixel])), Err(FilmError::LayerMismatch));
}

#[test]
fn a_cleared_delta_is_as_good_as_new() {
    let mut used = delta(1, 500);
    assert!(!used.is_empty());
    let bytes = used.memory_bytes();
    used.clear();
    assert!(used.is_empty());
    assert_eq!(used.memory_bytes(), bytes);
    assert_eq!(merged(&[&used]), FilmState::new(size(), &LAYERS));

    let mut taken = delta(1, 500);
    let contents = taken.take();
    assert!(taken.is_empty() && taken.memory_bytes() < bytes);
    assert_eq!(merged(&[&contents]), merged(&[&delta(1, 500)]));
}

#[test]
fn contributions_that_are_no_numbers_leave_no_trace() {
    let size = size();
    let filter = FilmFilter::new(Filter::Gaussian, size).unwrap();
    let mut film = FilmState::new(size, &LAYERS);
    let mut delta = film.delta();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e31] {
        delta.add_sample(0, 3, 3, [1.0, bad, 1.0], 1.0);
        delta.add_sample(0, 3, 3, [1.0, 1.0, 1.0], bad);
        delta.splat(1, Vec2::new(3.0, 3.0), [1.0, 1.0, bad], &filter);
    }
    delta.splat(1, Vec2::new(Real::NAN, 3.0), [1.0; 3], &filter);
    delta.add_brightness(1, f64::NAN, 1);
    film.merge(&delta).unwrap();
    assert_eq!((delta.refused(), film.refused), (14, 14));
    film.refused = 0;
    assert_eq!(film, FilmState::new(size, &LAYERS));
}
