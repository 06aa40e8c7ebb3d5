//! `cargo xtask soak`: a network render of many machines through a long night of failures, of which every test run has a
//! short one.

use crate::Outcome;
use crate::process;

/// Runs it, and lets it say what happened.
pub fn run(arguments: &[String]) -> Outcome {
    if !arguments.is_empty() {
        return Err("usage: cargo xtask soak".into());
    }
    // From the whole workspace, so that no library is built once more with fewer features.
    let test = ["test", "--workspace", "--test", "network", "a_long_night"];
    process::run(process::cargo(&test).args(["--", "--ignored", "--nocapture"]))
}
