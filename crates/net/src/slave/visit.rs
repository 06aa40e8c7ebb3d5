//! One connection to a master, from joining to good-bye.

use super::calls::{Client, Outcome, answer, is_refused, refusal};
use super::connect::Connector;
use super::parcels::{parcel_of, parts};
use super::work::Work;
use super::{Loader, Options};
use crate::NetError;
use crate::event::{Event, Sink};
use crate::key::{KeyError, random_bytes};
use crate::limits::{FASTEST, UPLOAD};
use crate::plain::plain;
use crate::proto::report_reply::Order;
use crate::proto::report_request::State;
use crate::proto::{JoinReply, LeaveRequest, ReportRequest, UploadReply};
use bytes::Bytes;
use indigo_film::FilmRecord;
use indigo_render::Progress;
use indigo_render::saved::blank_record;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tokio::sync::watch;
use tokio::time::{Instant, interval, sleep, sleep_until, timeout};
use tonic::{Response, Status};

/// The shortest and the longest time between reports that a slave keeps to, whatever a master asks for, in seconds.
const REPORTS: [f64; 2] = [0.1, 10.0];
/// The same of uploads: as quick as makes sense, and a year.
const UPLOADS: [f64; 2] = [0.01, 365.0 * 86_400.0];

/// Time between reports at the end of a render, when the master waits for all its slaves.
const WHILE_ENDING: Duration = Duration::from_millis(250);

/// So long an upload may take before that is told.
const SLOW_UPLOAD: Duration = Duration::from_secs(30);

/// Why samples are lost that a master would count twice.
pub(super) const PARTLY_THERE: &str = "the master has a part of them";

/// What a master's film is of.
pub(super) fn wanted_record(reply: &JoinReply) -> FilmRecord {
    FilmRecord {
        scene_hash: reply.scene_hash[..].try_into().unwrap_or_default(),
        settings: reply.identity.iter().map(|s| (s.name.clone(), s.value.clone())).collect(),
        ..FilmRecord::default()
    }
}

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
    /// What the master has of its units, as it said last.
    pub merged_end: u64,
    /// Time between reports, unless the master says otherwise, and when the next one is due.
    pub report_period: Duration,
    pub next_report: Instant,
    /// Where masters were found that wanted nothing of it, or had nothing for it: others are tried first.
    pub turned_down: Vec<SocketAddr>,
}

impl Life {
    /// Nowhere yet.
    ///
    /// # Errors
    /// Where there is no randomness or no encryption.
    pub fn new(
        options: Options,
        loader: Arc<dyn Loader>,
        sink: Sink,
        stopped: watch::Receiver<bool>,
    ) -> Result<Self, NetError> {
        Ok(Self {
            connector: Connector::new(options.key.as_ref())?,
            id: random_bytes()?,
            seed: options.seed.map_or_else(|| random_bytes().map(u64::from_le_bytes), Ok)?,
            options,
            loader,
            sink,
            stopped,
            work: None,
            seen: Arc::default(),
            merged_end: 0,
            report_period: crate::limits::REPORTS,
            next_report: Instant::now(),
            turned_down: vec![],
        })
    }

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

    /// Visits the master; `reached` tells whether it was there.
    pub async fn visit(&mut self, reached: &mut bool) -> Outcome {
        let mut stopped = self.stopped.clone();
        let joined = tokio::select! {
            joined = self.join() => joined,
            _ = stopped.wait_for(|stopped| *stopped) => Err(Outcome::Stopped),
        };
        let (mut client, reply, place) = match joined {
            Ok(joined) => joined,
            Err(outcome) => return outcome,
        };
        *reached = true;
        self.merged_end = reply.merged_end;
        (self.report_period, self.next_report) = (period(reply.report_period_s, REPORTS), Instant::now());
        let prepared = tokio::select! {
            prepared = self.prepare(&mut client, &reply) => prepared,
            _ = stopped.wait_for(|stopped| *stopped) => Err(Outcome::Stopped),
        };
        if let Err(outcome) = prepared {
            if let (Outcome::Refused(_), Some(place)) = (&outcome, place) {
                self.turn_down(place);
            }
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

    pub(super) fn id(&self) -> Bytes {
        Bytes::copy_from_slice(&self.id)
    }

    /// Sees to it that the master's scene is being rendered, and sorts out what the master has of it.
    async fn prepare(&mut self, client: &mut Client, reply: &JoinReply) -> Result<(), Outcome> {
        let wanted = wanted_record(reply);
        if self.work.as_ref().is_some_and(|work| !work.record.differences(&wanted).is_empty()) {
            self.lose(false, "the master has another scene now, and may not have saved them").await;
        }
        let loaded = if self.work.is_none() { Some(self.load(client, reply).await?) } else { None };
        let Options { threads, program, .. } = &self.options;
        let (work, begins) = match (&mut self.work, loaded) {
            (none, Some(scene)) => {
                let differences = blank_record(&scene, program).differences(&wanted);
                if !differences.is_empty() {
                    let words: Vec<String> = differences.iter().map(ToString::to_string).collect();
                    let words = plain(&words.join("; "));
                    return Err(Outcome::Refused(format!("the scene is not the master's: {words}")));
                }
                let started = Work::start(scene, *threads, self.seed, reply.merged_end, program);
                (none.insert(started.map_err(Outcome::Broken)?), true)
            }
            (Some(work), None) => {
                let goes_on = work.go_on(*threads, self.seed, reply.merged_end, program);
                let goes_on = goes_on.map_err(Outcome::Broken)?;
                (work, goes_on)
            }
            (None, None) => return Ok(()),
        };
        if begins {
            (self.sink)(Event::Rendering { scene: plain(&reply.scene), threads: *threads });
        }
        let lost = work.outbox.rejoined(reply.merged_end, reply.durable_end, reply.generation);
        work.engine.rest(false);
        self.tell_lost(lost, PARTLY_THERE);
        Ok(())
    }

    /// Renders for the master until something ends that.
    async fn stay(&mut self, client: &mut Client, reply: &JoinReply) -> Result<Outcome, Outcome> {
        let between_uploads = period(reply.upload_period_s, UPLOADS);
        // What was not sent over the last connection is sent first.
        let has_rest = self.work.as_ref().is_some_and(|work| work.outbox.next().is_some());
        let mut next = Instant::now() + if has_rest { Duration::ZERO } else { between_uploads };
        let mut stopped = self.stopped.clone();
        loop {
            let outcome = tokio::select! {
                _ = stopped.wait_for(|stopped| *stopped) => Some(Outcome::Stopped),
                () = sleep_until(self.next_report) => {
                    let ends = self.report(client).await? == Order::Finish;
                    if !ends && let Some(work) = &self.work {
                        // It may rest since an end that was taken back.
                        work.engine.rest(false);
                    }
                    ends.then_some(Outcome::Finished)
                }
                () = sleep_until(next) => {
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

    /// Stays until all that was sent is in a file of the master's: until then nobody else could send it again. Where the end is
    /// taken back it comes again, to render on.
    async fn see_it_saved(&mut self, client: &mut Client) -> Result<(), Outcome> {
        let mut stopped = self.stopped.clone();
        let mut reports = interval(WHILE_ENDING);
        while self.work.as_ref().is_some_and(|work| !work.outbox.is_empty()) {
            tokio::select! {
                _ = stopped.wait_for(|stopped| *stopped) => break,
                _ = reports.tick() => if self.report(client).await? == Order::GoOn {
                    return Err(Outcome::Lost("the render goes on after all".to_owned()));
                },
            }
        }
        Ok(())
    }

    /// Gives a sign of life, and hears what to do.
    async fn report(&mut self, client: &mut Client) -> Result<Order, Outcome> {
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
            // A rate over less than a moment may be anything.
            samples_per_second: progress.map_or(0.0, |p| p.samples_per_second).clamp(0.0, FASTEST),
            waiting_samples: self.work.as_ref().map_or(0, Work::waiting_samples),
            merged_end: self.merged_end,
        }))
        .await?;
        if let Some(work) = &mut self.work {
            work.outbox.saved(reply.durable_end);
        }
        let wanted = reply.report_period_s.map(|wanted| period(wanted, REPORTS));
        self.next_report = Instant::now() + wanted.unwrap_or(self.report_period);
        Ok(reply.order())
    }

    /// What a call gives that may take long, with reports meanwhile: it may have to wait for its turn, for the network, or for a
    /// disk. When the render ends meanwhile nothing more is rendered for it, unless that is taken back.
    pub(super) async fn beside<T>(
        &mut self,
        client: &mut Client,
        call: impl Future<Output = T>,
    ) -> Result<T, Outcome> {
        let mut call = std::pin::pin!(call);
        let mut patience_ends = Some(Instant::now() + SLOW_UPLOAD);
        loop {
            tokio::select! {
                given = &mut call => return Ok(given),
                () = sleep_until(self.next_report) => {
                    if patience_ends.take_if(|end| Instant::now() >= *end).is_some() && self.work.is_some() {
                        let what = format!(
                            "the master has not taken an upload for {} s: it is busy, or the network is slow",
                            SLOW_UPLOAD.as_secs()
                        );
                        self.tell(Event::Trouble(what));
                    }
                    let ends = self.report(client).await? == Order::Finish;
                    match &self.work {
                        Some(work) => work.engine.rest(ends),
                        None if ends => return Err(Outcome::Finished),
                        None => {}
                    }
                }
            }
        }
    }

    /// Sends what waits, or else what has been rendered since; at the end both, and the session ends.
    pub(super) async fn send(&mut self, client: &mut Client, is_last: bool) -> Result<(), Outcome> {
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
        while let Some(film) = self.work.as_ref().and_then(|work| work.outbox.next()) {
            let (samples, run, parcel) = parcel_of(film);
            let bytes = parcel.len() as u64;
            let mut calls = client.clone();
            let upload = calls.upload(tokio_stream::iter(parts(self.id(), parcel)));
            let sent = self.beside(client, timeout(UPLOAD, upload)).await?;
            let late = |_| Err(Status::deadline_exceeded("an upload takes too long"));
            if self.has_taken(sent.unwrap_or_else(late), samples)? {
                self.tell(Event::Sent { samples, bytes, run });
            }
        }
        Ok(())
    }

    /// Whether the master has taken a film that was sent.
    fn has_taken(
        &mut self,
        sent: Result<Response<UploadReply>, Status>,
        samples: u64,
    ) -> Result<bool, Outcome> {
        let Some(work) = &mut self.work else { return Ok(false) };
        match sent {
            Ok(reply) => {
                let reply = reply.into_inner();
                self.merged_end = reply.merged_end;
                // In this order: what is saved need not be joined to what is not.
                work.outbox.saved(reply.durable_end);
                work.outbox.received(reply.generation);
                Ok(true)
            }
            // To be sent again it would have to become another.
            Err(status) if is_refused(&status) => {
                work.outbox.discard();
                self.tell(Event::LostSamples { samples, reason: "the master refuses them" });
                let why = plain(status.message());
                self.tell(Event::Trouble(format!("the master refuses samples: {why}")));
                Ok(false)
            }
            Err(status) => Err(refusal(&status)),
        }
    }

    /// Says good-bye. The master will notice anyhow.
    pub(super) async fn leave(&self, client: &mut Client) {
        drop(answer(client.leave(LeaveRequest { slave: self.id() })).await);
    }
}
