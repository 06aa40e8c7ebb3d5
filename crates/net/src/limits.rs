//! Bounds on what peers may do: nobody's mistake or ill will takes more than this.

use std::time::Duration;

/// The protocol's number: peers of another do not understand each other.
pub const PROTOCOL: u32 = 3;
/// The port of the manual.
pub const PORT: u16 = 7777;

/// The most bytes of a piece of a scene or a parcel. Large enough that its overhead is lost in it, small enough that it comes
/// within [`SILENCE`] at 1100 bytes a second, and that reports need not wait long behind it.
pub const PIECE: usize = 32 << 10;
/// The most bytes of a message: a piece, or a reply with a settings file, and something for the numbers round them.
pub const MESSAGE: usize = 1 << 20;
/// The most bytes of a settings file, which travels in one message.
pub const SETTINGS: usize = MESSAGE / 2;
/// The most connections at a time.
pub const CONNECTIONS: usize = 256;
/// The most calls at a time over a connection: a slave makes one after another, and reports meanwhile.
pub const CALLS: u32 = 8;
/// The most connections to the status page at a time. When there is one more another makes room.
pub const VISITORS: usize = 64;
/// A connection to the status page over which no answer goes for so long ends: a question may take no longer, either.
pub const PAGE_SILENCE: Duration = Duration::from_secs(10);
/// So many films, as large as compressed ones can be, are what a master has room for beside its own. Those that are received
/// at a time share it by their real lengths, so that many slow ones have their turn together; others wait.
pub const UPLOADS: usize = 8;
/// What the room for uploads is counted in, in bytes.
pub const ROOM: u64 = 4 << 10;
/// The most slaves that are remembered, gone ones too.
pub const SLAVES: usize = 1024;
/// The longest name of a machine that is shown, in characters.
pub const NAME: usize = 64;
/// The most bytes of a packed scene that a slave takes: of no larger file is ever read.
pub const PACK: u64 = 4 << 30;

/// The most samples a second that a slave is believed to render.
pub const FASTEST: f64 = 1e12;

/// A peer that says nothing for so long is taken for gone.
pub const SILENCE: Duration = Duration::from_secs(30);
/// A slave whose connection broke so short a time ago is still expected back: it tries again after one second and three.
pub const RETURN: Duration = Duration::from_secs(5);
/// The longest text of a peer's that is shown or kept, in characters.
pub const TEXT: usize = 300;
/// How often a peer is asked whether it is still there: several times before it is taken for gone.
pub const KEEP_ALIVE: Duration = Duration::from_secs(8);
/// How long a connection may take to be made, with all proofs.
pub const HANDSHAKE: Duration = Duration::from_secs(10);
/// How long a slave waits for the answer to a short call.
pub const ANSWER: Duration = Duration::from_secs(30);
/// How long an upload may take, however slow the network.
pub const UPLOAD: Duration = Duration::from_mins(30);
/// Who waits so long for room makes one of those give up theirs that take it and send less than [`LEAST_RATE`].
pub const PATIENCE: Duration = Duration::from_secs(2);
/// The least bytes a second of an upload that others wait for, on the average: an eighth of a megabit, as poor lines have.
pub const LEAST_RATE: u64 = 16 << 10;
/// How long an upload may be slower than that at first: networks stand still for seconds.
pub const RUN_UP: Duration = Duration::from_secs(10);
/// Time between a slave's reports.
pub const REPORTS: Duration = Duration::from_secs(2);
/// The same when a number of samples is about to be reached: what is rendered between two of them may be too many.
pub const REPORTS_NEAR_END: Duration = Duration::from_millis(100);

/// The most bytes of a parcel of a film: of 40 bytes of a pixel of the master's film, sums take half in single precision and
/// counts what they take, 24 in all; and something more, since what cannot be compressed grows by half a percent, and for the
/// record.
pub fn parcel_bytes(film_bytes: u64) -> u64 {
    film_bytes / 5 * 3 + film_bytes / 100 + (1 << 20)
}
