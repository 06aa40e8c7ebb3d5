//! Reaching a master.

use crate::key::Key;
use crate::limits::{HANDSHAKE, KEEP_ALIVE, MESSAGE, PORT, SILENCE};
use crate::proto::farm_client::FarmClient;
use crate::watched::Watched;
use crate::{NetError, tls};
use hyper_util::rt::TokioIo;
use rustls::ClientConfig;
use rustls::pki_types::ServerName;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpSocket, lookup_host};
use tokio::time::timeout;
use tokio_rustls::TlsConnector;
use tonic::transport::{Channel, Endpoint};

/// Bytes that may wait in the system to be sent: on a slow network reports would else stand behind minutes of an upload.
const SEND_BUFFER: u32 = 64 << 10;

/// How masters are reached.
#[derive(Clone)]
pub struct Connector {
    tls: Option<Arc<ClientConfig>>,
}

/// Host and port of what a user gives; the port may be left out.
pub fn host_and_port(given: &str) -> Option<(String, u16)> {
    let (host, port) = match given.rsplit_once(':') {
        // An address of IPv6 without a port is full of colons.
        Some((host, port)) if !host.contains(':') || host.ends_with(']') => (host, port.parse().ok()?),
        _ => (given, PORT),
    };
    let host = host.strip_prefix('[').and_then(|h| h.strip_suffix(']')).unwrap_or(host);
    let is_name = !host.is_empty() && host.chars().all(|c| c.is_alphanumeric() || "-._".contains(c));
    // Behind % stands the interface of an address that is of one network alone.
    let is_address = host.split('%').next().is_some_and(|host| host.parse::<IpAddr>().is_ok());
    ((is_name || is_address) && port > 0).then(|| (host.to_owned(), port))
}

/// Host and port as a user gives them.
pub fn written(host: &str, port: u16) -> String {
    if host.contains(':') { format!("[{host}]:{port}") } else { format!("{host}:{port}") }
}

impl Connector {
    /// With the shared key, if there is one.
    ///
    /// # Errors
    /// Where there is no encryption.
    pub fn new(key: Option<&Key>) -> Result<Self, NetError> {
        Ok(Self { tls: key.map(tls::client).transpose()? })
    }

    /// Connects to a master.
    ///
    /// # Errors
    /// Why it is not reached, in words.
    pub async fn connect(&self, host: &str, port: u16) -> Result<FarmClient<Channel>, String> {
        let endpoint = Endpoint::from_static("http://indigo")
            .http2_keep_alive_interval(KEEP_ALIVE)
            .keep_alive_timeout(SILENCE)
            .keep_alive_while_idle(true)
            .tcp_nodelay(true);
        let (host, tls) = (host.to_owned(), self.tls.clone());
        // What is behind a failure is told by the library in its own words only.
        let why = Arc::new(Mutex::new(None));
        let noted = Arc::clone(&why);
        let connector = tower::service_fn(move |_| {
            let (host, tls, noted) = (host.clone(), tls.clone(), Arc::clone(&noted));
            async move {
                open(&host, port, tls).await.map(TokioIo::new).inspect_err(|error| {
                    *noted.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
                })
            }
        });
        match endpoint.connect_with_connector(connector).await {
            Ok(channel) => Ok(FarmClient::new(channel)
                .max_decoding_message_size(MESSAGE)
                .max_encoding_message_size(MESSAGE)),
            Err(error) => {
                let why = why.lock().unwrap_or_else(PoisonError::into_inner).take();
                Err(why.unwrap_or_else(|| error.to_string()))
            }
        }
    }
}

trait Stream: AsyncRead + AsyncWrite + Send + Unpin {}
impl<T: AsyncRead + AsyncWrite + Send + Unpin> Stream for T {}

async fn open(host: &str, port: u16, tls: Option<Arc<ClientConfig>>) -> io::Result<Box<dyn Stream>> {
    let late = || io::Error::other(format!("nobody says what address {host} has"));
    let addresses = timeout(HANDSHAKE, lookup_host((host, port))).await.map_err(|_| late())??;
    let nowhere = io::Error::other(format!("{host} has no address"));
    open_one(addresses, tls.as_ref(), HANDSHAKE).await.unwrap_or(Err(nowhere))
}

/// The first of a host's addresses that answers within a time, which each of them has: an address that no network leads to
/// takes it all. Else why the last is not reached, if there is one.
async fn open_one(
    addresses: impl Iterator<Item = SocketAddr>,
    tls: Option<&Arc<ClientConfig>>,
    time: Duration,
) -> Option<io::Result<Box<dyn Stream>>> {
    let mut last = None;
    for address in addresses {
        let opened = if tls.is_none() && !is_local(address.ip()) {
            Err(io::Error::other(NetError::NotLocal(address.to_string())))
        } else {
            let opened = timeout(time, open_address(address, tls)).await;
            opened.unwrap_or_else(|_| Err(io::Error::other("it does not answer")))
        };
        let is_open = opened.is_ok();
        last = Some(opened);
        if is_open {
            break;
        }
    }
    last
}

/// Whether an address is this machine's own, which no other can listen to.
fn is_local(address: IpAddr) -> bool {
    address.to_canonical().is_loopback()
}

async fn open_address(address: SocketAddr, tls: Option<&Arc<ClientConfig>>) -> io::Result<Box<dyn Stream>> {
    let socket = if address.is_ipv4() { TcpSocket::new_v4()? } else { TcpSocket::new_v6()? };
    socket.set_send_buffer_size(SEND_BUFFER)?;
    let tcp = socket.connect(address).await?;
    tcp.set_nodelay(true)?;
    let tcp = Watched::new(tcp, SILENCE);
    let Some(config) = tls else { return Ok(Box::new(tcp)) };
    let name = ServerName::try_from(tls::SERVER_NAME).map_err(io::Error::other)?;
    let proved = TlsConnector::from(Arc::clone(config)).connect(name, tcp).await;
    let stream = proved.map_err(|error| {
        io::Error::other(tls::unproved(&error, "it has not proved that it has the same key"))
    })?;
    Ok(Box::new(stream))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hosts_come_with_a_port_or_without() {
        let of = |given: &str| host_and_port(given);
        assert_eq!(of("lust:7778"), Some(("lust".into(), 7778)));
        assert_eq!(of("lust"), Some(("lust".into(), PORT)));
        assert_eq!(of("::1"), Some(("::1".into(), PORT)));
        assert_eq!(of("[::1]:9"), Some(("::1".into(), 9)));
        assert_eq!(of("[fe80::2]"), Some(("fe80::2".into(), PORT)));
        assert_eq!(of("fe80::2%eth0"), Some(("fe80::2%eth0".into(), PORT)));
        assert_eq!(written("::1", 9), "[::1]:9");
        assert_eq!(written("lust", 9), "lust:9");
        for bad in [
            "",
            ":1",
            "lust:",
            "lust:x",
            "lust:0",
            "lust:70000",
            "[::1]:",
            "a:b:c",
            "[::1",
            "foo bar",
            "http://lust",
        ] {
            assert_eq!(of(bad), None, "{bad}");
        }
    }

    /// A host with two addresses, of which the first takes connections and never says a word.
    #[test]
    fn an_address_that_is_silent_leaves_time_for_the_next() {
        let [silent, alive] = [(); 2].map(|()| std::net::TcpListener::bind("127.0.0.1:0").expect("free"));
        let addresses = [&silent, &alive].map(|listener| listener.local_addr().expect("it is bound"));
        let key = Key::random().expect("randomness");
        let (ours, theirs) = (tls::client(&key).expect("ours"), tls::server(&key).expect("theirs"));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("threads");
        runtime.block_on(async {
            alive.set_nonblocking(true).expect("a socket of ours");
            let alive = tokio::net::TcpListener::from_std(alive).expect("a listener");
            let answering = tokio::spawn(async move {
                let (tcp, _) = alive.accept().await?;
                tokio_rustls::TlsAcceptor::from(theirs).accept(tcp).await
            });
            // Each its own, or nothing would be left for the second.
            let opened = open_one(addresses.into_iter(), Some(&ours), Duration::from_secs(3)).await;
            assert!(opened.is_some_and(|opened| opened.is_ok()));
            assert!(answering.await.expect("it runs").is_ok());
        });
        drop(silent);
    }

    #[test]
    fn only_loopback_is_local() {
        for (address, expected) in [
            ("127.0.0.1", true),
            ("127.1.2.3", true),
            ("::1", true),
            ("::ffff:127.0.0.1", true),
            ("10.0.0.1", false),
            ("0.0.0.0", false),
        ] {
            assert_eq!(is_local(address.parse().unwrap()), expected, "{address}");
        }
    }
}
