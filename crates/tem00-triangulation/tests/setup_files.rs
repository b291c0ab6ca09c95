//! The set-up files of the repository and those of `docs/setup_file.md` are what the reader reads.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use tem00_triangulation::{parse_setup, read_setup};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn documentation() -> String {
    let path = repository().join("docs/setup_file.md");
    fs::read_to_string(path).expect("the page is there")
}

/// Returns the snippets of the page that are TOML.
fn snippets(text: &str) -> Vec<&str> {
    let after = text.split("```toml\n").skip(1);
    after
        .filter_map(|rest| Some(rest.split_once("```")?.0))
        .collect()
}

#[test]
fn the_setups_of_the_repository_are_read() {
    let entries = fs::read_dir(repository().join("setups")).expect("the folder is there");
    let paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("the entry is read").path())
        .collect();
    assert!(paths.len() >= 3, "{paths:?}");
    for path in paths {
        let setup = read_setup(&path).map_err(|error| error.to_string());
        let setup = setup.expect("a set-up");
        // A saturated or dark set-up is no example.
        let peak = setup.saturation();
        assert!((0.05..0.7).contains(&peak), "{path:?}: {peak} of full");
    }
}

#[test]
fn the_snippets_of_the_documentation_are_read() {
    let text = documentation();
    let snippets = snippets(&text);
    assert!(snippets.len() >= 2, "{} snippets", snippets.len());
    // The first is complete; what the others leave out is taken from it.
    for snippet in &snippets {
        let whole = match *snippet == snippets[0] {
            true => (*snippet).to_owned(),
            false => format!("{}\n{snippet}", snippets[0]),
        };
        let read = parse_setup(&whole).map_err(|error| error.to_string());
        assert!(read.is_ok(), "{read:?}\n{whole}");
    }
}

#[test]
fn what_has_no_default_is_all_that_a_setup_needs() {
    let text = documentation();
    let minimal = snippets(&text)[0];
    let lines: Vec<&str> = minimal.lines().collect();
    for (number, line) in lines.iter().enumerate() {
        let Some((key, _)) = line.split_once(" = ") else {
            continue;
        };
        let mut rest = lines.clone();
        rest.remove(number);
        let error = parse_setup(&rest.join("\n")).expect_err("a key is missing");
        assert!(error.to_string().contains(key), "{key}: {error}");
        let row = format!("| `{key}` |");
        let row = text.lines().find(|line| line.starts_with(&row));
        assert!(
            row.is_some_and(|row| row.ends_with("| required |")),
            "{key} is required: {row:?}"
        );
    }
}
