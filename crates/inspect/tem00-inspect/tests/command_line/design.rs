//! `tem00-inspect design`: searches among set-ups.

use std::{fs, path::Path};

use tem00_triangulation::{Budget, read_setup};

use super::{assert_code, files, folder, run, text};

pub(super) const SETUP: &str = include_str!("../cmd/files/design.toml");

fn setup_folder(require: &str) -> tempfile::TempDir {
    let folder = folder();
    let text = format!("{SETUP}\n[design.require]\n{require}\n");
    fs::write(folder.path().join("a.toml"), text).expect("the set-up is written");
    folder
}

fn json(path: &Path) -> serde_json::Value {
    let text = fs::read_to_string(path).expect("the file is there");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_best_line_below_two_speckles_sends_for_trials() {
    for (thickness, is_thin) in [("2e-5", true), ("2e-4", false)] {
        let folder = setup_folder("");
        let line =
            format!("design a.toml --set laser.line_thickness={thickness} --set laser.power=1e-3");
        let output = run(folder.path(), &line);
        assert_code(&output, 0);
        let told = text(&output.stdout).contains("ask the trials of `tem00-inspect budget`");
        assert_eq!(told, is_thin, "{thickness}: {}", text(&output.stdout));
    }
}

#[test]
fn a_search_over_linewidths_says_what_each_leaves_of_noise_and_contrast() {
    let folder = folder();
    let file = folder.path().join("a.toml");
    let broad = SETUP.replace("angle = [", "linewidth = [\"1 nm\", \"20 nm\"]\nangle = [");
    fs::write(&file, broad).expect("the set-up is written");
    let output = run(folder.path(), "design a.toml --best 2");
    assert_code(&output, 0);
    let (report, table) = (
        json(&folder.path().join("out/a/design.json")),
        text(&output.stdout),
    );
    for column in [
        "line noise over one wavelength",
        "contrast over one wavelength",
    ] {
        assert!(table.contains(column), "{column}: {table}");
    }
    let winner = read_setup(&folder.path().join("out/a/best.toml")).expect("a set-up file");
    let effect = winner.line().bandwidth;
    let best = &report["best"][0];
    assert_eq!(best["linewidth"], 20e-9, "{best}");
    assert_eq!(best["line_noise_ratio"], effect.line_noise_ratio, "{best}");
    assert_eq!(best["contrast_ratio"], effect.contrast, "{best}");
    let words = "of the noise of the line, which counts for the uncertainty";
    let page = fs::read_to_string(folder.path().join("out/a/design.html")).expect("text");
    assert!(page.contains(words), "{words}");

    fs::write(&file, SETUP).expect("the set-up is written");
    let output = run(folder.path(), "design a.toml --best 2");
    assert_code(&output, 0);
    let table = text(&output.stdout);
    assert!(!table.contains("contrast over"), "one wavelength: {table}");
}

#[test]
fn a_search_writes_its_files_and_a_winner_that_reads_back() {
    let folder = setup_folder("saturation = 0.9\ndepth_of_field = \"15 mm\"");
    let output = run(folder.path(), "design a.toml --best 2");
    assert_code(&output, 0);
    let out = folder.path().join("out/a");
    let mut expected = vec!["best.toml", "design.csv", "design.html", "design.json"];
    let drawings = [
        "over_angle.png",
        "over_angle.svg",
        "over_f_number.png",
        "over_f_number.svg",
        "sensitivity.png",
        "sensitivity.svg",
        "trade_off.png",
        "trade_off.svg",
    ];
    expected.extend(drawings);
    assert_eq!(files(&out), expected);

    let written = fs::read_to_string(out.join("best.toml")).expect("text");
    assert!(
        written.contains("exposure = \"0.05 ms\"\n") && written.contains("angle = \"40 deg\" #"),
        "{written}"
    );
    // The winner is a set-up file, and its budget is what the search says of it, bit by bit.
    let winner = read_setup(&out.join("best.toml")).expect("a set-up file");
    let budget = Budget::new(&winner).expect("the line is found");
    let found = json(&out.join("design.json"));
    let best = found["best"].as_array().expect("a list");
    assert_eq!(best.len(), 2, "{found}");
    let uncertainty = best[0]["uncertainty"].as_f64();
    assert_eq!(uncertainty, Some(budget.combined()), "{found}");
    assert_code(&run(folder.path(), "budget out/a/best.toml --trials 20"), 0);

    let csv = fs::read_to_string(out.join("design.csv")).expect("text");
    assert_eq!(csv.lines().count(), 7, "a line of headings and six set-ups");
    assert!(
        csv.starts_with("number,f_number,angle_rad,uncertainty_m,"),
        "{csv}"
    );
    let columns: Vec<_> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(columns.iter().all(|&count| count == columns[0]), "{csv}");
}

#[test]
fn where_no_set_up_will_do_there_is_no_winner() {
    let folder = setup_folder("field_width = \"2 m\"");
    fs::create_dir_all(folder.path().join("out/a")).expect("a folder");
    let best = folder.path().join("out/a/best.toml");
    fs::write(&best, "the winner of another search").expect("written");
    let output = run(folder.path(), "design a.toml");
    assert_code(&output, 3);
    assert!(!best.exists(), "the winner of another search");
    let page = fs::read_to_string(folder.path().join("out/a/design.html")).expect("text");
    assert!(!page.contains("best.toml"), "{page}");
    let printed = run(folder.path(), "design a.toml --json");
    assert_code(&printed, 3);
    let printed: serde_json::Value = serde_json::from_slice(&printed.stdout).expect("JSON");
    assert_eq!(printed["allowed"], 0, "{printed}");
    assert_eq!(printed["best"], serde_json::json!([]), "{printed}");
    assert!(
        printed["nearest"][0]["uncertainty"].is_number(),
        "{printed}"
    );
}

#[test]
fn what_a_search_finds_best_has_good_light_in_its_budget() {
    // Steel: f-number by exposure, without a word on the light.
    let vary = "f_number = [4, 5.6, 8, 11]\n\
                exposure = { from = \"0.02 ms\", to = \"0.64 ms\", steps = 6, scale = \"log\" }";
    let (setup, _) = SETUP.split_once("[design.vary]").expect("the set-up");
    let folder = folder();
    let text_of = |exposure: &str, vary: &str| {
        let setup = setup.replace("\"0.05 ms\"", exposure);
        format!("{setup}[design.vary]\n{vary}\n")
    };
    for (name, exposure, vary) in [
        ("fixed", "\"0.05 ms\"", vary),
        ("auto", "\"auto\"", "f_number = [4, 5.6, 8, 11]"),
    ] {
        let file = folder.path().join(format!("{name}.toml"));
        fs::write(file, text_of(exposure, vary)).expect("written");
        assert_code(&run(folder.path(), &format!("design {name}.toml")), 0);
        let line = format!("budget out/{name}/best.toml --trials 20 -o {name}");
        let output = run(folder.path(), &line);
        assert_code(&output, 0);
        let told = text(&output.stdout);
        assert!(told.contains("in the brightest pixel: good\n"), "{told}");
        assert!(!told.contains("The light is not right"), "{told}");
        // The frames of the trials are drawn and exposed: few columns lose their line to bright grains.
        let record = json(&folder.path().join(name).join("budget.json"));
        assert!(record["trials"]["invalid"].as_f64() < Some(0.1), "{record}");
        let best = fs::read_to_string(folder.path().join(format!("out/{name}/best.toml")));
        let best = best.expect("text");
        let chosen = best.contains("exposure = \"auto\" # ");
        assert_eq!(chosen, name == "auto", "{best}");
        let is_long = |word: &str| word.bytes().filter(u8::is_ascii_digit).count() > 6;
        assert!(!best.split_whitespace().any(is_long), "{best}");
    }
}
