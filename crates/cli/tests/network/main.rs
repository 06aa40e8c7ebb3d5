//! Renders of many processes: a master and slaves, while processes are killed and networks break.

#[path = "../console/workbench.rs"]
#[allow(dead_code, reason = "every test program uses its own part")]
mod workbench;

mod accounts;
mod agreement;
mod ends;
mod farm;
#[cfg(target_os = "linux")]
mod namespace;
mod proxy;
mod soak;
mod stories;
