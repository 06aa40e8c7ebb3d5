//! What masters and slaves tell whoever runs them.

use indigo_film::Run;
use std::fmt;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

/// Takes events, from any thread, without taking long. It asks nothing of the master or slave that tells, whose film may be locked
/// meanwhile.
pub type Sink = Arc<dyn Fn(Event) + Send + Sync>;

/// How much an event matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Weight {
    /// Only to those who want to know everything.
    Detail,
    /// To everybody.
    Info,
    /// Somebody should look after it.
    Warning,
}

/// Something has happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// To a master: a slave is there, for the first time or again.
    Joined {
        /// Its machine.
        slave: String,
        /// Where it calls from.
        peer: SocketAddr,
        /// Threads that render there.
        threads: u32,
        /// The random sequence that it renders, by which uploads are known for its.
        seed: u64,
    },
    /// To a master: a slave is gone, after saying so.
    Left {
        /// Its machine.
        slave: String,
        /// Where it called from.
        peer: SocketAddr,
    },
    /// To a master: a slave is gone without good-bye, or has said nothing for long.
    Lost {
        /// Its machine.
        slave: String,
        /// Where it called from.
        peer: SocketAddr,
    },
    /// To a master: samples were added to the film.
    Added {
        /// The slave's machine.
        slave: String,
        /// How many.
        samples: u64,
        /// Bytes that came.
        bytes: u64,
        /// The seed and units that they are of.
        run: Run,
        /// Units of work that never came, and will not: the slave was killed, or the film is older than what it sent.
        missing: u64,
    },
    /// To a working master: samples of its own were added to the film.
    Rendered {
        /// How many.
        samples: u64,
        /// The seed and units that they are of.
        run: Run,
    },
    /// To a master: samples came again that are in the film, since the first answer was lost.
    Repeated {
        /// The slave's machine.
        slave: String,
    },
    /// To a master: somebody was turned away. `more` others of that address were, since it was last told.
    Refused {
        /// Where from.
        peer: SocketAddr,
        /// Why.
        reason: String,
        /// Refusals that were not told.
        more: u64,
    },
    /// To a slave: it looks for a master.
    Searching,
    /// To a slave: it is connected.
    Connected {
        /// The master's address.
        master: String,
        /// The scene.
        scene: String,
    },
    /// To a slave: the scene comes over the network.
    Fetching {
        /// Bytes.
        bytes: u64,
    },
    /// To a slave: the scene is loaded, and rendered.
    Rendering {
        /// The scene.
        scene: String,
        /// Threads.
        threads: usize,
    },
    /// To a slave: the master has what was rendered.
    Sent {
        /// Samples.
        samples: u64,
        /// Bytes.
        bytes: u64,
        /// The seed and units that they are of.
        run: Run,
    },
    /// To a slave: there is no connection, and it will be tried again.
    Disconnected {
        /// Why.
        reason: String,
        /// When.
        again_in: Duration,
    },
    /// To a slave: samples are lost.
    LostSamples {
        /// How many.
        samples: u64,
        /// Why.
        reason: &'static str,
    },
    /// To a slave: the master has ended the render.
    Finished,
    /// Something does not work, and the rest goes on.
    Trouble(String),
}

impl Event {
    /// How much it matters.
    pub fn weight(&self) -> Weight {
        match self {
            Self::Added { missing: 0, .. }
            | Self::Rendered { .. }
            | Self::Repeated { .. }
            | Self::Sent { .. }
            | Self::Fetching { .. } => Weight::Detail,
            Self::Lost { .. }
            | Self::Refused { .. }
            | Self::Added { .. }
            | Self::Disconnected { .. }
            | Self::LostSamples { .. }
            | Self::Trouble(_) => Weight::Warning,
            _ => Weight::Info,
        }
    }

    /// The kind of event in a word, for logs that programs read.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Joined { .. } => "joined",
            Self::Left { .. } => "left",
            Self::Lost { .. } => "lost",
            Self::Added { .. } | Self::Rendered { .. } => "added",
            Self::Repeated { .. } => "repeated",
            Self::Refused { .. } => "refused",
            Self::Searching => "searching",
            Self::Connected { .. } => "connected",
            Self::Fetching { .. } => "fetching",
            Self::Rendering { .. } => "rendering",
            Self::Sent { .. } => "sent",
            Self::Disconnected { .. } => "disconnected",
            Self::LostSamples { .. } => "lost_samples",
            Self::Finished => "finished",
            Self::Trouble(_) => "trouble",
        }
    }

    /// Name and value of what such logs have besides; texts are not quoted yet.
    pub fn fields(&self) -> Vec<(&'static str, Field)> {
        let text = |t: &dyn fmt::Display| Field::Text(t.to_string());
        match self {
            Self::Joined { slave, peer, threads, seed } => {
                vec![
                    ("slave", text(slave)),
                    ("peer", text(peer)),
                    ("threads", Field::Number(f64::from(*threads))),
                    ("seed", text(seed)),
                ]
            }
            Self::Left { slave, peer } | Self::Lost { slave, peer } => {
                vec![("slave", text(slave)), ("peer", text(peer))]
            }
            Self::Added { slave, samples, bytes, missing, run } => {
                let mut fields =
                    vec![("slave", text(slave)), ("missing_units", Field::Number(*missing as f64))];
                fields.extend(of_upload(*samples, *bytes, *run));
                fields
            }
            Self::Rendered { samples, run } => of_upload(*samples, 0, *run).into(),
            Self::Repeated { slave } => vec![("slave", text(slave))],
            Self::Refused { peer, more, .. } => {
                vec![("peer", text(peer)), ("untold", Field::Number(*more as f64))]
            }
            Self::Connected { master, .. } => vec![("master", text(master))],
            Self::Fetching { bytes } => vec![("bytes", Field::Number(*bytes as f64))],
            Self::Rendering { threads, .. } => vec![("threads", Field::Number(*threads as f64))],
            Self::Sent { samples, bytes, run } => of_upload(*samples, *bytes, *run).into(),
            Self::LostSamples { samples, .. } => vec![("samples", Field::Number(*samples as f64))],
            Self::Disconnected { again_in, .. } => {
                vec![("again_in_s", Field::Number(again_in.as_secs_f64()))]
            }
            Self::Searching | Self::Finished | Self::Trouble(_) => vec![],
        }
    }
}

/// What logs have of an upload: which, so that a sum of logs counts each once.
fn of_upload(samples: u64, bytes: u64, run: Run) -> [(&'static str, Field); 5] {
    [
        ("samples", Field::Number(samples as f64)),
        ("bytes", Field::Number(bytes as f64)),
        // Larger than such logs' numbers can be.
        ("seed", Field::Text(run.seed.to_string())),
        ("first_unit", Field::Number(run.first as f64)),
        ("end_unit", Field::Number(run.end as f64)),
    ]
}

/// A value of a log that programs read.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// Text, not quoted yet.
    Text(String),
    /// A number.
    Number(f64),
}

/// Bytes in a unit that suits them.
struct Bytes(u64);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            n if n >= 10 << 20 => write!(f, "{} MiB", n >> 20),
            n if n >= 10 << 10 => write!(f, "{} KiB", n >> 10),
            n => write!(f, "{n} bytes"),
        }
    }
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joined { slave, peer, threads: 1, .. } => {
                write!(f, "{slave} ({peer}) has joined, with 1 thread")
            }
            Self::Joined { slave, peer, threads, .. } => {
                write!(f, "{slave} ({peer}) has joined, with {threads} threads")
            }
            Self::Left { slave, peer } => write!(f, "{slave} ({peer}) has left"),
            Self::Lost { slave, peer } => write!(f, "{slave} ({peer}) is gone without good-bye"),
            Self::Added { slave, samples, bytes, missing: 0, .. } => {
                write!(f, "{slave} has sent {samples} samples ({})", Bytes(*bytes))
            }
            Self::Added { slave, samples, missing, .. } => {
                write!(f, "{slave} has sent {samples} samples; {missing} units of work before them are lost")
            }
            Self::Rendered { samples, .. } => write!(f, "Added {samples} samples of this machine"),
            Self::Repeated { slave } => write!(f, "{slave} has sent again what is in the film already"),
            Self::Refused { peer, reason, more: 0 } => write!(f, "{peer} was refused: {reason}"),
            Self::Refused { peer, reason, more } => {
                let what = if *more == 1 { "refusal" } else { "refusals" };
                write!(f, "{peer} was refused: {reason} ({more} more {what} of this address before)")
            }
            Self::Searching => f.write_str("Looking for a master in the local network"),
            Self::Connected { master, scene } => write!(f, "Connected to {master}, which renders {scene}"),
            Self::Fetching { bytes } => write!(f, "Fetching the scene ({})", Bytes(*bytes)),
            Self::Rendering { scene, threads: 1 } => write!(f, "Rendering {scene} with 1 thread"),
            Self::Rendering { scene, threads } => write!(f, "Rendering {scene} with {threads} threads"),
            Self::Sent { samples, bytes, .. } => write!(f, "Sent {samples} samples ({})", Bytes(*bytes)),
            Self::Disconnected { reason, again_in } => {
                write!(f, "{reason}; trying again in {:.0} s", again_in.as_secs_f64().max(1.0))
            }
            Self::LostSamples { samples, reason } => write!(f, "{samples} samples are lost: {reason}"),
            Self::Finished => f.write_str("The master has ended the render"),
            Self::Trouble(what) => f.write_str(what),
        }
    }
}
