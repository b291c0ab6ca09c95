//! Ctrl-C and the termination signals: the first asks for a clean end within less than a second;
//! the second ends the process at once.

use std::{
    io::{self, Write},
    sync::atomic::{AtomicBool, Ordering},
    thread,
    time::Duration,
};

use crate::{atomic, failure::Failure};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// The time for a clean end. Work that cannot be interrupted, such as drawing, compressing an image
/// or waiting for input, is cut off after this time.
const GRACE: Duration = Duration::from_millis(800);

/// Takes over Ctrl-C and the termination signals.
///
/// # Errors
///
/// Returns an error if the operating system refuses.
pub fn install() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        let waiting = !INTERRUPTED.swap(true, Ordering::Relaxed)
            && thread::Builder::new().spawn(end_after_grace).is_ok();
        if !waiting {
            end();
        }
    })
    .map_err(|error| Failure::running(format!("cannot listen for Ctrl-C: {error}")))
}

fn end_after_grace() {
    thread::sleep(GRACE);
    end();
}

/// Ends the process. Files that are being written disappear; finished files stay.
fn end() -> ! {
    atomic::discard_pending();
    let told = Failure::Interrupted.report().unwrap_or_default();
    // Without standard error there is nobody left to tell.
    let _ = write!(io::stderr(), "{told}");
    std::process::exit(i32::from(Failure::Interrupted.exit_code()));
}

/// Returns the flag that is set once the user asked the program to end.
pub fn flag() -> &'static AtomicBool {
    &INTERRUPTED
}

/// Returns an error if the user asked the program to end.
pub fn check() -> Result<(), Failure> {
    if INTERRUPTED.load(Ordering::Relaxed) {
        Err(Failure::Interrupted)
    } else {
        Ok(())
    }
}
