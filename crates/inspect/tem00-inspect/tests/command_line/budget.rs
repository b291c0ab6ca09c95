//! `tem00-inspect budget`.

use std::fs;

use serde_json::{Value, json};

use super::*;

const UNCERTAIN_ANGLE: &str =
    "--set 'camera.angle={ value = \"30 deg\", uncertainty = \"0.3 deg\" }'";

/// Returns the record of a budget with options, and what is printed.
#[track_caller]
fn budget(options: &str) -> (Value, String) {
    let folder = written(SETUP);
    let printed = said(folder.path(), &format!("budget a.toml {options}"), 0).out;
    (
        json(&read(&folder.path().join("out/a/budget.json"))),
        printed,
    )
}

#[test]
fn a_budget_is_a_table_and_five_files() {
    let folder = written(SETUP);
    said(folder.path(), "budget a.toml --trials 10", 0);
    let out = folder.path().join("out/a");
    let drawn = [
        "contributions.png",
        "contributions.svg",
        "over_range.png",
        "over_range.svg",
    ];
    assert_eq!(
        files(&out),
        [&["budget.html", "budget.json"][..], &drawn].concat()
    );
    let record = json(&read(&out.join("budget.json")));
    let terms = record["terms"].as_array().expect("terms");
    let squares = terms
        .iter()
        .map(|term| number(&term["contribution"]).powi(2));
    let combined = squares.sum::<f64>().sqrt();
    assert!(
        (number(&record["combined"]) / combined - 1.0).abs() < 1e-12,
        "{record}"
    );
    assert!(number(&terms[0]["by_trials"]) > 0.0, "{record}");
    assert!(
        terms[7]["by_trials"].is_null(),
        "the calibration is not tried: {record}"
    );
    assert_eq!(record["dominant"], "speckle");
    let page = read(&out.join("budget.html"));
    reports::check(&page);
    let headings = ["The budget", "The set-up", "The inputs", "Files"];
    assert_eq!(reports::headings(&page), headings);
    assert_has(&page, &["<svg", "line_thickness = &quot;0.2 mm&quot;"]);
    assert!(!page.contains("<script"), "there is nothing to turn");
}

#[test]
fn a_page_has_name_day_checksum_and_every_input_and_the_json_no_day() {
    let folder = written(&format!("title = \"Rig <7>\"\n{SETUP}"));
    let of_day = |seconds: &str| {
        let mut command = tem00(folder.path(), "budget a.toml --trials 10");
        command.env("SOURCE_DATE_EPOCH", seconds);
        command.output().expect("the program starts")
    };
    let files = |seconds: &str| {
        assert_code(&of_day(seconds), 0);
        ["html", "json"].map(|end| read(&folder.path().join(format!("out/a/budget.{end}"))))
    };
    let [page, record] = files("1795651200");
    let found = json(&record);
    assert_eq!(found["title"], "Rig <7>", "{record}");
    let text = fs::read(folder.path().join("a.toml")).expect("the set-up");
    let checksum = format!("{:x}", md5::compute(text));
    assert_eq!(found["setup_md5"], *checksum, "{record}");
    // The last two are by default.
    let parts = [
        "<h1>Uncertainty budget of Rig &lt;7&gt;</h1>",
        "Computed on 2026-11-26 from a.toml. ",
        &checksum,
        "Trials: 10, with the seed 0.",
        "<td>laser.wavelength</td><td>650 nm</td>",
        "<td>sensor.dark_current</td>",
        "<td>surface.polarisation</td>",
    ];
    assert_has(&page, &parts);
    // Closed on paper as well as open: nothing of the table is inside of <details>.
    let (open, _) = page.split_once("<details").expect("the file");
    assert_has(open, &["<td>camera.angle</td>"]);
    // The same bits of the same seed, and of the same day a page of the same bytes.
    assert_eq!(files("1795651201"), [page.clone(), record.clone()]);
    let [later, same] = files("1795737600");
    assert_eq!(same, record, "no day");
    assert_eq!(later, page.replace("2026-11-26", "2026-11-27"));
    said(
        folder.path(),
        "budget a.toml --trials 0 --set camera.f_number=11",
        0,
    );
    let changed = read(&folder.path().join("out/a/budget.html"));
    assert_has(
        &changed,
        &["from a.toml, with", "changes of the command line"],
    );
    for wrong in ["-1", "today", "1e9", "253402300800"] {
        let output = of_day(wrong);
        assert_code(&output, 2);
        assert_has(&message(&output), &["SOURCE_DATE_EPOCH"]);
    }
}

#[test]
fn a_set_up_that_measures_nothing_has_no_uncertainty() {
    // A line that saturates; and in the last case the mean of the brightest pixel fills 93 % of the
    // range, and so wide a line has several grains in a column.
    for [options, why] in tem00_testkit::rows(
        "--trials 10 --set 'sensor.exposure=1 s' => the line saturates the sensor
        --trials 0 --set 'laser.power=5 W' => lower the exposure
        --trials 10 --set laser.power=1e-9 => raise the exposure
        --trials 0 --set 'sensor.exposure=1 ns' => finds no line
        --trials 10 --set 'laser.line_thickness=0.5 mm' --set 'laser.line_length=6 mm' => % of the columns have no line",
    ) {
        let folder = written(SETUP);
        said(folder.path(), "budget a.toml --trials 10", 0);
        let Said { out, told } = said(folder.path(), &format!("budget a.toml {options}"), 3);
        assert_has(&told, &[&why, "a.toml"]);
        assert_has(&out, &["light: "]);
        for part in ["U =", "combined", "expanded", "µm (95 %"] {
            assert!(!out.contains(part), "{part} is in\n{out}");
        }
        let results = folder.path().join("out/a");
        assert_eq!(files(&results), ["budget.html", "budget.json"], "no drawing, none of before");
        let page = read(&results.join("budget.html"));
        assert_has(&page, &["class=\"verdict\">Nothing can be measured"]);
        assert!(!page.contains("U ="), "{page}");
        let printed = said(folder.path(), &format!("budget a.toml {options} --json"), 3).out;
        let record = json(&printed);
        for key in ["height", "combined", "expanded", "dominant", "coverage_factor"] {
            assert!(record[key].is_null(), "{key}: {record}");
        }
        let reason = record["reason"].as_str().expect("a reason");
        assert!(told.contains(reason), "{record}");
        assert!(record["trials"]["uncertainty"].is_null(), "{record}");
        assert!(record["trials"]["combined"].is_null(), "{record}");
        assert_eq!(record["terms"], json!([]), "{record}");
    }
}

#[test]
fn an_uncertain_set_up_has_three_answers_and_one_to_quote() {
    // A tenth of it, whose square is far below two digits of the uncertainty.
    let angle = UNCERTAIN_ANGLE.replace("0.3", "0.03");
    let (record, _) = budget(&format!("--trials 40 --seed 3 {angle}"));
    let found = &record["measurement"];
    let height = number(&found["height"]);
    let highest = &record["image"]["measuring_range"][1];
    assert_eq!(found["height"], *highest, "by default");
    let answers = found["answers"].as_array().expect("the answers");
    for (method, answer) in ["first_order", "propagation", "virtual_experiment"]
        .iter()
        .zip(answers)
    {
        assert_eq!(answer["method"], *method);
        let [u, low, high] = ["uncertainty", "low", "high"].map(|key| number(&answer[key]));
        assert!(low < height && height < high, "{answer}");
        assert!(
            (number(&answer["estimate"]) - height).abs() < 0.5 * u,
            "{answer}"
        );
    }
    assert_eq!(answers.len(), 3, "{found}");
    assert_eq!(found["quoted"], "first_order", "{found}");
    assert_eq!(found["validation"]["is_valid"], true, "{found}");
    let inputs = found["inputs"].as_array().expect("the inputs").iter();
    let sum: f64 = inputs
        .map(|input| number(&input["variance_fraction"]))
        .sum();
    assert!((sum - 1.0).abs() < 1e-12, "{found}");
}

#[test]
fn a_line_below_two_speckles_is_quoted_by_trials() {
    // A speckle is 0.15 mm on the part.
    for (thickness, trials, method) in [
        ("0.02", 40, "trials"),
        ("0.2", 40, "trials"),
        ("0.6", 40, "formulas"),
        ("0.02", 0, "formulas"),
    ] {
        let (record, table) = budget(&format!(
            "--trials {trials} --set camera.f_number=16 --set sensor.exposure=2e-5 \
             --set 'laser.line_thickness={thickness} mm'"
        ));
        assert_eq!(record["quoted"], method, "{thickness}, {trials}: {table}");
        for key in ["combined", "expanded"] {
            assert_eq!(
                record[key], record[method][key],
                "{thickness}, {trials}: {key}"
            );
        }
        let factor = number(&record["expanded"]) / number(&record["combined"]);
        assert!(
            (number(&record["coverage_factor"]) / factor - 1.0).abs() < 1e-12,
            "{record}"
        );
        let is_told = table.contains("do not hold below 2; quote");
        assert_eq!(is_told, thickness != "0.6", "{thickness}: {table}");
        let is_quoted = table.contains("(95 %, by trials). By formulas");
        assert_eq!(is_quoted, method == "trials", "{thickness}: {table}");
        if thickness == "0.02" && trials > 0 {
            let ratio = number(&record["formulas"]["expanded"]) / number(&record["expanded"]);
            assert!((ratio - 1.0).abs() > 0.3, "far from first order: {ratio}");
        }
    }
}

#[test]
fn trials_that_refute_the_formulas_are_quoted() {
    let steger = "--set detector.window=31 --set detector.method=steger";
    let (record, table) = budget(&format!("--trials 40 {steger}"));
    assert_eq!(record["quoted"], "trials");
    let parts = [
        "by trials). By formulas",
        "averages neighbouring columns; quote the trials",
    ];
    assert_has(&table, &parts);
    let (record, table) = budget(&format!("--trials 60 {steger} {UNCERTAIN_ANGLE}"));
    assert_eq!(
        record["measurement"]["quoted"], "virtual_experiment",
        "{table}"
    );
    assert_has(&table, &["quote the virtual experiment"]);
}

#[test]
fn the_largest_uncertainty_within_the_measuring_range_is_stated() {
    const SENTENCE: &str = "within the measuring range it reaches";
    let (_, short) = budget("--trials 0");
    assert!(!short.contains(SENTENCE), "{short}");
    let (record, table) = budget("--trials 0 --set 'camera.resolution=[640, 2000]'");
    let heights = record["over_range"].as_array().expect("heights");
    let combined = heights.iter().map(|height| number(&height["combined"]));
    let ratio = combined.fold(0.0, f64::max) / number(&record["combined"]);
    let largest = 1e6 * ratio * number(&record["expanded"]);
    assert_has(&table, &[&format!("{SENTENCE} {largest:.1}"), "µm, at -"]);
}

#[test]
fn heights_without_a_line_are_stated() {
    let (record, table) =
        budget("--trials 0 --set detector.min_peak=700 --set 'camera.resolution=[640, 2000]'");
    let heights = record["over_range"].as_array().expect("heights");
    let lost = heights.iter().filter(|height| height["combined"].is_null());
    let percent = 100.0 * lost.count() as f64 / heights.len() as f64;
    assert!(percent > 0.0, "{record}");
    let sentence = format!("In {percent:.0} % of the measuring range the detector finds no line");
    assert_has(&table, &[&sentence]);
}

#[test]
fn noise_in_dark_speckle_is_a_part_of_the_variance_of_its_own() {
    const SENTENCE: &str = "of the variance has several sources";
    let (record, table) =
        budget("--trials 40 --set sensor.exposure=5us --set 'laser.line_thickness=\"0.1 mm\"'");
    let terms = record["terms"].as_array().expect("terms").iter();
    let alone = terms.map(|term| term["by_trials"].as_f64().unwrap_or(0.0).powi(2));
    let joint = 100.0 * (1.0 - alone.sum::<f64>() / number(&record["combined"]).powi(2));
    assert!(joint > 10.0, "{joint}");
    assert_has(&table, &[&format!("Another {joint:.0} % {SENTENCE}")]);
    let (_, bright) = budget("--trials 40");
    assert!(!bright.contains(SENTENCE), "{bright}");
}

#[test]
fn a_window_that_cuts_off_the_line_is_noted() {
    const SENTENCE: &str = "cuts off flanks of the line";
    let (_, table) = budget("--trials 0 --set detector.window=5");
    assert_has(&table, &[SENTENCE]);
    let (_, wide) = budget("--trials 0");
    assert!(!wide.contains(SENTENCE), "{wide}");
    let (_, fit) = budget("--trials 0 --set detector.window=7 --set detector.method=parabola");
    assert!(!fit.contains(SENTENCE), "{fit}");
}

#[test]
fn keys_without_effect_are_noted() {
    let folder = written(SETUP);
    let told = |options: &str| {
        said(
            folder.path(),
            &format!("budget a.toml --trials 0 {options}"),
            0,
        )
        .told
    };
    for [key, value, effect] in tem00_testkit::rows(
        "surface.rms_height => '\"1 um\"' => laser.linewidth='\"1 nm\"'
        average.independent_speckle => true => average.frames=2
        environment.temperature_change => 5 => environment.base_expansion=2e-5",
    ) {
        let (_, name) = key.split_once('.').expect("a section");
        let without = format!("--set {key}={value}");
        assert_has(&told(&without), &[&format!("`{name}` in [")]);
        let with = told(&format!("{without} --set {effect}"));
        assert!(!with.contains("no effect"), "{with}");
    }
}

#[test]
fn what_dominates_is_of_the_answer_to_quote() {
    // 30 % of a height, whose interval ends at √3 u and not at 1.96 u.
    let pitch = "{ value = \"3.45 um\", uncertainty = \"0.6 um\", distribution = \"rectangular\" }";
    let (record, table) = budget(&format!("--trials 0 --set 'camera.pixel_pitch={pitch}'"));
    assert_eq!(record["measurement"]["quoted"], "propagation", "{table}");
    assert_eq!(record["dominant"], "camera.pixel_pitch");
    let parts = [
        "it is not validated, quote the propagation",
        "camera.pixel_pitch dominates, with",
    ];
    assert_has(&table, &parts);
}

#[test]
fn correlated_values_have_no_parts_of_the_variance() {
    let folder = written(&format!(
        "{SETUP}\n[[correlation]]\nbetween = [\"camera.angle\", \"camera.distance\"]\n\
         coefficient = 0.5\n"
    ));
    let distance = "--set 'camera.distance={ value = \"300 mm\", uncertainty = \"1 mm\" }'";
    let options = format!("{UNCERTAIN_ANGLE} {distance} --set 'budget.height=0.5 mm'");
    let line = format!("budget a.toml --trials 0 --json {options}");
    let found = &json(&said(folder.path(), &line, 0).out)["measurement"];
    assert_eq!(found["height"], 0.5e-3, "{found}");
    assert_eq!(found["correlations"][0]["coefficient"], 0.5, "{found}");
    assert_eq!(
        found["answers"].as_array().map(Vec::len),
        Some(2),
        "{found}"
    );
    assert!(found["inputs"][0].get("total_index").is_none(), "{found}");
}

#[test]
fn few_readings_are_quoted_with_the_factor_of_students_t() {
    let offset = "{ value = 0, uncertainty = \"0.3 mm\", degrees_of_freedom = 4 }";
    let (record, _) = budget(&format!(
        "--trials 0 --set budget.height=0 --set average.columns=50 --set 'laser.offset={offset}'"
    ));
    let found = &record["measurement"];
    assert_eq!(found["quoted"], "first_order", "{found}");
    // The 0.975 quantile of t for 4, the offset and cot 30°. Noise adds 8 µm to 520 in quadrature,
    // 0.01 %; ends of the trials are known to a fifth of 50 µm.
    let half = 2.776_445 * 3e-4 * 3_f64.sqrt();
    for (index, tolerance) in [(0, 0.002), (1, 0.02)] {
        let [low, high] = ["low", "high"].map(|end| number(&found["answers"][index][end]));
        assert!(
            (0.5 * (high - low) / half - 1.0).abs() < tolerance,
            "{found}"
        );
    }
}

#[test]
fn a_certificate_states_the_height_to_quote() {
    let folder = written(include_str!("../cmd/files/certified.toml"));
    fs::write(folder.path().join("setup.toml"), SETUP).expect("written");
    let path = folder.path().join("x/certificate.xml");
    let line = format!("budget a.toml --trials 0 --json -o x {UNCERTAIN_ANGLE}");
    let with_address = format!("{line} --set certificate.customer.email=a@example.org");
    let certified = || {
        (
            json(&said(folder.path(), &with_address, 0).out),
            read(&path),
        )
    };
    let (record, certificate) = certified();
    let measurement = &record["measurement"];
    assert_eq!(measurement["quoted"], "first_order", "{record}");
    let answer = &measurement["answers"][0];
    for (element, value) in [
        ("si:value", number(&answer["estimate"])),
        ("si:valueStandardMU", 0.3_f64.to_radians()),
        ("si:coverageProbability", 0.95),
    ] {
        assert_has(&certificate, &[&format!("<{element}>{value}</{element}>")]);
    }
    let (_, expanded) = certificate.split_once("<si:valueExpandedMU>").expect("U");
    let (expanded, _) = expanded.split_once('<').expect("its end");
    let expanded: f64 = expanded.parse().expect("a number");
    let half = 0.5 * (number(&answer["high"]) - number(&answer["low"]));
    // The ends are rounded at 10⁻¹⁸ m beside a U of 10⁻⁵ m.
    assert!((expanded / half - 1.0).abs() < 1e-12, "{expanded}, {half}");
    let parts = [
        "Lines &amp; &lt;heights&gt;",
        "<dcc:eMail>a@example.org</dcc:eMail>",
        "not the result of a measurement",
    ];
    assert_has(&certificate, &parts);
    assert_eq!(certified().1, certificate, "the same bytes");
    let line = line.replace("a.toml", "setup.toml");
    said(folder.path(), &line, 0);
    assert!(
        !path.exists(),
        "that of another run would be taken for one of this"
    );
}

#[test]
fn a_changed_set_up_has_the_budget_of_an_edited_one() {
    let of = |text: &str, options: &str| {
        let line = format!("budget a.toml --json --trials 0 {options}");
        json(&said(written(text).path(), &line, 0).out)
    };
    let changed = of(SETUP, "--set camera.f_number=11");
    assert_eq!(
        changed,
        of(&replaced(SETUP, "f_number = 8", "f_number = 11"), "")
    );
    assert_ne!(changed, of(SETUP, ""), "the change counts");
}
