//! `tem00-inspect lines`.

use std::{f64::consts::PI, fs, path::Path};

use png::BitDepth;

use super::{assert_code, files, folder, helpers, message, run, text};

const SIZE: [usize; 2] = [60, 48];

/// The place of the line of the images below in a column.
fn place(x: usize) -> f64 {
    24.0 + 3.0 * (2.0 * PI * x as f64 / 60.0).sin()
}

/// The grey value in the middle of a pixel, as far from the line as told: a line of 8 pixels full width and
/// 3000 DN over 100 DN.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the grey value lies between 100 and 3100"
)]
fn grey(from_middle: f64) -> u16 {
    (100.0 + 3_000.0 * (-2.0 * (from_middle / 4.0).powi(2)).exp()).round() as u16
}

/// Writes a PNG of 16 bits.
fn write_png(path: &Path, size: [usize; 2], value: impl Fn(usize, usize) -> u16) {
    helpers::write_png(path, size, BitDepth::Sixteen, |x, y| [value(x, y)]);
}

/// Writes an image of a line at the places.
fn write_line(path: &Path, place: impl Fn(usize) -> f64) {
    write_png(path, SIZE, |x, y| grey(y as f64 + 0.5 - place(x)));
}

fn line_folder() -> tempfile::TempDir {
    let folder = folder();
    write_line(&folder.path().join("a.png"), place);
    folder
}

/// The cells of a table with commas, without its headings.
fn cells(path: &Path) -> Vec<Vec<String>> {
    let table = fs::read_to_string(path).expect("the table");
    let line = |line: &str| line.split(',').map(str::to_owned).collect();
    table.lines().skip(1).map(line).collect()
}

#[test]
fn lines_are_found_in_a_frame() {
    let folder = line_folder();
    let output = run(folder.path(), "lines a.png -o found");
    assert!(output.status.success(), "{}", message(&output));
    let found = folder.path().join("found");
    assert_eq!(files(&found), ["a.csv", "a_lines.png", "lines.json"]);

    let points = cells(&found.join("a.csv"));
    assert_eq!(points.len(), SIZE[0], "a point in each column");
    for (x, point) in points.iter().enumerate() {
        let y: f64 = point[2].parse().expect("a number");
        // The window of 31 pixels cuts nothing off; grey values are rounded by ½ DN of 3000 at lever
        // arms of up to 15 pixels: (15 · 0.5 · 31 / √3) / (3000 · 5) at the very most.
        assert!(
            (y - place(x)).abs() < 9e-3,
            "column {x}: {y} for {}",
            place(x)
        );
        assert_eq!(
            (&*point[0], &*point[7], &*point[8]),
            (&*x.to_string(), "1", "")
        );
    }
    let summary = text(&output.stdout);
    assert!(
        summary.contains("position/px") && summary.contains("100.0 %"),
        "{summary}"
    );
}

#[test]
fn the_summary_is_json_on_demand() {
    let folder = line_folder();
    let output = run(
        folder.path(),
        "lines a.png --json --detector steger --sigma 2.5",
    );
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(json["detector"], "steger");
    let line = &json["lines"][0];
    assert_eq!(line["columns"], 60);
    let position = line["position_pixels"].as_f64().expect("a number");
    // The sine has the mean 0 over its period.
    assert!((position - 24.0).abs() < 1e-2, "{position}");
    let written = fs::read(folder.path().join("out/lines/lines.json")).expect("the file");
    assert_eq!(written, output.stdout, "the same text");
}

#[test]
fn saturated_points_are_not_valid() {
    let folder = line_folder();
    let output = run(folder.path(), "lines a.png --bits 12 -o found");
    assert!(output.status.success(), "{}", message(&output));
    let valid = |output: &Path| cells(output).iter().filter(|point| point[7] == "1").count();
    assert_eq!(
        valid(&folder.path().join("found/a.csv")),
        60,
        "4095 is not reached"
    );

    write_line(&folder.path().join("b.png"), |_| 20.5);
    // The middle pixel has 3100 DN, which ten bits do not hold.
    let output = run(folder.path(), "lines b.png --bits 10 -o found");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        message(&output).contains("at most 1023, but there is one of 3100"),
        "{}",
        message(&output)
    );
}

#[test]
fn rows_tell_the_place_of_lines_from_top_to_bottom() {
    let folder = folder();
    let path = folder.path().join("turned.png");
    let [width, height] = SIZE;
    write_png(&path, [height, width], |y, x| {
        grey(y as f64 + 0.5 - place(x))
    });
    write_line(&folder.path().join("a.png"), place);
    run(folder.path(), "lines a.png -o found");
    let output = run(folder.path(), "lines turned.png --rows -o found");
    assert!(output.status.success(), "{}", message(&output));
    let of = |name: &str| cells(&folder.path().join("found").join(name));
    assert_eq!(of("a.csv"), of("turned.csv"), "the same points");
}

#[test]
fn several_images_get_a_table_each() {
    let folder = line_folder();
    fs::create_dir(folder.path().join("b")).expect("a folder");
    write_line(&folder.path().join("b/a.png"), |_| 10.0);
    let output = run(folder.path(), "lines a.png b/a.png -o found");
    assert!(output.status.success(), "{}", message(&output));
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
    let output = run(folder.path(), "lines dark.png --json");
    assert_code(&output, 3);
    let record: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let line = &record["lines"][0];
    assert_eq!(line["image"], "dark.png", "{record}");
    for key in ["line", "position_pixels", "noise_pixels", "peak_dn"] {
        assert!(line[key].is_null(), "{key}: {record}");
    }
    let output = run(folder.path(), "lines dark.png");
    assert_code(&output, 3);
    assert!(
        message(&output).contains("no point of a line"),
        "{}",
        message(&output)
    );
    assert!(
        text(&output.stdout).contains("none"),
        "{}",
        text(&output.stdout)
    );
    assert!(
        cells(&folder.path().join("out/lines/dark.csv")).is_empty(),
        "no points"
    );
}

#[test]
fn what_is_doubtful_is_told_with_what_helps() {
    let folder = line_folder();
    let path = |name: &str| folder.path().join(name);
    write_png(&path("dark.png"), [40, 30], |_, _| 0);
    // A line from top to bottom.
    write_png(&path("down.png"), [48, 60], |x, y| {
        grey(x as f64 + 0.5 - place(y))
    });
    write_png(&path("white.png"), SIZE, |x, y| {
        grey(y as f64 + 0.5 - place(x)).saturating_mul(30)
    });
    for (line, part) in [
        (
            "lines dark.png",
            "a line in 0 of 40 columns only: give --rows",
        ),
        ("lines down.png --rows --min-peak 5000", "leave --rows out"),
        ("lines a.png --window 61", "a smaller --window helps"),
        ("lines white.png", "pixels are saturated"),
    ] {
        let output = run(folder.path(), line);
        assert_code(&output, 3);
        assert!(
            message(&output).contains(part),
            "{line}: {}",
            message(&output)
        );
    }
    // One image with a line is a result.
    assert_code(&run(folder.path(), "lines dark.png a.png"), 0);
    let fine = run(folder.path(), "lines a.png");
    assert!(!message(&fine).contains("note"), "{}", message(&fine));
}
