//! Uploads good and bad.

use super::*;
use indigo_film::{FilmSize, FilmState};

fn film(seed: u64, first: u64, end: u64) -> SavedFilm {
    let size = FilmSize::new(2, 1, 1).expect("a size");
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
    let samples = end - first;
    film.layers[0].counts[0] = samples as f64;
    film.layers[0].sums[0] = [samples as f64, 1.0, 1.0, 1.0];
    film.layers[0].totals.n_samples = samples as f64;
    let runs = if samples > 0 { vec![Run { seed, first, end }] } else { vec![] };
    SavedFilm { film, record: Some(FilmRecord { runs, samples, ..FilmRecord::default() }) }
}

fn ledger() -> Ledger {
    Ledger::new(film(0, 0, 0)).expect("a film of ours")
}

fn changed(change: impl FnOnce(&mut SavedFilm)) -> SavedFilm {
    let mut film = film(7, 0, 5);
    change(&mut film);
    film
}

#[test]
fn each_upload_counts_once() {
    let mut ledger = ledger();
    let receipt = ledger.take(7, &film(7, 0, 5)).unwrap();
    assert_eq!((receipt.merged_end, receipt.durable_end, receipt.is_repeated), (5, 0, false));
    assert!(ledger.take(7, &film(7, 0, 5)).unwrap().is_repeated);
    assert!(ledger.take(8, &film(8, 0, 5)).is_ok(), "another's");
    assert_eq!(ledger.record().samples, 10);
    let refused = ledger.take(7, &film(7, 3, 9)).unwrap_err();
    assert_eq!(refused, Refusal::Overlap { seed: 7, first: 3, last: 4 });
    let receipt = ledger.take(7, &film(7, 8, 9)).unwrap();
    assert_eq!((receipt.merged_end, receipt.missing), (9, 3));
    assert_eq!(ledger.record().samples, 11);
}

#[test]
fn a_master_that_is_started_anew_knows_what_its_film_holds() {
    let mut ledger = ledger();
    ledger.take(7, &film(7, 0, 5)).unwrap();
    let saved = ledger.copy();
    let receipt = ledger.take(7, &film(7, 5, 6)).unwrap();
    assert_eq!((receipt.durable_end, receipt.generation), (0, Some(1)));
    ledger.saved(saved.record.clone().unwrap());
    assert_eq!(ledger.ends(7), (6, 5));
    let mut again = Ledger::new(saved).unwrap();
    assert_eq!(again.ends(7), (5, 5));
    assert!(again.take(7, &film(7, 0, 5)).unwrap().is_repeated);
    assert!(!again.take(7, &film(7, 5, 6)).unwrap().is_repeated);
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut ledger = ledger();
    let refused = |ledger: &mut Ledger, film: &SavedFilm| ledger.take(7, film).unwrap_err();
    assert_eq!(refused(&mut ledger, &film(8, 0, 5)), Refusal::NotOneRun, "another's seed");
    assert_eq!(refused(&mut ledger, &changed(|f| f.record = None)), Refusal::NotOneRun);
    let two = changed(|f| f.record.as_mut().unwrap().runs.push(Run { seed: 9, first: 0, end: 1 }));
    assert_eq!(refused(&mut ledger, &two), Refusal::NotOneRun);
    let slow = changed(|f| f.record.as_mut().unwrap().elapsed_s = 1e308);
    assert_eq!(refused(&mut ledger, &slow), Refusal::Time);
    let impossible = [
        changed(|f| f.record.as_mut().unwrap().samples = 6),
        changed(|f| f.film.layers[0].counts[0] = 4.5),
        changed(|f| f.film.layers[0].counts[1] = 1.0),
        changed(|f| f.film.layers[0].totals.n_samples = 1e300),
        changed(|f| f.film.layers[0].totals.n_idle = f64::NAN),
        changed(|f| f.film.layers[0].totals.b_sum = f64::MAX),
    ];
    for (n, film) in impossible.iter().enumerate() {
        assert_eq!(refused(&mut ledger, film), Refusal::Samples, "{n}");
    }
    let other_scene = changed(|f| f.record.as_mut().unwrap().scene_hash = [1; 32]);
    assert!(refused(&mut ledger, &other_scene).to_string().contains("the scene itself"));
    let setting = ("max_depth".to_owned(), "3".to_owned());
    let other_setting = changed(|f| f.record.as_mut().unwrap().settings.push(setting));
    assert!(refused(&mut ledger, &other_setting).to_string().contains("max_depth is 3 there"));
    let other_layer = changed(|f| f.film.layers[0].name = "light".to_owned());
    assert!(matches!(refused(&mut ledger, &other_layer), Refusal::Mismatch(_)));
    assert_eq!(ledger.copy(), film(0, 0, 0));
}
