//! The calls that a master answers.

use super::Shared;
use super::listen::Peer;
use super::reports::{Report, note};
use super::roster::{Introduction, Unwelcome};
use super::slave::SlaveId;
use super::uploads::{Bounds, gather, next};
use crate::event::Event;
use crate::ledger::{Receipt, Refusal, run_of};
use crate::limits::{PIECE, PROTOCOL, REPORTS, REPORTS_NEAR_END};
use crate::plain::plain;
use crate::proto::farm_server::Farm;
use crate::proto::report_reply::Order;
use crate::proto::upload_part::Part;
use crate::proto::{
    JoinReply, JoinRequest, LeaveReply, LeaveRequest, Piece, ReportReply, ReportRequest, SceneRequest,
    Setting, UploadPart, UploadReply, UploadStart,
};
use bytes::Bytes;
use indigo_film::igi::{Parcel, parcel_size};
use indigo_film::{Run, Share as _};
use indigo_scene::schema::settings::MOST_THREADS;
use std::net::{Ipv4Addr, SocketAddr};
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;
use tokio::task::spawn_blocking;
use tokio_stream::{Stream, iter};
use tonic::{Request, Response, Status, Streaming};

/// Answers calls.
pub struct Service {
    shared: Arc<Shared>,
}

impl Service {
    /// For a master.
    pub fn new(shared: Arc<Shared>) -> Self {
        Self { shared }
    }

    /// Turns a caller away, and tells of it.
    fn refuse(&self, peer: SocketAddr, status: &Status) -> Status {
        self.shared.refused(peer, status.message());
        // It may hold what the caller has said, of whatever length.
        Status::new(status.code(), plain(status.message()))
    }

    /// The same of a slave that has joined, for which it counts as an error.
    fn refuse_slave(&self, peer: SocketAddr, id: &SlaveId, status: &Status) -> Status {
        let status = self.refuse(peer, status);
        if let Some(slave) = self.shared.roster().known(id) {
            slave.errors += 1;
            slave.last_error = Some(status.message().to_owned());
        }
        status
    }
}

/// The caller's address.
fn peer_of<T>(request: &Request<T>) -> SocketAddr {
    request.extensions().get::<Peer>().map_or((Ipv4Addr::UNSPECIFIED, 0).into(), |peer| peer.0)
}

/// Name and version of a program, without its platform: the same samples come from all.
fn version(program: &str) -> &str {
    program.split(',').next().unwrap_or_default()
}

/// So many characters of what another program calls itself are shown.
const SHOWN_PROGRAM: usize = 100;

/// A slave's name for itself.
fn slave_id(bytes: &[u8]) -> Result<SlaveId, Status> {
    bytes.try_into().map_err(|_| Status::invalid_argument("a slave is named by 16 bytes"))
}

/// What somebody is told whom the master does not know, since it was started anew or has heard nothing for long.
fn unknown() -> Status {
    Status::not_found(
        "the master does not know this slave: it was started anew, or has heard nothing for long",
    )
}

/// What somebody is told when a thread of the master's has failed.
fn failed(error: impl std::fmt::Display) -> Status {
    Status::internal(error.to_string())
}

/// Counts an upload as long as it is under way.
struct Busy<'a>(&'a Shared);

impl<'a> Busy<'a> {
    fn new(shared: &'a Shared) -> Self {
        shared.busy.fetch_add(1, Ordering::Relaxed);
        Self(shared)
    }
}

impl Drop for Busy<'_> {
    fn drop(&mut self) {
        self.0.busy.fetch_sub(1, Ordering::Relaxed);
    }
}

#[tonic::async_trait]
impl Farm for Service {
    type FetchSceneStream = Pin<Box<dyn Stream<Item = Result<Piece, Status>> + Send>>;

    async fn join(&self, request: Request<JoinRequest>) -> Result<Response<JoinReply>, Status> {
        let peer = peer_of(&request);
        let JoinRequest { protocol, program, slave, seed, name, threads } = request.into_inner();
        let shared = &self.shared;
        if protocol != PROTOCOL || version(&program) != version(&shared.program) {
            let ours = &shared.program;
            let what = format!(
                "the master is \"{ours}\" (protocol {PROTOCOL}), and the slave is \"{}\" (protocol {protocol}): \
                 samples of different programs do not mix, so the same version is needed",
                program.chars().take(SHOWN_PROGRAM).collect::<String>()
            );
            return Err(self.refuse(peer, &Status::failed_precondition(what)));
        }
        let id = slave_id(&slave).map_err(|status| self.refuse(peer, &status))?;
        if !(1..=MOST_THREADS).contains(&(threads as usize)) {
            let what = format!("a slave tells of {threads} threads; 1 to {MOST_THREADS} can be");
            return Err(self.refuse(peer, &Status::invalid_argument(what)));
        }
        // Who has something left to send may come back for that.
        if shared.is_ending.load(Ordering::Relaxed) && !shared.roster().expects(&id) {
            return Err(Status::unavailable("the render is about to end"));
        }
        if shared.own_seed == Some(seed) {
            let what = format!(
                "the master renders with seed {seed} itself, and the same samples would come twice; give the slave another \
                 -seed, or none"
            );
            return Err(self.refuse(peer, &Status::already_exists(what)));
        }
        let introduction = Introduction { name: &name, peer, seed, threads };
        let joined = shared.roster().join(id, introduction, Instant::now()).map(|slave| slave.name.clone());
        let slave = joined.map_err(|why| {
            let status = match why {
                Unwelcome::Taken(what) => Status::already_exists(what),
                Unwelcome::Full(what) => Status::resource_exhausted(what),
            };
            self.refuse(peer, &status)
        })?;
        let ((merged_end, durable_end), generation) = {
            let shared = Arc::clone(shared);
            let known = spawn_blocking(move || {
                let ledger = shared.ledger();
                let ends = ledger.ends(seed);
                (ends, ledger.generation_of(seed, ends.0))
            });
            known.await.map_err(failed)?
        };
        shared.tell(Event::Joined { slave, peer, threads, seed });
        let scene = &shared.scene;
        let setting = |option: &str, name: &str, value: &str| Setting {
            option: option.to_owned(),
            name: name.to_owned(),
            value: value.to_owned(),
        };
        Ok(Response::new(JoinReply {
            scene: scene.name.clone(),
            pack_hash: Bytes::copy_from_slice(&shared.pack_hash),
            pack_bytes: scene.pack.len() as u64,
            settings_file: scene.settings_file.clone(),
            overrides: scene
                .overrides
                .iter()
                .map(|[option, name, value]| setting(option, name, value))
                .collect(),
            scene_hash: Bytes::copy_from_slice(&scene.identity.hash),
            identity: scene.identity.settings.iter().map(|(name, value)| setting("", name, value)).collect(),
            upload_period_s: scene.upload_period.as_secs_f64(),
            report_period_s: REPORTS.as_secs_f64(),
            merged_end,
            durable_end,
            generation,
        }))
    }

    async fn fetch_scene(
        &self,
        request: Request<SceneRequest>,
    ) -> Result<Response<Self::FetchSceneStream>, Status> {
        let peer = peer_of(&request);
        let SceneRequest { slave, pack_hash } = request.into_inner();
        let id = slave_id(&slave).map_err(|status| self.refuse(peer, &status))?;
        self.shared.roster().heard(&id, Instant::now()).ok_or_else(unknown)?;
        if pack_hash != self.shared.pack_hash[..] {
            return Err(self.refuse(peer, &Status::not_found("the master has another scene")));
        }
        let pack = self.shared.scene.pack.clone();
        let shared = Arc::clone(&self.shared);
        let pieces = (0..pack.len()).step_by(PIECE).map(move |from| {
            // Fetching is a sign of life.
            shared.roster().heard(&id, Instant::now());
            Ok(Piece { data: pack.slice(from..(from + PIECE).min(pack.len())) })
        });
        Ok(Response::new(Box::pin(iter(pieces))))
    }

    async fn upload(&self, request: Request<Streaming<UploadPart>>) -> Result<Response<UploadReply>, Status> {
        let peer = peer_of(&request);
        let mut stream = request.into_inner();
        let Some(Part::Start(start)) = next(&mut stream).await? else {
            return Err(self.refuse(peer, &Status::invalid_argument("an upload begins with its length")));
        };
        let id = slave_id(&start.slave).map_err(|status| self.refuse(peer, &status))?;
        let seed = self.shared.roster().heard(&id, Instant::now()).ok_or_else(unknown)?.seed;
        let result = self.receive(id, seed, &start, stream).await;
        match result {
            Ok(Receipt { merged_end, durable_end, generation, .. }) => {
                self.shared.roster().heard(&id, Instant::now());
                Ok(Response::new(UploadReply { merged_end, durable_end, generation }))
            }
            Err(status) => Err(self.refuse_slave(peer, &id, &status)),
        }
    }

    async fn report(&self, request: Request<ReportRequest>) -> Result<Response<ReportReply>, Status> {
        let peer = peer_of(&request);
        let said = request.into_inner();
        let id = slave_id(&said.slave)?;
        // It lives, however long the film is busy.
        self.shared.roster().heard(&id, Instant::now()).ok_or_else(unknown)?;
        let report = Report::of(&said)
            .map_err(|what| self.refuse_slave(peer, &id, &Status::invalid_argument(what)))?;
        let shared = Arc::clone(&self.shared);
        let noted = spawn_blocking(move || note(&shared, &id, report));
        let durable_end = noted.await.map_err(failed)?.ok_or_else(unknown)?;
        let is_ending = self.shared.is_ending.load(Ordering::Relaxed);
        let order = if is_ending { Order::Finish } else { Order::GoOn };
        let is_near_end = self.shared.is_near_end.load(Ordering::Relaxed);
        let report_period_s = is_near_end.then(|| REPORTS_NEAR_END.as_secs_f64());
        Ok(Response::new(ReportReply { durable_end, order: order.into(), report_period_s }))
    }

    async fn leave(&self, request: Request<LeaveRequest>) -> Result<Response<LeaveReply>, Status> {
        let id = slave_id(&request.into_inner().slave)?;
        let left = self.shared.roster().leave(&id).map(|slave| (slave.name.clone(), slave.peer));
        if let Some((slave, peer)) = left {
            self.shared.tell(Event::Left { slave, peer });
        }
        Ok(Response::new(LeaveReply {}))
    }
}

impl Service {
    /// Receives a parcel and adds it to the film; what became of it.
    async fn receive(
        &self,
        id: SlaveId,
        seed: u64,
        start: &UploadStart,
        stream: Streaming<UploadPart>,
    ) -> Result<Receipt, Status> {
        let shared = &self.shared;
        let _busy = Busy::new(shared);
        if start.bytes > shared.parcel_limit {
            let limit = shared.parcel_limit;
            let what = format!("an upload of {} bytes is more than a film takes, {limit}", start.bytes);
            return Err(Status::resource_exhausted(what));
        }
        let mut parcel = shared.rooms.take(start.bytes).await.map_err(failed)?;
        let pace = Arc::clone(&parcel.pace);
        let came = |bytes| {
            pace.add(bytes);
            shared.bytes_received.fetch_add(bytes, Ordering::Relaxed);
            shared.roster().heard(&id, Instant::now());
        };
        gather(&mut parcel, start.bytes, Bounds::new(|| shared.rooms.must_give_up(&pace)), stream, came)
            .await?;
        let shared = Arc::clone(shared);
        spawn_blocking(move || add(&shared, id, seed, &parcel)).await.map_err(failed)?
    }
}

/// Adds a parcel to the film, and tells of it before anybody can copy that: what a file has is told of, whatever happens then.
fn add(shared: &Shared, id: SlaveId, seed: u64, parcel: &[u8]) -> Result<Receipt, Status> {
    let damaged = |error| Status::invalid_argument(format!("an upload is damaged: {error}"));
    let (size, expected) = (parcel_size(parcel).map_err(damaged)?, shared.ledger().size());
    if size != expected {
        return Err(Status::invalid_argument(format!("an upload is {size}, and the film is {expected}")));
    }
    let film = Parcel::open(parcel).map_err(damaged)?;
    let samples = film.record().map_or(0, |record| record.samples);
    let mut ledger = shared.ledger();
    let receipt = ledger
        .take(seed, &film)
        .map_err(|refusal: Refusal| Status::invalid_argument(format!("an upload is refused: {refusal}")))?;
    // Under the ledger's lock, so that nobody sees the samples as waiting and in the film.
    let slave = credit(shared, &id, samples, &receipt);
    shared.tell(if receipt.is_repeated {
        Event::Repeated { slave }
    } else {
        // Without a run it would have been refused.
        let run = run_of(&film).unwrap_or(Run { seed, first: 0, end: 0 });
        Event::Added { slave, samples, bytes: parcel.len() as u64, run, missing: receipt.missing }
    });
    drop(ledger);
    Ok(receipt)
}

/// Counts an upload for its slave, which may be gone by now; the slave's name.
fn credit(shared: &Shared, id: &SlaveId, samples: u64, receipt: &Receipt) -> String {
    let mut roster = shared.roster();
    if !receipt.is_repeated {
        roster.credit(id, samples, Instant::now());
    }
    roster.known(id).map_or_else(String::new, |slave| slave.name.clone())
}
