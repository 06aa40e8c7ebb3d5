//! One connection to a master, from joining to good-bye.

use super::connect::Connector;
use super::fetch::{self, SceneFiles};
use super::work::Work;
use super::{Loader, Options};
use crate::discovery;
use crate::event::{Event, Sink};
use crate::ledger::run_of;
use crate::limits::{ANSWER, PIECE, PROTOCOL, UPLOAD};
use crate::proto::farm_client::FarmClient;
use crate::proto::report_reply::Order;
use crate::proto::report_request::State;
use crate::proto::upload_part::Part;
use crate::proto::{
    JoinReply, JoinRequest, LeaveRequest, ReportReply, ReportRequest, SceneRequest, UploadPart, UploadStart,
};
use bytes::Bytes;
use indigo_film::igi::write_parcel;
use indigo_film::{FilmRecord, Run, SavedFilm};
use indigo_render::Progress;
use indigo_render::saved::blank_record;
use indigo_scene::Scene;
use std::future::Future;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tokio::sync::watch;
use tokio::time::{Instant, MissedTickBehavior, interval, sleep, timeout};
use tonic::transport::Channel;
use tonic::{Code, Status};

/// The shortest and the longest time between reports that a slave keeps to, whatever a master asks for, in seconds.
const REPORTS: [f64; 2] = [0.1, 10.0];
/// The same of uploads: as quick as makes sense, and a year.
const UPLOADS: [f64; 2] = [0.01, 365.0 * 86_400.0];

/// A time that a master has asked for, within bounds.
fn period(seconds: f64, [shortest, longest]: [f64; 2]) -> Duration {
    Duration::from_secs_f64(if seconds.is_nan() { longest } else { seconds.clamp(shortest, longest) })
}

type Client = FarmClient<Channel>;

/// What a slave is.
pub struct Life {
    /// What it was told.
    pub options: Options,
    /// How masters are reached.
    pub connector: Connector,
    /// Loads scenes.
    pub loader: Arc<dyn Loader>,
    /// Takes events.
    pub sink: Sink,
    /// Its name for itself.
    pub id: [u8; 16],
    /// The random sequence that it renders.
    pub seed: u64,
    /// Whether it is to stop.
    pub stopped: watch::Receiver<bool>,
    /// What it renders.
    pub work: Option<Work>,
    /// How far that is, for others to see.
    pub seen: Arc<Mutex<Option<Progress>>>,
}

/// How a visit ends.
pub enum Outcome {
    /// The slave was told to stop.
    Stopped,
    /// The master has ended the render.
    Finished,
    /// The master wants nothing of this slave.
    Refused(String),
    /// The connection is lost, or was never there.
    Lost(String),
    /// The renderer has a fault.
    Broken(String),
}

/// What a master's answer means, if it is none.
fn refusal(status: &Status) -> Outcome {
    let message = match status.message() {
        "" => status.code().description().to_owned(),
        message => message.to_owned(),
    };
    match status.code() {
        Code::FailedPrecondition | Code::AlreadyExists | Code::InvalidArgument | Code::Unimplemented => {
            Outcome::Refused(format!("the master refuses: {message}"))
        }
        _ => Outcome::Lost(format!("the connection to the master is lost: {message}")),
    }
}

/// A short call's answer.
async fn answer<T>(call: impl Future<Output = Result<tonic::Response<T>, Status>>) -> Result<T, Outcome> {
    match timeout(ANSWER, call).await {
        Ok(Ok(reply)) => Ok(reply.into_inner()),
        Ok(Err(status)) => Err(refusal(&status)),
        Err(_) => Err(Outcome::Lost("the master does not answer".to_owned())),
    }
}

impl Life {
    /// Whether it is to stop.
    pub fn is_stopped(&self) -> bool {
        *self.stopped.borrow()
    }

    /// Tells whoever runs it.
    pub fn tell(&self, event: Event) {
        (self.sink)(event);
    }

    /// Waits, unless it is to stop.
    pub async fn wait(&mut self, time: Duration) {
        tokio::select! {
            () = sleep(time) => {}
            _ = self.stopped.wait_for(|stopped| *stopped) => {}
        }
    }

    /// Lets the session rest until there is a master again.
    pub fn rest(&self) {
        if let Some(work) = &self.work {
            work.engine.rest(true);
        }
    }

    /// Tells what is lost at the end.
    pub fn lose(&mut self) {
        let Some(work) = self.work.take() else { return };
        let samples = work.outbox.waiting_samples();
        if samples > 0 {
            self.tell(Event::LostSamples { samples, reason: "there is no master to send them to" });
        }
    }

    /// Visits the master; `reached` tells whether it was there.
    pub async fn visit(&mut self, reached: &mut bool) -> Outcome {
        let mut stopped = self.stopped.clone();
        let joined = tokio::select! {
            joined = self.join() => joined,
            _ = stopped.wait_for(|stopped| *stopped) => Err(Outcome::Stopped),
        };
        let (mut client, reply) = match joined {
            Ok(joined) => joined,
            Err(outcome) => return outcome,
        };
        *reached = true;
        let prepared = tokio::select! {
            prepared = self.prepare(&mut client, &reply) => prepared,
            _ = stopped.wait_for(|stopped| *stopped) => Err(Outcome::Stopped),
        };
        if let Err(outcome) = prepared {
            self.leave(&mut client).await;
            return outcome;
        }
        match self.stay(&mut client, &reply).await {
            Ok(outcome) => {
                self.leave(&mut client).await;
                outcome
            }
            Err(outcome) => outcome,
        }
    }

    /// Connects, and introduces itself.
    async fn join(&self) -> Result<(Client, JoinReply), Outcome> {
        let Options { name, program, threads, .. } = &self.options;
        let (mut client, master) = self.find().await.map_err(Outcome::Lost)?;
        let request = JoinRequest {
            protocol: PROTOCOL,
            program: program.clone(),
            slave: self.id(),
            seed: self.seed,
            name: name.clone(),
            threads: u32::try_from(*threads).unwrap_or(u32::MAX),
        };
        let reply = answer(client.join(request)).await?;
        self.tell(Event::Connected { master, scene: reply.scene.clone() });
        Ok((client, reply))
    }

    /// A connection to the master that was named, or to one in the local network that has the key; and where that is.
    async fn find(&self) -> Result<(Client, String), String> {
        if let Some((host, port)) = &self.options.master {
            let client = self.connector.connect(host, *port).await;
            let client = client.map_err(|why| format!("there is no master at {host}:{port}: {why}"))?;
            return Ok((client, format!("{host}:{port}")));
        }
        let found = discovery::masters().await;
        let found =
            found.map_err(|why| format!("no master can be looked for: {why}; name its machine by -h"))?;
        let mut reason = "no master is in the local network".to_owned();
        for (address, port) in found {
            match self.connector.connect(&address.to_string(), port).await {
                Ok(client) => return Ok((client, SocketAddr::from((address, port)).to_string())),
                Err(why) => reason = format!("there is a master at {address}, but {why}"),
            }
        }
        Err(reason)
    }

    fn id(&self) -> Bytes {
        Bytes::copy_from_slice(&self.id)
    }

    /// Sees to it that the master's scene is being rendered, and sorts out what the master has of it.
    async fn prepare(&mut self, client: &mut Client, reply: &JoinReply) -> Result<(), Outcome> {
        let wanted = FilmRecord {
            scene_hash: reply.scene_hash[..].try_into().unwrap_or_default(),
            settings: reply.identity.iter().map(|s| (s.name.clone(), s.value.clone())).collect(),
            ..FilmRecord::default()
        };
        if self.work.as_ref().is_some_and(|work| !work.record.differences(&wanted).is_empty()) {
            // What the master of another scene could not use.
            self.lose();
        }
        let work = match &mut self.work {
            Some(work) => work,
            none => {
                let scene = load(&self.options, &self.loader, &self.sink, client, self.id, reply).await?;
                let program = &self.options.program;
                let differences = blank_record(&scene, program).differences(&wanted);
                if !differences.is_empty() {
                    let words: Vec<String> = differences.iter().map(ToString::to_string).collect();
                    let words = words.join("; ");
                    return Err(Outcome::Refused(format!("the scene is not the master's: {words}")));
                }
                let threads = self.options.threads;
                let started = Work::start(scene, threads, self.seed, reply.merged_end, program);
                (self.sink)(Event::Rendering { scene: reply.scene.clone(), threads });
                none.insert(started.map_err(Outcome::Broken)?)
            }
        };
        let lost = work.outbox.rejoined(reply.merged_end, reply.durable_end);
        work.engine.rest(false);
        if lost > 0 {
            self.tell(Event::LostSamples { samples: lost, reason: "the master has a part of them" });
        }
        Ok(())
    }

    /// Renders for the master until something ends that.
    async fn stay(&mut self, client: &mut Client, reply: &JoinReply) -> Result<Outcome, Outcome> {
        if self.work.as_ref().is_some_and(|work| work.engine.has_ended()) {
            // The last of a render that has ended, which did not arrive over the last connection.
            self.send(client, true).await?;
            return Ok(Outcome::Finished);
        }
        let mut reports = interval(period(reply.report_period_s, REPORTS));
        reports.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let period = period(reply.upload_period_s, UPLOADS);
        // What was not sent over the last connection is sent first.
        let has_rest = self.work.as_ref().is_some_and(|work| work.outbox.next().is_some());
        let mut next = Instant::now() + if has_rest { Duration::ZERO } else { period };
        let mut stopped = self.stopped.clone();
        loop {
            let outcome = tokio::select! {
                _ = stopped.wait_for(|stopped| *stopped) => Some(Outcome::Stopped),
                _ = reports.tick() => match self.report(client).await?.order() {
                    Order::Finish => Some(Outcome::Finished),
                    Order::GoOn => None,
                },
                () = tokio::time::sleep_until(next) => {
                    next = Instant::now() + period;
                    self.send(client, false).await?;
                    None
                }
            };
            if let Some(failure) = self.work.as_ref().and_then(|work| work.engine.seen().failure) {
                return Ok(Outcome::Broken(failure));
            }
            if let Some(outcome) = outcome {
                self.send(client, true).await?;
                return Ok(outcome);
            }
        }
    }

    /// Gives a sign of life.
    async fn report(&mut self, client: &mut Client) -> Result<ReportReply, Outcome> {
        let progress = self.work.as_ref().and_then(|work| work.engine.seen().progress);
        *self.seen.lock().unwrap_or_else(PoisonError::into_inner) = progress;
        let state = if self.work.is_some() { State::Rendering } else { State::Loading };
        let reply = answer(client.report(ReportRequest {
            slave: self.id(),
            state: state.into(),
            samples: progress.map_or(0, |p| p.samples),
            samples_per_second: progress.map_or(0.0, |p| p.samples_per_second),
        }))
        .await?;
        if let Some(work) = &mut self.work {
            work.outbox.saved(reply.durable_end);
        }
        Ok(reply)
    }

    /// Sends what waits, or else what has been rendered since; at the end both, and the session ends.
    async fn send(&mut self, client: &mut Client, is_last: bool) -> Result<(), Outcome> {
        let Some(work) = &mut self.work else { return Ok(()) };
        let rest = match (is_last, work.outbox.next()) {
            (true, _) => work.engine.end().await,
            // One film at a time: the session holds the rest.
            (false, Some(_)) => None,
            (false, None) => work.engine.drain().await,
        };
        if let Some(film) = rest {
            work.outbox.push(film);
        }
        while let Some(film) = work.outbox.next() {
            let (samples, run, parcel) = parcel_of(film);
            let bytes = parcel.len() as u64;
            let parts = parts(Bytes::copy_from_slice(&self.id), parcel);
            let sent = timeout(UPLOAD, client.upload(tokio_stream::iter(parts))).await;
            match sent.unwrap_or_else(|_| Err(Status::deadline_exceeded("an upload takes too long"))) {
                Ok(reply) => {
                    let reply = reply.into_inner();
                    // In this order: what is saved need not be joined to what is not.
                    work.outbox.saved(reply.durable_end);
                    work.outbox.received(reply.generation);
                    (self.sink)(Event::Sent { samples, bytes, run });
                }
                // To be sent again it would have to become another.
                Err(status) if matches!(status.code(), Code::InvalidArgument | Code::ResourceExhausted) => {
                    work.outbox.discard();
                    (self.sink)(Event::LostSamples { samples, reason: "the master refuses them" });
                    (self.sink)(Event::Trouble(format!("the master refuses samples: {}", status.message())));
                }
                Err(status) => return Err(refusal(&status)),
            }
        }
        Ok(())
    }

    /// Says good-bye. The master will notice anyhow.
    async fn leave(&self, client: &mut Client) {
        drop(answer(client.leave(LeaveRequest { slave: self.id() })).await);
    }
}

/// Fetches the scene, if it is not there, and loads it, with signs of life meanwhile.
async fn load(
    options: &Options,
    loader: &Arc<dyn Loader>,
    sink: &Sink,
    client: &mut Client,
    id: [u8; 16],
    reply: &JoinReply,
) -> Result<Scene, Outcome> {
    let slave = Bytes::copy_from_slice(&id);
    let hash = reply.pack_hash.clone();
    let path = fetch::path_of(&options.cache, &hash);
    if !fetch::is_cached(&path, &hash) {
        sink(Event::Fetching { bytes: reply.pack_bytes });
        let request = SceneRequest { slave: slave.clone(), pack_hash: hash.clone() };
        let pieces = answer(client.fetch_scene(request)).await?;
        let pack = fetch::receive(pieces, reply.pack_bytes, &hash).await.map_err(Outcome::Lost)?;
        let kept = fetch::keep(&path, &pack);
        kept.map_err(|error| Outcome::Broken(format!("cannot write {}: {error}", path.display())))?;
    }
    let overrides = reply.overrides.iter().map(|s| [s.option.clone(), s.name.clone(), s.value.clone()]);
    let files = SceneFiles {
        name: reply.scene.clone(),
        pack: path,
        settings_file: reply.settings_file.as_ref().map(|file| file.to_vec()),
        overrides: overrides.collect(),
    };
    let loader = Arc::clone(loader);
    let mut loading = tokio::task::spawn_blocking(move || loader.load(&files));
    let mut reports = interval(crate::limits::REPORTS);
    loop {
        tokio::select! {
            loaded = &mut loading => {
                let loaded = loaded.map_err(|error| Outcome::Broken(error.to_string()))?;
                return loaded.map_err(|why| Outcome::Refused(format!("the master's scene cannot be loaded: {why}")));
            }
            _ = reports.tick() => {
                let report = ReportRequest { slave: slave.clone(), ..ReportRequest::default() };
                if answer(client.report(report)).await?.order() == Order::Finish {
                    return Err(Outcome::Finished);
                }
            }
        }
    }
}

/// The samples and units of a film, and the film as it travels.
fn parcel_of(film: &SavedFilm) -> (u64, Run, Bytes) {
    let blank = FilmRecord::default();
    let record = film.record.as_ref().unwrap_or(&blank);
    let mut bytes = vec![];
    // To write to memory cannot fail, and what came out wrong the master would refuse.
    drop(write_parcel(&mut bytes, &film.film, record));
    let run = run_of(film).unwrap_or(Run { seed: 0, first: 0, end: 0 });
    (record.samples, run, bytes.into())
}

/// A parcel in pieces, behind what says how long it is.
fn parts(slave: Bytes, parcel: Bytes) -> impl Iterator<Item = UploadPart> + Send + 'static {
    let start = Part::Start(UploadStart { slave, bytes: parcel.len() as u64 });
    let pieces = (0..parcel.len())
        .step_by(PIECE)
        .map(move |from| Part::Data(parcel.slice(from..(from + PIECE).min(parcel.len()))));
    std::iter::once(start).chain(pieces).map(|part| UploadPart { part: Some(part) })
}
