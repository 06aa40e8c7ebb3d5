//! Going on with a film, and adding films.
//!
//! Films pass through the bytes of a file on their way. Verdicts on Markov chains are Welch tests of block
//! means over independent batches of fixed seeds, with a false alarm anywhere in this file at 1e-4.

use super::{finish, options, small_scene, small_scene_with};
use indigo_film::{FilmState, Mismatch, SavedFilm, igi};
use indigo_render::{Halt, Options, Session, SessionError};
use indigo_scene::Scene;
use indigo_testkit::sidak;
use indigo_testkit::zgrid::{BlockGrid, ZGrid};
use std::sync::Arc;

/// Probability of any false alarm, over the comparisons below.
const FAMILY: f64 = 1e-4;
const COMPARISONS: usize = 16;
/// Independent renders of each kind.
const BATCHES: u64 = 12;
/// Blocks along a side of the picture.
const BLOCKS: usize = 4;

/// The scene in a mode: bidirectional, Metropolis, hybrid. A large ball stands in for the infinite plane, which
/// cannot be traced from both ends.
fn scene([bidirectional, metropolis, hybrid]: [bool; 3]) -> Arc<Scene> {
    const PLANE: &str = "<plane><normal>0 0 1</normal><dist>0</dist>";
    small_scene_with(1, |text| {
        text.replace("<bidirectional>false", &format!("<bidirectional>{bidirectional}"))
            .replace("<metropolis>false", &format!("<hybrid>{hybrid}</hybrid><metropolis>{metropolis}"))
            .replace(PLANE, "<sphere><center>0 0 -50</center><radius>50</radius>")
            .replace("</plane>", "</sphere>")
    })
}

fn ran(mut session: Session) -> SavedFilm {
    finish(&mut session);
    through_a_file(&session.saved("test"))
}

fn through_a_file(saved: &SavedFilm) -> SavedFilm {
    let mut bytes = vec![];
    igi::write(&mut bytes, &saved.film, saved.record.as_ref().expect("ours")).expect("memory");
    let back = igi::read(&bytes).expect("a sound file");
    assert_eq!(&back, saved);
    back
}

fn render(scene: &Arc<Scene>, options: &Options) -> SavedFilm {
    ran(Session::start(Arc::clone(scene), options).expect("threads"))
}

fn go_on(scene: &Arc<Scene>, options: &Options, saved: &SavedFilm) -> SavedFilm {
    ran(Session::go_on(Arc::clone(scene), options, saved).expect("the same scene"))
}

/// In the order of the units even the bits agree; otherwise sums differ by rounding. 5 passes and 7: the first
/// stop lies within a cycle through the internal pixels.
#[test]
fn independent_samples_go_on_as_if_they_had_never_paused() {
    for bidirectional in [false, true] {
        let scene = scene([bidirectional, false, false]);
        let once = render(&scene, &options(2, 12));
        let first = render(&scene, &options(2, 5));
        let both = go_on(&scene, &options(1, 12), &first);
        assert_eq!(both.film, once.film);
        let (a, b) = (both.record.expect("ours"), once.record.expect("ours"));
        assert_eq!((a.samples, a.runs), (b.samples, b.runs));
        let loose = Options { deterministic: false, ..options(3, 12) };
        let loose = go_on(&scene, &loose, &first);
        for (a, b) in loose.film.layers.iter().zip(&once.film.layers) {
            assert_eq!((&a.counts, a.totals), (&b.counts, b.totals));
            for (a, b) in a.sums.as_flattened().iter().zip(b.sums.as_flattened()) {
                // As many single-precision additions as splats may fall on a pixel.
                assert!((a - b).abs() <= 64.0 * 6e-8 * a.abs().max(b.abs()), "{a} and {b}");
            }
        }
    }
}

/// Another seed on top of a film: twice the samples, none of them twice.
#[test]
fn another_seed_adds_its_own_samples() {
    let scene = scene([false, false, false]);
    let first = render(&scene, &options(2, 4));
    let other = Options { seed: 12, ..options(2, 8) };
    let both = go_on(&scene, &other, &first);
    let mut sum = first.clone();
    sum.merge(&render(&scene, &Options { seed: 12, ..options(2, 4) })).expect("another seed");
    assert_eq!(both.film.layers[0].counts, sum.film.layers[0].counts);
    for (a, b) in both.film.layers[0].sums.as_flattened().iter().zip(sum.film.layers[0].sums.as_flattened()) {
        assert!((a - b).abs() <= 1e-12 * a.abs());
    }
    assert_eq!(both.record.expect("ours").runs, sum.record.expect("ours").runs);
}

fn block_means(film: &FilmState) -> Vec<f64> {
    let (picture, side) = (film.develop(), film.size.internal_width() as usize);
    let block = side / BLOCKS;
    let mean = |b: usize| {
        let (x, y) = (b % BLOCKS * block, b / BLOCKS * block);
        let pixels = (0..block * block).map(|i| (y + i / block) * side + x + i % block);
        pixels.map(|i| f64::from(picture.pixels[i][1])).sum::<f64>() / (block * block) as f64
    };
    (0..BLOCKS * BLOCKS).map(mean).collect()
}

fn grid(mut film: impl FnMut(u64) -> FilmState) -> BlockGrid {
    let mut grid = BlockGrid::new(BLOCKS, BLOCKS);
    for batch in 0..BATCHES {
        grid.add_batch(&block_means(&film(batch))).expect("a mean for each block");
    }
    grid
}

#[track_caller]
fn assert_agree(what: &str, a: &BlockGrid, b: &BlockGrid) {
    let test = ZGrid { family_level: sidak(FAMILY, COMPARISONS), rounding: 1e-5 };
    let result = test.compare(a, b).expect("grids of one shape");
    assert!(result.passed(), "{what}: {result}");
}

/// Halves that go on, and quarters that are added, expect what one render of all samples does; in all modes
/// with Markov chains, whose starts and brightness estimates must be neither lost nor counted twice.
#[test]
fn resumed_and_merged_markov_chains_make_the_same_picture() {
    for mode in [[false, true, false], [true, true, false], [false, true, true], [true, true, true]] {
        let scene = scene(mode);
        let with = |seed, spp| Options { seed, ..options(2, spp) };
        let once = grid(|batch| render(&scene, &with(100 + batch, 16)).film);
        let resumed = grid(|batch| {
            let half = render(&scene, &with(200 + batch, 8));
            let both = go_on(&scene, &with(200 + batch, 16), &half);
            let record = both.record.as_ref().expect("ours");
            assert!(record.samples >= 48 * 48 * 16 && record.runs.len() == 1, "{record:?}");
            both.film
        });
        let merged = grid(|batch| {
            let quarter = |i| render(&scene, &with(1000 + 10 * batch + i, 4));
            let mut sum = quarter(0);
            (1..4).for_each(|i| sum.merge(&quarter(i)).expect("another seed"));
            sum.film
        });
        assert_agree(&format!("{mode:?}, resumed"), &once, &resumed);
        assert_agree(&format!("{mode:?}, merged"), &once, &merged);
    }
}

/// Chains that go on under the same seed must not repeat what they did.
#[test]
fn chains_that_go_on_use_fresh_randomness() {
    let scene = scene([false, true, false]);
    let half = render(&scene, &options(2, 4));
    let both = go_on(&scene, &options(2, 8), &half);
    let (a, b) = (&half.film.layers[0], &both.film.layers[0]);
    let repeated = a.sums.iter().zip(&b.sums).filter(|(a, b)| (b[1] - 2.0 * a[1]).abs() <= 1e-9 * b[1]);
    assert!(repeated.count() < a.sums.len() / 2, "the second half is the first one again");
}

/// Wherever a film left off: in the midst of a pass, whose tiles are of different sizes, too.
#[test]
fn a_halt_gives_no_fewer_samples_when_it_is_gone_on_to() {
    let scene = scene([false, false, true]);
    let mut film = render(&scene, &options(2, 1));
    for wanted in [2, 3, 5, 9, 16] {
        film = go_on(&scene, &options(2, wanted), &film);
        let found = film.film.samples_per_pixel();
        // No more than a pair of units above.
        let most = wanted as f64 + f64::from(2048 + 1024) / f64::from(48 * 48);
        assert!((wanted as f64..=most).contains(&found), "{found} instead of {wanted}");
    }
}

#[test]
fn a_film_of_another_picture_is_refused_with_all_differences() {
    let (film, ball) = (render(&small_scene(1, ""), &options(1, 1)), scene([false; 3]));
    let ball = render(&ball, &options(1, 1));
    let reasons = |scene: Arc<Scene>, film: &SavedFilm| match Session::go_on(scene, &options(1, 2), film) {
        Err(SessionError::Mismatch(reasons)) => reasons,
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("it goes on"),
    };
    let names = |scene, film| -> Vec<String> {
        let name = |m: &Mismatch| match m {
            Mismatch::Setting { name, .. } => name.clone(),
            other => other.to_string(),
        };
        reasons(scene, film).iter().map(name).collect()
    };
    assert_eq!(names(scene([true, false, false]), &ball), ["bidirectional"]);
    assert_eq!(
        names(small_scene(2, "<max_depth>3</max_depth>"), &film),
        ["super_sample_factor", "max_depth"]
    );
    let brighter = small_scene_with(1, |text| text.replace("10000", "10001"));
    assert_eq!(reasons(brighter, &film), [Mismatch::Scene]);
    // How it is developed, how long it is rendered and how it is named make no difference.
    let developed = small_scene_with(1, |text| {
        text.replace("<linear><scale>1<", "<linear><scale>2<")
            .replace("<cache_trees>", "<halt_time>5</halt_time><cache_trees>")
            .replace("<aperture_radius>", "<white_balance>D50</white_balance><aperture_radius>")
    });
    let halt = Halt { samples_per_pixel: Some(2), ..Halt::default() };
    let options = Options { halt, ..options(1, 2) };
    assert_eq!(go_on(&developed, &options, &film).record.expect("ours").samples, 48 * 48 * 2);
}
