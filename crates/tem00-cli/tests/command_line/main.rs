//! The program as its users meet it: exit codes, what goes where, and which files appear.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::{
    fs,
    io::Write,
    path::Path,
    process::{Command, Output, Stdio},
};

use serde_json::Value;

/// A spot on a diffuse plane, small enough to be rendered in a moment.
const SCENE: &str = r#"
[camera]
position = ["0 mm", "0 mm", "300 mm"]
look_at = ["0 mm", "0 mm", "0 mm"]
focal_length = "25 mm"
f_number = 8
pixel_pitch = "3.45 um"
resolution = [48, 40]

[[laser]]
wavelength = "650 nm"
power = "5 mW"
position = ["100 mm", "0 mm", "300 mm"]
look_at = ["0 mm", "0 mm", "0 mm"]
spot = { waist_radius = "0.2 mm" }

[[surface]]
rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = ["20 mm", "20 mm"] }

[render]
samples_per_pixel = 4
"#;

fn tem00(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tem00"));
    command
        .current_dir(folder)
        .args(line.split_whitespace())
        .stdin(Stdio::null());
    command
}

fn run(folder: &Path, line: &str) -> Output {
    tem00(folder, line).output().expect("the program starts")
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn scene_folder() -> tempfile::TempDir {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), SCENE).expect("the scene is written");
    folder
}

fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder can be read");
    let mut names: Vec<_> = entries
        .map(|entry| entry.expect("the entry can be read").file_name())
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Returns standard error as one line without the frame that long messages are wrapped in.
fn message(output: &Output) -> String {
    let words = text(&output.stderr);
    let words = words.split_whitespace().filter(|word| *word != "│");
    words.collect::<Vec<_>>().join(" ")
}

#[track_caller]
fn assert_code(output: &Output, code: i32) {
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
}

#[test]
fn help_teaches_by_examples() {
    let folder = folder();
    let output = run(folder.path(), "--help");
    assert_code(&output, 0);
    assert!(
        text(&output.stdout).contains("tem00 pattern -o speckle.png"),
        "examples are shown"
    );
    for command in ["render", "pattern", "stats"] {
        let output = run(folder.path(), &format!("{command} --help"));
        assert_code(&output, 0);
        assert!(
            text(&output.stdout).contains("Examples:"),
            "{command} shows examples"
        );
    }
}

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
    #[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
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
fn fields_that_are_none_are_refused_by_their_name() {
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
        ("cut.npy", "a part of it"),
        ("text.npy", "something else"),
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
fn a_size_that_cannot_be_measured_costs_no_file() {
    let folder = folder();
    let output = run(folder.path(), "pattern -o a.npy --pupil rectangle:0.001");
    assert_code(&output, 0);
    assert_eq!(files(folder.path()), ["a.npy"]);
    assert!(text(&output.stdout).contains("speckle size x"), "one axis");
    assert!(!text(&output.stdout).contains("speckle size y"), "no other");
    let said = message(&output);
    assert!(
        said.contains("size along y could not be measured"),
        "{said}"
    );
}

#[cfg(feature = "plot")]
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
        ("even.npy", 20, &[2.0; 400][..], "all of them are 2e0"),
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
fn bad_input_is_one_message_exit_code_2_and_no_file() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("text.png"), "no picture").expect("written");
    fs::write(path.join("a.toml"), SCENE).expect("written");
    let before = files(path);
    for (line, part) in [
        ("pattern -o a.jpg", "a.jpg"),
        ("pattern -o a.png --diameter 300", "got 300"),
        ("pattern -o a.png --diameter 4", "got 4"),
        ("pattern -o a.png --size 1000000", "16384"),
        ("pattern -o a.png --size 0", "got 0"),
        ("pattern -o a.png --pupil annulus:1.5", "1.5"),
        ("pattern -o a.png --pupil square", "square"),
        ("pattern -o a.png --amplitude", "amplitude"),
        ("pattern -o no/a.png", "no/a.png"),
        ("pattern -o a.png --sede 3", "--seed"),
        ("stats missing.png", "missing.png"),
        ("stats text.png", "text.png"),
        ("stats a.toml", "a.toml"),
        ("render missing.toml", "missing.toml"),
        ("render a.toml --spp 0", "0"),
        ("render a.toml --white-level 0", "positive"),
        ("render a.toml -o text.png/out", "text.png/out"),
        ("rendr a.toml", "render"),
    ] {
        let output = run(path, line);
        assert_code(&output, 2);
        assert!(
            message(&output).contains(part),
            "{line}: {}",
            message(&output)
        );
        assert!(output.stdout.is_empty(), "{line}: nothing is data");
        assert_eq!(files(path), before, "{line}");
    }
}

#[test]
fn bad_scenes_are_located_and_leave_no_folder() {
    for (good, bad, part) in [
        ("wavelength", "wave_length", "wavelength"),
        ("\"650 nm\"", "\"-650 nm\"", "-650"),
        ("wavelength = \"650 nm\"", "", "wavelength"),
        ("\"0.2 mm\"", "\"0.2 kg\"", "kg"),
        ("[48, 40]", "[1000000, 1000000]", "1000000"),
        (
            "samples_per_pixel = 4",
            "samples_per_pixel = 0",
            "samples_per_pixel",
        ),
        (
            "[render]",
            "[speckle]\nsize = 64\ndiameter = 48\n[render]",
            "48",
        ),
        (
            "rectangle = { centre",
            "mesh = { file = \"no.ply\" }\n#",
            "no.ply",
        ),
        ("[camera]", "[camera", "TOML"),
    ] {
        let folder = folder();
        let scene = SCENE.replacen(good, bad, 1);
        assert_ne!(scene, SCENE, "{good} is replaced");
        fs::write(folder.path().join("a.toml"), scene).expect("written");
        let output = run(folder.path(), "render a.toml");
        assert_code(&output, 2);
        let message = message(&output);
        assert!(
            message.contains("a.toml") && message.contains(part),
            "{bad}: {message}"
        );
        assert_eq!(files(folder.path()), ["a.toml"], "{bad}");
    }
}

#[test]
fn a_render_writes_preview_layers_and_summary() {
    let folder = scene_folder();
    let output = run(folder.path(), "render a.toml --seed 5");
    assert_code(&output, 0);
    let out = folder.path().join("out").join("a");
    assert_eq!(files(&out), ["a.exr", "a.json", "a.png"]);
    assert_eq!(
        text(&output.stdout).lines().count(),
        3,
        "the names of the files are the data"
    );

    let summary = fs::read(out.join("a.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    assert_eq!(summary["seed"], 5);
    assert_eq!(summary["samples"], 48 * 40 * 4);
    // h = λ d / D = 650 nm · 27.27 mm / 3.125 mm = 5.67 µm, 1.64 pixels of 3.45 µm.
    let size = summary["lasers"][0]["pattern"]["speckle_size_pixels"].as_f64();
    assert!((size.expect("a size") - 1.644).abs() < 0.005, "{size:?}");
    assert!(
        summary["exposure"]["white_level_w_per_m2_sr"].as_f64() > Some(0.0),
        "{summary}"
    );
}

#[test]
fn files_do_not_depend_on_the_number_of_threads() {
    let folder = scene_folder();
    for threads in [1, 3] {
        let line = format!("render a.toml -o {threads} --threads {threads}");
        assert_code(&run(folder.path(), &line), 0);
    }
    for name in ["a.png", "a.exr"] {
        let file = |threads: &str| fs::read(folder.path().join(threads).join(name));
        let (one, three) = (file("1").expect("written"), file("3").expect("written"));
        assert!(one == three, "{name} differs");
    }
}

#[test]
fn without_speckle_the_factor_is_one() {
    let folder = scene_folder();
    assert_code(&run(folder.path(), "render a.toml -o . --no-speckle"), 0);
    // The factor is even, which is no speckle to measure.
    let output = run(folder.path(), "stats a.exr --channel laser_0.speckle");
    assert_code(&output, 2);
    assert!(
        message(&output).contains("all of them are 1"),
        "{}",
        message(&output)
    );
}

/// Returns what a preview says about its exposure.
fn exposure(preview: &Path) -> String {
    let file = fs::File::open(preview).expect("a preview");
    let reader = png::Decoder::new(std::io::BufReader::new(file)).read_info();
    let reader = reader.expect("a PNG");
    let mut texts = reader.info().utf8_text.iter();
    let chunk = texts.find(|chunk| chunk.keyword == "Exposure");
    chunk
        .expect("the exposure is stated")
        .get_text()
        .expect("UTF-8")
}

#[test]
fn frames_are_numbered_and_share_one_exposure() {
    let folder = folder();
    // The laser leaves the image, so that the second frame alone would be exposed differently.
    let moving = SCENE.replace(
        "[render]",
        "displacement_per_frame = [\"10.2 mm\", 0, 0]\n[render]\nframes = 2",
    );
    fs::write(folder.path().join("a.toml"), moving).expect("written");
    assert_code(&run(folder.path(), "render a.toml -o ."), 0);
    let names = [
        "a.json",
        "a.toml",
        "a_0000.exr",
        "a_0000.png",
        "a_0001.exr",
        "a_0001.png",
    ];
    assert_eq!(files(folder.path()), names);
    let [first, second] =
        ["a_0000.png", "a_0001.png"].map(|name| exposure(&folder.path().join(name)));
    assert!(first.contains("W/(m² sr)"), "{first}");
    assert_eq!(first, second);
}

#[test]
fn what_was_asked_for_is_in_the_summary() {
    let folder = scene_folder();
    let line = "render a.toml -o . --white-level 1e3 --paper --spp 2 --seed 9 --threads 1";
    assert_code(&run(folder.path(), line), 0);
    assert!(
        exposure(&folder.path().join("a.png")).contains("1e3 W"),
        "the exposure is stated"
    );
    let summary = fs::read(folder.path().join("a.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    assert_eq!(summary["exposure"]["white_level_w_per_m2_sr"], 1e3);
    assert_eq!(summary["formulas"], "as printed in Bergmann et al. 2016");
    assert_eq!(summary["samples_per_pixel"], 2);
    assert_eq!(summary["seed"], 9);
    assert_eq!(summary["threads"], 1);
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

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_render_cleanly() {
    use std::{thread::sleep, time::Duration};

    let folder = scene_folder();
    let child = tem00(folder.path(), "render a.toml -o out --spp 10000")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // The folder appears when the render is about to start, within seconds on a busy machine.
    let started = (0..6_000).any(|_| {
        sleep(Duration::from_millis(5));
        folder.path().join("out").exists()
    });
    assert!(started, "the render starts");
    sleep(Duration::from_millis(100));
    interrupt(&child);

    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 130);
    assert!(output.stdout.is_empty(), "nothing was written");
    assert!(
        files(&folder.path().join("out")).is_empty(),
        "nothing is left"
    );
}

/// Sends an interrupt, as Ctrl-C does.
#[cfg(unix)]
fn interrupt(child: &std::process::Child) {
    let interrupt = format!("kill -INT {}", child.id());
    let sent = Command::new("sh").args(["-c", &interrupt]).status();
    assert!(sent.expect("a shell").success(), "the signal is sent");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_pattern_without_a_file() {
    use std::{thread::sleep, time::Duration};

    let folder = folder();
    write_field(&folder.path().join("field.npy"), 20, 20);
    // The program waits for the field of a pipe, so that the signal meets it before any pass.
    let made = Command::new("mkfifo")
        .arg(folder.path().join("pipe"))
        .status();
    assert!(made.expect("mkfifo").success(), "a pipe is made");
    let child = tem00(folder.path(), "pattern -o a.npy --field pipe")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut pipe = fs::File::create(folder.path().join("pipe")).expect("the program opens it");
    interrupt(&child);
    sleep(Duration::from_millis(200));
    let field = fs::read(folder.path().join("field.npy")).expect("the field");
    pipe.write_all(&field).expect("the program reads on");
    drop(pipe);

    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 130);
    assert!(output.stdout.is_empty(), "nothing was measured");
    assert_eq!(files(folder.path()), ["field.npy", "pipe"]);
}

#[test]
fn a_picture_without_laser_light_says_where_things_stand() {
    let folder = folder();
    let away = SCENE.replace("centre = [0, 0, 0]", "centre = [\"70 mm\", 0, 0]");
    fs::write(folder.path().join("a.toml"), away).expect("written");
    let output = run(folder.path(), "render a.toml --spp 1");
    assert_code(&output, 0);
    let notes = text(&output.stderr);
    assert!(notes.contains("sees no light of a laser"), "{notes}");
    assert!(notes.contains("surface 1: x 60.0 … 80.0 mm"), "{notes}");
}
