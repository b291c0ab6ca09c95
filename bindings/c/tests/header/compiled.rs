//! The headers in the hands of a compiler with the flags of a careful user.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

use super::here;

/// The languages of the headers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Language {
    C99,
    Cpp17,
}

impl Language {
    /// The compiler of the system, asked to be strict.
    fn compiler(self) -> Command {
        let (variable, compiler, arguments) = match self {
            Self::C99 => ("CC", "cc", ["-std=c99", "-x", "c"]),
            Self::Cpp17 => ("CXX", "c++", ["-std=c++17", "-x", "c++"]),
        };
        let mut command = Command::new(env::var_os(variable).unwrap_or_else(|| compiler.into()));
        command
            .args(arguments)
            .args([
                "-Wall",
                "-Wextra",
                "-Wpedantic",
                "-Wconversion",
                "-Wshadow",
                "-Werror",
            ])
            .arg("-I")
            .arg(here("include"))
            .arg("-I")
            .arg(here("../../crates/light/tem00-beam/include"));
        command
    }
}

/// Compiles a program, in a place of its own for each name, and returns its path.
pub(crate) fn compile(language: Language, name: &str, source: &str, more: &[&str]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join(format!("{name}_{language:?}"));
    let code = path.with_extension("source");
    fs::write(&code, source).unwrap();
    let mut command = language.compiler();
    let output = command
        .args(more)
        .arg(&code)
        .arg("-o")
        .arg(&path)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {text}");
    path
}

#[test]
fn the_header_stands_alone_in_c_and_in_cpp() {
    for language in [Language::C99, Language::Cpp17] {
        let source = "#include \"tem00.h\"\n#include \"tem00.h\"\nint main(void) { return 0; }\n";
        compile(language, "alone", source, &[]);
    }
}

#[test]
fn the_header_and_the_closed_forms_go_together() {
    for language in [Language::C99, Language::Cpp17] {
        let source =
            "#include \"tem00_beam.h\"\n#include \"tem00.h\"\nint main(void) { return 0; }\n";
        compile(language, "together", source, &[]);
    }
}

#[test]
fn the_wrapper_stands_alone() {
    let source = "#include \"tem00.hpp\"\n#include \"tem00.hpp\"\nint main() {}\n";
    compile(Language::Cpp17, "wrapper", source, &["-c"]);
}
