//! How things stand, as plain data.

use super::slave::Presence;
use super::{Shared, lock};
use std::net::SocketAddr;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// How things stand with a master.
#[derive(Clone, Debug, Default)]
pub struct Status {
    /// The scene.
    pub scene: String,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Samples in the film, and those of a working master that are not there yet.
    pub samples: u64,
    /// The same per pixel.
    pub samples_per_pixel: f64,
    /// Samples that slaves have still to send, by their own account.
    pub waiting: u64,
    /// What slaves render, by their own account, and a working master.
    pub samples_per_second: f64,
    /// Since the master was started.
    pub elapsed: Duration,
    /// Time of rendering of all machines together, in seconds.
    pub rendered_s: f64,
    /// Bytes of uploads.
    pub bytes_received: u64,
    /// Whoever was turned away.
    pub refused: u64,
    /// Slaves that are there.
    pub present: usize,
    /// What a working master renders itself.
    pub own: Option<OwnStatus>,
    /// All slaves, in the order in which they came.
    pub slaves: Vec<SlaveStatus>,
}

/// How things stand with what a working master renders itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OwnStatus {
    /// Its threads.
    pub threads: usize,
    /// What they render.
    pub samples_per_second: f64,
    /// Samples that are not in the film yet.
    pub pending: u64,
}

/// How things stand with a slave.
#[derive(Clone, Debug)]
pub struct SlaveStatus {
    /// Its machine.
    pub name: String,
    /// Where it calls from.
    pub peer: SocketAddr,
    /// Its threads.
    pub threads: u32,
    /// Whether it is there.
    pub presence: Presence,
    /// Since it came first.
    pub since: Duration,
    /// Samples of its in the film.
    pub samples: u64,
    /// By its own account.
    pub samples_per_second: f64,
    /// Uploads that were added.
    pub uploads: u64,
    /// Time since the last of them.
    pub last_upload: Option<Duration>,
    /// Uploads that were refused or broke off.
    pub errors: u64,
    /// Why the last of these did.
    pub last_error: Option<String>,
}

impl Status {
    pub(super) fn of(shared: &Shared) -> Self {
        let now = Instant::now();
        // At one moment: what comes in between would else be counted twice, or not at all.
        let ledger = shared.ledger();
        let own = *lock(&shared.own);
        let (own_rate, pending) = own.map_or((0.0, 0), |own| (own.samples_per_second, own.pending));
        let (size, rendered_s) = (ledger.size(), ledger.record().elapsed_s);
        let samples = ledger.record().samples + pending;
        let (slaves, samples_per_second, present, waiting) = {
            let roster = shared.roster();
            (roster.all(), roster.samples_per_second(), roster.present(), roster.waiting())
        };
        drop(ledger);
        let refused = lock(&shared.refusals).total();
        Self {
            scene: shared.scene.name.clone(),
            size: [size.width(), size.height()],
            samples,
            samples_per_pixel: samples as f64 / size.pixels() as f64,
            waiting,
            samples_per_second: samples_per_second + own_rate,
            elapsed: now - shared.started,
            rendered_s,
            bytes_received: shared.bytes_received.load(Ordering::Relaxed),
            refused,
            present,
            own,
            slaves: slaves
                .into_iter()
                .map(|slave| SlaveStatus {
                    name: slave.name,
                    peer: slave.peer,
                    threads: slave.threads,
                    presence: slave.presence,
                    since: now.saturating_duration_since(slave.since),
                    samples: slave.samples,
                    samples_per_second: slave.samples_per_second,
                    uploads: slave.uploads,
                    last_upload: slave.last_upload.map(|at| now.saturating_duration_since(at)),
                    errors: slave.errors,
                    last_error: slave.last_error,
                })
                .collect(),
        }
    }
}
