//! The master: holds the film, hands out the scene, and adds what slaves send.

mod listen;
mod refusals;
mod reports;
mod rooms;
mod roster;
mod serve;
mod service;
mod slave;
mod status;
mod uploads;

pub use roster::Unsent;
pub use slave::Presence;
pub use status::{OwnStatus, SlaveStatus, Status};

use crate::discovery::Announcement;
use crate::event::{Event, Sink};
use crate::key::Key;
use crate::ledger::{Ledger, Receipt, Refusal};
use crate::limits::{UPLOADS, parcel_bytes};
use crate::plain::plain;
use crate::{NetError, tls};
use bytes::Bytes;
use indigo_film::{FilmRecord, FilmState, MasterFilm, SavedFilm};
use indigo_scene::{Identity, Scene};
use refusals::Refusals;
use rooms::Rooms;
use roster::Roster;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;
use tokio::sync::oneshot;
use tokio_rustls::TlsAcceptor;

/// A setting of the command line: the option as it was written, the setting's name, its value.
pub type Override = [String; 3];

/// The scene as slaves get it.
#[derive(Clone, Debug)]
pub struct SceneParcel {
    /// What people call it.
    pub name: String,
    /// Packed.
    pub pack: Bytes,
    /// The master's settings file.
    pub settings_file: Option<Bytes>,
    /// Settings of the master's command line.
    pub overrides: Vec<Override>,
    /// What a slave must find when it has loaded it.
    pub identity: Identity,
    /// How often slaves send what they have rendered.
    pub upload_period: Duration,
}

impl SceneParcel {
    /// With what slaves must know of the scene as the master has loaded it.
    pub fn new(
        scene: &Scene,
        pack: Vec<u8>,
        settings_file: Option<Vec<u8>>,
        overrides: Vec<Override>,
    ) -> Self {
        Self {
            name: scene.output.scene_path.clone(),
            pack: pack.into(),
            settings_file: settings_file.map(Bytes::from),
            overrides,
            identity: scene.identity.clone(),
            // The setting is positive; more than can be said is for ever.
            upload_period: Duration::try_from_secs_f64(scene.output.frame_upload_period)
                .unwrap_or(Duration::MAX),
        }
    }
}

/// What a master is told to do.
pub struct Setup {
    /// The scene.
    pub scene: SceneParcel,
    /// The film: without samples, or one that is gone on with.
    pub film: SavedFilm,
    /// Name, version and platform of the program.
    pub program: String,
    /// The shared key; without one only this machine can connect.
    pub key: Option<Key>,
    /// The random sequence that the master renders itself, if it does: no slave's.
    pub own_seed: Option<u64>,
    /// The port; 0 takes any that is free.
    pub port: u16,
    /// Where the status page is, if there is one, and the picture that it shows.
    pub page: Option<(SocketAddr, PathBuf)>,
}

/// What all parts of a master share.
struct Shared {
    scene: SceneParcel,
    pack_hash: [u8; 32],
    program: String,
    /// Whoever locks others besides locks this one first: samples move between them.
    ledger: Mutex<Ledger>,
    roster: Mutex<Roster>,
    refusals: Mutex<Refusals>,
    /// Bytes of the largest parcel that can be one.
    parcel_limit: u64,
    rooms: Rooms,
    own_seed: Option<u64>,
    own: Mutex<Option<OwnStatus>>,
    is_ending: AtomicBool,
    is_near_end: AtomicBool,
    /// Uploads that are being received or added.
    busy: AtomicU64,
    bytes_received: AtomicU64,
    started: Instant,
    sink: Sink,
}

impl Shared {
    fn ledger(&self) -> MutexGuard<'_, Ledger> {
        lock(&self.ledger)
    }

    fn roster(&self) -> MutexGuard<'_, Roster> {
        lock(&self.roster)
    }

    fn tell(&self, event: Event) {
        (self.sink)(event);
    }

    /// Somebody was turned away.
    fn refused(&self, peer: SocketAddr, reason: &str) {
        let told = lock(&self.refusals).add(peer.ip(), Instant::now());
        if let Some(more) = told {
            self.tell(Event::Refused { peer, reason: plain(reason), more });
        }
    }

    /// A connection has ended: whoever called by it and has not said good-bye is gone, or will call again.
    fn disconnected(&self, peer: SocketAddr) {
        let lost = self.roster().disconnected(peer, Instant::now());
        if let Some(name) = lost {
            self.tell(Event::Lost { slave: name, peer });
        }
    }
}

/// Nothing that is done under these locks can be left half done by a panic and matter.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A running master. Dropping it ends all connections.
pub struct Master {
    shared: Arc<Shared>,
    address: SocketAddr,
    page: Option<SocketAddr>,
    announcement: Option<Announcement>,
    end: Option<oneshot::Sender<()>>,
    runtime: Option<Runtime>,
}

impl Master {
    /// Listens.
    ///
    /// # Errors
    /// Where the port is taken, or the system refuses.
    pub fn start(setup: Setup, sink: Sink) -> Result<Self, NetError> {
        let Setup { scene, film, program, key, own_seed, port, page } = setup;
        let film_bytes = MasterFilm::bytes_needed(film.film.size, film.film.layers.iter().map(|l| l.kind));
        let shared = Arc::new(Shared {
            pack_hash: *blake3::hash(&scene.pack).as_bytes(),
            parcel_limit: parcel_bytes(film_bytes),
            ledger: Mutex::new(Ledger::new(film)?),
            scene,
            program,
            roster: Mutex::default(),
            refusals: Mutex::default(),
            rooms: Rooms::new(parcel_bytes(film_bytes)),
            own_seed,
            own: Mutex::default(),
            is_ending: AtomicBool::new(false),
            is_near_end: AtomicBool::new(false),
            busy: AtomicU64::new(0),
            bytes_received: AtomicU64::new(0),
            started: Instant::now(),
            sink,
        });
        let tls = key.as_ref().map(tls::server).transpose()?.map(TlsAcceptor::from);
        let is_open = tls.is_some();
        let runtime = tokio::runtime::Builder::new_multi_thread()
            // Two, so that what takes long for one slave does not keep another's report waiting.
            .worker_threads(2)
            // Each holds a film in memory while it adds it.
            .max_blocking_threads(UPLOADS)
            .thread_name("network")
            .enable_all()
            .build()
            .map_err(NetError::Threads)?;
        let listener = runtime.block_on(serve::listen(is_open, port))?;
        let address = listener.local_addr().map_err(|source| NetError::Listen { port, source })?;
        let (end, ended) = oneshot::channel::<()>();
        runtime.spawn(serve::serve(listener, tls, Arc::clone(&shared), ended));
        runtime.spawn(serve::watch(Arc::clone(&shared)));
        let page = page.map(|(at, picture)| serve::show(&runtime, at, picture, &shared)).transpose()?;
        let announcement = Announcement::start(address.port(), is_open)
            .inspect_err(|error| {
                let what = format!("slaves have to be told where the master is (-h): {error}");
                shared.tell(Event::Trouble(what));
            })
            .ok();
        Ok(Self { shared, address, page, announcement, end: Some(end), runtime: Some(runtime) })
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Where the status page is.
    pub fn page(&self) -> Option<SocketAddr> {
        self.page
    }

    /// Tells what this process renders itself.
    pub fn tell_own(&self, own: OwnStatus) {
        *lock(&self.shared.own) = Some(own);
    }

    /// The record of the film as it stands.
    pub fn record(&self) -> FilmRecord {
        self.shared.ledger().record().clone()
    }

    /// Adds what was rendered in this process.
    ///
    /// # Errors
    /// Where it does not belong to the film.
    pub fn add(&self, seed: u64, film: &SavedFilm) -> Result<Receipt, Refusal> {
        let mut ledger = self.shared.ledger();
        let receipt = ledger.take(seed, film)?;
        // Under the ledger's lock, so that nobody sees the samples here and there.
        if let Some(own) = &mut *lock(&self.shared.own)
            && !receipt.is_repeated
        {
            own.pending = own.pending.saturating_sub(film.record.as_ref().map_or(0, |record| record.samples));
        }
        Ok(receipt)
    }

    /// A copy of the film to be saved, by [`saved`](Self::saved) if that succeeds.
    pub fn copy(&self) -> SavedFilm {
        self.shared.ledger().copy()
    }

    /// The film's sums as they stand, to be looked at.
    pub fn sums(&self) -> FilmState {
        self.shared.ledger().sums().clone()
    }

    /// A copy is on the disk, with this record: slaves need not keep what is in it.
    pub fn saved(&self, record: FilmRecord) {
        self.shared.ledger().saved(record);
    }

    /// How things stand.
    pub fn status(&self) -> Status {
        Status::of(&self.shared)
    }

    /// Whether the end is so near that slaves are to report often.
    pub fn tell_near_end(&self, is_near: bool) {
        self.shared.is_near_end.store(is_near, Ordering::Relaxed);
    }

    /// Asks all slaves for the last of what they have. They leave when [`saved`](Self::saved) has told that it is in a file.
    pub fn begin_end(&self) {
        self.shared.is_ending.store(true, Ordering::Relaxed);
    }

    /// The render goes on after all, since samples that slaves had told of did not come. What those slaves tell of is not
    /// counted on again: who has heard of the end leaves, and comes back as another.
    pub fn take_back_end(&self) {
        self.shared.roster().disbelieve();
        self.shared.is_ending.store(false, Ordering::Relaxed);
    }

    /// Whether all that slaves have is in the film.
    pub fn has_all(&self) -> bool {
        self.shared.busy.load(Ordering::Relaxed) == 0 && !self.shared.roster().is_at_work(Instant::now())
    }

    /// What slaves have not sent.
    pub fn unsent(&self) -> Unsent {
        self.shared.roster().unsent()
    }

    /// Whether nobody is there any more, and nothing on its way.
    pub fn is_deserted(&self) -> bool {
        self.shared.busy.load(Ordering::Relaxed) == 0 && self.shared.roster().present() == 0
    }
}

impl Drop for Master {
    fn drop(&mut self) {
        self.close();
    }
}

impl Master {
    /// Ends all connections. From now on no slave is told that something was added to the film: a copy of it then has all
    /// of which one ever was.
    pub fn close(&mut self) {
        self.announcement = None;
        if let Some(end) = self.end.take() {
            // The server may have ended by itself.
            let _ = end.send(());
        }
        if let Some(runtime) = self.runtime.take() {
            // Long enough for answers that are on their way.
            runtime.shutdown_timeout(Duration::from_millis(500));
        }
    }
}
