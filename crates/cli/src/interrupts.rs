//! Ctrl-C, and being told to end otherwise: a render ends in good order, and everything else is left at once, without
//! unfinished files.

use crate::console::Console;
use indigo_front::messages::Messages as _;
use indigo_front::status::INTERRUPTED;
use indigo_render::atomic::abandon;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// How often it was pressed since it ends things in good order.
static PRESSED: AtomicUsize = AtomicUsize::new(0);
/// Whether what is done now looks at [`is_interrupted`].
static IN_ORDER: AtomicBool = AtomicBool::new(false);

/// From now on nothing is left half written by it.
pub fn catch(console: &mut Console) {
    #[expect(clippy::disallowed_methods, reason = "whoever presses Ctrl-C asks for just that")]
    let leave = || std::process::exit(INTERRUPTED.into());
    let caught = ctrlc::set_handler(move || {
        if !IN_ORDER.load(Ordering::Relaxed) || PRESSED.fetch_add(1, Ordering::Relaxed) > 0 {
            abandon();
            leave();
        }
    });
    if let Err(error) = caught {
        console.warn(&format!("Ctrl-C will not save the picture: {error}"));
    }
}

/// From now on the first only makes [`is_interrupted`] true, and the second leaves at once.
pub fn end_in_order() {
    IN_ORDER.store(true, Ordering::Relaxed);
}

/// Whether it was pressed.
pub fn is_interrupted() -> bool {
    PRESSED.load(Ordering::Relaxed) > 0
}
