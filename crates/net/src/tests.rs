//! A master against callers of all kinds, over sockets of this machine.

use crate::event::{Event, Sink};
use crate::key::Key;
use crate::limits::{MESSAGE, PROTOCOL};
use crate::master::{Master, Override, SceneParcel, Setup, Unsent};
use crate::proto::farm_client::FarmClient;
use crate::proto::upload_part::Part;
use crate::proto::{
    JoinReply, JoinRequest, ReportRequest, SceneRequest, UploadPart, UploadReply, UploadStart,
};
use crate::slave::calls::{Outcome, is_refused};
use crate::slave::visit::Life;
use crate::slave::{Connector, Loader, Options, SceneFiles};
use bytes::Bytes;
use indigo_film::igi::write_parcel;
use indigo_film::{FilmRecord, FilmSize, FilmState, LayerKind, Run, SavedFilm};
use indigo_scene::{Identity, Scene};
use std::io::{Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;
use tokio_stream::StreamExt as _;
use tonic::transport::Channel;
use tonic::{Code, Status};

const PROGRAM: &str = "Indigo of this test";
const SLAVE: [u8; 16] = [7; 16];
const SEED: u64 = 42;
/// What the master renders itself.
const OWN_SEED: u64 = 43;
/// More than a piece, so that the scene comes in several.
const PACK: usize = 1_000_000;

/// A film with a sample of each unit, in one pixel.
fn film(first: u64, end: u64) -> SavedFilm {
    let size = FilmSize::new(8, 4, 1).expect("a size");
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
    let samples = end - first;
    film.layers[0].counts[3] = samples as f64;
    film.layers[0].sums[3] = [1.0, 2.0, 3.0, 4.0].map(|v| v * samples as f64);
    film.layers[0].totals.n_samples = samples as f64;
    let runs = if samples > 0 { vec![Run { seed: SEED, first, end }] } else { vec![] };
    SavedFilm { film, record: Some(FilmRecord { runs, samples, ..FilmRecord::default() }) }
}

fn parcel(film: &SavedFilm) -> Vec<u8> {
    let mut bytes = vec![];
    write_parcel(&mut bytes, &film.film, film.record.as_ref().expect("ours")).expect("memory");
    bytes
}

/// A master, and what it has told.
struct Bench {
    master: Master,
    events: Arc<Mutex<Vec<Event>>>,
    runtime: Runtime,
    key: Option<Key>,
}

impl Bench {
    fn new(key: Option<Key>) -> Self {
        Self::running(key, PROGRAM)
    }

    /// Another program's master.
    fn running(key: Option<Key>, program: &str) -> Self {
        let events: Arc<Mutex<Vec<Event>>> = Arc::default();
        let told = Arc::clone(&events);
        let sink: Sink =
            Arc::new(move |event| told.lock().unwrap_or_else(PoisonError::into_inner).push(event));
        let scene = SceneParcel {
            name: "scene.igs".to_owned(),
            pack: (0..PACK).map(|n| n as u8).collect::<Vec<u8>>().into(),
            settings_file: Some(Bytes::from_static(b"<x/>")),
            overrides: vec![Override::from(["-haltspp", "halt", "3"].map(str::to_owned))],
            identity: Identity::default(),
            upload_period: Duration::from_secs(40),
        };
        let setup = Setup {
            scene,
            film: film(0, 0),
            program: program.to_owned(),
            key: key.clone(),
            own_seed: Some(OWN_SEED),
            port: 0,
            page: Some((([127, 0, 0, 1], 0).into(), "no_such_picture.png".into())),
        };
        let master = Master::start(setup, sink).expect("a free port");
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("threads");
        Self { master, events, runtime, key }
    }

    fn connect_with(&self, key: Option<&Key>) -> Result<FarmClient<Channel>, String> {
        let connector = Connector::new(key).expect("encryption");
        self.runtime.block_on(connector.connect("127.0.0.1", self.master.address().port()))
    }

    fn connect(&self) -> FarmClient<Channel> {
        self.connect_with(self.key.as_ref()).expect("the master is there")
    }

    fn join_as(&self, client: &mut FarmClient<Channel>, request: JoinRequest) -> Result<JoinReply, Status> {
        self.runtime.block_on(client.join(request)).map(tonic::Response::into_inner)
    }

    fn join(&self) -> (FarmClient<Channel>, JoinReply) {
        let mut client = self.connect();
        let reply = self.join_as(&mut client, request()).expect("it may join");
        (client, reply)
    }

    fn upload(&self, client: &mut FarmClient<Channel>, parts: Vec<Part>) -> Result<UploadReply, Status> {
        let parts = parts.into_iter().map(|part| UploadPart { part: Some(part) });
        self.runtime
            .block_on(client.upload(tokio_stream::iter(parts.collect::<Vec<_>>())))
            .map(tonic::Response::into_inner)
    }

    /// Sends a parcel as slaves do.
    fn send(&self, client: &mut FarmClient<Channel>, parcel: Vec<u8>) -> Result<UploadReply, Status> {
        let parts = vec![start(parcel.len() as u64), Part::Data(parcel.into())];
        self.upload(client, parts)
    }

    /// Waits until something has been told.
    fn wait_for(&self, what: &str, is_it: impl Fn(&Event) -> bool) {
        let deadline = Instant::now() + Duration::from_mins(1);
        while !self.events.lock().unwrap_or_else(PoisonError::into_inner).iter().any(&is_it) {
            assert!(Instant::now() < deadline, "{what} is not told; what is: {:?}", self.events.lock());
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Waits until a refusal is told, with the address of whoever it was, and sees that the film is as it was.
    fn assert_refused(&self, reason: &str) {
        self.wait_for(reason, |event| {
            matches!(event, Event::Refused { peer, reason: told, .. } if peer.ip().to_canonical().is_loopback() && told.contains(reason))
        });
        assert_eq!(self.master.record().samples, 0, "{reason}");
    }
}

fn request() -> JoinRequest {
    JoinRequest {
        protocol: PROTOCOL,
        program: PROGRAM.to_owned(),
        slave: Bytes::copy_from_slice(&SLAVE),
        seed: SEED,
        name: "box".to_owned(),
        threads: 2,
    }
}

fn start(bytes: u64) -> Part {
    Part::Start(UploadStart { slave: Bytes::copy_from_slice(&SLAVE), bytes })
}

#[test]
fn a_slave_gets_the_scene_and_its_work_counts_once() {
    let bench = Bench::new(Some(Key::random().unwrap()));
    let (mut client, reply) = bench.join();
    assert_eq!((reply.pack_bytes, reply.merged_end, &*reply.scene), (PACK as u64, 0, "scene.igs"));
    assert_eq!(reply.settings_file.as_deref(), Some(&b"<x/>"[..]));
    assert_eq!(reply.overrides[0].value, "3");
    let wanted = SceneRequest { slave: Bytes::copy_from_slice(&SLAVE), pack_hash: reply.pack_hash.clone() };
    let pack = bench.runtime.block_on(async {
        let pieces = client.fetch_scene(wanted).await.unwrap().into_inner();
        crate::slave::fetch::receive(pieces, reply.pack_bytes, &reply.pack_hash).await.unwrap()
    });
    assert_eq!(pack.len(), PACK);
    assert_eq!(bench.send(&mut client, parcel(&film(0, 5))).unwrap().merged_end, 5);
    assert_eq!(bench.send(&mut client, parcel(&film(0, 5))).unwrap().merged_end, 5);
    assert_eq!(bench.send(&mut client, parcel(&film(5, 6))).unwrap().merged_end, 6);
    let copy = bench.master.copy();
    assert_eq!(copy, {
        let mut sum = film(0, 5);
        sum.merge(&film(5, 6)).unwrap();
        sum
    });
    bench.master.saved(copy.record.clone().unwrap());
    let report = ReportRequest { slave: Bytes::copy_from_slice(&SLAVE), ..ReportRequest::default() };
    assert_eq!(bench.runtime.block_on(client.report(report)).unwrap().into_inner().durable_end, 6);
    let (_, again) = bench.join();
    assert_eq!((again.merged_end, again.durable_end), (6, 6));
    let status = bench.master.status();
    assert_eq!((status.samples, status.present, status.slaves.len()), (6, 1, 1));
    assert_eq!((status.slaves[0].samples, status.slaves[0].uploads), (6, 2), "what came again is not added");
}

/// What slaves have still to send is counted once: as waiting, or in the film.
#[test]
fn what_waits_is_counted_until_it_is_in_the_film() {
    let bench = Bench::new(None);
    let (mut client, _) = bench.join();
    let slave = Bytes::copy_from_slice(&SLAVE);
    let report = ReportRequest { slave, waiting_samples: 7, ..ReportRequest::default() };
    let waits = |bench: &Bench| (bench.master.status().samples, bench.master.status().waiting);
    bench.runtime.block_on(client.report(report.clone())).unwrap();
    assert_eq!(waits(&bench), (0, 7));
    bench.send(&mut client, parcel(&film(0, 5))).unwrap();
    assert_eq!(waits(&bench), (5, 2));
    // Of a slave that has not heard yet that five of its seven have come.
    bench.runtime.block_on(client.report(report.clone())).unwrap();
    assert_eq!(waits(&bench), (5, 2));
    // More than it has told of.
    bench.send(&mut client, parcel(&film(5, 9))).unwrap();
    assert_eq!(waits(&bench), (9, 0));
    let absurd = ReportRequest { waiting_samples: u64::MAX, merged_end: 9, ..report.clone() };
    let status = bench.runtime.block_on(client.report(absurd)).unwrap_err();
    assert_eq!(status.code(), Code::InvalidArgument);
    bench.wait_for("the refusal", |event| {
        matches!(event, Event::Refused { reason, .. } if reason.contains("more than a film can count"))
    });
    assert_eq!((waits(&bench), bench.master.status().slaves[0].errors), ((9, 0), 1));
    let report = ReportRequest { waiting_samples: 70, merged_end: 9, ..report };
    bench.runtime.block_on(client.report(report.clone())).unwrap();
    assert_eq!(waits(&bench), (9, 70));
    bench.master.begin_end();
    bench.master.take_back_end();
    let reply = bench.runtime.block_on(client.report(report.clone())).unwrap().into_inner();
    assert_eq!(reply.order(), crate::proto::report_reply::Order::GoOn);
    assert_eq!(waits(&bench), (9, 0), "it was not kept");
    let _again = bench.join();
    assert_eq!(waits(&bench), (9, 0), "what it has told of may have come");
    let period = |client: &mut FarmClient<Channel>| {
        bench.runtime.block_on(client.report(report.clone())).unwrap().into_inner().report_period_s
    };
    assert_eq!(period(&mut client), None);
    bench.master.tell_near_end(true);
    assert_eq!(period(&mut client), Some(0.1));
}

#[test]
fn without_the_key_nobody_gets_in() {
    let (key, other) = (Key::random().unwrap(), Key::random().unwrap());
    let bench = Bench::new(Some(key));
    assert!(
        bench.connect_with(Some(&other)).unwrap_err().contains("has not proved that it has the same key")
    );
    bench.assert_refused("has not proved that it has the key");
    // Who does not even try encryption, and who sends rubbish.
    let mut plain = bench.connect_with(None);
    let joined = plain.as_mut().map(|client| bench.join_as(client, request()).is_ok());
    assert_ne!(joined, Ok(true));
    let mut rubbish = TcpStream::connect(("127.0.0.1", bench.master.address().port())).unwrap();
    rubbish.write_all(&[0x55; 5000]).unwrap();
    rubbish.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
    let mut answer = vec![];
    // Closed, in whatever way.
    drop(rubbish.read_to_end(&mut answer));
    assert_eq!(bench.master.status().slaves.len(), 0);
    bench.join();
}

/// A slave with a key does not talk to a master without one.
#[test]
fn a_slave_with_a_key_wants_a_master_that_has_it() {
    let bench = Bench::new(None);
    assert!(bench.master.address().ip().is_loopback(), "no other machine can connect");
    assert!(bench.connect_with(Some(&Key::random().unwrap())).is_err());
    bench.join();
}

#[test]
fn other_programs_are_told_why_they_cannot_join() {
    let bench = Bench::new(None);
    let refused = |change: fn(&mut JoinRequest)| {
        let mut request = request();
        change(&mut request);
        bench.join_as(&mut bench.connect(), request).unwrap_err()
    };
    let status = refused(|request| request.program = "Indigo of tomorrow".to_owned());
    assert_eq!(status.code(), Code::FailedPrecondition);
    assert!(
        status.message().contains(PROGRAM) && status.message().contains("Indigo of tomorrow"),
        "{status}"
    );
    bench.assert_refused("Indigo of tomorrow");
    assert_eq!(refused(|request| request.protocol = PROTOCOL - 1).code(), Code::FailedPrecondition);
    assert_eq!(refused(|request| request.slave = Bytes::from_static(b"short")).code(), Code::InvalidArgument);
    assert_eq!(refused(|request| request.threads = 0).code(), Code::InvalidArgument);
    assert_eq!(refused(|request| request.threads = u32::MAX).code(), Code::InvalidArgument);
    // Two slaves with one seed would send the same samples.
    let (mut first, _) = bench.join();
    let second = JoinRequest { slave: Bytes::from_static(&[8; 16]), seed: SEED + 5, ..request() };
    assert_eq!(bench.join_as(&mut first, second).unwrap_err().code(), Code::ResourceExhausted);
    let status = refused(|request| request.slave = Bytes::from_static(&[8; 16]));
    assert_eq!(status.code(), Code::AlreadyExists);
    assert!(status.message().contains("seed 42"), "{status}");
}

#[test]
fn who_has_not_joined_is_not_listened_to() {
    let bench = Bench::new(None);
    let mut client = bench.connect();
    assert_eq!(bench.send(&mut client, parcel(&film(0, 5))).unwrap_err().code(), Code::NotFound);
    let report = ReportRequest { slave: Bytes::copy_from_slice(&SLAVE), ..ReportRequest::default() };
    assert_eq!(bench.runtime.block_on(client.report(report)).unwrap_err().code(), Code::NotFound);
    assert_eq!(bench.master.record().samples, 0);
}

#[test]
fn what_is_no_sound_upload_is_refused_and_harms_nothing() {
    let changed = |change: fn(&mut SavedFilm)| {
        let mut film = film(0, 5);
        change(&mut film);
        parcel(&film)
    };
    let mut short = parcel(&film(0, 5));
    short.pop();
    let mut larger = film(0, 5);
    larger.film = FilmState::new(FilmSize::new(8, 5, 1).unwrap(), &[(LayerKind::PerPixel, "camera")]);
    let uploads = [
        (changed(|f| f.film.layers[0].sums[3][0] = f64::NAN), "a sum is not finite"),
        (changed(|f| f.film.layers[0].sums[3][1] = f64::INFINITY), "a sum is not finite"),
        (changed(|f| f.film.layers[0].sums[0][2] = 1e300), "a sum is not finite"),
        (changed(|f| f.film.layers[0].counts[3] = -5.0), "negative number of samples"),
        (changed(|f| f.film.layers[0].counts[3] = 4.0), "number of samples is impossible"),
        (changed(|f| f.record.as_mut().unwrap().scene_hash = [9; 32]), "the scene itself"),
        (changed(|f| f.record.as_mut().unwrap().runs[0].seed = 1), "one run of units"),
        (short, "the file ends within a block of sums"),
        (parcel(&larger), "8 x 5"),
        (b"GIF89a".to_vec(), "not an Indigo image"),
        (vec![], "not an Indigo image"),
    ];
    for (bytes, reason) in uploads {
        // One each, so that every refusal of this address is told.
        let bench = Bench::new(None);
        let (mut client, _) = bench.join();
        let status = bench.send(&mut client, bytes).unwrap_err();
        assert_eq!(status.code(), Code::InvalidArgument, "{reason}: {status}");
        assert!(is_refused(&status), "what it holds is not to be sent again: {status:?}");
        assert!(status.message().contains(reason), "{reason}: {status}");
        bench.assert_refused(reason);
        assert_eq!(bench.master.status().slaves[0].errors, 1);
        // The slave itself is as welcome as before.
        assert!(bench.send(&mut client, parcel(&film(0, 5))).is_ok());
    }
}

#[test]
fn lengths_are_kept_to() {
    let bench = Bench::new(None);
    let (mut client, _) = bench.join();
    let sound = parcel(&film(0, 5));
    let length = sound.len() as u64;
    let refused =
        |client: &mut FarmClient<Channel>, parts: Vec<Part>| bench.upload(client, parts).unwrap_err().code();
    let data = || Part::Data(sound.clone().into());
    for stated in [u64::MAX, length - 1] {
        let status = bench.upload(&mut client, vec![start(stated), data()]).unwrap_err();
        assert_eq!(status.code(), Code::ResourceExhausted);
        assert!(is_refused(&status), "{status:?}");
    }
    assert_eq!(refused(&mut client, vec![start(length + 1), data()]), Code::DataLoss);
    assert_eq!(refused(&mut client, vec![start(length), start(length)]), Code::InvalidArgument);
    assert_eq!(refused(&mut client, vec![data()]), Code::InvalidArgument);
    assert_eq!(refused(&mut client, vec![]), Code::InvalidArgument);
    // A frame that is larger than any may be. The client's own limit is taken away first.
    let mut client = client.max_encoding_message_size(usize::MAX);
    let huge = Part::Data(vec![0; 2 * MESSAGE].into());
    assert_eq!(refused(&mut client, vec![start(length), huge]), Code::OutOfRange);
    assert_eq!(bench.master.record().samples, 0);
    assert!(bench.send(&mut client, sound).is_ok());
}

/// Callers who say nothing, or begin and go on no more, keep nobody else waiting.
#[test]
fn who_is_silent_hinders_nobody() {
    let bench = Bench::new(Some(Key::random().unwrap()));
    let silent: Vec<TcpStream> = (0..200)
        .map(|_| TcpStream::connect(("127.0.0.1", bench.master.address().port())).expect("it listens"))
        .collect();
    let (mut client, _) = bench.join();
    assert!(bench.send(&mut client, parcel(&film(0, 5))).is_ok());
    drop(silent);
}

#[test]
fn the_masters_own_seed_is_no_slaves() {
    let bench = Bench::new(None);
    let status =
        bench.join_as(&mut bench.connect(), JoinRequest { seed: OWN_SEED, ..request() }).unwrap_err();
    assert_eq!(status.code(), Code::AlreadyExists);
    assert!(status.message().contains("the master renders with seed 43 itself"), "{status}");
    // Another platform's program of the same version is welcome, and another version is not.
    let program = format!("{PROGRAM}, of another platform");
    assert!(bench.join_as(&mut bench.connect(), JoinRequest { program, ..request() }).is_ok());
    let program = format!("{PROGRAM} 2");
    let status = bench.join_as(&mut bench.connect(), JoinRequest { program, ..request() }).unwrap_err();
    assert_eq!(status.code(), Code::FailedPrecondition);
}

#[test]
fn slaves_are_told_when_the_render_ends() {
    let bench = Bench::new(None);
    let (mut client, _) = bench.join();
    bench.master.begin_end();
    assert!(!bench.master.is_deserted());
    let report = ReportRequest { slave: Bytes::copy_from_slice(&SLAVE), ..ReportRequest::default() };
    let reply = bench.runtime.block_on(client.report(report)).unwrap().into_inner();
    assert_eq!(reply.order(), crate::proto::report_reply::Order::Finish);
    assert!(bench.send(&mut client, parcel(&film(0, 5))).is_ok(), "the last of it is taken");
    assert!(!bench.master.has_all(), "it may have more");
    let done = ReportRequest {
        slave: Bytes::copy_from_slice(&SLAVE),
        state: crate::proto::report_request::State::Done.into(),
        ..ReportRequest::default()
    };
    let reply = bench.runtime.block_on(client.report(done.clone())).unwrap().into_inner();
    assert!(bench.master.has_all() && !bench.master.is_deserted());
    assert_eq!(reply.durable_end, 0, "it is not saved");
    bench.master.saved(bench.master.record());
    assert_eq!(bench.runtime.block_on(client.report(done)).unwrap().into_inner().durable_end, 5);
    // It may come back as long as it has not said good-bye; new ones may not.
    let _again = bench.join();
    let new = JoinRequest { slave: Bytes::from_static(&[9; 16]), seed: 1, ..request() };
    assert_eq!(bench.join_as(&mut bench.connect(), new).unwrap_err().code(), Code::Unavailable);
    let leave = crate::proto::LeaveRequest { slave: Bytes::copy_from_slice(&SLAVE) };
    bench.runtime.block_on(client.leave(leave)).unwrap();
    assert!(bench.master.is_deserted());
    assert_eq!(bench.join_as(&mut bench.connect(), request()).unwrap_err().code(), Code::Unavailable);
}

#[test]
fn a_slave_that_dies_is_missed() {
    let bench = Bench::new(Some(Key::random().unwrap()));
    let (client, _) = bench.join();
    assert_eq!(bench.master.status().present, 1);
    drop(client);
    // What ends the connection runs there.
    bench.runtime.block_on(async { tokio::time::sleep(Duration::from_millis(100)).await });
    bench.wait_for("the loss", |event| matches!(event, Event::Lost { .. }));
    assert_eq!(bench.master.status().present, 0);
}

/// An answer of the status page.
fn ask(bench: &Bench, path: &str, host: &str) -> String {
    let page = bench.master.page().expect("there is one");
    let mut stream = TcpStream::connect(page).expect("it listens");
    stream
        .write_all(format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").as_bytes())
        .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer
}

#[test]
fn the_status_page_shows_and_is_of_this_machine() {
    let bench = Bench::new(Some(Key::random().unwrap()));
    let (mut client, _) = bench.join();
    bench.send(&mut client, parcel(&film(0, 5))).unwrap();
    let json = ask(&bench, "/status.json", "localhost");
    assert!(json.starts_with("HTTP/1.1 200") && json.contains("\"samples\":5,"), "{json}");
    assert!(json.contains("\"name\":\"box\""), "{json}");
    assert!(ask(&bench, "/metrics", "127.0.0.1:80").contains("\nindigo_samples_total 5\n"));
    let page = ask(&bench, "/", "localhost");
    assert!(page.contains("<!doctype html>") && page.contains("content-security-policy: default-src 'none'"));
    assert!(ask(&bench, "/picture.png", "localhost").starts_with("HTTP/1.1 404"), "none has been saved");
    assert!(ask(&bench, "/status.json", "evil.example").starts_with("HTTP/1.1 403"));
}

/// Slaves that open more uploads than there is room for, and give a byte now and then, are never silent: they make room for one
/// that sends.
#[test]
fn who_drips_does_not_keep_others_from_the_film() {
    let bench = Bench::new(None);
    let drip = |slave: [u8; 16], mut client: FarmClient<Channel>| async move {
        let start = UploadStart { slave: Bytes::copy_from_slice(&slave), bytes: 1 << 20 };
        let drops = tokio_stream::iter(0..).then(|_| async {
            tokio::time::sleep(Duration::from_secs(1)).await;
            Part::Data(Bytes::from_static(b"."))
        });
        let parts = tokio_stream::iter([Part::Start(start)]).chain(drops);
        client.upload(parts.map(|part| UploadPart { part: Some(part) })).await
    };
    let mut drips = vec![];
    for n in [1, 2] {
        let mut client = bench.connect();
        let slave = Bytes::from(vec![n; 16]);
        bench.join_as(&mut client, JoinRequest { slave, seed: n.into(), ..request() }).expect("it may join");
        drips.extend((0..6).map(|_| bench.runtime.spawn(drip([n; 16], client.clone()))));
    }
    let (mut client, _) = bench.join();
    // Until they have what room there is.
    bench.runtime.block_on(async { tokio::time::sleep(Duration::from_secs(3)).await });
    let began = Instant::now();
    assert_eq!(bench.send(&mut client, parcel(&film(0, 5))).map(|reply| reply.merged_end).ok(), Some(5));
    assert!(began.elapsed() < Duration::from_mins(1), "{:?}", began.elapsed());
    bench.wait_for(
        "who made room",
        |event| matches!(event, Event::Refused { reason, .. } if reason.contains("makes room for others")),
    );
    assert_eq!(bench.master.status().samples, 5);
    drips.iter().for_each(tokio::task::JoinHandle::abort);
}

/// More connections than there are places, over which nothing is said: they make room, or run out of time.
#[test]
fn who_is_silent_leaves_the_status_page_to_others() {
    let bench = Bench::new(None);
    let page = bench.master.page().expect("there is one");
    let silent: Vec<TcpStream> =
        (0..crate::limits::VISITORS + 8).map(|_| TcpStream::connect(page).expect("it listens")).collect();
    assert!(ask(&bench, "/status.json", "localhost").starts_with("HTTP/1.1 200"));
    for mut stream in silent {
        assert_eq!(stream.read(&mut [0; 1]).ok(), Some(0), "closed by the master");
    }
    bench.join();
}

/// As many connections as there are places, over which a question comes that never ends: others need not wait for them, and they
/// run out of time although they are never silent.
#[test]
fn who_never_ends_a_question_leaves_the_status_page_to_others() {
    use crate::limits::{PAGE_SILENCE, VISITORS};
    let bench = Bench::new(None);
    let page = bench.master.page().expect("there is one");
    let drip = |_| {
        let mut stream = TcpStream::connect(page).expect("it listens");
        stream.write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: ").map(|()| stream)
    };
    let mut drips = (0..VISITORS).map(drip).collect::<Result<Vec<_>, _>>().expect("it listens");
    let began = Instant::now();
    assert!(ask(&bench, "/status.json", "localhost").starts_with("HTTP/1.1 200"));
    assert!(began.elapsed() < PAGE_SILENCE / 2, "it does not wait until others have run out of time");
    bench.wait_for(
        "who made room",
        |event| matches!(event, Event::Refused { reason, .. } if reason.contains("made room for others")),
    );
    while !drips.is_empty() {
        assert!(began.elapsed() < 2 * PAGE_SILENCE, "{} are still there", drips.len());
        drips.retain_mut(|stream| stream.write_all(b"x").is_ok());
        std::thread::sleep(Duration::from_millis(100));
    }
    bench.join();
}

/// What it has told of is missing at the end, and a moment is left for it to come back.
#[test]
fn a_slave_whose_connection_breaks_at_the_end_is_waited_for_and_missed() {
    let bench = Bench::new(None);
    let (mut client, _) = bench.join();
    let slave = Bytes::copy_from_slice(&SLAVE);
    let rendering = crate::proto::report_request::State::Rendering.into();
    let report = ReportRequest { slave, state: rendering, waiting_samples: 7, ..ReportRequest::default() };
    bench.runtime.block_on(client.report(report)).unwrap();
    bench.master.begin_end();
    assert_eq!(bench.master.unsent(), Unsent { here: 1, gone: 0, samples: 7 });
    drop(client);
    bench.runtime.block_on(async { tokio::time::sleep(Duration::from_millis(100)).await });
    bench.wait_for("the loss", |event| matches!(event, Event::Lost { .. }));
    assert!(!bench.master.has_all(), "it may be back in a second");
    assert_eq!(bench.master.unsent(), Unsent { here: 0, gone: 1, samples: 7 });
    let (mut client, _) = bench.join();
    bench.send(&mut client, parcel(&film(0, 7))).unwrap();
    assert_eq!(bench.master.unsent().samples, 0);
}

/// A parcel may hold texts of whatever length, with commands for terminals in them.
#[test]
fn texts_of_peers_are_cut_and_cleaned() {
    let bench = Bench::new(None);
    let is_plain = |text: &str| text.chars().count() < 400 && !text.chars().any(char::is_control);
    let program = format!("\x1b[2J{}", "x".repeat(1000));
    let status = bench.join_as(&mut bench.connect(), JoinRequest { program, ..request() }).unwrap_err();
    assert!(is_plain(status.message()), "{:?}", status.message());
    let (mut client, _) = bench.join();
    let mut odd = film(0, 5);
    let setting = ("\x1b]0;mine\x07".to_owned(), "y".repeat(100_000));
    odd.record.as_mut().unwrap().settings.push(setting);
    let status = bench.send(&mut client, parcel(&odd)).unwrap_err();
    assert!(status.message().contains("mine") && is_plain(status.message()), "{:?}", status.message());
    let seen = bench.master.status().slaves[0].last_error.clone().unwrap();
    assert!(seen.contains("mine") && is_plain(&seen), "{seen:?}");
    let told = bench.events.lock().unwrap();
    let reasons: Vec<&String> = told
        .iter()
        .filter_map(|event| if let Event::Refused { reason, .. } = event { Some(reason) } else { None })
        .collect();
    assert!(!reasons.is_empty() && reasons.iter().all(|reason| is_plain(reason)), "{reasons:?}");
}

/// No scene is loaded here.
struct NoScenes;

impl Loader for NoScenes {
    fn load(&self, _: &SceneFiles) -> Result<Scene, String> {
        Err("no scenes".to_owned())
    }
}

/// Of several masters that were found, the first wants nothing of this slave.
#[test]
fn who_is_refused_goes_on_to_the_next_master() {
    let others = Bench::running(None, "Indigo of tomorrow");
    let ours = Bench::new(None);
    let options = Options {
        master: None,
        key: None,
        seed: Some(SEED),
        name: "box".to_owned(),
        threads: 1,
        program: PROGRAM.to_owned(),
        cache: std::env::temp_dir(),
    };
    let (_stop, stopped) = tokio::sync::watch::channel(false);
    let mut life = Life::new(options, Arc::new(NoScenes), Arc::new(|_| {}), stopped).unwrap();
    let places = [&others, &ours].map(|bench| bench.master.address());
    let joined = |life: &mut Life, places: &[SocketAddr]| {
        ours.runtime.block_on(life.join_one(places.to_vec())).map(|(_, _, place)| place)
    };
    assert!(matches!(joined(&mut life, &places[..1]), Err(Outcome::Refused(_))));
    assert_eq!(joined(&mut life, &places).ok(), Some(Some(places[1])));
    // Something else listens there.
    let page = ours.master.page().expect("there is one");
    let Err(Outcome::Lost(why)) = joined(&mut life, &[page]) else { panic!("a page is no master") };
    assert!(
        why.contains(&format!("what is at {page} does not answer as a render master without a key does")),
        "{why}"
    );
    // One that let it in, and had a scene that could not be loaded.
    life.turn_down(places[1]);
    let twins = Bench::new(None);
    let twin = twins.master.address();
    assert_eq!(joined(&mut life, &[places[1], twin]).ok(), Some(Some(twin)));
    assert_eq!(joined(&mut life, &places).ok(), Some(Some(places[1])), "better than none");
}
