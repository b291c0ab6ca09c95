//! `tem00-inspect lines` on images as cameras write them.

use png::BitDepth;

use super::{
    helpers::{noise, rounded, write_png},
    *,
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

/// Finds the lines of `a.png`, checks the numbers of its points and of valid ones, and returns what
/// was said.
#[track_caller]
fn found(folder: &Path, options: &str, code: i32, valid: usize) -> Said {
    let said = said(folder, &format!("lines a.png -o f {options}"), code);
    let table = read(&folder.join("f/a.csv"));
    let rows = table.lines().skip(1);
    let is_valid = |row: &&str| row.split(',').nth(7) == Some("1");
    let counts = [rows.clone().count(), rows.filter(is_valid).count()];
    assert_eq!(counts, [SIZE, valid], "{}", said.told);
    said
}

#[test]
fn saturation_of_lines_is_one_judgement_whatever_the_bits_and_where_they_lie() {
    let folder = folder();
    let file = folder.path().join("a.png");
    // The largest value and the step of two values: 10, 12 and 14 bits, in the lower and the upper
    // bits of a word, and values clipped by what a camera computes.
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
        let (full, step) = (f64::from(largest), f64::from(step));
        for (exposure, is_clipped) in [(0.9, false), (1.5, true)] {
            write_grey(&file, |x, y| {
                let value = step * (exposure * full * line(x, y) / step).round();
                rounded(value.min(full))
            });
            let (code, valid) = if is_clipped { (3, 0) } else { (0, SIZE) };
            for detector in ["centre_of_gravity", "blais_rioux"] {
                let options = format!("--detector {detector}");
                let told = found(folder.path(), &options, code, valid).told;
                let warning =
                    "100 % of the points are not valid, 100 % because pixels are saturated";
                assert_eq!(
                    told.contains(warning),
                    is_clipped,
                    "{largest}, {step}: {told}"
                );
            }
        }
    }
    // Who knows the bits is believed.
    found(folder.path(), "--bits 16", 0, SIZE);
}

#[test]
fn a_pixel_is_saturated_if_one_of_its_channels_is() {
    let folder = folder();
    let file = folder.path().join("a.png");
    for (depth, full) in [(BitDepth::Eight, 255.0), (BitDepth::Sixteen, 4_095.0)] {
        // The channels of bright, of dim and of little light.
        for [bright, dim, dark] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            write_png(&file, [SIZE, SIZE], depth, |x, y| {
                let mut pixel = [0; 3];
                for (channel, part) in [(bright, 1.5), (dim, 0.3), (dark, 0.1)] {
                    pixel[channel] = rounded((full * part * line(x, y)).min(full));
                }
                pixel
            });
            let name = |channel: usize| format!("--channel {}", ["R", "G", "B"][channel]);
            for (channel, code, valid) in [
                (String::new(), 3, 0),
                (name(bright), 3, 0),
                (name(dim), 0, SIZE),
            ] {
                let told = found(folder.path(), &channel, code, valid).told;
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
        let printed = found(folder.path(), "--json", code, SIZE - columns).out;
        let record = json(&printed);
        let warning = record["warnings"][0].as_str().unwrap_or_default();
        let found = warning.contains("pixels are saturated");
        assert_eq!(found, is_told, "{columns}: {record}");
    }
}
