//! The commands of `docs/tutorial.md` do what they say, on smaller set-ups and scenes.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{folder, message, tem00};

/// What is made smaller, so that the commands take seconds: file, what it has, what it gets.
const SMALLER: [(&str, &str, &str); 5] = [
    ("setups/design.toml", "steps = 7", "steps = 2"),
    ("setups/design.toml", "steps = 6", "steps = 2"),
    (
        "setups/design.toml",
        "line_width = [\"0.08 mm\", \"0.1 mm\", ",
        "line_width = [",
    ),
    (
        "scenes/triangulation/step_gauge.toml",
        "samples_per_pixel = 16",
        "samples_per_pixel = 2",
    ),
    (
        "scenes/triangulation/step_gauge.toml",
        "frames = 8",
        "frames = 2",
    ),
];

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
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

fn make_smaller(folder: &Path) {
    for (file, from, to) in SMALLER {
        let path = folder.join(file);
        let text = fs::read_to_string(&path).expect("the file is read");
        assert!(text.contains(from), "{file} has no `{from}`");
        fs::write(&path, text.replace(from, to)).expect("the file is written");
    }
}

/// Returns the words of a command, of which some may be in quotation marks.
fn words(command: &str) -> Vec<String> {
    let parts = command.split('"').enumerate();
    let words = parts.flat_map(|(number, part)| match number % 2 {
        0 => part.split_whitespace().map(str::to_owned).collect(),
        _ => vec![part.to_owned()],
    });
    words.collect()
}

/// Returns the commands of the page that run the program, without its name.
fn commands(page: &str) -> Vec<String> {
    let blocks = page.split("```sh\n").skip(1);
    let blocks = blocks.filter_map(|rest| Some(rest.split_once("```")?.0));
    let lines = blocks.flat_map(str::lines);
    let commands = lines.filter_map(|line| line.strip_prefix("tem00 "));
    let without_comment = |line: &str| line.split(" #").next().unwrap_or(line).to_owned();
    commands.map(without_comment).collect()
}

#[test]
fn the_commands_of_the_tutorial_work() {
    let folder = folder();
    for name in ["setups", "scenes/triangulation", "scenes/meshes"] {
        copy(name, folder.path());
    }
    make_smaller(folder.path());
    let page =
        fs::read_to_string(repository().join("docs/tutorial.md")).expect("the page is there");
    let commands = commands(&page);
    for name in ["budget", "design", "triangulate", "lines"] {
        let named = commands.iter().any(|command| command.starts_with(name));
        assert!(named, "the tutorial has no `tem00 {name}`");
    }
    for command in commands {
        let mut program = tem00(folder.path(), "");
        program.args(words(&command));
        if command.starts_with("budget") {
            program.args(["--trials", "100"]);
        }
        let output = program.output().expect("the program starts");
        if command.contains("calibration_boards") {
            // An example takes the photographs. Without them, the folder is all that is amiss.
            let why = message(&output);
            assert_eq!(output.status.code(), Some(2), "tem00 {command}: {why}");
            assert!(why.contains("calibration_boards"), "tem00 {command}: {why}");
            continue;
        }
        assert!(
            output.status.success(),
            "tem00 {command}: {}",
            message(&output)
        );
    }
}
