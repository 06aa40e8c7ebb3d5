//! Options of network rendering.

use super::Role;
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
