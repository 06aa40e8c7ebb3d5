//! Being told to end from outside, by Ctrl-C in a terminal or at the end of a session: what is rendered is saved then, as by the
//! window itself.

use indigo_front::status::INTERRUPTED;
use indigo_render::atomic::abandon;
use std::sync::atomic::{AtomicBool, Ordering};

/// From now on the first signal only calls `end`, and the second leaves at once, without unfinished files.
///
/// # Errors
/// Where signals cannot be caught: why.
pub fn catch(end: impl Fn() + Send + 'static) -> Result<(), String> {
    let is_second = AtomicBool::new(false);
    #[expect(clippy::disallowed_methods, reason = "whoever asks twice wants just that")]
    let leave = || std::process::exit(INTERRUPTED.into());
    let caught = ctrlc::set_handler(move || {
        if is_second.swap(true, Ordering::Relaxed) {
            abandon();
            leave();
        }
        end();
    });
    caught.map_err(|error| error.to_string())
}
