//! The committed header against the one that cbindgen makes of the sources.

use std::{
    env, fs,
    path::{Path, PathBuf},
};

/// Set to anything, it writes the header instead of comparing it.
const WRITE: &str = "TEM00_WRITE_HEADER";

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn generated() -> String {
    let config = cbindgen::Config::from_file(here("cbindgen.toml")).unwrap();
    let source = here("src/lib.rs");
    let builder = cbindgen::Builder::new()
        .with_config(config)
        .with_src(source);
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    // What is a heading in the documentation of Rust is one paragraph among others here.
    String::from_utf8(text)
        .unwrap()
        .replace(" * # Safety\n *\n", "")
}

#[test]
fn the_committed_header_is_that_of_the_sources() {
    let path = here("include/tem00.h");
    let generated = generated();
    if env::var_os(WRITE).is_some() {
        fs::write(&path, &generated).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    let differs = committed
        .lines()
        .zip(generated.lines())
        .position(|(a, b)| a != b);
    assert!(
        committed == generated,
        "the header differs from line {:?}: run the test once with {WRITE}=1",
        differs.map(|line| line + 1)
    );
}
