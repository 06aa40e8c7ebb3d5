//! Connections of those who look: a few at a time, each of which is soon answered, or ends.
//!
//! The page needs no key, so whoever reaches it must be able neither to take what slaves and files need, nor to keep others
//! from it.

use crate::limits::{PAGE_SILENCE, VISITORS};
use crate::watched::Watched;
use axum::serve::Listener;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::oneshot;
use tokio::time::sleep;

/// How long to wait where the system gives no connection, for want of file handles, say.
const PAUSE: Duration = Duration::from_millis(100);

/// Tells that somebody was turned away, and why.
pub type Refuse = Arc<dyn Fn(SocketAddr, &str) + Send + Sync>;

/// Lets in whoever comes. Where there are [`VISITORS`] already one of them makes room: of the address that has most of them, so
/// that whoever takes them all keeps others out by none, the one that came first.
pub struct Door {
    listener: TcpListener,
    /// In the order in which they came.
    visitors: Vec<Visitor>,
    refuse: Refuse,
}

struct Visitor {
    peer: SocketAddr,
    /// Dropping it ends the connection.
    place: oneshot::Sender<()>,
}

impl Door {
    /// With nobody there.
    pub fn new(listener: TcpListener, refuse: Refuse) -> Self {
        Self { listener, visitors: vec![], refuse }
    }

    /// Gives a place to one who comes; it has that until it hears otherwise.
    fn let_in(&mut self, peer: SocketAddr) -> oneshot::Receiver<()> {
        self.visitors.retain(|visitor| !visitor.place.is_closed());
        if self.visitors.len() >= VISITORS {
            self.make_room();
        }
        let (place, told) = oneshot::channel();
        self.visitors.push(Visitor { peer, place });
        told
    }

    fn make_room(&mut self) {
        let of_address = |visitor: &Visitor| {
            let same = self.visitors.iter().filter(|other| other.peer.ip() == visitor.peer.ip());
            same.count()
        };
        // The last of those that are equal is the first that came.
        let crowd = self.visitors.iter().enumerate().rev().max_by_key(|(_, visitor)| of_address(visitor));
        if let Some(first) = crowd.map(|(i, _)| i) {
            let peer = self.visitors.remove(first).peer;
            let what =
                format!("it made room for others at the status page, which takes {VISITORS} connections");
            (self.refuse)(peer, &what);
        }
    }
}

impl Listener for Door {
    type Io = Watched<TcpStream>;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Watched<TcpStream>, SocketAddr) {
        loop {
            if let Ok((tcp, peer)) = self.listener.accept().await {
                let peer = SocketAddr::new(peer.ip().to_canonical(), peer.port());
                let place = self.let_in(peer);
                return (Watched::answered(tcp, PAGE_SILENCE, place), peer);
            }
            sleep(PAUSE).await;
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}
