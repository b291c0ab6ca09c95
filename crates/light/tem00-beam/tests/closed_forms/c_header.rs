use std::env;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tem00_beam::Emitter;

use super::comparison::{Answer, Judge};
use super::layouts::layouts;
use super::samples::{Sample, lines, single_precision, spots};

/// The scalar type that the program works in.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Precision {
    Single,
    Double,
}

/// The compiler, with the flags of a careful user.
fn compiler() -> Command {
    let mut command = Command::new(env::var_os("CC").unwrap_or_else(|| "cc".into()));
    command
        .args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion"])
        .args(["-Wshadow", "-Werror", "-O1"])
        .arg("-I")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("include"));
    command
}

/// Runs a command to its end, and returns its output.
fn output(command: &mut Command, input: &str) -> String {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let mut stdin = child.stdin.take().unwrap();
    // The program reads while it writes, so it gets its input from another thread.
    let input = input.to_owned();
    let writer = std::thread::spawn(move || stdin.write_all(input.as_bytes()));
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", output.status);
    writer.join().unwrap().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// Compiles the program, in a place of its own for each test.
fn program(precision: Precision, test: &str) -> PathBuf {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/closed_forms/program.c");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{test}_{precision:?}"));
    let mut command = compiler();
    if precision == Precision::Single {
        command.arg("-DSINGLE");
    }
    output(command.arg(source).arg("-o").arg(&path).arg("-lm"), "");
    path
}

/// Returns the program's answers for a light at points.
fn answers(program: &Path, light: &str, fields: &[f32], points: &[[f64; 3]]) -> Vec<Answer> {
    let mut input = light.to_owned();
    let fields = fields.iter().copied().map(f64::from);
    for number in fields.chain(points.iter().flatten().copied()) {
        input.push_str(&format!(" {number:e}"));
    }
    let output = output(&mut Command::new(program), &input);
    let answer = |line: &str| {
        let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    output.lines().map(answer).collect()
}

#[test]
fn structs_have_the_layout_of_their_counterparts() {
    for (precision, scale) in [(Precision::Single, 1), (Precision::Double, 2)] {
        let program = program(precision, "layout");
        let output = output(&mut Command::new(program), "layout");
        let expected: String = layouts()
            .into_iter()
            .map(|(name, (fields, size))| {
                let line = |name: &str, bytes: usize| format!("{name} {}\n", scale * bytes);
                let fields = fields.iter().map(|(name, offset)| line(name, *offset));
                fields.collect::<String>() + &line(&name["Tem00".len()..], size)
            })
            .collect();
        assert_eq!(
            output, expected,
            "offsets in C, then in Rust: {precision:?}"
        );
    }
}

#[test]
fn only_the_include_guard_is_left_defined() {
    let mut command = compiler();
    command.args(["-dM", "-E", "-x", "c", "-"]);
    let macros = output(&mut command, "#include \"tem00_beam.h\"\n");
    let ours: Vec<_> = macros
        .lines()
        .filter(|line| line.contains("TEM00"))
        .collect();
    assert_eq!(ours, ["#define TEM00_BEAM_H "], "macros after the header");
}

fn agree<L: Emitter>(kind: &str, precision: Precision, samples: &[Sample<L>]) {
    let program = program(precision, kind);
    let epsilon = match precision {
        Precision::Single => f64::from(f32::EPSILON),
        Precision::Double => f64::EPSILON,
    };
    for sample in samples {
        let mut points = sample.points.clone();
        if precision == Precision::Single {
            points = points
                .into_iter()
                .map(|p| single_precision(p).map(f64::from))
                .collect();
        }
        let answers = answers(&program, kind, &sample.fields, &points);
        assert_eq!(answers.len(), points.len(), "one answer for each point");
        let mut judge = Judge::new(sample, epsilon);
        for (p, answer) in points.into_iter().zip(answers) {
            judge.compare(p, answer);
        }
        judge.finish();
    }
}

#[test]
fn spots_in_float_agree_with_the_light() {
    agree("spot", Precision::Single, &spots());
}

#[test]
fn spots_in_double_agree_with_the_light() {
    agree("spot", Precision::Double, &spots());
}

#[test]
fn lines_in_float_agree_with_the_light() {
    agree("line", Precision::Single, &lines());
}

#[test]
fn lines_in_double_agree_with_the_light() {
    agree("line", Precision::Double, &lines());
}
