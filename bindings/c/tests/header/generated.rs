//! The committed header against the one that cbindgen makes of the sources.

use std::{env, fs};

use super::here;

/// Set to anything, it writes the header instead of comparing it.
const WRITE: &str = "TEM00_WRITE_HEADER";

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

/// The names that a line at the outermost level declares.
fn declared(line: &str) -> Option<&str> {
    if let Some(name) = line.strip_prefix("} ") {
        return Some(name).filter(|name| !name.contains("extern"));
    }
    let before = line.split(['(', ';']).next()?;
    let is_code = line.starts_with(|c: char| c.is_ascii_alphabetic()) && line.contains(['(', ';']);
    before.rsplit([' ', '*']).next().filter(|_| is_code)
}

#[test]
fn every_name_begins_with_that_of_the_library() {
    let header = fs::read_to_string(here("include/tem00.h")).unwrap();
    let names: Vec<_> = header.lines().filter_map(declared).collect();
    let foreign = |name: &&&str| !name.starts_with("tem00_");
    let foreign: Vec<_> = names.iter().filter(foreign).collect();
    assert!(names.len() > 80, "all of them are found: {}", names.len());
    assert!(foreign.is_empty(), "names without the prefix: {foreign:?}");
}
