//! `tem00 pattern` and `tem00 stats`.

use std::{fs, path::Path};

use serde_json::{Value, json as literal};

use super::*;

#[test]
fn a_pattern_in_every_format_has_the_same_statistics() {
    let folder = folder();
    let [exact, exr, png] = ["a.npy", "a.exr", "a.png"].map(|name| {
        let output = done(
            folder.path(),
            &format!("pattern -o {name} --size 128 --seed 3"),
        );
        let table = text(&output.stdout);
        assert!(table.starts_with("quantity"), "the table is the data");
        assert_eq!(text(&output.stderr), "");
        let found = stats(folder.path(), name);
        for curve in ["histogram", "autocovariance", "power_spectrum"] {
            let points = found["curves"][curve].as_array().expect("a curve");
            assert!(points.len() > 8, "{curve} has {} points", points.len());
        }
        measured(&found, "contrast")
    });
    assert_eq!(files(folder.path()), ["a.exr", "a.npy", "a.png"]);
    assert!((exr - exact).abs() < 1e-12, "EXR holds the same f32");
    // 16 bits of about ten times the mean: rounding of 1.5e-4 / √12 of the mean, averaged.
    assert!((png - exact).abs() < 1e-5, "PNG holds 16 bits");
}

/// Writes an array of `c8` as NumPy does: a wave that is spread over all of the image.
fn write_field(path: &Path, width: usize, height: usize) {
    let phase = |i: usize| 0.1 * (i % width).pow(2) as f32 + 0.2 * (i / width).pow(2) as f32;
    let phases = (0..width * height).map(phase);
    let values: Vec<f32> = phases
        .flat_map(|phase| [phase.cos(), phase.sin()])
        .collect();
    write_array(path, "<c8", [height, width], &values);
}

#[test]
fn a_field_from_outside_takes_the_place_of_a_random_one() {
    let folder = folder();
    write_field(&folder.path().join("field.npy"), 40, 60);
    let told = text(&done(folder.path(), "pattern -o a.npy --field field.npy").stderr);
    assert!(
        told.contains("random phases"),
        "the theory is that of speckle: {told}"
    );
    // Four times the shorter side; the mean is that of the power in the pupil.
    let found = stats(folder.path(), "a.npy");
    assert_eq!(found["width"], 160);
    let mean = measured(&found, "mean");
    assert!((mean - 1.0).abs() < 1e-5, "{mean}");
    // What is beyond the field is dark, and said to be.
    let line = "pattern -o b.exr --field field.npy --diameter 80 --size 200 --amplitude";
    let told = text(&done(folder.path(), line).stderr);
    assert!(told.contains("beyond the field of 40 × 60"), "{told}");
    assert_eq!(files(folder.path()), ["a.npy", "b.exr", "field.npy"]);
}

#[test]
fn fields_and_images_that_cannot_be_are_refused_in_words() {
    let varied: Vec<f32> = (0..400_u16).map(|i| f32::from(i % 7)).collect();
    let mut hole = varied.clone();
    hole[23] = f32::NAN;
    let given = helpers::play("arrays", |folder| {
        let array = |name, kind, shape, values: &[f32]| {
            write_array(&folder.join(name), kind, shape, values);
        };
        write_field(&folder.join("good.npy"), 20, 20);
        array("real.npy", "<f4", [20, 20], &varied);
        array("dark.npy", "<c8", [20, 20], &[0.0; 800]);
        array("nan.npy", "<c8", [20, 20], &[f32::NAN; 800]);
        array("cut.npy", "<c8", [20, 20], &[1.0; 799]);
        array("tiny.npy", "<f4", [4, 4], &varied[..16]);
        array("row.npy", "<f4", [1, 400], &varied);
        array("even.npy", "<f4", [20, 20], &[2.0; 400]);
        array("black.npy", "<f4", [20, 20], &[0.0; 400]);
        array("hole.npy", "<f4", [20, 20], &hole);
        done(folder, "pattern -o pattern.npy --size 64");
    });
    let names = files(given.path());
    assert!(!names.contains(&"a.npy".to_owned()), "{names:?}");
}

#[test]
fn a_page_of_plots_is_drawn_where_it_was_asked_for() {
    let folder = folder();
    done(folder.path(), "pattern -o a.npy --size 64");
    for (name, start) in [("page.svg", "<svg"), ("page.png", "\u{fffd}PNG")] {
        let output = done(folder.path(), &format!("stats a.npy --plot {name}"));
        let table = text(&output.stdout);
        assert!(table.starts_with("quantity"), "the table is the data");
        let page = fs::read(folder.path().join(name)).expect("a page");
        assert!(text(&page).starts_with(start), "{name}");
    }
    for name in ["page.pdf", "no/page.svg"] {
        refused(
            folder.path(),
            &format!("stats a.npy --plot {name}"),
            &[name],
        );
    }
    refused(folder.path(), "stats missing.npy --plot none.svg", &[]);
    assert_eq!(files(folder.path()), ["a.npy", "page.png", "page.svg"]);
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
fn nobody_reading_is_no_failure() {
    let folder = folder();
    let mut child = start(folder.path(), "pattern -o a.npy --size 64");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 0);
    assert_eq!(text(&output.stderr), "");
    assert_eq!(files(folder.path()), ["a.npy"]);
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_ends_a_pattern_without_a_file() {
    let folder = folder();
    let child = start(folder.path(), "pattern -o a.npy --size 4096");
    // As soon as it listens, long before the pattern is made.
    let status = format!("/proc/{}/status", child.id());
    wait_until("the program listens", || {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let caught = text.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        // Signal 2, the second bit.
        caught.is_some_and(|mask| mask & 2 != 0)
    });
    interrupt(&child);

    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 130);
    assert!(output.stdout.is_empty(), "nothing was measured");
    assert!(files(folder.path()).is_empty(), "nothing is left");
}

/// Writes an image of 400 × 320 pixels as a map of 16 bits: `pixel` of x and y, from the middle,
/// and of the intensity of a pattern with this pupil, on 512 samples, whose mean is 1.
fn write_image(folder: &Path, name: &str, pupil: usize, pixel: impl Fn(f64, f64, f64) -> f64) {
    let values = helpers::pattern(folder, "even.npy", [512, pupil]);
    let (width, height) = (400_u16, 320_u16);
    let mut map = format!("P5 {width} {height} 65535\n").into_bytes();
    for y in 0..height {
        for x in 0..width {
            let speckle = values[512 * usize::from(y) + usize::from(x)];
            let value = pixel(f64::from(x) - 200.0, f64::from(y) - 160.0, speckle);
            map.extend(helpers::rounded(3_000.0 * value).to_be_bytes());
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
pub(crate) fn stats(folder: &Path, arguments: &str) -> Value {
    json(folder, &format!("stats {arguments} --json"))
}

fn row<'a>(found: &'a Value, quantity: &str) -> &'a Value {
    let mut rows = found["rows"].as_array().expect("rows").iter();
    let row = rows.find(|row| row["quantity"] == quantity);
    row.unwrap_or(&Value::Null)
}

pub(crate) fn measured(found: &Value, quantity: &str) -> f64 {
    row(found, quantity)["measured"]
        .as_f64()
        .unwrap_or(f64::NAN)
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
        assert_eq!(found["warnings"], literal!([]));
        assert_eq!(row(found, "contrast")["verdict"], "agrees");
    }
    for quantity in [
        "contrast",
        "speckle size x (pixels)",
        "speckle size y (pixels)",
    ] {
        let ratio = measured(&flat, quantity) / measured(&even, quantity);
        // Light that falls to 0.41 at the edges weighs the speckles otherwise: a third of the
        // spread from image to image, 0.77 / 40, at 3 σ.
        assert!((ratio - 1.0).abs() < 0.02, "{quantity}: {ratio}");
    }
    let cropped = stats(path, "even.npy --crop 10,20,100,90");
    assert_eq!(cropped["width"], 100);
    assert_eq!(cropped["height"], 90);
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
        let size = measured(&found, "speckle size x (pixels)");
        assert!(size > 20.0, "{name}: the light sets the size, {size}");
    }
    for name in ["blob.pgm", "vignette.pgm"] {
        // Windows that follow the light are found although the light seems to be speckle at first.
        let flat = stats(path, &format!("{name} --flatten"));
        let size = measured(&flat, "speckle size x (pixels)");
        assert!((1.9..2.5).contains(&size), "{name}: {size}");
        let flat = stats(path, &format!("{name} --flatten=16"));
        assert_eq!(flat["warnings"], literal!([]), "{name}");
        // To 0.77 / 180 of the contrast and 0.62 / 180 of the size by chance, and s² = 4e-4 by the
        // second order.
        let size = measured(&flat, "speckle size x (pixels)") / 2.0;
        let contrast = measured(&flat, "contrast") / WEAK;
        assert!((size - 1.0).abs() < 0.015, "{name}: {size}");
        assert!((contrast - 1.0).abs() < 0.02, "{name}: {contrast}");
    }
}
