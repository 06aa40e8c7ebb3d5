//! What 32 slaves cost their master that send films of two megapixels every 40 seconds.
//!
//! The master is this process; the slaves are another, so that the processor time of this one is the master's alone. They
//! send one film after another without pause: what matters is the time that the master needs for each.
//!
//! `cargo bench -p indigo-net --bench uploads`

use bytes::Bytes;
use indigo_film::igi::write_parcel;
use indigo_film::{FilmRecord, FilmSize, FilmState, LayerKind, Run, SavedFilm};
use indigo_net::key::Key;
use indigo_net::limits::{PIECE, PROTOCOL};
use indigo_net::master::{Master, SceneParcel, Setup};
use indigo_net::proto::upload_part::Part;
use indigo_net::proto::{JoinRequest, UploadPart, UploadStart};
use indigo_net::slave::Connector;
use indigo_scene::Identity;
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

const SLAVES: u64 = 32;
/// Uploads of each slave.
const UPLOADS: u64 = 2;
/// Seconds between uploads, unless a scene says otherwise.
const PERIOD_S: f64 = 40.0;
const PROGRAM: &str = "bench";
/// Tells this program to be the slaves.
const BE_SLAVES: &str = "--slaves";
/// The layers of bidirectional path tracing: more than any other mode without `save_layers_exr` has.
const LAYERS: [(LayerKind, &str); 2] = [(LayerKind::PerPixel, "camera"), (LayerKind::PerScreen, "light")];

fn size() -> FilmSize {
    FilmSize::new(1600, 1250, 1).expect("two million pixels")
}

/// A film of sums as random as those of samples are.
fn film(seed: u64, samples: u64, first: u64) -> SavedFilm {
    let mut film = FilmState::new(size(), &LAYERS);
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    if samples > 0 {
        for layer in &mut film.layers {
            layer.sums.iter_mut().flatten().for_each(|sum| *sum = 30.0 * random() * random());
            layer.counts.fill(samples as f64);
            layer.totals.n_samples = samples as f64 * size().pixels() as f64;
        }
    }
    let samples = samples * size().pixels() as u64;
    let runs = if samples > 0 { vec![Run { seed, first, end: first + 1 }] } else { vec![] };
    SavedFilm { film, record: Some(FilmRecord { runs, samples, ..FilmRecord::default() }) }
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    match arguments.iter().position(|argument| argument == BE_SLAVES) {
        Some(at) => be_slaves(&arguments[at + 1], &arguments[at + 2]),
        None => be_master(),
    }
}

fn be_master() {
    let key = Key::random().expect("randomness");
    let scene = SceneParcel {
        name: "bench".to_owned(),
        pack: Bytes::new(),
        settings_file: None,
        overrides: vec![],
        identity: Identity::default(),
        upload_period: Duration::from_secs_f64(PERIOD_S),
    };
    let (program, page) = (PROGRAM.to_owned(), None);
    let setup =
        Setup { scene, film: film(0, 0, 0), program, key: Some(key.clone()), own_seed: None, port: 0, page };
    let master = Master::start(setup, Arc::new(|_| {})).expect("a free port");
    let port = master.address().port().to_string();
    let start = cpu_time::ProcessTime::now();
    let me = std::env::current_exe().expect("this program");
    let ended = Command::new(me).args([BE_SLAVES, &port, &key.text()]).status().expect("the slaves");
    assert!(ended.success());
    let used = start.elapsed().as_secs_f64();
    let uploads = SLAVES * UPLOADS;
    assert_eq!(master.record().samples, uploads * size().pixels() as u64, "all of them are in the film");
    let each = used / uploads as f64;
    println!(
        "{uploads} uploads of {} MiB: {:.0} ms of the master's processor time each; {SLAVES} slaves every {PERIOD_S} s: \
         {:.1}% of a core; at most {} MiB of memory",
        (master.status().bytes_received / uploads) >> 20,
        1e3 * each,
        100.0 * each * SLAVES as f64 / PERIOD_S,
        peak_mib().map_or_else(|| "?".to_owned(), |mib| mib.to_string()),
    );
}

/// The most memory that this process has had, where the system tells.
fn peak_mib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? >> 10)
}

fn be_slaves(port: &str, key: &str) {
    let (port, key) = (port.parse().expect("a port"), Key::parse(key).expect("a key"));
    let runtime =
        tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build().expect("threads");
    // One film for all: what differs between them is the record.
    let sums = film(1, 1, 0);
    let sums = Arc::new(sums);
    runtime.block_on(async {
        let slaves: Vec<_> = (1..=SLAVES)
            .map(|seed| tokio::spawn(be_slave(seed, port, key.clone(), Arc::clone(&sums))))
            .collect();
        for slave in slaves {
            slave.await.expect("a slave");
        }
    });
}

async fn be_slave(seed: u64, port: u16, key: Key, sums: Arc<SavedFilm>) {
    let connector = Connector::new(Some(&key)).expect("encryption");
    let mut client = connector.connect("127.0.0.1", port).await.expect("the master");
    let slave = Bytes::from([[seed as u8; 16]].concat());
    let (program, name) = (PROGRAM.to_owned(), "simulated".to_owned());
    let request = JoinRequest { protocol: PROTOCOL, program, slave: slave.clone(), seed, name, threads: 1 };
    client.join(request).await.expect("it may join");
    for first in 0..UPLOADS {
        let mut record = sums.record.clone().expect("ours");
        record.runs = vec![Run { seed, first, end: first + 1 }];
        let mut parcel = vec![];
        write_parcel(&mut parcel, &sums.film, &record).expect("memory");
        let parcel = Bytes::from(parcel);
        let start = Part::Start(UploadStart { slave: slave.clone(), bytes: parcel.len() as u64 });
        let pieces = (0..parcel.len())
            .step_by(PIECE)
            .map(move |from| Part::Data(parcel.slice(from..(from + PIECE).min(parcel.len()))));
        let parts = std::iter::once(start).chain(pieces).map(|part| UploadPart { part: Some(part) });
        client.upload(tokio_stream::iter(parts)).await.expect("it is added");
    }
}
