//! Finding masters in the local network, by DNS-SD over multicast DNS (RFC 6763, RFC 6762).
//!
//! Anybody there can say that a master is anywhere. So what is found is only where to ask: a slave with a key stays with none
//! that does not prove it, and one without joins masters of its own machine alone.

use mdns_sd::{IfKind, ServiceDaemon, ServiceEvent, ServiceInfo};
use std::collections::HashMap;
use std::net::{IpAddr, Ipv4Addr};
use std::time::Duration;
use tokio::time::{Instant, timeout_at};

/// What masters are called there.
const SERVICE: &str = "_indigo._tcp.local.";
/// How long answers are waited for: multicast answers come within a second or so (RFC 6762, section 6), and may be lost
/// once.
const PATIENCE: Duration = Duration::from_secs(3);
/// How long others are waited for when one has answered.
const OTHERS: Duration = Duration::from_millis(300);
/// The most masters, and addresses of each, that are tried.
const MOST: usize = 16;

/// Nothing that a slave believes could be said here.
const NO_PROPERTIES: Option<HashMap<String, String>> = None;

/// Tells the network of a master as long as it is there.
pub struct Announcement(ServiceDaemon);

impl Announcement {
    /// Of a master at that port: in the whole network, or on this machine alone.
    ///
    /// # Errors
    /// Why it cannot be told.
    pub fn start(port: u16, is_open: bool) -> mdns_sd::Result<Self> {
        let daemon = ServiceDaemon::new()?;
        // Two masters on a machine differ in their ports.
        let instance = format!("{}-{port}", std::process::id());
        let host = format!("indigo-{instance}.local.");
        let info = |address: &str| ServiceInfo::new(SERVICE, &instance, &host, address, port, NO_PROPERTIES);
        let info = if is_open {
            info("")?.enable_addr_auto()
        } else {
            daemon.disable_interface(IfKind::All)?;
            daemon.enable_interface(IfKind::LoopbackV4)?;
            info(&Ipv4Addr::LOCALHOST.to_string())?
        };
        daemon.register(info)?;
        Ok(Self(daemon))
    }
}

impl Drop for Announcement {
    fn drop(&mut self) {
        // Whoever does not hear of it finds out.
        drop(self.0.shutdown());
    }
}

/// Where masters say that they are: host and port, those first that are likeliest to be reached.
///
/// # Errors
/// Why nobody can be asked.
pub async fn masters() -> mdns_sd::Result<Vec<(IpAddr, u16)>> {
    let daemon = ServiceDaemon::new()?;
    let answers = daemon.browse(SERVICE)?;
    let mut end = Instant::now() + PATIENCE;
    let mut found = vec![];
    while let Ok(Ok(event)) = timeout_at(end, answers.recv_async()).await {
        let ServiceEvent::ServiceResolved(service) = event else { continue };
        let addresses = service.addresses.iter().map(|address| (address.to_ip_addr(), service.port));
        found.extend(addresses.take(MOST));
        if found.len() >= MOST * MOST {
            break;
        }
        end = end.min(Instant::now() + OTHERS);
    }
    drop(daemon.shutdown());
    found.sort_by_key(|(address, port)| (rank(*address), *address, *port));
    found.dedup();
    Ok(found)
}

/// The lower, the likelier it is reached: an address of the other family, or one that needs an interface to go with it, may
/// not be.
fn rank(address: IpAddr) -> u8 {
    match address {
        IpAddr::V4(v4) if v4.is_link_local() => 2,
        IpAddr::V4(_) => 0,
        IpAddr::V6(v6) if v6.is_unicast_link_local() => 3,
        IpAddr::V6(_) => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;
    use std::net::UdpSocket;

    /// Whether the loopback interface passes multicast on, found out without DNS-SD.
    fn passes_multicast() -> std::io::Result<bool> {
        const GROUP: Ipv4Addr = Ipv4Addr::new(239, 255, 77, 77);
        let hears = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0))?;
        hears.join_multicast_v4(&GROUP, &Ipv4Addr::LOCALHOST)?;
        hears.set_read_timeout(Some(Duration::from_secs(1)))?;
        // By its address the system knows through which interface to send.
        let says = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
        says.send_to(b"?", (GROUP, hears.local_addr()?.port()))?;
        Ok(hears.recv_from(&mut [0; 1]).is_ok_and(|(_, from)| Some(from) == says.local_addr().ok()))
    }

    /// Over the loopback interface, where machines allow multicast there.
    #[test]
    fn a_master_of_this_machine_is_found() {
        if !matches!(passes_multicast(), Ok(true)) {
            // Past what catches the output of tests that pass.
            let said =
                b"SKIPPED: whether masters are found, as the loopback interface passes no multicast on\n";
            return drop(std::io::stderr().write_all(said));
        }
        let port = 40_000 + (std::process::id() % 20_000) as u16;
        let announcement = Announcement::start(port, false).expect("multicast works");
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("threads");
        let expected = (IpAddr::from(Ipv4Addr::LOCALHOST), port);
        // Looking ends soon after the first has answered, who may be another; and datagrams may be lost.
        let found = (0..5).any(|_| runtime.block_on(masters()).expect("multicast works").contains(&expected));
        drop(announcement);
        assert!(found, "nobody tells of {expected:?}");
    }

    #[test]
    fn addresses_that_need_no_interface_come_first() {
        let mut found: Vec<IpAddr> = ["fe80::1", "2001:db8::1", "169.254.1.1", "10.0.0.1"]
            .map(|a| a.parse().expect("an address"))
            .to_vec();
        found.sort_by_key(|address| rank(*address));
        let words: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert_eq!(words, ["10.0.0.1", "2001:db8::1", "169.254.1.1", "fe80::1"]);
    }
}
