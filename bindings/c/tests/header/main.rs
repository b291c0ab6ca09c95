//! The headers against the library that they describe.
#![expect(
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

mod compiled;
mod generated;
mod layouts;

use std::path::{Path, PathBuf};

/// A path inside the package.
fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}
