//! Writes the meshes of `examples/scenes/`, in millimetres, into `examples/scenes/meshes/`.
//!
//! Run it from anywhere: `cargo run --example make_meshes`. The files are in the repository;
//! running it again changes nothing.

#![expect(clippy::print_stdout, reason = "the program says what it has written")]

mod flange;
mod nut;
mod ply;
mod profile;

use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

/// A block that stands on z = 0: its least and greatest x and y, and its height, in millimetres.
type Block = [f64; 5];

/// Gauge blocks wrung side by side to a staircase; the last step is 0.1 mm.
const GAUGE_BLOCKS: [Block; 4] = [
    [-18.0, -9.0, -10.0, 10.0, 1.0],
    [-9.0, 0.0, -10.0, 10.0, 2.0],
    [0.0, 9.0, -10.0, 10.0, 4.0],
    [9.0, 18.0, -10.0, 10.0, 4.1],
];

fn main() -> io::Result<()> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes/meshes");
    fs::create_dir_all(&directory)?;
    for (name, text) in [
        ("gauge_blocks.ply", gauge_blocks_ply()),
        ("corrugated_sheet.obj", corrugated_sheet_obj()),
        ("flange.obj", flange::flange_obj()),
        ("step_gauge.ply", profile::step_gauge_ply()),
        ("groove.ply", profile::groove_ply()),
        ("hexagon_nut.ply", nut::nut_ply()),
    ] {
        fs::write(directory.join(name), &text)?;
        println!("examples/scenes/meshes/{name}: {} bytes", text.len());
    }
    Ok(())
}

/// Returns the blocks as PLY: eight corners and six quadrilaterals each, seen from outside.
fn gauge_blocks_ply() -> String {
    let (vertices, faces) = (8 * GAUGE_BLOCKS.len(), 6 * GAUGE_BLOCKS.len());
    let mut ply = format!(
        "ply\nformat ascii 1.0\ncomment gauge blocks, in millimetres\n\
         element vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    for [x0, x1, y0, y1, height] in GAUGE_BLOCKS {
        for z in [0.0, height] {
            for (x, y) in [(x0, y0), (x1, y0), (x1, y1), (x0, y1)] {
                line(&mut ply, format_args!("{x} {y} {z}"));
            }
        }
    }
    for first in (0..GAUGE_BLOCKS.len()).map(|block| 8 * block) {
        let bottom_and_top = [[3, 2, 1, 0], [4, 5, 6, 7]];
        let sides = (0..4).map(|a| [a, (a + 1) % 4, (a + 1) % 4 + 4, a + 4]);
        for [a, b, c, d] in bottom_and_top.into_iter().chain(sides) {
            let [a, b, c, d] = [a, b, c, d].map(|corner| first + corner);
            line(&mut ply, format_args!("4 {a} {b} {c} {d}"));
        }
    }
    ply
}

/// Returns a sheet, 40 mm × 30 mm, with four waves of 3 mm height along x, as OBJ.
///
/// A wave is the polynomial 16 t²(1 − t)², so that every platform writes the same digits.
fn corrugated_sheet_obj() -> String {
    const WAVES: u32 = 4;
    const STEPS: u32 = 64;
    const WIDTH: f64 = 40.0;
    const HALF_DEPTH: f64 = 15.0;
    const HEIGHT: f64 = 3.0;
    let mut obj = String::from("# A corrugated sheet, in millimetres.\n");
    for step in 0..=WAVES * STEPS {
        let x = WIDTH * (f64::from(step) / f64::from(WAVES * STEPS) - 0.5);
        let t = f64::from(step % STEPS) / f64::from(STEPS);
        let z = HEIGHT * (4.0 * t * (1.0 - t)).powi(2);
        for y in [-HALF_DEPTH, HALF_DEPTH] {
            line(&mut obj, format_args!("v {x:.3} {y} {z:.4}"));
        }
    }
    for step in 0..WAVES * STEPS {
        let a = 2 * step + 1;
        line(
            &mut obj,
            format_args!("f {a} {} {} {}", a + 2, a + 3, a + 1),
        );
    }
    obj
}

fn line(text: &mut String, content: core::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{content}");
}
