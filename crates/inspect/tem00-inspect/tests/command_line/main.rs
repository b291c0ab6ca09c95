//! The program as its users meet it: exit codes, what goes where, and which files appear.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

mod budget;
mod calibrate;
mod changes;
mod characterise;
mod design;
mod folders;
#[path = "../../../../render/tem00-cli/tests/command_line/helpers.rs"]
mod helpers;
mod images;
mod lines;
mod manners;
mod reports;
mod sweep;
mod triangulate;
mod tutorial;

use self::helpers::{assert_code, files, folder, message, run, tem00, text};

const PROGRAM: &str = env!("CARGO_BIN_EXE_tem00-inspect");
