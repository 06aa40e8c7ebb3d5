//! Options of network rendering.

use super::{Arguments, Role};
use indigo_net::slave::host_and_port;
use std::net::{Ipv4Addr, SocketAddr};

/// What `-n` says.
pub fn role(value: &str) -> Result<Role, String> {
    match value {
        "s" => Ok(Role::Slave),
        "m" => Ok(Role::Master),
        "wm" => Ok(Role::WorkingMaster),
        other => Err(format!("-n needs s (slave), m (master) or wm (working master), not {other}")),
    }
}

/// What `-h` says.
pub fn host(value: &str) -> Result<(String, u16), String> {
    host_and_port(value).ok_or_else(|| {
        format!("-h needs the master's machine, such as -h lust or -h lust:7777, not {value}; help is --help")
    })
}

/// What `-p` says. Port 0 is any that is free, which the master then tells.
pub fn port(value: &str) -> Result<u16, String> {
    value.parse().map_err(|_| format!("-p needs the number of a port, such as 7777, not {value}"))
}

/// What `--status-port` says: a port of this machine alone, or an address with a port.
pub fn status(value: &str) -> Result<SocketAddr, String> {
    let local = value.parse().map(|port: u16| SocketAddr::from((Ipv4Addr::LOCALHOST, port)));
    local.ok().or_else(|| value.parse().ok()).ok_or_else(|| {
        format!("-status-port needs a port, such as 8080, or an address and a port, such as 0.0.0.0:8080, not {value}")
    })
}

/// Whether every option has a part in what is done, and what must be given is there.
pub fn check(parsed: &Arguments) -> Result<(), String> {
    /// What a slave takes besides options that are always taken.
    const OF_SLAVES: &[&str] = &["n", "h", "key-file", "t", "seed", "halt", "quiet", "verbose", "log-json"];
    /// What is of masters or slaves alone.
    const OF_NETWORKS: &[&str] = &["h", "p", "key-file", "status-port"];
    /// What a master does not do.
    const NOT_OF_MASTERS: &[&str] =
        &["h", "halterror", "strategies", "replay", "check", "print-settings", "ptest", "pack", "unpack"];
    let given = |names: &[&str]| parsed.given.iter().find(|name| names.contains(name));
    match parsed.network {
        None => match given(OF_NETWORKS) {
            Some(name) => Err(format!("-{name} is for network rendering: -n s, -n m or -n wm")),
            None => Ok(()),
        },
        Some(Role::Slave) => {
            if let Some(file) = parsed.files.first() {
                return Err(format!("a slave gets its scene from the master, so {file} has no part in -n s"));
            }
            if parsed.port.is_some() {
                return Err(
                    "-p is a master's; for a slave the port stands behind the host: -h HOST:PORT".to_owned()
                );
            }
            match parsed.given.iter().find(|name| !OF_SLAVES.contains(name)) {
                Some(name) => Err(format!("-{name} has no part in -n s: it is the master's to say")),
                None => Ok(()),
            }
        }
        Some(role) => match given(NOT_OF_MASTERS) {
            Some(name) => Err(format!("-{name} has no part in the work of a network master")),
            None if role == Role::Master && given(&["seed"]).is_some() => {
                Err("-seed has no part in -n m, which renders nothing itself; give it to -n wm, or to slaves"
                    .to_owned())
            }
            None => Ok(()),
        },
    }
}
