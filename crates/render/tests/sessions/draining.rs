//! Films taken from a running session, as network slaves take them.

use super::{options, room};
use indigo_film::{FilmRecord, Run, SavedFilm, igi};
use indigo_render::{Event, Options, Session};
use indigo_scene::Scene;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The ways of rendering, by their settings.
const MODES: [(&str, &str); 4] = [
    ("path tracing", "<metropolis>false</metropolis><bidirectional>false</bidirectional>"),
    ("bidirectional", "<metropolis>false</metropolis><bidirectional>true</bidirectional>"),
    ("Metropolis", "<metropolis>true</metropolis><bidirectional>true</bidirectional>"),
    ("hybrid", "<metropolis>true</metropolis><bidirectional>true</bidirectional><hybrid>true</hybrid>"),
];

/// Relative difference of the same sums taken in another order, in double precision.
const ROUNDING: f64 = 1e-12;

/// Renders to the end and drains again and again meanwhile; all that was drained.
fn drained(mut session: Session) -> Vec<SavedFilm> {
    let deadline = Instant::now() + super::PATIENCE;
    let mut films = vec![];
    loop {
        let event = session.wait(Duration::from_millis(15));
        films.extend(session.drain("test"));
        if let Event::Halted(..) = event {
            assert!(session.drain("test").is_none(), "nothing is left");
            return films;
        }
        assert!(Instant::now() < deadline, "the session hangs");
    }
}

fn undisturbed(scene: &Arc<Scene>, options: &Options) -> SavedFilm {
    let mut session = Session::start(Arc::clone(scene), options).expect("threads");
    super::finish(&mut session);
    session.saved("test")
}

fn run_of(film: &SavedFilm) -> Run {
    match &film.record.as_ref().expect("ours").runs[..] {
        [run] => *run,
        runs => panic!("one run is expected, not {runs:?}"),
    }
}

/// Equal but for the rounding of sums in another order.
#[track_caller]
fn assert_same(mode: &str, a: &SavedFilm, b: &SavedFilm) {
    let near = |a: f64, b: f64| (a - b).abs() <= ROUNDING * a.abs().max(b.abs());
    for (a, b) in a.film.layers.iter().zip(&b.film.layers) {
        assert_eq!(a.counts, b.counts, "{mode}");
        let whole = |t: &indigo_film::Totals| (t.n_samples, t.n_idle, t.b_count);
        assert_eq!(whole(&a.totals), whole(&b.totals), "{mode}");
        assert!(near(a.totals.b_sum, b.totals.b_sum), "{mode}: {:?} {:?}", a.totals, b.totals);
        for (a, b) in a.sums.as_flattened().iter().zip(b.sums.as_flattened()) {
            assert!(near(*a, *b), "{mode}: {a} and {b}");
        }
    }
    let samples = |film: &SavedFilm| film.record.as_ref().map(|record| record.samples);
    assert_eq!(samples(a), samples(b), "{mode}");
}

#[test]
fn what_is_drained_adds_up_to_the_film_of_an_undisturbed_render() {
    for (mode, settings) in MODES {
        let scene = room(settings);
        let options = options(3, 60);
        let films = drained(Session::start(Arc::clone(&scene), &options).expect("threads"));
        assert!(films.len() > 2, "{mode}: only {} drains", films.len());
        let mut end = 0;
        for film in &films {
            let run = run_of(film);
            assert!(
                run.seed == options.seed && run.first == end && run.end > end,
                "{mode}: {run:?} after {end}"
            );
            end = run.end;
        }
        let mut sum = films[0].clone();
        for film in &films[1..] {
            sum.merge(film).expect("runs that follow each other");
        }
        assert_eq!(run_of(&sum), Run { seed: options.seed, first: 0, end });
        assert_same(mode, &sum, &undisturbed(&scene, &options));
    }
}

/// As they travel: the sums lose what is beyond single precision, counts and totals nothing.
#[test]
fn drained_films_travel_in_single_precision() {
    let scene = room(MODES[1].1);
    let film = undisturbed(&scene, &options(2, 4));
    let mut bytes = vec![];
    igi::write_parcel(&mut bytes, &film.film, film.record.as_ref().expect("ours")).expect("memory");
    let back = igi::read_parcel(&bytes).expect("a sound parcel");
    assert_eq!(back.record, film.record);
    for (back, sent) in back.film.layers.iter().zip(&film.film.layers) {
        assert_eq!((&back.name, back.kind, back.totals), (&sent.name, sent.kind, sent.totals));
        assert_eq!(back.counts, sent.counts);
        let single: Vec<f64> = sent.sums.as_flattened().iter().map(|v| f64::from(*v as f32)).collect();
        assert_eq!(back.sums.as_flattened(), single);
    }
}

#[test]
fn what_goes_to_another_film_begins_behind_its_random_numbers() {
    let scene = room(MODES[0].1);
    let options = options(2, 2);
    let used = Run { seed: options.seed, first: 0, end: 123 };
    let other =
        FilmRecord { runs: vec![used, Run { seed: 99, first: 0, end: 500 }], ..FilmRecord::default() };
    let films = drained(Session::start_beside(scene, &options, &other).expect("threads"));
    let first = films.first().map(run_of).expect("a film");
    assert_eq!((first.seed, first.first), (options.seed, 123));
    let samples: u64 =
        films.iter().filter_map(|film| film.record.as_ref()).map(|record| record.samples).sum();
    assert_eq!(samples, 2 * 48 * 48, "the other film's samples are not this one's");
}
