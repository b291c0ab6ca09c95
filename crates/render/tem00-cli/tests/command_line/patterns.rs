//! `tem00 pattern` and `tem00 stats`.

use std::{fs, path::Path, process::Stdio};

use serde_json::Value;

use super::*;

#[test]
fn a_pattern_in_every_format_has_the_same_statistics() {
    let folder = folder();
    for name in ["a.png", "a.exr", "a.npy"] {
        let output = run(
            folder.path(),
            &format!("pattern -o {name} --size 128 --seed 3"),
        );
        assert_code(&output, 0);
        assert!(
            text(&output.stdout).starts_with("quantity"),
            "the table is the data"
        );
        assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
    }
    assert_eq!(files(folder.path()), ["a.exr", "a.npy", "a.png"]);

    let contrast = |name: &str| {
        let output = run(folder.path(), &format!("stats {name} --json"));
        assert_code(&output, 0);
        let found: Value = serde_json::from_slice(&output.stdout).expect("JSON and nothing else");
        let rows = found["rows"].as_array().expect("rows");
        let row = rows
            .iter()
            .find(|row| row["quantity"] == "contrast")
            .expect("a contrast");
        row["measured"].as_f64().expect("a number")
    };
    let exact = contrast("a.npy");
    assert!(
        (contrast("a.exr") - exact).abs() < 1e-12,
        "EXR holds the same f32"
    );
    // 16 bits of about ten times the mean: rounding of 1.5e-4 / √12 of the mean, averaged.
    assert!(
        (contrast("a.png") - exact).abs() < 1e-5,
        "PNG holds 16 bits"
    );
}

/// Writes an array of `c8` as NumPy does: a wave that is spread over all of the image.
fn write_field(path: &Path, width: usize, height: usize) {
    let phase = |i: usize| 0.1 * (i % width).pow(2) as f32 + 0.2 * (i / width).pow(2) as f32;
    let values: Vec<f32> = (0..width * height)
        .flat_map(|i| [phase(i).cos(), phase(i).sin()])
        .collect();
    write_array(path, "<c8", [height, width], &values);
}

#[test]
fn a_field_from_outside_takes_the_place_of_a_random_one() {
    let folder = folder();
    write_field(&folder.path().join("field.npy"), 40, 60);
    let output = run(folder.path(), "pattern -o a.npy --field field.npy");
    assert_code(&output, 0);
    assert!(
        text(&output.stderr).contains("random phases"),
        "the theory is that of speckle: {}",
        text(&output.stderr)
    );
    // Four times the shorter side; the mean is that of the power in the pupil.
    let pattern = run(folder.path(), "stats a.npy --json");
    let found: Value = serde_json::from_slice(&pattern.stdout).expect("JSON and nothing else");
    assert_eq!(found["width"], 160);
    let mean = found["rows"][0]["measured"].as_f64().expect("a number");
    assert!((mean - 1.0).abs() < 1e-5, "{mean}");
    // What is beyond the field is dark, and said to be.
    let line = "pattern -o b.exr --field field.npy --diameter 80 --size 200 --amplitude";
    let output = run(folder.path(), line);
    assert_code(&output, 0);
    assert!(
        text(&output.stderr).contains("beyond the field of 40 × 60"),
        "{}",
        text(&output.stderr)
    );
    assert_eq!(files(folder.path()), ["a.npy", "b.exr", "field.npy"]);
}

#[test]
fn fields_that_are_not_fields_are_refused_by_their_name() {
    let folder = folder();
    let path = folder.path();
    write_field(&path.join("good.npy"), 20, 20);
    write_array(&path.join("real.npy"), "<f4", [20, 20], &[1.0; 400]);
    write_array(&path.join("dark.npy"), "<c8", [20, 20], &[0.0; 800]);
    write_array(&path.join("hole.npy"), "<c8", [20, 20], &[f32::NAN; 800]);
    write_array(&path.join("cut.npy"), "<c8", [20, 20], &[1.0; 799]);
    fs::write(path.join("text.npy"), "no array").expect("written");
    let before = files(path);
    for (field, part) in [
        ("real.npy", "got the type <f4"),
        ("dark.npy", "sees no light"),
        ("hole.npy", "index [0, 0]"),
        ("cut.npy", "ends before its array"),
        ("text.npy", "not a NumPy file"),
        ("missing.npy", "missing.npy"),
        ("good.npy --seed 3", "--seed"),
        ("good.npy --size 30", "got 20"),
        ("good.npy --diameter 7", "got 7"),
        ("good.npy --diameter 5000", "20000"),
    ] {
        let output = run(path, &format!("pattern -o a.npy --field {field}"));
        assert_code(&output, 2);
        let said = message(&output);
        assert!(said.contains(part), "{field}: {said}");
        assert_eq!(files(path), before, "{field}");
    }
}

#[test]
fn a_page_of_plots_is_drawn_where_it_was_asked_for() {
    let folder = folder();
    assert_code(&run(folder.path(), "pattern -o a.npy --size 64"), 0);
    for (name, start) in [("page.svg", "<svg"), ("page.png", "\u{fffd}PNG")] {
        let output = run(folder.path(), &format!("stats a.npy --plot {name}"));
        assert_code(&output, 0);
        assert!(
            text(&output.stdout).starts_with("quantity"),
            "the table is the data"
        );
        let page = fs::read(folder.path().join(name)).expect("a page");
        assert!(text(&page).starts_with(start), "{name}");
    }
    for name in ["page.pdf", "no/page.svg"] {
        let output = run(folder.path(), &format!("stats a.npy --plot {name}"));
        assert_code(&output, 2);
        assert!(message(&output).contains(name), "{}", message(&output));
    }
    let output = run(folder.path(), "stats missing.npy --plot none.svg");
    assert_code(&output, 2);
    assert_eq!(files(folder.path()), ["a.npy", "page.png", "page.svg"]);
}

#[test]
fn json_holds_the_curves() {
    let folder = folder();
    assert_code(&run(folder.path(), "pattern -o a.npy --size 64"), 0);
    let output = run(folder.path(), "stats a.npy --json");
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON and nothing else");
    for curve in ["histogram", "autocovariance", "power_spectrum"] {
        let points = found["curves"][curve].as_array().expect("a curve");
        assert!(points.len() > 8, "{curve} has {} points", points.len());
    }
}

/// Writes an array as NumPy does.
fn write_array(path: &Path, element_type: &str, [height, width]: [usize; 2], values: &[f32]) {
    let header = format!(
        "{{'descr': '{element_type}', 'fortran_order': False, 'shape': ({height}, {width}), }}"
    );
    // The header is padded so that the data begin at a multiple of 64 bytes.
    let mut file = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    file.extend(format!("{header:<117}\n").bytes());
    file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    fs::write(path, file).expect("the array is written");
}

#[test]
fn images_without_speckle_are_refused_by_their_name() {
    let folder = folder();
    let varied: Vec<f32> = (0..400_u16).map(|i| f32::from(i % 7)).collect();
    let mut hole = varied.clone();
    hole[23] = f32::NAN;
    for (name, width, values, part) in [
        ("tiny.npy", 4, &varied[..16], "4 × 4 pixels"),
        ("row.npy", 400, &varied[..], "400 × 1 pixels"),
        (
            "even.npy",
            20,
            &[2.0; 400][..],
            "more than one value, got 2",
        ),
        ("black.npy", 20, &[0.0; 400][..], "0"),
        ("hole.npy", 20, &hole[..], "(3, 1) is NaN"),
    ] {
        let shape = [values.len() / width, width];
        write_array(&folder.path().join(name), "<f4", shape, values);
        let output = run(folder.path(), &format!("stats {name}"));
        assert_code(&output, 2);
        let said = message(&output);
        assert!(said.contains(name) && said.contains(part), "{name}: {said}");
    }
}

#[test]
fn nobody_reading_is_no_failure() {
    let folder = folder();
    let mut child = tem00(folder.path(), "pattern -o a.npy --size 64")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 0);
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
    assert_eq!(files(folder.path()), ["a.npy"]);
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_ends_a_pattern_without_a_file() {
    use std::{thread::sleep, time::Duration};

    let folder = folder();
    let child = tem00(folder.path(), "pattern -o a.npy --size 4096")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // As soon as it listens, long before the pattern is made.
    let status = format!("/proc/{}/status", child.id());
    let listens = || {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let caught = text.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        // Signal 2, the second bit.
        caught.is_some_and(|mask| mask & 2 != 0)
    };
    let listening = (0..6_000).any(|_| {
        sleep(Duration::from_millis(5));
        listens()
    });
    assert!(listening, "the program listens");
    interrupt(&child);

    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 130);
    assert!(output.stdout.is_empty(), "nothing was measured");
    assert!(files(folder.path()).is_empty(), "nothing is left");
}

/// Writes an image of 400 × 320 pixels as a map of 16 bits: `pixel` of x and y, from the middle, and of the intensity of a
/// pattern with this pupil, on 512 samples, whose mean is 1.
fn write_image(folder: &Path, name: &str, pupil: u32, pixel: impl Fn(f64, f64, f64) -> f64) {
    let command = format!("pattern -o even.npy --size 512 --diameter {pupil} --seed 5");
    assert_code(&run(folder, &command), 0);
    let file = fs::read(folder.join("even.npy")).expect("the pattern");
    let values: Vec<f64> = file[file.len() - 4 * 512 * 512..]
        .chunks_exact(4)
        .map(|bytes| f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])))
        .collect();
    let (width, height) = (400_u16, 320_u16);
    let mut map = format!("P5 {width} {height} 65535\n").into_bytes();
    for y in 0..height {
        for x in 0..width {
            let speckle = values[512 * usize::from(y) + usize::from(x)];
            let value = pixel(f64::from(x) - 200.0, f64::from(y) - 160.0, speckle);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "rounded to 16 bits"
            )]
            let stored = (3_000.0 * value).round().min(65_535.0) as u16;
            map.extend(stored.to_be_bytes());
        }
    }
    fs::write(folder.join(name), map).expect("the image");
}

/// Light over x and y, in pixels from the middle.
type Light = dyn Fn(f64, f64) -> f64;

/// The light of a Gaussian spot of the radius `radius`, in pixels.
fn spot(x: f64, y: f64, radius: f64) -> f64 {
    (-2.0 * (x * x + y * y) / (radius * radius)).exp()
}

/// Returns the JSON of `tem00 stats`.
fn stats(folder: &Path, arguments: &str) -> Value {
    let output = run(folder, &format!("stats {arguments} --json"));
    assert_code(&output, 0);
    serde_json::from_slice(&output.stdout).expect("JSON and nothing else")
}

fn row<'a>(found: &'a Value, quantity: &str) -> &'a Value {
    let mut rows = found["rows"].as_array().expect("rows").iter();
    rows.find(|row| row["quantity"] == quantity)
        .expect("the row is there")
}

#[test]
fn uneven_light_is_warned_of_and_taken_out() {
    let folder = folder();
    let path = folder.path();
    write_image(path, "spot.pgm", 128, |x, y, speckle| {
        speckle * spot(x, y, 120.0)
    });
    let whole = stats(path, "spot.pgm");
    let warning = whole["warnings"][0].as_str().expect("a warning");
    assert!(
        warning.contains("--crop") && warning.contains("--flatten"),
        "{warning}"
    );
    assert!(row(&whole, "contrast")["verdict"].is_null(), "{whole}");

    // The same pattern in even light is the oracle.
    let crop = "--crop 120,80,160,160";
    let flat = stats(path, &format!("spot.pgm {crop} --flatten"));
    let even = stats(path, &format!("even.npy {crop}"));
    for found in [&flat, &even] {
        assert_eq!(found["warnings"], serde_json::json!([]));
        assert_eq!(row(found, "contrast")["verdict"], "agrees");
    }
    for quantity in [
        "contrast",
        "speckle size x (pixels)",
        "speckle size y (pixels)",
    ] {
        let of = |found| {
            let measured = &row(found, quantity)["measured"];
            measured.as_f64().expect("a number")
        };
        let ratio: f64 = of(&flat) / of(&even);
        // Light that falls to 0.41 at the edges weighs the speckles otherwise: a third of the spread
        // from image to image, 0.77 / 40, at 3 σ.
        assert!((ratio - 1.0).abs() < 0.02, "{quantity}: {ratio}");
    }
    let cropped = stats(path, "even.npy --crop 10,20,100,90");
    assert_eq!(
        (&cropped["width"], &cropped["height"]),
        (&100.into(), &90.into())
    );
}

/// The contrast of grains of two pixels as in blood that flows: less than that of the light.
const WEAK: f64 = 0.08;

#[test]
fn light_that_sets_the_size_is_warned_of_and_taken_out() {
    let folder = folder();
    let path = folder.path();
    let blob = |x: f64, y: f64| 0.05 + spot(x, y, 160.0);
    let cases: [(&str, f64, &Light); 6] = [
        ("blob.pgm", WEAK, &blob),
        ("vignette.pgm", WEAK, &|x, y| {
            (1.0 + (x * x + y * y) / 9e4).powi(-2)
        }),
        ("fringes.pgm", WEAK, &|x, y| {
            2.0 + (x / 20.0).cos() + (y / 15.0).cos()
        }),
        ("small.pgm", WEAK, &|x, y| 0.01 + 9.0 * spot(x, y, 16.0)),
        // Without grains: a contrast of 1.37 ± 0.7 behind so few speckles, which agrees.
        ("smooth.pgm", 0.0, &|x, y| spot(x, y, 120.0)),
        ("smooth_and_dim.pgm", 0.0, &blob),
    ];
    let of = |found: &Value, quantity| row(found, quantity)["measured"].as_f64().expect("a number");
    for (name, grains, light) in cases {
        let pixel = |x, y, speckle| light(x, y) * (1.0 + grains * (speckle - 1.0));
        write_image(path, name, 256, pixel);
        let found = stats(path, name);
        let warning = found["warnings"][0].as_str().expect("a warning");
        assert!(
            warning.contains("does not count as even"),
            "{name}: {warning}"
        );
        assert!(
            row(&found, "contrast")["verdict"].is_null(),
            "{name}: {found}"
        );
        let size = of(&found, "speckle size x (pixels)");
        assert!(size > 20.0, "{name}: the light sets the size, {size}");
    }
    for name in ["blob.pgm", "vignette.pgm"] {
        // Windows that follow the light are found although the light seems to be speckle at first.
        let size = of(
            &stats(path, &format!("{name} --flatten")),
            "speckle size x (pixels)",
        );
        assert!((1.9..2.5).contains(&size), "{name}: {size}");
        let flat = stats(path, &format!("{name} --flatten=16"));
        assert_eq!(flat["warnings"], serde_json::json!([]), "{name}");
        // To 0.77 / 180 of the contrast and 0.62 / 180 of the size by chance, and s² = 4e-4 by the second order.
        let size = of(&flat, "speckle size x (pixels)") / 2.0;
        let contrast = of(&flat, "contrast") / WEAK;
        assert!((size - 1.0).abs() < 0.015, "{name}: {size}");
        assert!((contrast - 1.0).abs() < 0.02, "{name}: {contrast}");
    }
}

#[test]
fn crops_and_windows_that_cannot_be_are_refused() {
    let folder = folder();
    assert_code(&run(folder.path(), "pattern -o a.npy --size 64"), 0);
    for (arguments, part) in [
        (
            "--crop 0,0,65,10",
            "must lie in the image of 64 × 64 pixels",
        ),
        (
            "--crop 60,0,10,10",
            "must lie in the image of 64 × 64 pixels",
        ),
        ("--crop 0,0,4,30", "4 × 30 pixels"),
        ("--flatten=1", "window must be at least 2 pixels"),
        ("--flatten=9", "6 speckle sizes"),
        ("--flatten=65", "got 65"),
    ] {
        let output = run(folder.path(), &format!("stats a.npy {arguments}"));
        assert_code(&output, 2);
        let said = message(&output);
        assert!(said.contains(part), "{arguments}: {said}");
    }
}
