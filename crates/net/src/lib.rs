//! Rendering on many machines.
//!
//! A [`Master`](master::Master) holds a film and serves its scene; a [`Slave`](slave::Slave) fetches the scene, runs a
//! [`Session`](indigo_render::Session) of its own, and sends the film that it has drained from it again and again.
//! Neither waits for the other: slaves come and go, and render on while there is no master to send to.
//!
//! | part | purpose |
//! |---|---|
//! | `proto/indigo.proto` | the calls, as others see them |
//! | [`ledger`] | the master's film, to which each upload is added exactly once |
//! | [`outbox`] | what a slave keeps until it is safe with the master |
//! | `discovery` | masters in the local network |
//! | [`key`], `tls` | who may take part |
//! | `page` | the status page |
//! | [`limits`], `plain` | what peers may do at most, and how their texts are shown |
//! | [`master`], [`slave`] | the two programs, on threads of their own |
//! | [`event`] | what they tell whoever runs them |
//!
//! The first two of them are plain data without clocks, threads or sockets, and hold all that "exactly once" rests on.
#![cfg_attr(
    not(test),
    deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing)
)]

mod discovery;
pub mod event;
pub mod key;
pub mod ledger;
pub mod limits;
pub mod master;
pub mod outbox;
mod page;
mod plain;
pub mod proto;
pub mod slave;
#[cfg(test)]
mod tests;
mod tls;
mod watched;

use indigo_film::FilmError;
use std::io::ErrorKind;

/// What may help where a port cannot be listened at.
fn way_out(why: &std::io::Error, port: u16) -> &'static str {
    match why.kind() {
        ErrorKind::AddrInUse => {
            "another master may be running, or choose another port (on a command line with -p)"
        }
        ErrorKind::PermissionDenied if port < 1024 => {
            "those below 1024 are the system's own as a rule: choose another port (on a command line with -p)"
        }
        _ => "choose another port (on a command line with -p)",
    }
}

/// Why there is no master or slave.
#[derive(Debug, thiserror::Error)]
pub enum NetError {
    /// The port cannot be listened at.
    #[error("cannot listen at port {port}: {source}; {}", way_out(.source, *.port))]
    Listen {
        /// The port.
        port: u16,
        /// What the system says.
        source: std::io::Error,
    },
    /// The status page cannot be shown.
    #[error(
        "the status page cannot be shown at {address}: {source}; choose another place with --status-port"
    )]
    Page {
        /// Where.
        address: std::net::SocketAddr,
        /// What the system says.
        source: std::io::Error,
    },
    /// The system gives no threads.
    #[error("cannot start the threads of the network: {0}")]
    Threads(std::io::Error),
    /// The cryptography fails.
    #[error("no encryption: {0}")]
    Encryption(#[from] rustls::Error),
    /// The key is none, or there is no randomness.
    #[error(transparent)]
    Key(#[from] key::KeyError),
    /// The film cannot be added to.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// A master without encryption is asked for over the network.
    #[error(
        "without a key a slave joins masters of its own machine only, and {0} is none: make a key with \
         indigo_console --make-key FILE, and give that file to master and slaves by --key-file"
    )]
    NotLocal(String),
}

#[cfg(test)]
mod words {
    use super::{ErrorKind, NetError};

    #[test]
    fn a_port_that_is_forbidden_is_not_another_masters() {
        let told = |kind: ErrorKind| NetError::Listen { port: 80, source: kind.into() }.to_string();
        assert!(told(ErrorKind::AddrInUse).contains("another master may be running"));
        let forbidden = told(ErrorKind::PermissionDenied);
        assert!(forbidden.contains("below 1024") && !forbidden.contains("another master"), "{forbidden}");
    }
}
