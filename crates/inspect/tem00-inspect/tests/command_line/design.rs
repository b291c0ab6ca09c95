//! `tem00-inspect design`: searches among set-ups.

use std::fs;

use tem00_triangulation::{Budget, read_setup};

use super::*;

fn record(folder: &tempfile::TempDir) -> Value {
    json(&read(&folder.path().join("out/a/design.json")))
}

#[test]
fn a_best_line_below_two_speckles_sends_for_trials() {
    let folder = written(DESIGN);
    for (thickness, is_thin) in [("2e-5", true), ("2e-4", false)] {
        let options = format!("--set laser.line_thickness={thickness} --set laser.power=1e-3");
        let printed = said(folder.path(), &format!("design a.toml {options}"), 0).out;
        let told = printed.contains("ask the trials of `tem00-inspect budget`");
        assert_eq!(told, is_thin, "{thickness}: {printed}");
    }
}

#[test]
fn a_search_over_linewidths_says_what_each_leaves_of_noise_and_contrast() {
    let folder = written(DESIGN);
    let linewidths = "--set 'design.vary.linewidth=[\"1 nm\", \"20 nm\"]'";
    let table = said(
        folder.path(),
        &format!("design a.toml --best 2 {linewidths}"),
        0,
    )
    .out;
    let columns = [
        "line noise over one wavelength",
        "contrast over one wavelength",
    ];
    assert_has(&table, &columns);
    let out = folder.path().join("out/a");
    let winner = read_setup(&out.join("best.toml")).expect("a set-up file");
    let effect = winner.line().bandwidth;
    let best = &record(&folder)["best"][0];
    assert_eq!(best["linewidth"], 20e-9, "{best}");
    assert_eq!(best["line_noise_ratio"], effect.line_noise_ratio, "{best}");
    assert_eq!(best["contrast_ratio"], effect.contrast, "{best}");
    let words = "(enters the uncertainty)";
    assert_has(&read(&out.join("design.html")), &[words]);
    let table = said(folder.path(), "design a.toml --best 2", 0).out;
    assert!(!table.contains("contrast over"), "one wavelength: {table}");
}

#[test]
fn a_search_writes_its_files_and_a_winner_that_reads_back() {
    let folder = written(DESIGN);
    let require = "--set design.require.saturation=0.9 --set 'design.require.depth_of_field=15 mm'";
    said(
        folder.path(),
        &format!("design a.toml --best 2 {require}"),
        0,
    );
    let out = folder.path().join("out/a");
    let mut expected = ["best.toml", "design.csv", "design.html", "design.json"]
        .map(str::to_owned)
        .to_vec();
    for name in ["over_angle", "over_f_number", "sensitivity", "trade_off"] {
        expected.extend(["png", "svg"].map(|end| format!("{name}.{end}")));
    }
    assert_eq!(files(&out), expected);

    let page = read(&out.join("design.html"));
    reports::check(&page);
    assert_eq!(reports::headings(&page)[0], "The best set-ups");
    // Speckle is in both diagrams over a parameter.
    assert!(page.matches(">speckle</text>").count() >= 2);

    let written = read(&out.join("best.toml"));
    assert_has(
        &written,
        &["exposure = \"0.05 ms\"\n", "angle = \"40 deg\" #"],
    );
    // The winner is a set-up file, and its budget is what the search says of it, bit by bit.
    let winner = read_setup(&out.join("best.toml")).expect("a set-up file");
    let budget = Budget::new(&winner).expect("the line is found");
    let found = record(&folder);
    assert_eq!(found["best"].as_array().map(Vec::len), Some(2), "{found}");
    let uncertainty = found["best"][0]["uncertainty"].as_f64();
    assert_eq!(uncertainty, Some(budget.combined()), "{found}");
    said(folder.path(), "budget out/a/best.toml --trials 20", 0);

    let csv = read(&out.join("design.csv"));
    assert_eq!(csv.lines().count(), 7, "a line of headings and six set-ups");
    let headings = "number,f_number,angle_rad,uncertainty_m,";
    assert!(csv.starts_with(headings), "{csv}");
    let columns: Vec<_> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(columns.iter().all(|&count| count == columns[0]), "{csv}");
}

#[test]
fn where_no_set_up_will_do_there_is_no_winner() {
    let folder = written(DESIGN);
    let out = folder.path().join("out/a");
    fs::create_dir_all(&out).expect("a folder");
    fs::write(out.join("best.toml"), "the winner of another search").expect("written");
    let line = "design a.toml --json --set 'design.require.field_width=2 m'";
    let printed = json(&said(folder.path(), line, 3).out);
    assert!(
        !out.join("best.toml").exists(),
        "the winner of another search"
    );
    assert!(!read(&out.join("design.html")).contains("best.toml"));
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
    let (setup, _) = DESIGN.split_once("[design.vary]").expect("the set-up");
    let vary = "[design.vary]\nf_number = [4, 5.6, 8, 11]\n";
    let exposures =
        "exposure = { from = \"0.02 ms\", to = \"0.64 ms\", steps = 6, scale = \"log\" }";
    let folder = folder();
    for (name, text) in [
        ("fixed", format!("{setup}{vary}{exposures}")),
        ("auto", replaced(setup, "\"0.05 ms\"", "\"auto\"") + vary),
    ] {
        fs::write(folder.path().join(format!("{name}.toml")), text).expect("written");
        said(folder.path(), &format!("design {name}.toml"), 0);
        let line = format!("budget out/{name}/best.toml --trials 20 -o {name}");
        let told = said(folder.path(), &line, 0).out;
        assert_has(&told, &["in the brightest pixel: good\n"]);
        assert!(!told.contains("The light is not right"), "{told}");
        // The frames of the trials are drawn and exposed: few columns lose their line to bright
        // grains.
        let record = json(&read(&folder.path().join(name).join("budget.json")));
        assert!(number(&record["trials"]["invalid"]) < 0.1, "{record}");
        let best = read(&folder.path().join(format!("out/{name}/best.toml")));
        let chosen = best.contains("exposure = \"auto\" # ");
        assert_eq!(chosen, name == "auto", "{best}");
        let is_long = |word: &str| word.bytes().filter(u8::is_ascii_digit).count() > 6;
        assert!(!best.split_whitespace().any(is_long), "{best}");
    }
}
