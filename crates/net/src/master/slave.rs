//! What is known of a slave.

use std::net::SocketAddr;
use std::time::Instant;

/// Names a slave: random bytes that it has chosen.
pub type SlaveId = [u8; 16];

/// Whether a slave is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// It loads the scene.
    Loading,
    /// It renders.
    Rendering,
    /// It has sent all there is, and waits until that is in a file.
    Done,
    /// It has said good-bye.
    Left,
    /// It is gone without good-bye.
    Lost,
}

impl Presence {
    /// Whether it takes part.
    pub fn is_there(self) -> bool {
        matches!(self, Self::Loading | Self::Rendering | Self::Done)
    }

    /// In a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Loading => "loading",
            Self::Rendering => "rendering",
            Self::Done => "done",
            Self::Left => "left",
            Self::Lost => "lost",
        }
    }
}

/// What is known of a slave.
#[derive(Clone, Debug)]
pub struct Slave {
    /// Its machine, as people call it.
    pub name: String,
    /// Where it calls from.
    pub peer: SocketAddr,
    /// The random sequence that it renders.
    pub seed: u64,
    /// Threads that render there.
    pub threads: u32,
    /// Whether it is there.
    pub presence: Presence,
    /// When it came first.
    pub since: Instant,
    /// When it was heard of last.
    pub heard: Instant,
    /// Samples of its that were added to the film.
    pub samples: u64,
    /// By its own account.
    pub samples_per_second: f64,
    /// Samples that it has still to send, by its own account: of one that is lost, when it was heard of last.
    pub waiting: u64,
    /// Whether that is counted on: what it told of has not failed to come, or something of it came since.
    pub is_believed: bool,
    /// Uploads that were added.
    pub uploads: u64,
    /// When the last of them came.
    pub last_upload: Option<Instant>,
    /// Uploads that were refused or broke off.
    pub errors: u64,
    /// Why the last of these did.
    pub last_error: Option<String>,
}
