//! The stubs of the Python package against those that the sources of the bindings declare.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

mod classes;
mod declared;
mod exceptions;
mod functions;
mod modules;
mod types;

use std::{env, fs, path::Path};

/// Set to anything, it writes the stubs instead of comparing them.
const WRITE: &str = "TEM00_WRITE_STUBS";

#[test]
fn the_committed_stubs_are_those_of_the_sources() {
    let bindings = Path::new(env!("CARGO_MANIFEST_DIR")).join("bindings/python");
    for (path, generated) in modules::stubs(&bindings.join("src")) {
        let path = bindings.join("python/tem00").join(path);
        if env::var_os(WRITE).is_some() {
            fs::write(&path, &generated).expect("a stub can be written");
        }
        let committed = fs::read_to_string(&path).unwrap_or_default();
        let differs = committed
            .lines()
            .zip(generated.lines())
            .position(|(a, b)| a != b);
        assert!(
            committed == generated,
            "{} differs from line {:?}: run the test once with {WRITE}=1",
            path.display(),
            differs.map(|line| line + 1)
        );
    }
}
