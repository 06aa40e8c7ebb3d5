//! What 32 slaves cost their master that send films of two megapixels every 40 seconds.
//!
//! The master is this process; the slaves are another, so that the processor time of this one is the master's alone. First
//! they all send at once, which is the most that a master is asked for, and shows its memory; then one after another, without
//! pause, as 32 slaves do that send every 40 seconds: one every 1.25 seconds. A slave packs its film while none sends, as it
//! does on a machine of its own.
//!
//! `cargo bench -p indigo-net --bench uploads`

use bytes::Bytes;
use indigo_film::igi::write_parcel;
use indigo_film::{FilmRecord, FilmSize, FilmState, LayerKind, Run, SavedFilm};
use indigo_net::key::Key;
use indigo_net::limits::{PIECE, PROTOCOL, REPORTS};
use indigo_net::master::{Master, SceneParcel, Setup};
use indigo_net::proto::farm_client::FarmClient;
use indigo_net::proto::upload_part::Part;
use indigo_net::proto::{JoinRequest, ReportRequest, UploadPart, UploadStart};
use indigo_net::slave::Connector;
use indigo_scene::Identity;
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Semaphore;
use tonic::transport::Channel;

const SLAVES: u64 = 32;
/// Uploads of each slave, in each of both ways.
const UPLOADS: u64 = 3;
/// Seconds between uploads, unless a scene says otherwise.
const PERIOD_S: f64 = 40.0;
const PROGRAM: &str = "bench";
/// Tells this program to be the slaves, and so many of them to send at a time.
const BE_SLAVES: &str = "--slaves";
/// The layers of bidirectional path tracing: more than any other mode without `save_layers_exr` has.
const LAYERS: [(LayerKind, &str); 2] = [(LayerKind::PerPixel, "camera"), (LayerKind::PerScreen, "light")];

fn size() -> FilmSize {
    FilmSize::new(1600, 1250, 1).expect("two million pixels")
}

/// A film of sums as random as those of samples are. All that the camera sees covers its pixel, and light on the film covers
/// nothing: alpha is that of scenes without an open background.
fn film(seed: u64, samples: u64, first: u64) -> SavedFilm {
    let mut film = FilmState::new(size(), &LAYERS);
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    if samples > 0 {
        for layer in &mut film.layers {
            let alpha = if layer.kind == LayerKind::PerPixel { samples as f64 } else { 0.0 };
            for sum in &mut layer.sums {
                *sum = [
                    30.0 * random() * random(),
                    30.0 * random() * random(),
                    30.0 * random() * random(),
                    alpha,
                ];
            }
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
        Some(at) => be_slaves(&arguments[at + 1..]),
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
    measure(&master, &key, "at once", SLAVES, 0);
    measure(&master, &key, "in turn", 1, UPLOADS);
}

/// Lets so many slaves at a time send, units from `first` on.
fn measure(master: &Master, key: &Key, how: &str, at_a_time: u64, first: u64) {
    let before = (master.record().samples, master.status().bytes_received);
    let start = cpu_time::ProcessTime::now();
    let me = std::env::current_exe().expect("this program");
    let numbers = [u64::from(master.address().port()), at_a_time, first].map(|n| n.to_string());
    let ended = Command::new(me).arg(BE_SLAVES).args(numbers).arg(key.text()).status().expect("the slaves");
    assert!(ended.success());
    let used = start.elapsed().as_secs_f64();
    let uploads = SLAVES * UPLOADS;
    let added = master.record().samples - before.0;
    assert_eq!(added, uploads * size().pixels() as u64, "all of them are in the film");
    let each = used / uploads as f64;
    println!(
        "{uploads} uploads of {} MiB {how}: {:.0} ms of the master's processor time each; {SLAVES} slaves every \
         {PERIOD_S} s: {:.1}% of a core; so far at most {} MiB of memory",
        ((master.status().bytes_received - before.1) / uploads) >> 20,
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

fn be_slaves(arguments: &[String]) {
    let [port, at_a_time, first, key] = arguments else { panic!("four arguments") };
    let (port, key) = (port.parse().expect("a port"), Key::parse(key).expect("a key"));
    let turns = Arc::new(Semaphore::new(at_a_time.parse().expect("a number")));
    let first: u64 = first.parse().expect("a number");
    let runtime =
        tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build().expect("threads");
    // One film for all: what differs between them is the record.
    let sums = film(1, 1, 0);
    let sums = Arc::new(sums);
    runtime.block_on(async {
        let slaves: Vec<_> = (1..=SLAVES)
            .map(|seed| {
                let (sums, turns) = (Arc::clone(&sums), Arc::clone(&turns));
                tokio::spawn(be_slave(seed, port, key.clone(), sums, turns, first))
            })
            .collect();
        for slave in slaves {
            slave.await.expect("a slave");
        }
    });
}

async fn be_slave(seed: u64, port: u16, key: Key, sums: Arc<SavedFilm>, turns: Arc<Semaphore>, first: u64) {
    let connector = Connector::new(Some(&key)).expect("encryption");
    let mut client = connector.connect("127.0.0.1", port).await.expect("the master");
    let slave = Bytes::from([[seed as u8; 16]].concat());
    let (program, name) = (PROGRAM.to_owned(), "simulated".to_owned());
    let request = JoinRequest { protocol: PROTOCOL, program, slave: slave.clone(), seed, name, threads: 1 };
    client.join(request).await.expect("it may join");
    let reports = tokio::spawn(report(client.clone(), slave.clone()));
    for first in first..first + UPLOADS {
        let _turn = turns.acquire().await.expect("it stays open");
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
    reports.abort();
}

/// Gives signs of life, as a slave does that waits for its turn.
async fn report(mut client: FarmClient<Channel>, slave: Bytes) {
    loop {
        tokio::time::sleep(REPORTS).await;
        let report = ReportRequest { slave: slave.clone(), ..ReportRequest::default() };
        client.report(report).await.expect("the master knows it");
    }
}
