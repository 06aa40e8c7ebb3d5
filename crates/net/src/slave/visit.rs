//! One connection to a master, from joining to good-bye.

use super::calls::{Client, Outcome, answer, beside_reports, is_refused, refusal};
use super::connect::{Connector, written};
use super::fetch::{self, SceneFiles};
use super::work::Work;
use super::{Loader, Options};
use crate::discovery;
use crate::event::{Event, Sink};
use crate::key::{KeyError, random_bytes};
use crate::ledger::run_of;
use crate::limits::{PIECE, PROTOCOL, UPLOAD};
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
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tokio::sync::watch;
use tokio::time::{Instant, interval, sleep, timeout};
use tonic::Status;

/// The shortest and the longest time between reports that a slave keeps to, whatever a master asks for, in seconds.
const REPORTS: [f64; 2] = [0.1, 10.0];
/// The same of uploads: as quick as makes sense, and a year.
const UPLOADS: [f64; 2] = [0.01, 365.0 * 86_400.0];

/// Time between reports at the end of a render, when the master waits for all its slaves.
const WHILE_ENDING: Duration = Duration::from_millis(250);

/// A time that a master has asked for, within bounds.
fn period(seconds: f64, [shortest, longest]: [f64; 2]) -> Duration {
    Duration::from_secs_f64(if seconds.is_nan() { longest } else { seconds.clamp(shortest, longest) })
}

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

impl Life {
    /// Becomes another slave, with a random sequence of its own, unless that was chosen.
    ///
    /// # Errors
    /// Where the system gives no random numbers, in words.
    pub fn begin_anew(&mut self) -> Result<(), String> {
        let words = |error: KeyError| error.to_string();
        self.id = random_bytes().map_err(words)?;
        if self.options.seed.is_none() {
            self.seed = u64::from_le_bytes(random_bytes().map_err(words)?);
        }
        Ok(())
    }

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

    /// Ends what it renders, and tells what is lost by that. Without a good-bye nobody knows what of it the master has saved.
    pub async fn lose(&mut self, has_left: bool, reason: &'static str) {
        let Some(mut work) = self.work.take() else { return };
        if !work.engine.has_ended()
            && let Some(film) = work.engine.end().await
        {
            work.outbox.push(film);
        }
        let samples = if has_left { work.outbox.waiting_samples() } else { work.outbox.samples() };
        self.tell_lost(samples, reason);
    }

    fn tell_lost(&self, samples: u64, reason: &'static str) {
        if samples > 0 {
            self.tell(Event::LostSamples { samples, reason });
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
        let reply = answer(client.join(request)).await.map_err(|outcome| match outcome {
            Outcome::Lost(why) if self.options.key.is_none() => Outcome::Lost(format!(
                "{why}; if it has a key, this slave needs the same one (--key-file FILE)"
            )),
            outcome => outcome,
        })?;
        self.tell(Event::Connected { master, scene: reply.scene.clone() });
        Ok((client, reply))
    }

    /// A connection to the master that was named, or to one in the local network that has the key; and where that is.
    async fn find(&self) -> Result<(Client, String), String> {
        if let Some((host, port)) = &self.options.master {
            let client = self.connector.connect(host, *port).await;
            let place = written(host, *port);
            let client = client.map_err(|why| format!("no master is reached at {place}: {why}"))?;
            return Ok((client, place));
        }
        let found = discovery::masters().await;
        let found =
            found.map_err(|why| format!("no master can be looked for: {why}; name its machine by -h"))?;
        // Of several addresses the first says best why it is not reached: they are sorted.
        let mut reason = None;
        for (address, port) in found {
            match self.connector.connect(&address.to_string(), port).await {
                Ok(client) => return Ok((client, SocketAddr::from((address, port)).to_string())),
                Err(why) => {
                    let place = SocketAddr::from((address, port));
                    reason.get_or_insert(format!("there is a master at {place}, but {why}"));
                }
            }
        }
        Err(reason.unwrap_or_else(|| "no master is in the local network".to_owned()))
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
            self.lose(false, "the master has another scene now, and may not have saved them").await;
        }
        let Options { threads, program, .. } = &self.options;
        let work = match &mut self.work {
            Some(work) => {
                let goes_on = work.go_on(*threads, self.seed, reply.merged_end, program);
                if goes_on.map_err(Outcome::Broken)? {
                    (self.sink)(Event::Rendering { scene: reply.scene.clone(), threads: *threads });
                }
                work
            }
            none => {
                let scene = load(&self.options, &self.loader, &self.sink, client, self.id, reply).await?;
                let differences = blank_record(&scene, program).differences(&wanted);
                if !differences.is_empty() {
                    let words: Vec<String> = differences.iter().map(ToString::to_string).collect();
                    let words = words.join("; ");
                    return Err(Outcome::Refused(format!("the scene is not the master's: {words}")));
                }
                let started = Work::start(scene, *threads, self.seed, reply.merged_end, program);
                (self.sink)(Event::Rendering { scene: reply.scene.clone(), threads: *threads });
                none.insert(started.map_err(Outcome::Broken)?)
            }
        };
        let lost = work.outbox.rejoined(reply.merged_end, reply.durable_end);
        work.engine.rest(false);
        self.tell_lost(lost, "the master has a part of them");
        Ok(())
    }

    /// Renders for the master until something ends that.
    async fn stay(&mut self, client: &mut Client, reply: &JoinReply) -> Result<Outcome, Outcome> {
        let usual = period(reply.report_period_s, REPORTS);
        let mut next_report = Instant::now();
        let between_uploads = period(reply.upload_period_s, UPLOADS);
        // What was not sent over the last connection is sent first.
        let has_rest = self.work.as_ref().is_some_and(|work| work.outbox.next().is_some());
        let mut next = Instant::now() + if has_rest { Duration::ZERO } else { between_uploads };
        let mut stopped = self.stopped.clone();
        loop {
            let outcome = tokio::select! {
                _ = stopped.wait_for(|stopped| *stopped) => Some(Outcome::Stopped),
                () = tokio::time::sleep_until(next_report) => {
                    let reply = self.report(client).await?;
                    next_report = Instant::now() + reply.report_period_s.map_or(usual, |wanted| period(wanted, REPORTS));
                    (reply.order() == Order::Finish).then_some(Outcome::Finished)
                }
                () = tokio::time::sleep_until(next) => {
                    next = Instant::now() + between_uploads;
                    self.send(client, false).await?;
                    None
                }
            };
            if let Some(failure) = self.work.as_ref().and_then(|work| work.engine.seen().failure) {
                return Ok(Outcome::Broken(failure));
            }
            if let Some(outcome) = outcome {
                self.send(client, true).await?;
                if let Outcome::Finished = outcome {
                    self.see_it_saved(client).await?;
                }
                return Ok(outcome);
            }
        }
    }

    /// Stays until all that was sent is in a file of the master's: until then nobody else could send it again.
    async fn see_it_saved(&mut self, client: &mut Client) -> Result<(), Outcome> {
        let mut stopped = self.stopped.clone();
        let mut reports = interval(WHILE_ENDING);
        while self.work.as_ref().is_some_and(|work| !work.outbox.is_empty()) {
            tokio::select! {
                _ = stopped.wait_for(|stopped| *stopped) => break,
                _ = reports.tick() => drop(self.report(client).await?),
            }
        }
        Ok(())
    }

    /// Gives a sign of life.
    async fn report(&mut self, client: &mut Client) -> Result<ReportReply, Outcome> {
        let progress = self.work.as_ref().and_then(|work| work.engine.seen().progress);
        *self.seen.lock().unwrap_or_else(PoisonError::into_inner) = progress;
        let state = match &self.work {
            None => State::Loading,
            Some(work) if work.engine.has_ended() && work.outbox.next().is_none() => State::Done,
            Some(_) => State::Rendering,
        };
        let reply = answer(client.report(ReportRequest {
            slave: self.id(),
            state: state.into(),
            samples: progress.map_or(0, |p| p.samples),
            samples_per_second: progress.map_or(0.0, |p| p.samples_per_second),
            waiting_samples: self.work.as_ref().map_or(0, Work::waiting_samples),
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
            let mut calls = client.clone();
            let upload = timeout(UPLOAD, calls.upload(tokio_stream::iter(parts)));
            let sent = beside_reports(upload, client, &self.id).await?;
            match sent.unwrap_or_else(|_| Err(Status::deadline_exceeded("an upload takes too long"))) {
                Ok(reply) => {
                    let reply = reply.into_inner();
                    // In this order: what is saved need not be joined to what is not.
                    work.outbox.saved(reply.durable_end);
                    work.outbox.received(reply.generation);
                    (self.sink)(Event::Sent { samples, bytes, run });
                }
                // To be sent again it would have to become another.
                Err(status) if is_refused(&status) => {
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
