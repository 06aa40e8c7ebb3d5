//! Accepting connections: a few at a time, each with its proofs and within a time.

use super::Shared;
use crate::limits::{CONNECTIONS, HANDSHAKE, SILENCE};
use crate::tls;
use crate::watched::Watched;
use std::collections::VecDeque;
use std::io;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::mpsc::{Receiver, Sender, channel};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};
use tokio::time::{sleep, timeout};
use tokio_rustls::TlsAcceptor;
use tonic::transport::server::Connected;

/// The most connections whose proofs are still to come: strangers fill these, not the places of slaves. When there is one
/// more the oldest makes room, since a slave's proof takes milliseconds: whoever says nothing keeps nobody out.
const STRANGERS: usize = 64;
/// How long to wait where the system gives no connection, for want of file handles, say.
const PAUSE: Duration = Duration::from_millis(100);

/// The address of whoever calls.
#[derive(Clone, Copy, Debug)]
pub struct Peer(pub SocketAddr);

trait Stream: AsyncRead + AsyncWrite + Send + Unpin {}
impl<T: AsyncRead + AsyncWrite + Send + Unpin> Stream for T {}

/// A connection whose other side has proved that it may be there.
pub struct Connection {
    stream: Box<dyn Stream>,
    peer: SocketAddr,
    shared: Arc<Shared>,
    _place: OwnedSemaphorePermit,
}

impl Drop for Connection {
    fn drop(&mut self) {
        self.shared.disconnected(self.peer);
    }
}

/// Accepts connections until nobody takes them any more.
pub fn accept(
    listener: TcpListener,
    tls: Option<TlsAcceptor>,
    shared: Arc<Shared>,
) -> Receiver<io::Result<Connection>> {
    // One, so that no more connections wait here than are counted.
    let (give, take) = channel(1);
    tokio::spawn(accept_all(listener, tls, shared, give));
    take
}

async fn accept_all(
    listener: TcpListener,
    tls: Option<TlsAcceptor>,
    shared: Arc<Shared>,
    give: Sender<io::Result<Connection>>,
) {
    let mut strangers: VecDeque<oneshot::Sender<()>> = VecDeque::new();
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    loop {
        let accepted = tokio::select! {
            accepted = listener.accept() => accepted,
            () = give.closed() => return,
        };
        let Ok((tcp, peer)) = accepted else {
            sleep(PAUSE).await;
            continue;
        };
        // An address of IPv4 as people know it, not as a listener of both families tells it.
        let peer = SocketAddr::new(peer.ip().to_canonical(), peer.port());
        strangers.retain(|stranger| !stranger.is_closed());
        if strangers.len() >= STRANGERS {
            // Dropping it tells.
            strangers.pop_front();
        }
        let (stranger, crowded_out) = oneshot::channel();
        strangers.push_back(stranger);
        let (tls, shared, give, places) =
            (tls.clone(), Arc::clone(&shared), give.clone(), Arc::clone(&places));
        tokio::spawn(async move {
            let introduced = tokio::select! {
                introduced = introduce(tcp, tls) => introduced,
                _ = crowded_out => Err(io::Error::other("others came while it proved nothing")),
            };
            let stream = match introduced {
                Ok(stream) => stream,
                Err(error) => return shared.refused(peer, &error.to_string()),
            };
            let Ok(place) = places.try_acquire_owned() else {
                return shared.refused(peer, &format!("there are {CONNECTIONS} connections already"));
            };
            // The server may have ended.
            drop(give.send(Ok(Connection { stream, peer, shared, _place: place })).await);
        });
    }
}

/// Exchanges proofs, if there is a key.
async fn introduce(tcp: TcpStream, tls: Option<TlsAcceptor>) -> io::Result<Box<dyn Stream>> {
    // Small answers are not to wait for others.
    tcp.set_nodelay(true)?;
    let tcp = Watched::new(tcp, SILENCE);
    let Some(tls) = tls else { return Ok(Box::new(tcp)) };
    match timeout(HANDSHAKE, tls.accept(tcp)).await {
        Ok(Ok(stream)) => Ok(Box::new(stream)),
        Ok(Err(error)) => {
            Err(io::Error::other(tls::unproved(&error, "it has not proved that it has the key")))
        }
        Err(_) => Err(io::Error::other("it has not proved in time that it has the key")),
    }
}

impl Connected for Connection {
    type ConnectInfo = Peer;

    fn connect_info(&self) -> Peer {
        Peer(self.peer)
    }
}

impl AsyncRead for Connection {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(cx, buf)
    }
}

impl AsyncWrite for Connection {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, buf: &[u8]) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(cx, buf)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bufs: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write_vectored(cx, bufs)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
