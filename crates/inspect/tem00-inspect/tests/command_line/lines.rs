//! `tem00-inspect lines`.

use std::{f64::consts::PI, fs};

use png::BitDepth;

use super::{helpers::rounded, *};

const SIZE: [usize; 2] = [60, 48];

/// The place of the line of the images below in a column.
fn place(x: usize) -> f64 {
    24.0 + 3.0 * (2.0 * PI * x as f64 / 60.0).sin()
}

/// The grey value in the middle of a pixel, as far from the line as told: a line of 8 pixels full
/// width and 3000 DN over 100 DN.
fn grey(from_middle: f64) -> u16 {
    rounded(100.0 + 3_000.0 * (-2.0 * (from_middle / 4.0).powi(2)).exp())
}

/// Writes a PNG of 16 bits.
fn write_png(path: &Path, size: [usize; 2], value: impl Fn(usize, usize) -> u16) {
    helpers::write_png(path, size, BitDepth::Sixteen, |x, y| [value(x, y)]);
}

/// Writes an image of a line at the places.
fn write_line(path: &Path, place: impl Fn(usize) -> f64) {
    write_png(path, SIZE, |x, y| grey(y as f64 + 0.5 - place(x)));
}

/// Writes an image of a line from top to bottom.
fn write_turned(path: &Path) {
    let [width, height] = SIZE;
    write_png(path, [height, width], |y, x| {
        grey(y as f64 + 0.5 - place(x))
    });
}

fn line_folder() -> tempfile::TempDir {
    let folder = folder();
    write_line(&folder.path().join("a.png"), place);
    folder
}

/// The cells of a table with commas, without its headings.
fn cells(path: &Path) -> Vec<Vec<String>> {
    let line = |line: &str| line.split(',').map(str::to_owned).collect();
    read(path).lines().skip(1).map(line).collect()
}

#[test]
fn lines_are_found_in_a_frame() {
    let folder = line_folder();
    let summary = said(folder.path(), "lines a.png -o found --bits 12", 0).out;
    let found = folder.path().join("found");
    assert_eq!(files(&found), ["a.csv", "a_lines.png", "lines.json"]);
    let points = cells(&found.join("a.csv"));
    assert_eq!(points.len(), SIZE[0], "a point in each column");
    for (x, point) in points.iter().enumerate() {
        let y: f64 = point[2].parse().expect("a number");
        // The window of 31 pixels cuts nothing off; grey values are rounded by ½ DN of 3000 at
        // lever arms of up to 15 pixels: (15 · 0.5 · 31 / √3) / (3000 · 5) at the very most.
        assert!((y - place(x)).abs() < 9e-3, "column {x}: {y}");
        let known = (&*point[0], &*point[7], &*point[8]);
        assert_eq!(known, (&*x.to_string(), "1", ""));
    }
    assert_has(&summary, &["position/px", "100.0 %"]);
    // Rows tell the place of lines from top to bottom: the same points.
    write_turned(&folder.path().join("turned.png"));
    said(folder.path(), "lines turned.png --rows -o found", 0);
    assert_eq!(cells(&found.join("turned.csv")), points);
}

#[test]
fn the_summary_is_json_on_demand() {
    let folder = line_folder();
    let line = "lines a.png --json --detector steger --sigma 2.5";
    let printed = said(folder.path(), line, 0).out;
    let record = json(&printed);
    assert_eq!(record["detector"], "steger");
    let line = &record["lines"][0];
    assert_eq!(line["columns"], 60);
    // The sine has the mean 0 over its period.
    let position = number(&line["position_pixels"]);
    assert!((position - 24.0).abs() < 1e-2, "{position}");
    let written = read(&folder.path().join("out/lines/lines.json"));
    assert_eq!(written, printed, "the same text");
}

#[test]
fn several_images_get_a_table_each() {
    let folder = line_folder();
    fs::create_dir(folder.path().join("b")).expect("a folder");
    write_line(&folder.path().join("b/a.png"), |_| 10.0);
    said(folder.path(), "lines a.png b/a.png -o found", 0);
    let expected = [
        "a.csv",
        "a_2.csv",
        "a_2_lines.png",
        "a_lines.png",
        "lines.json",
    ];
    assert_eq!(files(&folder.path().join("found")), expected);
}

#[test]
fn an_image_without_a_line_has_none() {
    let folder = folder();
    write_png(&folder.path().join("dark.png"), [40, 30], |_, _| 0);
    let record = json(&said(folder.path(), "lines dark.png --json", 3).out);
    let line = &record["lines"][0];
    assert_eq!(line["image"], "dark.png", "{record}");
    for key in ["line", "position_pixels", "noise_pixels", "peak_dn"] {
        assert!(line[key].is_null(), "{key}: {record}");
    }
    let Said { out, told } = said(folder.path(), "lines dark.png", 3);
    assert_has(&told, &["no point of a line"]);
    assert_has(&out, &["none"]);
    assert!(cells(&folder.path().join("out/lines/dark.csv")).is_empty());
}

#[test]
fn what_is_doubtful_is_told_with_what_helps() {
    let folder = line_folder();
    let path = |name: &str| folder.path().join(name);
    write_png(&path("dark.png"), [40, 30], |_, _| 0);
    write_turned(&path("down.png"));
    write_png(&path("white.png"), SIZE, |x, y| {
        grey(y as f64 + 0.5 - place(x)).saturating_mul(30)
    });
    for [options, code, part] in tem00_testkit::rows(
        "dark.png => 3 => line found in only 0 of 40 columns: pass --rows
        down.png --rows --min-peak 5000 => 3 => omit --rows
        a.png --window 61 => 3 => a smaller --window helps
        white.png => 3 => pixels are saturated
        a.png --bits 10 => 2 => at most 1023, but there is one of 3",
    ) {
        let code = code.parse().expect("a code");
        let told = said(folder.path(), &format!("lines {options}"), code).told;
        assert_has(&told, &[&part]);
    }
    // One image with a line is a result.
    said(folder.path(), "lines dark.png a.png", 0);
    let told = said(folder.path(), "lines a.png", 0).told;
    assert!(!told.contains("note"), "{told}");
}
