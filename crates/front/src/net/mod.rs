//! Rendering on many machines, for whatever shows it.

mod key;
pub mod master;
mod own;
mod scene;
pub mod slave;

pub use key::make_key;

use crate::messages::Messages;
use crate::status::FAILED;
use indigo_net::NetError;
use indigo_net::event::{Event, Sink};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// How long whoever waits for others looks at nothing else.
const PULSE: Duration = Duration::from_millis(50);

/// What people call this machine.
fn machine() -> String {
    let from_system = std::fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let named = ["HOSTNAME", "COMPUTERNAME"].into_iter().find_map(|name| std::env::var(name).ok());
    from_system
        .or(named)
        .map(|name| name.trim().to_owned())
        .filter(|name| !name.is_empty())
        .unwrap_or_default()
}

/// Where events go from the threads of the network, and where they come from here.
fn events() -> (Sink, Receiver<Event>) {
    let (give, take) = channel();
    // At the end nobody listens any more.
    (Arc::new(move |event| drop(give.send(event))), take)
}

/// Says why there is no master or slave; the exit status.
fn fail(error: &NetError, messages: &mut dyn Messages) -> u8 {
    messages.error(&error.to_string());
    FAILED
}
