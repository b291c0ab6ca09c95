//! The commands of `docs/tutorial.md` and `docs/certificate.md` do what they say, some on smaller
//! set-ups and scenes.

use std::{fs, path::PathBuf};

use super::*;

/// Options that make commands smaller, so that they take seconds: the beginning of a command, and
/// what it gets. The middle of a line has the noise of all of it.
const SMALLER: &str = "
    budget => --trials 20
    design => --set design.vary.f_number.steps=2 --set design.vary.exposure.steps=2 \
              --set 'design.vary.line_thickness=[\"0.15 mm\", \"0.2 mm\", \"0.3 mm\"]'
    triangulate examples/scenes/triangulation/step_gauge => --spp 2 --set 'camera.resolution=[288, 144]' \
              --set 'camera.principal_point=[144, 112]'
    triangulate examples/scenes/triangulation/calibration => --spp 1 --set calibration.boards=4";

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// Copies the files of a folder of the repository.
fn copy(name: &str, to: &Path) {
    fs::create_dir_all(to.join(name)).expect("the folder is made");
    for entry in fs::read_dir(repository().join(name)).expect("the folder is there") {
        let path = entry.expect("the entry is read").path();
        if path.is_file() {
            let file = path.file_name().expect("a file has a name");
            fs::copy(&path, to.join(name).join(file)).expect("the file is copied");
        }
    }
}

/// Returns the blocks of the page in a language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let blocks = page.split(&*fence).skip(1);
    let blocks = blocks.filter_map(|rest| Some(rest.split_once("```")?.0));
    blocks.collect()
}

/// Returns the commands of the page that run the program, without its name.
fn commands(page: &str) -> Vec<String> {
    let lines = blocks(page, "sh").into_iter().flat_map(str::lines);
    let commands = lines.filter_map(|line| line.strip_prefix("tem00-inspect "));
    let without_comment = |line: &str| line.split(" #").next().unwrap_or(line).to_owned();
    commands.map(without_comment).collect()
}

fn page(name: &str) -> String {
    read(&repository().join("docs").join(name))
}

/// A folder with what the commands of the page read.
fn clone() -> tempfile::TempDir {
    let folder = folder();
    for name in [
        "examples/setups",
        "examples/scenes/triangulation",
        "examples/scenes/meshes",
    ] {
        copy(name, folder.path());
    }
    folder
}

#[test]
#[ignore = "takes 20 s: `cargo test --test command_line -- --ignored`"]
fn the_commands_of_the_tutorial_work() {
    let (folder, page) = (clone(), page("tutorial.md"));
    let commands = commands(&page);
    for name in ["budget", "design", "triangulate", "lines", "calibrate"] {
        let named = commands.iter().any(|command| command.starts_with(name));
        assert!(named, "the tutorial has no `tem00-inspect {name}`");
    }
    // Whoever has installed the program has no examples, and no compiler perhaps.
    let lines = blocks(&page, "sh").into_iter().flat_map(str::lines);
    let others: Vec<_> = lines
        .filter(|line| !line.starts_with("tem00-inspect "))
        .collect();
    assert_eq!(
        others,
        ["cargo install --path crates/inspect/tem00-inspect"]
    );
    for command in commands {
        let smaller = tem00_testkit::rows(SMALLER).find(|[begin, _]| command.starts_with(begin));
        let options = smaller.map_or_else(String::new, |[_, options]| options);
        said(folder.path(), &format!("{command} {options}"), 0);
    }
    // What the eight frames say of themselves does not hang on the samples of a pixel.
    let quoted = figures(&page, "triangulate", "expanded, 95 %");
    let found = json(&read(
        &folder.path().join("out/step_gauge/measurement.json"),
    ));
    let found = number(&found["uncertainty"]["expanded"]);
    assert!(
        (1e6 * found / quoted[0] - 1.0).abs() < 0.05,
        "{found}, {quoted:?}"
    );
}

/// Returns the block of results after the command that begins so.
fn quoted<'a>(page: &'a str, command: &str) -> Vec<&'a str> {
    let start = page.find(&format!("\ntem00-inspect {command}"));
    let blocks = blocks(&page[start.expect(command)..], "text");
    let lines = blocks[0].lines();
    lines.filter(|line| !line.is_empty()).collect()
}

/// Returns the numbers of the row of a name in the results of a command.
fn figures(page: &str, command: &str, name: &str) -> Vec<f64> {
    let rows = quoted(page, command);
    // Tables come after quantities whose names may begin alike.
    let row = rows.iter().rev().find_map(|row| row.strip_prefix(name));
    let numbers = row.expect(name).split_whitespace();
    numbers.filter_map(|word| word.parse().ok()).collect()
}

/// The names of the rows of a budget begin so.
const ROWS: &str = "speckle |shot|dark|quant|PRNU|DSNU|detector b|calib|combined";

/// Checks that each line of results is a line of what was printed, perhaps without some columns.
/// The last two columns of a budget are by trials, which take longer than a test should.
fn check_results(quoted: &[&str], printed: &str) {
    let by_trials = quoted.iter().any(|line| line.contains("± (µm)"));
    for line in quoted {
        let line = line.split(" By trials").next().unwrap_or(line);
        let mut wanted: Vec<&str> = line.trim_end_matches('…').split_whitespace().collect();
        if by_trials && line.starts_with("source") {
            wanted.truncate(wanted.len() - 5);
        } else if ROWS.split('|').any(|name| line.starts_with(name)) {
            wanted.truncate(wanted.len() - 2);
        }
        let holds = printed.lines().any(|found| {
            let mut found = found.split_whitespace();
            wanted.iter().all(|word| found.any(|other| other == *word))
        });
        assert!(holds, "`{line}` is not in\n{printed}");
    }
}

#[test]
#[ignore = "takes 20 s: `cargo test --test command_line -- --ignored`"]
fn the_results_in_the_tutorial_are_those_of_the_program() {
    let (folder, page) = (clone(), page("tutorial.md"));
    // The table of the decision has the same numbers, rounded.
    let row = page.lines().find(|line| line.starts_with("| U (95 %)"));
    let row = row.expect("the table");
    for (command, options) in [
        (
            "budget examples/setups/data_sheet.toml -o out/budget",
            "--trials 0",
        ),
        (
            "budget examples/setups/design.toml -o out/averaged",
            "--trials 0",
        ),
        ("design examples/setups/design.toml -o out/design", ""),
        ("budget out/design/best.toml -o out/best", "--trials 0"),
    ] {
        let found = said(folder.path(), &format!("{command} {options}"), 0).out;
        let results = quoted(&page, command);
        check_results(&results, &found);
        let results = results.join("\n");
        if let Some((_, rest)) = results.split_once("U = ") {
            let number = rest.split(' ').next().and_then(|word| word.parse().ok());
            let number: f64 = number.expect("an expanded uncertainty");
            assert_has(row, &[&format!("{number:.0} µm")]);
        }
    }
    // The figure is the diagram of the search.
    let numbers = |path: PathBuf| -> Vec<f64> {
        let svg = read(&path);
        let (_, svg) = svg.split_once("<rect").expect("a drawing");
        let words = svg.split(|c: char| !(c.is_ascii_digit() || c == '.'));
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let figure = numbers(repository().join("docs/figures/triangulation_trade_off.svg"));
    let found = numbers(folder.path().join("out/design/trade_off.svg"));
    assert_eq!(figure.len(), found.len(), "points and ticks");
    let alike = figure.iter().zip(&found).all(|(a, b)| (a - b).abs() < 0.02);
    assert!(alike, "docs/figures/make.sh makes the figure again");
}

#[test]
#[ignore = "takes 20 s: `cargo test --test command_line -- --ignored`"]
fn the_commands_of_the_page_on_certificates_print_its_results() {
    let (folder, page) = (clone(), page("certificate.md"));
    let parts: Vec<&str> = page.split("\ntem00-inspect ").skip(1).collect();
    assert_eq!(parts.len(), 3, "commands");
    for part in parts {
        let (command, results) = part.split_once('\n').expect("results");
        let lines = blocks(results, "text").into_iter().flat_map(str::lines);
        let lines: Vec<&str> = lines.filter(|line| !line.is_empty()).collect();
        assert!(lines.len() > 1, "{command} has no results");
        let printed = said(folder.path(), &format!("{command} --trials 0"), 0).out;
        check_results(&lines, &printed);
    }
    for (language, file) in [
        ("toml", "examples/setups/toleranced.toml"),
        ("xml", "out/scaled/certificate.xml"),
    ] {
        let text = read(&folder.path().join(file));
        for line in blocks(&page, language).into_iter().flat_map(str::lines) {
            assert!(text.contains(line), "{file} has no `{line}`");
        }
    }
}

#[test]
fn formulas_and_trials_agree_as_the_tutorial_says() {
    let page = page("tutorial.md");
    assert_has(&page, &["agree within 3 %"]);
    for command in [
        "budget examples/setups/data_sheet.toml",
        "budget out/design/best.toml",
    ] {
        for name in ["speckle ", "combined "] {
            // The last four numbers are contribution, part of u², by trials and ±.
            let numbers = figures(&page, command, name);
            let [formula, _, trials, error] = numbers[numbers.len() - 4..] else {
                panic!("{numbers:?}");
            };
            let tolerance = (0.03 * formula).max(3.0 * error);
            let difference = (trials - formula).abs();
            assert!(difference < tolerance, "{command}, {name}: {numbers:?}");
        }
    }
}

#[test]
fn the_search_begins_with_the_data_sheet() {
    let parts = |name: &str| {
        let text = read(&repository().join("examples/setups").join(name));
        text[text.find("[laser]").expect("a laser")..].to_owned()
    };
    let design = parts("design.toml");
    let rest = design.strip_prefix(parts("data_sheet.toml").trim_end());
    let rest = rest.expect("the same keys").trim_start();
    assert!(rest.starts_with("[average]"), "{rest}");
}

#[test]
fn the_rendered_figures_are_of_the_scenes_as_they_are() {
    let list = read(&repository().join("docs/figures/made_from.txt"));
    assert!(list.lines().count() >= 2, "{list}");
    for line in list.lines() {
        let (sum, name) = line.split_once("  ").expect("a checksum and a name");
        let bytes = fs::read(repository().join(name)).expect(name);
        let found = format!("{:x}", md5::compute(bytes));
        assert_eq!(
            found, sum,
            "{name}: docs/figures/make.sh makes the figures again"
        );
    }
}
