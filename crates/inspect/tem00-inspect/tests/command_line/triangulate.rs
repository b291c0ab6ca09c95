//! `tem00-inspect triangulate`.

use super::*;

fn record(folder: &Path) -> Value {
    json(&read(&folder.join("measurement.json")))
}

/// Asserts which files are in a folder.
#[track_caller]
fn assert_files(folder: &Path, there: &str, absent: &str) {
    let found = files(folder);
    let has = |name: &&str| found.iter().any(|file| file == name);
    let missing: Vec<&str> = there.split(' ').filter(|name| !has(name)).collect();
    assert!(missing.is_empty(), "{missing:?} is not in {found:?}");
    let left: Vec<&str> = absent.split(' ').filter(has).collect();
    assert!(left.is_empty(), "{left:?} is in {found:?}");
}

#[test]
fn a_scan_leaves_all_its_files() {
    let folder = written(SCAN);
    let table = said(folder.path(), "triangulate a.toml", 0).out;
    let parts = ["speckle", "calibration", "combined", "out/a/report.html"];
    assert_has(&table, &parts);
    assert_has(&table, &["Speckle from frame to frame: "]);
    let results = folder.path().join("out/a");
    // Columns of an image have no size on the part, which X3P wants.
    assert_files(
        &results,
        "height.npy height.png height_map.svg height_uncertainty.npy measurement.json points.pcd \
         points.ply profile.png profile_0003.csv raw_0003.png reflectance.png report.html \
         uncertainty_map.png width.png",
        "height.x3p",
    );
    let record = record(&results);
    assert_eq!(record["frames"].as_array().map(Vec::len), Some(4));
    let speckle = &record["speckle"]["between_frames"];
    let [across, down] = [0, 1].map(|axis| number(&speckle["displacement"][axis]));
    // The camera looks down at 30° to the vertical and images 0.2 mm · cos 30° at 1:11, upwards.
    let expected = -0.2e-3 * 0.75_f64.sqrt() / 11.0 / 3.45e-6;
    assert!(
        across.abs() < 0.05 && (down - expected).abs() < 0.05,
        "{speckle}"
    );
    // One millimetre, and the noise of single points: 35 µm of standard deviation.
    let [low, high] = [0, 1].map(|end| number(&record["height_map"]["range"][end]));
    assert!(
        low.abs() < 2e-4 && (high - 1e-3).abs() < 2e-4,
        "{low} to {high}"
    );
}

#[test]
fn light_of_a_second_surface_is_told() {
    // A wall along the scan at the end of a plate.
    let wall = "[[surface]]\nlambertian.reflectance = 0.9\n\
                rectangle = { centre = [0, 0, \"10 mm\"], normal = [-1, 0, 0], \
                size = [\"80 mm\", \"20 mm\"] }\n[sensor]";
    let with_wall = replaced(SCAN, "[sensor]", wall);
    for (scene, is_told) in [(SCAN, false), (&*with_wall, true)] {
        let folder = written(scene);
        let table = said(folder.path(), "triangulate a.toml --frames 1 --spp 16", 0).out;
        assert_has(&table, &["indirect light"]);
        assert_eq!(
            table.contains("came by a second surface"),
            is_told,
            "{table}"
        );
        let found = record(&folder.path().join("out/a"));
        let fraction = number(&found["uncertainty"]["indirect_points"]);
        assert_eq!(fraction > 0.02, is_told, "{fraction}");
    }
}

#[test]
fn profiles_are_tables_with_uncertainties() {
    let folder = written(SCAN);
    said(
        folder.path(),
        "triangulate a.toml --frames 1 -o r --spp 8",
        0,
    );
    let table = read(&folder.path().join("r/profile_0000.csv"));
    let mut rows = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let headings = rows.next().expect("headings");
    let column = |name: &str| {
        headings
            .iter()
            .position(|heading| *heading == name)
            .expect(name)
    };
    let rows: Vec<_> = rows.collect();
    assert!(rows.len() >= 40, "{} of 48 columns", rows.len());
    for row in rows {
        assert_eq!(row.len(), headings.len(), "{row:?}");
        let number = |name: &str| row[column(name)].parse::<f64>().expect("a number");
        assert!((1e-5..1e-4).contains(&number("u_height_m")), "{row:?}");
        assert!((-2e-4..1.2e-3).contains(&number("height_m")), "{row:?}");
    }
    // One profile is no map.
    assert_files(
        &folder.path().join("r"),
        "report.html",
        "height.npy height.png height_map.svg",
    );
}

#[test]
fn where_the_noise_of_a_detector_is_not_first_order_its_u_is_called_too_large() {
    let folder = written(SCAN);
    for (method, ratios) in [
        ("centre_of_gravity", 0.9..1.1),
        ("parabola", 1.3..1.6),
        ("linear_interpolation", 1.8..2.2),
        ("steger", 1.7..2.5),
    ] {
        let line = format!(
            "triangulate a.toml --set 'camera.resolution=[320, 56]' --set detector.method={method}"
        );
        let table = said(folder.path(), &line, 0).out;
        let is_told = table.contains("times too large for this detector");
        assert_eq!(is_told, ratios.start > 1.0, "{method}: {table}");
        let out = folder.path().join("out/a");
        let combined = number(&record(&out)["uncertainty"]["combined"]);
        let ratio = combined / rms_error(&out);
        assert!(ratios.contains(&ratio), "{method}: {ratio}");
    }
}

/// Returns the root mean square error of the heights of two plates, beside the step of a millimetre
/// between them, in metres.
fn rms_error(folder: &Path) -> f64 {
    let mut squares = Vec::new();
    for frame in 0..4 {
        let table = read(&folder.join(format!("profile_{frame:04}.csv")));
        for row in table.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let [x, height] = [7, 10].map(|cell| cells[cell].parse::<f64>().unwrap_or(0.0));
            let truth = if x > 0.0 { 1e-3 } else { 0.0 };
            if x.abs() > 1e-3 {
                squares.push((height - truth).powi(2));
            }
        }
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn results_depend_on_the_seed_and_on_speckle() {
    let folder = written(SCAN);
    let cloud = |options: &str, out: &str| {
        let line = format!("triangulate a.toml --frames 0..1 {options} -o {out}");
        said(folder.path(), &line, 0);
        fs::read(folder.path().join(out).join("points.ply")).expect("the cloud")
    };
    let one = cloud("", "one");
    assert_ne!(one, cloud("--seed 5", "other"));
    assert_ne!(one, cloud("--no-speckle", "quiet"));
    assert!(record(&folder.path().join("quiet"))["speckle"].is_null());
}

#[test]
fn without_a_valid_point_there_is_no_number() {
    let folder = written(SCAN);
    said(folder.path(), "triangulate a.toml", 0);
    let dark = ["no line was found", "raise `exposure`"];
    for (exposure, frames, parts) in [
        ("1 ns", "0..3", dark),
        ("5 ms", "0..3", ["saturated pixels", "lower `exposure`"]),
        ("1 ns", "2", dark),
    ] {
        let options = format!("--frames {frames} --set 'sensor.exposure={exposure}'");
        let Said { out, told } = said(folder.path(), &format!("triangulate a.toml {options}"), 3);
        assert_has(&told, &parts);
        assert!(!out.contains("0.000") && !out.contains("expanded"), "{out}");
        let results = folder.path().join("out/a");
        // None of before.
        assert_files(
            &results,
            "raw_0002.png report.html points.ply profile_0000.csv",
            "height.png height.npy height_map.svg reflectance.png terms.png profile.svg",
        );
        let page = read(&results.join("report.html"));
        assert_has(&page, &["Nothing was measured"]);
        assert!(!page.contains("U ="), "{page}");
        let record = record(&results);
        let uncertainty = &record["uncertainty"];
        for value in [
            &uncertainty["combined"],
            &uncertainty["expanded"],
            &record["average"]["effective_frames"],
            &record["height_map"],
        ] {
            assert!(value.is_null(), "{record}");
        }
        assert_eq!(uncertainty["points"], 0, "{uncertainty}");
        let reason = uncertainty["reason"].as_str().expect("a reason");
        assert!(told.contains(reason), "{uncertainty}");
    }
}

#[test]
fn points_on_saturated_pixels_are_told_and_most_of_them_are_no_result() {
    let folder = written(SCAN);
    let mut seen = [false; 3];
    // From no saturated point to two thirds of them.
    for exposure in ["0.1", "0.2", "0.3", "0.5"] {
        let options = format!("--frames 0..1 --set 'sensor.exposure={exposure} ms'");
        let mut program = tem00(folder.path(), "triangulate a.toml");
        let output = program.args(words(&options)).output();
        let output = output.expect("the program starts");
        let record = record(&folder.path().join("out/a"));
        let sum = |key: &str| -> f64 {
            let frames = record["frames"].as_array().expect("frames");
            frames.iter().map(|frame| number(&frame[key])).sum()
        };
        let fraction = sum("saturated") / sum("points");
        let [is_told, is_refused] = [fraction > 0.05, fraction > 0.5];
        seen[usize::from(is_told) + usize::from(is_refused)] = true;
        assert_code(&output, if is_refused { 3 } else { 0 });
        let sentence = format!("{:.0} % because pixels are saturated", 100.0 * fraction);
        let table = text(&output.stdout);
        for (part, is_there, place) in [
            (&*sentence, is_told, &record["warnings"].to_string()),
            (&sentence, is_told, &message(&output)),
            ("U = ", !is_refused, &table),
            (&sentence, is_told && !is_refused, &table),
        ] {
            assert_eq!(
                place.contains(part),
                is_there,
                "{exposure}, {part}: {place}"
            );
        }
        let expanded = &record["uncertainty"]["expanded"];
        assert_eq!(expanded.is_null(), is_refused, "{record}");
    }
    assert_eq!(seen, [true; 3], "none, some and most");
}

#[test]
fn height_maps_may_be_tiff_and_square() {
    let scan = "[scan]\npitch = \"0.3 mm\"\nraw = \"tiff\"\n\
                average = { frames = 2, columns = 2 }\n[render]";
    let folder = written(&replaced(SCAN, "[render]", scan));
    said(folder.path(), "triangulate a.toml", 0);
    let results = folder.path().join("out/a");
    assert_files(
        &results,
        "height.tiff height.x3p raw_0000.tiff profile_0001.csv",
        "height.png",
    );
    let record = record(&results);
    assert_eq!(record["profiles"], 2);
    assert_eq!(record["height_map"]["pitch"], 3e-4);
    assert!(
        number(&record["average"]["effective_frames"]) > 1.0,
        "{record}"
    );
}

#[test]
fn a_measurement_warns_of_a_dark_image_as_well() {
    let folder = written(SCAN);
    // The plates end 10 mm from the middle.
    let line = "triangulate a.toml --frames 0 --no-speckle --set 'laser[0].look_at=[0, 0.09, 0]'";
    assert_has(
        &said(folder.path(), line, 3).told,
        &["misses every surface"],
    );
}
