//! `tem00-inspect triangulate`.

use std::{fs, path::Path};

use serde_json::Value;

use super::{assert_code, files, folder, message, run, tem00, text};

/// Two plates, a millimetre apart, that move under a line in four frames.
pub(super) const SCAN: &str = include_str!("../cmd/files/scan.toml");

fn written(scene: &str) -> tempfile::TempDir {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), scene).expect("the scene is written");
    folder
}

fn record(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("measurement.json")).expect("the record is there");
    serde_json::from_str(&text).expect("the record is JSON")
}

#[test]
fn a_scan_leaves_all_its_files() {
    let folder = written(SCAN);
    let output = run(folder.path(), "triangulate a.toml");
    assert_code(&output, 0);
    let table = text(&output.stdout);
    for part in ["speckle", "calibration", "combined", "out/a/report.html"] {
        assert!(table.contains(part), "{part}: {table}");
    }
    let results = folder.path().join("out/a");
    let found = files(&results);
    for name in [
        "height.npy",
        "height.png",
        "height_map.svg",
        "height_uncertainty.npy",
        "measurement.json",
        "points.pcd",
        "points.ply",
        "profile.png",
        "profile_0003.csv",
        "raw_0003.png",
        "reflectance.png",
        "report.html",
        "uncertainty_map.png",
        "width.png",
    ] {
        assert!(found.iter().any(|file| file == name), "{name}: {found:?}");
    }
    assert!(
        !found.iter().any(|file| file == "height.x3p"),
        "columns of an image have no size on the part"
    );
    let record = record(&results);
    assert_eq!(record["frames"].as_array().map(Vec::len), Some(4));
    assert!(table.contains("Speckle from frame to frame: "), "{table}");
    let speckle = &record["speckle"]["between_frames"];
    let moved = |axis: usize| speckle["displacement"][axis].as_f64().expect("pixels");
    // The camera looks down at 30° to the vertical and images 0.2 mm · cos 30° at 1:11, upwards.
    let expected = -0.2e-3 * 0.75_f64.sqrt() / 11.0 / 3.45e-6;
    assert!(moved(0).abs() < 0.05, "{speckle}");
    assert!((moved(1) - expected).abs() < 0.05, "{speckle}");
    let range = record["height_map"]["range"].as_array().expect("heights");
    let height = |i: usize| range[i].as_f64().expect("a number");
    // One millimetre, and the noise of single points: 35 µm of standard deviation.
    assert!(
        height(0).abs() < 2e-4 && (height(1) - 1e-3).abs() < 2e-4,
        "{range:?}"
    );
}

#[test]
fn light_of_a_second_surface_is_told() {
    // A wall along the scan at the end of a plate.
    let wall = "[[surface]]\nlambertian.reflectance = 0.9\n\
                rectangle = { centre = [0, 0, \"10 mm\"], normal = [-1, 0, 0], size = [\"80 mm\", \"20 mm\"] }\n[sensor]";
    let with_wall = SCAN.replacen("[sensor]", wall, 1);
    for (scene, is_told) in [(SCAN, false), (&*with_wall, true)] {
        let folder = written(scene);
        let output = run(folder.path(), "triangulate a.toml --frames 1 --spp 16");
        assert_code(&output, 0);
        let table = text(&output.stdout);
        assert!(table.contains("indirect light"), "{table}");
        assert_eq!(
            table.contains("came by a second surface"),
            is_told,
            "{table}"
        );
        let found = &record(&folder.path().join("out/a"))["uncertainty"]["indirect_points"];
        let fraction = found.as_f64().expect("a fraction");
        assert_eq!(fraction > 0.02, is_told, "{fraction}");
    }
}

#[test]
fn profiles_are_tables_with_uncertainties() {
    let folder = written(SCAN);
    let output = run(folder.path(), "triangulate a.toml --frames 1 -o r --spp 8");
    assert_code(&output, 0);
    let path = folder.path().join("r/profile_0000.csv");
    let table = fs::read_to_string(path).expect("the profile is there");
    let mut lines = table.lines();
    let headings: Vec<&str> = lines.next().expect("headings").split(',').collect();
    let column = |name: &str| headings.iter().position(|heading| *heading == name);
    let (height, u) = (column("height_m"), column("u_height_m"));
    let (height, u) = (height.expect("heights"), u.expect("uncertainties"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert!(rows.len() >= 40, "{} of 48 columns", rows.len());
    for row in rows {
        assert_eq!(row.len(), headings.len(), "{row:?}");
        let number = |index: usize| row[index].parse::<f64>().expect("a number");
        assert!((1e-5..1e-4).contains(&number(u)), "{row:?}");
        assert!((-2e-4..1.2e-3).contains(&number(height)), "{row:?}");
    }
    let found = files(&folder.path().join("r"));
    assert!(
        !found.iter().any(|name| name.starts_with("height")),
        "one profile is no map"
    );
}

#[test]
fn results_do_not_depend_on_the_threads_but_on_the_seed() {
    let folder = written(SCAN);
    let cloud = |line: &str, out: &str| {
        assert_code(
            &run(
                folder.path(),
                &format!("triangulate a.toml --frames 0..1 {line} -o {out}"),
            ),
            0,
        );
        fs::read(folder.path().join(out).join("points.ply")).expect("the cloud is there")
    };
    let one = cloud("--threads 1", "one");
    assert_eq!(one, cloud("--threads 3", "three"));
    assert_ne!(one, cloud("--seed 5", "other"));
    assert_ne!(one, cloud("--no-speckle", "quiet"));
    assert!(record(&folder.path().join("quiet"))["speckle"].is_null());
}

#[test]
fn without_a_valid_point_there_is_no_number() {
    let folder = written(SCAN);
    assert_code(&run(folder.path(), "triangulate a.toml"), 0);
    for (exposure, frames, parts) in [
        ("1 ns", "0..3", ["no line was found", "raise `exposure`"]),
        ("5 ms", "0..3", ["saturated pixels", "lower `exposure`"]),
        ("1 ns", "2", ["no line was found", "raise `exposure`"]),
    ] {
        fs::write(
            folder.path().join("a.toml"),
            SCAN.replace("0.1 ms", exposure),
        )
        .expect("written");
        let output = run(
            folder.path(),
            &format!("triangulate a.toml --frames {frames}"),
        );
        assert_code(&output, 3);
        let told = message(&output);
        assert!(
            parts.iter().all(|part| told.contains(part)),
            "{exposure}: {told}"
        );
        let table = text(&output.stdout);
        assert!(
            !table.contains("0.000") && !table.contains("expanded"),
            "{table}"
        );

        let results = folder.path().join("out/a");
        let found = files(&results);
        for name in [
            "raw_0002.png",
            "report.html",
            "points.ply",
            "profile_0000.csv",
        ] {
            assert!(found.iter().any(|file| file == name), "{name}: {found:?}");
        }
        for name in [
            "height.png",
            "height.npy",
            "height_map.svg",
            "reflectance.png",
            "terms.png",
            "profile.svg",
        ] {
            assert!(
                !found.iter().any(|file| file == name),
                "{name} of before: {found:?}"
            );
        }
        let page = fs::read_to_string(results.join("report.html")).expect("the report");
        assert!(
            page.contains("Nothing was measured") && !page.contains("U ="),
            "{page}"
        );
        let record = record(&results);
        let uncertainty = &record["uncertainty"];
        for key in ["combined", "expanded"] {
            assert!(uncertainty[key].is_null(), "{key}: {uncertainty}");
        }
        assert_eq!(uncertainty["points"], 0, "{uncertainty}");
        assert!(
            uncertainty["reason"]
                .as_str()
                .is_some_and(|reason| told.contains(reason)),
            "{uncertainty}"
        );
        assert!(record["average"]["effective_frames"].is_null(), "{record}");
        assert!(record["height_map"].is_null(), "{record}");
    }
}

#[test]
fn points_on_saturated_pixels_are_told_and_most_of_them_are_no_result() {
    let folder = folder();
    let mut seen = [false; 3];
    // From no saturated point to two thirds of them.
    for exposure in ["0.1 ms", "0.2 ms", "0.3 ms", "0.5 ms"] {
        let scene = SCAN.replace("0.1 ms", exposure);
        fs::write(folder.path().join("a.toml"), scene).expect("written");
        let output = run(folder.path(), "triangulate a.toml --frames 0..1");
        let record = record(&folder.path().join("out/a"));
        let sum = |key: &str| {
            let frames = record["frames"].as_array().expect("frames");
            frames
                .iter()
                .filter_map(|frame| frame[key].as_f64())
                .sum::<f64>()
        };
        let fraction = sum("saturated") / sum("points");
        let [is_told, is_refused] = [fraction > 0.05, fraction > 0.5];
        seen[usize::from(is_told) + usize::from(is_refused)] = true;
        assert_code(&output, if is_refused { 3 } else { 0 });
        let sentence = format!("{:.0} % because pixels are saturated", 100.0 * fraction);
        assert_eq!(
            record["warnings"].to_string().contains(&sentence),
            is_told,
            "{record}"
        );
        assert_eq!(message(&output).contains(&sentence), is_told, "{exposure}");
        let table = text(&output.stdout);
        assert_eq!(table.contains("U = "), !is_refused, "{exposure}: {table}");
        assert_eq!(
            table.contains(&sentence),
            is_told && !is_refused,
            "{exposure}: {table}"
        );
        assert_eq!(
            record["uncertainty"]["expanded"].is_null(),
            is_refused,
            "{record}"
        );
    }
    assert_eq!(seen, [true; 3], "none, some and most");
}

#[test]
fn height_maps_may_be_tiff_and_square() {
    let scan = "[scan]\npitch = \"0.3 mm\"\nraw = \"tiff\"\naverage = { frames = 2, columns = 2 }\n[render]";
    let folder = written(&SCAN.replace("[render]", scan));
    assert_code(&run(folder.path(), "triangulate a.toml"), 0);
    let results = folder.path().join("out/a");
    let found = files(&results);
    for name in [
        "height.tiff",
        "height.x3p",
        "raw_0000.tiff",
        "profile_0001.csv",
    ] {
        assert!(found.iter().any(|file| file == name), "{name}: {found:?}");
    }
    let record = record(&results);
    assert_eq!(record["profiles"], 2);
    assert_eq!(record["height_map"]["pitch"], 3e-4);
    assert!(
        record["average"]["effective_frames"].as_f64() > Some(1.0),
        "{record}"
    );
}

#[test]
fn a_measurement_warns_of_a_dark_image_as_well() {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), SCAN).expect("written");
    let mut command = tem00(folder.path(), "triangulate a.toml --frames 0 --no-speckle");
    // The plates end 10 mm from the middle.
    let output = command
        .args(["--set", "laser[0].look_at=[0, 0.09, 0]"])
        .output();
    let output = output.expect("the program starts");
    assert_code(&output, 3);
    let said = text(&output.stderr);
    assert!(said.contains("misses every surface"), "{said}");
}
