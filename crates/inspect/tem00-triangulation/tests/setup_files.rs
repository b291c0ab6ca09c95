//! The set-up files of the repository and those of `docs/setup_file.md` are what the reader reads,
//! and the page has the keys of the reader.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use tem00_triangulation::{
    Budget, LightLevel, LineImage, LineMethod, SetupQuantity, parse_setup, parse_setup_with,
    read_design, read_setup,
};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
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
    let entries = fs::read_dir(repository().join("examples/setups")).expect("the folder is there");
    let paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("the entry is read").path())
        .filter(|path| path.is_file())
        .collect();
    assert!(paths.len() >= 4, "{paths:?}");
    for path in paths {
        let setup = read_setup(&path).map_err(|error| error.to_string());
        let setup = setup.expect("a set-up");
        // A saturated or dark set-up is no example.
        assert_eq!(setup.light_level(), LightLevel::Good, "{path:?}");
    }
}

#[test]
fn the_decision_about_a_broader_source_has_the_uncertainty_of_its_setup() {
    let read = |name: &str| fs::read_to_string(repository().join(name)).expect(name);
    let expanded = |text: &str| {
        let setup = parse_setup(text).map_err(|error| error.to_string());
        1e6 * Budget::new(&setup.expect("a set-up"))
            .expect("a budget")
            .expanded()
    };
    let broad = read("examples/setups/superluminescent.toml");
    let stated = format!("U = {:.1} µm", expanded(&broad));
    assert!(read("docs/broader_source.md").contains(&stated), "{stated}");
    let single = expanded(&broad.replace("linewidth", "# linewidth"));
    assert!(expanded(&broad) < 0.6 * single, "of {single} µm");
}

#[test]
fn a_relief_of_any_height_has_images() {
    let path = repository().join("examples/setups/superluminescent.toml");
    let text = fs::read_to_string(path).expect("the set-up");
    for (height, patterns) in [("0.1 mm", 2), ("0.5 mm", 1), ("0.5 mm", 2), ("0.5 mm", 64)] {
        let height = format!("\"{height}\"\npatterns = {patterns}");
        let text = text.replace("\"0.4 um\"", &height);
        let setup = parse_setup(&text).map_err(|error| error.to_string());
        let image = LineImage::of_setup(&setup.expect("a set-up"), [64, 64]);
        assert!(image.is_ok(), "{height}: {image:?}");
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

/// Returns the keys that the reader says are allowed where the `line` of a `section` has another.
fn keys(page: &str, section: &str, line: &str) -> BTreeSet<String> {
    let setup = snippets(page)[0];
    let header = format!("[{section}]\n");
    let with_line = format!("{header}{}\n", line.replace('?', "unheard_of = 0"));
    let text = match setup.contains(&header) {
        true => setup.replace(&header, &with_line),
        false => format!("{setup}{with_line}"),
    };
    let error = parse_setup_with(&text, |document, setup| {
        read_design(document, setup.description()).map(|_| ())
    });
    let error = error.expect_err("a key is unknown");
    assert!(error.message().contains("`unheard_of`"), "{error}");
    let help = error
        .help()
        .and_then(|help| help.strip_prefix("allowed here: "));
    let keys = help.expect("the keys are told").split(", ");
    keys.map(str::to_owned).collect()
}

/// Returns the text under a heading, up to the next one.
fn under<'a>(page: &'a str, heading: &str) -> &'a str {
    let after = page.split_once(&format!("# `[{heading}]`\n"));
    let (_, after) = after.expect("the heading is there");
    after.split("\n#").next().unwrap_or(after)
}

/// Returns what stands between backticks.
fn in_backticks(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Returns the keys that the first cells of a section's tables name; quoted ones are values.
fn documented(page: &str, heading: &str) -> BTreeSet<String> {
    let rows = under(page, heading).lines();
    let cells = rows.filter_map(|line| line.strip_prefix("| ")?.split(" |").next());
    let named = cells.flat_map(in_backticks);
    let keys = named.filter(|key| {
        key.bytes()
            .all(|byte| byte == b'_' || byte.is_ascii_lowercase())
    });
    keys.map(str::to_owned).collect()
}

/// Set `TEM00_WRITE_PAGES` to write the rows into the page.
#[test]
fn the_page_has_the_rows_of_the_quantities() {
    let mut page = documentation();
    for quantity in SetupQuantity::ALL {
        let [section, key] = quantity.path();
        let rows = under(&page, section).to_owned();
        let found = rows
            .lines()
            .find(|line| line.starts_with(&format!("| `{key}` |")));
        let found = found.unwrap_or_else(|| panic!("{quantity} has no row"));
        page = page.replace(&rows, &rows.replace(found, &quantity.documentation()));
    }
    if env::var_os("TEM00_WRITE_PAGES").is_some() {
        fs::write(repository().join("docs/setup_file.md"), &page).expect("the page is written");
    }
    assert_eq!(
        documentation(),
        page,
        "the page is made anew with TEM00_WRITE_PAGES"
    );
}

#[test]
fn the_page_has_exactly_the_keys_of_the_reader() {
    let page = documentation();
    for section in [
        "laser",
        "camera",
        "sensor",
        "surface",
        "calibration",
        "environment",
        "average",
        "budget",
        "design",
    ] {
        let keys = keys(&page, section, "?");
        assert_eq!(documented(&page, section), keys, "[{section}]");
    }
    let range = keys(&page, "design", "vary = { f_number = { ? } }");
    assert_eq!(documented(&page, "design.vary"), range, "a range");
    let vary = "vary = { f_number = [4] }\nrequire = { ? }";
    let require = keys(&page, "design", vary);
    assert_eq!(documented(&page, "design.require"), require, "bounds");
}

#[test]
fn the_page_has_the_keys_of_the_detector_and_its_methods() {
    let page = documentation();
    let text = under(&page, "detector");
    let keys = keys(&page, "detector", "?");
    let others = &documented(&page, "detector") - &keys;
    assert!(others.is_empty(), "{others:?} are no keys");
    for key in keys {
        assert!(text.contains(&format!("| `{key}` |")), "{key}");
    }
    for method in LineMethod::ALL {
        assert!(text.contains(&format!("`\"{method}\"`")), "{method}");
    }
}

#[test]
fn the_page_has_what_a_search_can_vary() {
    let page = documentation();
    let text = under(&page, "design.vary");
    for key in keys(&page, "design", "vary = { ? }") {
        assert!(in_backticks(text).any(|name| name == key), "{key}");
    }
}
