//! What the film costs a worker: a camera sample, a splat, a hand-over to the shared film.
//!
//! The film has 1600 × 1200 internal pixels. "dense" deltas touch each pixel once, "sparse" ones
//! every twentieth, as a worker of 100,000 samples/s does in a second.

use indigo_film::{FilmDelta, FilmFilter, FilmSize, Filter, LayerKind, MasterFilm};
use indigo_math::rng::Rng;
use indigo_math::{Real, Vec2};
use std::hint::black_box;
use std::time::Instant;

const LAYERS: [(LayerKind, &str); 1] = [(LayerKind::PerPixel, "camera")];
/// Samples of a run: few enough that some runs have a processor to themselves.
const N: u32 = 50_000;

/// The best of fifty runs, in seconds: the one that other programs disturbed least.
fn best(mut run: impl FnMut() -> f64) -> f64 {
    (0..50).map(|_| run()).fold(f64::INFINITY, f64::min)
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn fill(delta: &mut FilmDelta, samples: u32, seed: u64) {
    let mut rng = Rng::new(seed);
    for _ in 0..samples {
        let (x, y) = (rng.below(1600) as u32, rng.below(1200) as u32);
        delta.add_sample(0, x, y, [1.0, 2.0, 3.0], 1.0);
    }
}

fn positions(size: FilmSize) {
    for filter in [Filter::Box, Filter::Gaussian, Filter::MN_DEFAULT] {
        let fitted = FilmFilter::new(filter, size).expect("a filter with good parameters");
        let mut rng = Rng::new(1);
        let each = best(|| {
            seconds(|| {
                for i in 0..N {
                    black_box(fitted.sample(i % 1600, i % 1200, [rng.next_real(), rng.next_real()]));
                }
            })
        }) / f64::from(N);
        println!("draw a film position, {filter:?}: {:.1} ns", each * 1e9);

        let mut delta = FilmDelta::new(size, [LayerKind::PerScreen]);
        let each = best(|| {
            seconds(|| {
                for _ in 0..N {
                    let p = Vec2::new(rng.next_real() * 1600.0, rng.next_real() * 1200.0 as Real);
                    delta.splat(0, p, [1.0; 3], &fitted);
                }
            })
        }) / f64::from(N);
        println!("splat at a random place, {filter:?}: {:.1} ns", each * 1e9);
    }
}

fn hand_over(size: FilmSize) {
    let master = MasterFilm::new(size, &LAYERS).unwrap();
    for (name, samples) in [("dense", 1_920_000), ("sparse", 100_000)] {
        let mut deltas: Vec<FilmDelta> = (0..2).map(|_| master.delta()).collect();
        let one = best(|| {
            fill(&mut deltas[0], samples, 7);
            seconds(|| {
                master.merge(&deltas[0]).expect("a delta of this film");
                deltas[0].clear();
            })
        });
        let both = best(|| {
            for delta in &mut deltas {
                fill(delta, samples, 7);
            }
            seconds(|| {
                std::thread::scope(|scope| {
                    for delta in &mut deltas {
                        scope.spawn(|| {
                            master.merge(delta).expect("a delta of this film");
                            delta.clear();
                        });
                    }
                });
            })
        });
        println!(
            "hand over, {name}: {:.1} ms alone, {:.1} ms for two workers at once; {:.0} MB a worker",
            one * 1e3,
            both * 1e3,
            deltas[0].memory_bytes() as f64 / 1e6
        );
    }
    println!("shared film: {:.0} MB", master.memory_bytes() as f64 / 1e6);
    println!(
        "develop to XYZ: {:.1} ms",
        best(|| seconds(|| drop(black_box(master.develop(&indigo_film::LightMix::default()))))) * 1e3
    );
    println!("snapshot: {:.1} ms", best(|| seconds(|| drop(black_box(master.snapshot())))) * 1e3);
}

fn main() {
    let size = FilmSize::new(800, 600, 2).expect("a good size");
    let mut delta = FilmDelta::new(size, [LayerKind::PerPixel]);
    let each = best(|| seconds(|| fill(&mut delta, N, 3))) / f64::from(N);
    println!("add a sample at a random place: {:.1} ns, its random numbers included", each * 1e9);
    positions(size);
    hand_over(size);
}
