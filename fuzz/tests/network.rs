//! The fuzz targets of network rendering: what a master makes of what slaves send.

mod common;

use common::fuzz;
use indigo_film::igi::{Parcel, parcel_size, read_parcel, write_parcel};
use indigo_film::{FilmRecord, FilmSize, FilmState, LayerKind, Run, SavedFilm, Totals};
use indigo_net::ledger::Ledger;
use indigo_net::proto;
use prost::Message;

const SEED: u64 = 7;

fn size() -> FilmSize {
    FilmSize::new(5, 3, 2).unwrap()
}

/// A film as slaves send them, or one without samples.
fn film(samples: f64) -> SavedFilm {
    let mut film =
        FilmState::new(size(), &[(LayerKind::PerPixel, "camera"), (LayerKind::PerScreen, "metropolis")]);
    let totals = Totals { n_samples: samples, b_sum: 2.0 * samples, b_count: samples, ..Totals::default() };
    if samples > 0.0 {
        film.layers[0].sums[7] = [1.5, -0.25, 3.0, samples];
        film.layers[0].counts[7] = samples;
        film.layers[0].totals.n_samples = samples;
        film.layers[1].sums.iter_mut().for_each(|sum| *sum = [0.1, 0.2, 0.3, 0.4]);
        film.layers[1].totals = totals;
    }
    let runs = if samples > 0.0 { vec![Run { seed: SEED, first: 0, end: 4 }] } else { vec![] };
    let settings = vec![("width".to_owned(), "5".to_owned())];
    let samples = (film.samples_per_pixel() * film.size.pixels() as f64) as u64;
    SavedFilm { film, record: Some(FilmRecord { runs, samples, settings, ..FilmRecord::default() }) }
}

fn parcel() -> Vec<u8> {
    let mut bytes = vec![];
    let film = film(9.0);
    write_parcel(&mut bytes, &film.film, film.record.as_ref().unwrap()).unwrap();
    bytes
}

/// Whatever is taken, the master's film stays one that can be saved, and counts whole samples.
#[test]
fn upload() {
    fuzz(&[parcel()], |bytes| {
        // As a master does, so that no parcel is unpacked that is larger than the film.
        let opened = Parcel::open(bytes);
        if parcel_size(bytes) == Ok(size()) {
            let unpacked = read_parcel(bytes);
            assert_eq!(opened.as_ref().err(), unpacked.as_ref().err(), "both ways see the same");
        }
        if let Ok(sent) = opened
            && sent.size() == size()
        {
            let mut ledger = Ledger::new(film(0.0)).unwrap();
            let taken = ledger.take(SEED, &sent);
            let sum = ledger.copy();
            if taken.is_ok() {
                let mut unpacked = film(0.0);
                unpacked.merge(&read_parcel(bytes).unwrap()).unwrap();
                assert_eq!(sum, unpacked);
            }
            let whole = |n: f64| n >= 0.0 && n.fract() == 0.0;
            assert!(sum.film.layers.iter().flat_map(|l| &l.sums).flatten().all(|v| v.is_finite()));
            assert!(sum.film.layers.iter().flat_map(|l| &l.counts).all(|n| whole(*n)));
            assert!(sum.film.layers.iter().all(|l| whole(l.totals.n_samples) && l.totals.b_sum.is_finite()));
            assert_eq!(sum == film(0.0), taken.is_err(), "{taken:?}");
        }
    });
}

/// Every message that a peer may send, of any bytes.
#[test]
fn message() {
    let part = |part| proto::UploadPart { part: Some(part) }.encode_to_vec();
    let seeds = [
        proto::JoinRequest {
            protocol: 1,
            program: "Indigo".to_owned(),
            slave: vec![1; 16].into(),
            seed: 3,
            name: "box".to_owned(),
            threads: 2,
        }
        .encode_to_vec(),
        proto::JoinReply {
            scene: "scene.igs".to_owned(),
            pack_hash: vec![2; 32].into(),
            overrides: vec![proto::Setting {
                option: "-t".to_owned(),
                name: "x".to_owned(),
                value: "1".to_owned(),
            }],
            ..proto::JoinReply::default()
        }
        .encode_to_vec(),
        part(proto::upload_part::Part::Start(proto::UploadStart {
            slave: vec![1; 16].into(),
            bytes: 1 << 20,
        })),
        part(proto::upload_part::Part::Data(vec![5; 100].into())),
    ];
    fuzz(&seeds, |bytes| {
        drop(proto::JoinRequest::decode(bytes));
        drop(proto::JoinReply::decode(bytes));
        drop(proto::SceneRequest::decode(bytes));
        drop(proto::Piece::decode(bytes));
        drop(proto::UploadPart::decode(bytes));
        drop(proto::UploadReply::decode(bytes));
        drop(proto::ReportRequest::decode(bytes));
        drop(proto::ReportReply::decode(bytes));
        drop(proto::LeaveRequest::decode(bytes));
    });
}

/// A seed that is not itself taken teaches nothing.
#[test]
fn seeds_are_sound() {
    let sent = read_parcel(&parcel()).unwrap();
    assert!(Ledger::new(film(0.0)).unwrap().take(SEED, &sent).is_ok());
}
