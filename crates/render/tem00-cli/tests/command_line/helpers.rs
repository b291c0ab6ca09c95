//! What the tests of both programs share: a folder, a command, and what it says.

#![allow(dead_code, reason = "each program needs a part of it")]

use std::{
    fs,
    path::Path,
    process::{Child, Command, Output, Stdio},
    thread::sleep,
    time::Duration,
};

use png::{BitDepth, ColorType, Encoder};
use serde_json::Value;

pub(crate) fn tem00(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(super::PROGRAM);
    command
        .current_dir(folder)
        .args(line.split_whitespace())
        .stdin(Stdio::null());
    command
}

pub(crate) fn run(folder: &Path, line: &str) -> Output {
    tem00(folder, line).output().expect("the program starts")
}

pub(crate) fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

pub(crate) fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder can be read");
    let mut names: Vec<_> = entries
        .map(|entry| entry.expect("the entry can be read").file_name())
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Returns standard error as one line without the frame that long messages are wrapped in.
pub(crate) fn message(output: &Output) -> String {
    let words = text(&output.stderr);
    let words = words.split_whitespace().filter(|word| *word != "│");
    words.collect::<Vec<_>>().join(" ")
}

#[track_caller]
pub(crate) fn assert_code(output: &Output, code: i32) {
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
}

/// Runs a command that succeeds.
#[track_caller]
pub(crate) fn done(folder: &Path, line: &str) -> Output {
    let output = run(folder, line);
    assert_code(&output, 0);
    output
}

/// Runs a command that succeeds and prints nothing but JSON.
#[track_caller]
pub(crate) fn json(folder: &Path, line: &str) -> Value {
    serde_json::from_slice(&done(folder, line).stdout).expect("JSON and nothing else")
}

#[track_caller]
pub(crate) fn json_of(file: &Path) -> Value {
    serde_json::from_slice(&fs::read(file).expect("a file")).expect("JSON")
}

/// Runs a command that is refused, and returns what it says, with all of these words.
#[track_caller]
pub(crate) fn refused(folder: &Path, line: &str, words: &[&str]) -> String {
    let output = run(folder, line);
    assert_code(&output, 2);
    let said = message(&output);
    for word in words {
        assert!(said.contains(word), "{line}: {word:?} is not in {said}");
    }
    said
}

#[track_caller]
pub(crate) fn write(folder: &Path, name: &str, content: impl AsRef<[u8]>) {
    fs::write(folder.join(name), content).expect("written");
}

/// Starts a command, whose output is kept.
pub(crate) fn start(folder: &Path, line: &str) -> Child {
    let mut command = tem00(folder, line);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the program starts")
}

/// Waits until something has happened, for at most a minute.
#[track_caller]
pub(crate) fn wait_until(what: &str, mut happened: impl FnMut() -> bool) {
    let has_happened = (0..12_000).any(|_| {
        sleep(Duration::from_millis(5));
        happened()
    });
    assert!(has_happened, "{what}");
}

/// Sends an interrupt, as Ctrl-C does.
#[cfg(unix)]
pub(crate) fn interrupt(child: &Child) {
    let interrupt = format!("kill -INT {}", child.id());
    let sent = Command::new("sh").args(["-c", &interrupt]).status();
    assert!(sent.expect("a shell").success(), "the signal is sent");
}

/// Returns the words of a command, of which some may be in quotation marks.
pub(crate) fn words(command: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for c in command.chars() {
        match (c, quote) {
            ('\'' | '"', None) => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (_, Some(open)) if c == open => quote = None,
            (_, None) if c.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

/// Plays the transcript `tests/cmd/NAME.txt`: runs its commands one after the other beside the
/// files of `tests/cmd/files` and those that `prepare` makes, and compares what they say.
/// `SNAPSHOTS=overwrite cargo test` writes what they say now.
#[track_caller]
pub(crate) fn play(name: &str, prepare: impl FnOnce(&Path)) -> tempfile::TempDir {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cmd");
    let folder = folder();
    for file in files(&here.join("files")) {
        fs::copy(here.join("files").join(&file), folder.path().join(&file)).expect("copied");
    }
    prepare(folder.path());
    let path = here.join(name).with_extension("txt");
    let script = fs::read_to_string(&path).expect("the transcript");
    let mut found = String::new();
    for line in script.lines() {
        if let Some(command) = line.strip_prefix("$ ") {
            let mut program = tem00(folder.path(), "");
            let output = program.args(&words(command)[1..]).output();
            let output = output.expect("the program starts");
            let said = text(&output.stdout) + &text(&output.stderr);
            found.push_str(&format!("{line}\n{said}"));
            if let Some(code @ 1..) = output.status.code() {
                found.push_str(&format!("=> {code}\n"));
            }
            found.push('\n');
        } else if line.starts_with("# ") {
            found.push_str(&format!("{line}\n"));
        }
    }
    let expected = snapbox::Data::read_from(&path, Some(snapbox::data::DataFormat::Text));
    let assert = snapbox::Assert::new().action_env("SNAPSHOTS");
    assert.eq(found, expected);
    folder
}

/// Makes a pattern of a size, from a pupil of a diameter, and returns its intensities, whose mean
/// is 1.
pub(crate) fn pattern(folder: &Path, name: &str, [size, diameter]: [usize; 2]) -> Vec<f64> {
    let line = format!("pattern -o {name} --size {size} --diameter {diameter} --seed 5");
    done(folder, &line);
    let file = fs::read(folder.join(name)).expect("the pattern");
    let (values, _) = file[file.len() - 4 * size * size..].as_chunks::<4>();
    let values = values.iter().map(|bytes| f32::from_le_bytes(*bytes).into());
    values.collect()
}

/// Noise of a pixel, uniform from −1 to 1.
pub(crate) fn noise(x: usize, y: usize) -> f64 {
    let seed = (y * 64 + x) as u64 + 1;
    let mixed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rounded to 16 bits"
)]
pub(crate) fn rounded(value: f64) -> u16 {
    value.round().clamp(0.0, 65_535.0) as u16
}

/// Writes a PNG of grey or RGB values of 8 or 16 bits.
pub(crate) fn write_png<const C: usize>(
    path: &Path,
    [width, height]: [usize; 2],
    depth: BitDepth,
    pixel: impl Fn(usize, usize) -> [u16; C],
) {
    let size = [width, height].map(|side| u32::try_from(side).expect("a small image"));
    let file = fs::File::create(path).expect("the file");
    let mut encoder = Encoder::new(file, size[0], size[1]);
    encoder.set_color(if C == 1 {
        ColorType::Grayscale
    } else {
        ColorType::Rgb
    });
    encoder.set_depth(depth);
    let pixel = &pixel;
    let values = (0..height).flat_map(|y| (0..width).flat_map(move |x| pixel(x, y)));
    let bytes = |value: u16| value.to_be_bytes()[usize::from(depth == BitDepth::Eight)..].to_vec();
    let data: Vec<u8> = values.flat_map(bytes).collect();
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&data).expect("an image");
}
