//! Connections of those who look: a few at a time, which end when nothing comes or goes for a while.
//!
//! The page needs no key, so whoever reaches it must not be able to take what slaves and files need.

use crate::limits::{PAGE_SILENCE, VISITORS};
use crate::watched::Watched;
use axum::serve::Listener;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::time::sleep;

/// How long to wait where the system gives no connection, for want of file handles, say.
const PAUSE: Duration = Duration::from_millis(100);

/// Listens; who comes when there are [`VISITORS`] waits for a place.
pub struct Door {
    listener: TcpListener,
    places: Arc<Semaphore>,
}

impl Door {
    /// With all places free.
    pub fn new(listener: TcpListener) -> Self {
        Self { listener, places: Arc::new(Semaphore::new(VISITORS)) }
    }
}

impl Listener for Door {
    type Io = Watched<TcpStream>;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Watched<TcpStream>, SocketAddr) {
        loop {
            if let Ok(place) = Arc::clone(&self.places).acquire_owned().await
                && let Ok((tcp, peer)) = self.listener.accept().await
            {
                return (Watched::both_ways(tcp, PAGE_SILENCE, place), peer);
            }
            sleep(PAUSE).await;
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}
