//! `tem00-inspect lines` on images as cameras write them.

use std::{fs, path::Path};

use png::BitDepth;
use serde_json::Value;

use super::{
    assert_code, folder,
    helpers::{noise, rounded, write_png},
    message, run,
};

const SIZE: usize = 64;

/// The light of a line of 8 pixels full width, with noise, 1 at its brightest.
fn line(x: usize, y: usize) -> f64 {
    let distance = y as f64 + 0.5 - 31.3 - 0.02 * x as f64;
    0.05 + (0.9 + 0.02 * noise(x, y)) * (-2.0 * (distance / 4.0).powi(2)).exp()
}

fn write_grey(path: &Path, value: impl Fn(usize, usize) -> u16) {
    write_png(path, [SIZE, SIZE], BitDepth::Sixteen, |x, y| [value(x, y)]);
}

/// Writes an image of a line, as a camera shows it.
pub(super) fn write_line(path: &Path) {
    write_grey(path, |x, y| rounded(4_000.0 * line(x, y)));
}

/// Returns the numbers of points and of valid ones in a table of `tem00-inspect lines`.
fn points(path: &Path) -> [usize; 2] {
    let table = fs::read_to_string(path).expect("the table");
    let valid = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(7) == Some("1"));
    [valid.clone().count(), valid.filter(|valid| *valid).count()]
}

#[test]
fn saturation_of_lines_is_one_judgement_whatever_the_bits_and_where_they_lie() {
    let folder = folder();
    let file = folder.path().join("a.png");
    // The largest value and the step of two values: 10, 12 and 14 bits, in the lower and the upper bits of a word, and
    // values clipped by what a camera computes.
    for (largest, step) in [
        (4_095, 1),
        (1_023, 1),
        (16_383, 1),
        (65_520, 16),
        (65_472, 64),
        (65_535, 1),
        (3_931, 1),
        (235, 1),
    ] {
        let full = f64::from(largest);
        for (exposure, is_clipped) in [(0.9, false), (1.5, true)] {
            write_grey(&file, |x, y| {
                let value =
                    f64::from(step) * (exposure * full * line(x, y) / f64::from(step)).round();
                rounded(value.min(full))
            });
            let case = format!("{largest} in steps of {step}, exposure {exposure}");
            for detector in ["centre_of_gravity", "blais_rioux"] {
                let output = run(
                    folder.path(),
                    &format!("lines a.png --detector {detector} -o f"),
                );
                let told = message(&output);
                let warning =
                    "100 % of the points are not valid, 100 % because pixels are saturated";
                assert_eq!(told.contains(warning), is_clipped, "{case}: {told}");
                assert_code(&output, if is_clipped { 3 } else { 0 });
                let valid = if is_clipped { 0 } else { SIZE };
                assert_eq!(
                    points(&folder.path().join("f/a.csv")),
                    [SIZE, valid],
                    "{case}"
                );
            }
        }
    }
    // Who knows the bits is believed.
    let output = run(folder.path(), "lines a.png --bits 16 -o f");
    assert_code(&output, 0);
}

#[test]
fn a_pixel_is_saturated_if_one_of_its_channels_is() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let colours = [[0, 1, 2], [2, 0, 1], [1, 2, 0]];
    for (depth, full) in [(BitDepth::Eight, 255.0), (BitDepth::Sixteen, 4_095.0)] {
        for places in colours {
            let pixel = |lights: [f64; 3]| {
                places.map(|place: usize| rounded((full * lights[place]).min(full)))
            };
            write_png(&path("a.png"), [SIZE, SIZE], depth, |x, y| {
                pixel([1.5, 0.3, 0.1].map(|part| part * line(x, y)))
            });
            let bright = ["R", "G", "B"][places.iter().position(|place| *place == 0).expect("one")];
            let dim = ["R", "G", "B"][places.iter().position(|place| *place == 1).expect("one")];
            for (channel, code) in [
                (String::new(), 3),
                (format!("--channel {bright}"), 3),
                (format!("--channel {dim}"), 0),
            ] {
                let output = run(folder.path(), &format!("lines a.png -o f {channel}"));
                assert_code(&output, code);
                let told = message(&output);
                let is_told = told.contains("because pixels are saturated: expose shorter");
                assert_eq!(is_told, code == 3, "{channel}: {told}");
            }
        }
    }
}

#[test]
fn half_a_line_on_saturated_pixels_is_no_result() {
    let folder = folder();
    let file = folder.path().join("a.png");
    for (columns, is_told, code) in [(2, false, 0), (8, true, 0), (31, true, 0), (34, true, 3)] {
        write_png(&file, [SIZE, SIZE], BitDepth::Eight, |x, y| {
            let exposure = if x < columns { 1.5 } else { 0.9 };
            [rounded((exposure * 255.0 * line(x, y)).min(255.0))]
        });
        let output = run(folder.path(), "lines a.png --json -o f");
        assert_code(&output, code);
        let record: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let warning = record["warnings"][0].as_str().unwrap_or_default();
        assert_eq!(
            warning.contains("pixels are saturated"),
            is_told,
            "{columns}: {record}"
        );
        assert_eq!(
            points(&folder.path().join("f/a.csv")),
            [SIZE, SIZE - columns]
        );
    }
}
