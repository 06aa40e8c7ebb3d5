//! `cargo xtask doc`: the API documentation.

use crate::Outcome;
use crate::process;

/// Builds the documentation of all our crates; a broken link is an error. `--open` shows it.
pub fn run(arguments: &[String]) -> Outcome {
    let mut cargo = process::cargo(&["doc", "--workspace", "--no-deps"]);
    match arguments {
        [] => {}
        [open] if open == "--open" => {
            cargo.arg("--open");
        }
        _ => return Err("usage: cargo xtask doc [--open]".into()),
    }
    process::run(cargo.env("RUSTDOCFLAGS", "-D warnings"))
}
