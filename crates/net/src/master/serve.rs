//! The master's server: where it listens, and what it serves until the end.

use super::listen::accept;
use super::service::Service;
use super::{Shared, Status};
use crate::NetError;
use crate::event::Event;
use crate::limits::{CALLS, KEEP_ALIVE, MESSAGE, PIECE, SILENCE};
use crate::page::{self, View};
use crate::proto::farm_server::FarmServer;
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::net::TcpListener;
use tokio::runtime::Runtime;
use tokio::sync::oneshot;
use tokio_rustls::TlsAcceptor;
use tokio_stream::wrappers::ReceiverStream;
use tonic::transport::Server;

/// Listens at all addresses if connections have to prove a key, else at those that only this machine can reach.
pub(super) async fn listen(is_open: bool, port: u16) -> Result<TcpListener, NetError> {
    if is_open {
        // Both families where the system has both.
        if let Ok(listener) = TcpListener::bind((Ipv6Addr::UNSPECIFIED, port)).await
            && cfg!(unix)
        {
            return Ok(listener);
        }
    }
    let address = if is_open { Ipv4Addr::UNSPECIFIED } else { Ipv4Addr::LOCALHOST };
    TcpListener::bind((address, port)).await.map_err(|source| NetError::Listen { port, source })
}

/// Serves until the end.
pub(super) async fn serve(
    listener: TcpListener,
    tls: Option<TlsAcceptor>,
    shared: Arc<Shared>,
    ended: oneshot::Receiver<()>,
) {
    /// Uploads in flight for each connection: what a gigabit network takes in the time that an answer needs across a
    /// house, and no more than so many connections may hold together.
    const WINDOW: u32 = 1 << 20;
    let connections = accept(listener, tls, Arc::clone(&shared));
    let farm = FarmServer::new(Service::new(Arc::clone(&shared)))
        .max_decoding_message_size(MESSAGE)
        .max_encoding_message_size(MESSAGE);
    let served = Server::builder()
        .http2_keepalive_interval(Some(KEEP_ALIVE))
        .http2_keepalive_timeout(Some(SILENCE))
        .max_concurrent_streams(CALLS)
        .concurrency_limit_per_connection(CALLS as usize)
        .initial_stream_window_size(WINDOW)
        .initial_connection_window_size(2 * WINDOW)
        // A piece in one frame.
        .max_frame_size(Some(2 * PIECE as u32))
        .http2_max_header_list_size(16 << 10)
        .add_service(farm)
        .serve_with_incoming_shutdown(ReceiverStream::new(connections), async {
            drop(ended.await);
        })
        .await;
    if let Err(error) = served {
        shared.tell(Event::Trouble(format!("the network server has ended: {error}")));
    }
}

/// Begins to show how things stand; where.
pub(super) fn show(
    runtime: &Runtime,
    address: SocketAddr,
    picture: PathBuf,
    shared: &Arc<Shared>,
) -> Result<SocketAddr, NetError> {
    let failed = |source| NetError::Page { address, source };
    let listener = runtime.block_on(page::listen(address)).map_err(failed)?;
    let address = listener.local_addr().map_err(failed)?;
    let [asked, refusing, told] = [(); 3].map(|()| Arc::clone(shared));
    let view = View {
        status: Arc::new(move || Status::of(&asked)),
        picture,
        read: Arc::default(),
        refuse: Arc::new(move |peer, reason| refusing.refused(peer, reason)),
    };
    runtime.spawn(async move {
        if let Err(error) = page::serve(listener, view).await {
            told.tell(Event::Trouble(format!("the status page has ended: {error}")));
        }
    });
    Ok(address)
}

/// Looks now and then who has been silent for too long.
pub(super) async fn watch(shared: Arc<Shared>) {
    let mut ticks = tokio::time::interval(Duration::from_secs(1));
    loop {
        ticks.tick().await;
        let lost = shared.roster().expire(Instant::now());
        for slave in lost {
            shared.tell(Event::Lost { slave: slave.name, peer: slave.peer });
        }
    }
}
