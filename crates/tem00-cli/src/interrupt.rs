//! Ctrl-C: the first asks for a clean end, the second ends at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::{atomic, failure::Failure};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Takes over Ctrl-C and the termination signals.
///
/// # Errors
///
/// Returns an error if the operating system refuses.
pub(crate) fn install() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            atomic::discard_pending();
            std::process::exit(i32::from(Failure::Interrupted.exit_code()));
        }
    })
    .map_err(|error| Failure::running(format!("cannot listen for Ctrl-C: {error}")))
}

/// Returns the flag that is set once the user asked the program to end.
pub(crate) fn flag() -> &'static AtomicBool {
    &INTERRUPTED
}

/// Returns an error if the user asked the program to end.
pub(crate) fn check() -> Result<(), Failure> {
    if INTERRUPTED.load(Ordering::Relaxed) {
        Err(Failure::Interrupted)
    } else {
        Ok(())
    }
}
