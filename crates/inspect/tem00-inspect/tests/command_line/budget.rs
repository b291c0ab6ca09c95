use std::fs;

use serde_json::Value;

use super::{assert_code, files, folder, message, run, tem00, text};

/// A set-up of the usual parts, with few rows.
pub(super) const SETUP: &str = include_str!("../cmd/files/setup.toml");

fn setup_folder(from: &str, to: &str) -> tempfile::TempDir {
    assert!(SETUP.contains(from), "{from} is in the set-up");
    let folder = folder();
    let text = SETUP.replacen(from, to, 1);
    fs::write(folder.path().join("a.toml"), text).expect("the set-up is written");
    folder
}

fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).expect("it is JSON")
}

#[test]
fn a_budget_is_a_table_and_five_files() {
    let folder = setup_folder("[laser]", "[laser]");
    let output = run(folder.path(), "budget a.toml --trials 10");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let out = folder.path().join("out/a");
    let expected = [
        "budget.html",
        "budget.json",
        "contributions.png",
        "contributions.svg",
        "over_range.png",
        "over_range.svg",
    ];
    assert_eq!(files(&out), expected, "nothing else");
    let record = json(&fs::read(out.join("budget.json")).expect("the record"));
    let number = |value: &Value| value.as_f64().expect("a number");
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
    let page = fs::read_to_string(out.join("budget.html")).expect("the report");
    assert!(
        page.contains("<svg") && page.contains("line_thickness = &quot;0.2 mm&quot;"),
        "{page}"
    );
}

#[test]
fn a_page_has_name_day_checksum_and_every_input_and_the_json_no_day() {
    let folder = setup_folder("[laser]", "title = \"Rig <7>\"\n[laser]");
    let of_day = |seconds: &str| {
        let mut command = tem00(folder.path(), "budget a.toml --trials 10");
        command
            .env("SOURCE_DATE_EPOCH", seconds)
            .output()
            .expect("the program starts")
    };
    let files = |seconds: &str| {
        assert_code(&of_day(seconds), 0);
        ["html", "json"].map(|end| {
            let path = folder.path().join(format!("out/a/budget.{end}"));
            fs::read_to_string(path).expect("the report")
        })
    };
    let [page, record] = files("1795651200");
    for part in [
        "<h1>Uncertainty budget of Rig &lt;7&gt;</h1>",
        "Computed on 2026-11-26 from a.toml",
        "<td>laser.wavelength</td><td>650 nm</td>",
        // By default.
        "<td>sensor.dark_current</td>",
        "<td>surface.polarisation</td>",
    ] {
        assert!(page.contains(part), "{part} is not in\n{page}");
    }
    // Closed on paper as well as open: nothing of the table is inside of <details>.
    let (open, _) = page.split_once("<details").expect("the file");
    assert!(open.contains("<td>camera.angle</td>"), "{page}");
    let found = json(record.as_bytes());
    assert_eq!(found["title"], "Rig <7>", "{record}");
    let text = fs::read(folder.path().join("a.toml")).expect("the set-up");
    let checksum = format!("{:x}", md5::compute(text));
    assert_eq!(found["setup_md5"], *checksum, "{record}");
    assert!(page.contains(&checksum), "{page}");
    // The same bits of the same seed, and of the same day a page of the same bytes.
    assert_eq!(files("1795651201"), [page.clone(), record.clone()]);
    let [later, same] = files("1795737600");
    assert_eq!(same, record, "no day");
    assert_eq!(later, page.replace("2026-11-26", "2026-11-27"));
    for wrong in ["-1", "today", "1e9", "253402300800"] {
        let output = of_day(wrong);
        assert_code(&output, 2);
        assert!(message(&output).contains("SOURCE_DATE_EPOCH"), "{wrong}");
    }
}

/// Asserts that a set-up gets no number: in no stream, in no file.
#[track_caller]
fn assert_no_number(from: &str, to: &str, trials: u32, why: &str) {
    let folder = setup_folder(from, "");
    fs::write(folder.path().join("a.toml"), SETUP).expect("the set-up is written");
    assert_code(&run(folder.path(), "budget a.toml --trials 10"), 0);
    fs::write(folder.path().join("a.toml"), SETUP.replacen(from, to, 1)).expect("written");

    let output = run(folder.path(), &format!("budget a.toml --trials {trials}"));
    assert_code(&output, 3);
    let told = message(&output);
    assert!(told.contains(why) && told.contains("a.toml"), "{told}");
    let table = text(&output.stdout);
    assert!(table.contains("light: "), "what helps to find out: {table}");
    for part in ["U =", "combined", "expanded", "µm (95 %"] {
        assert!(!table.contains(part), "{part} is in\n{table}");
    }
    let out = folder.path().join("out/a");
    assert_eq!(
        files(&out),
        ["budget.html", "budget.json"],
        "no drawing, none of before"
    );
    let page = fs::read_to_string(out.join("budget.html")).expect("the report");
    assert!(
        page.contains("class=\"verdict\">Nothing can be measured"),
        "{page}"
    );
    assert!(!page.contains("U ="), "{page}");

    let output = run(
        folder.path(),
        &format!("budget a.toml --json --trials {trials}"),
    );
    assert_code(&output, 3);
    let record = json(&output.stdout);
    for key in [
        "height",
        "combined",
        "expanded",
        "dominant",
        "coverage_factor",
    ] {
        assert!(record[key].is_null(), "{key}: {record}");
    }
    assert!(
        record["reason"]
            .as_str()
            .is_some_and(|reason| told.contains(reason)),
        "{record}"
    );
    assert!(record["trials"]["uncertainty"].is_null(), "{record}");
    assert!(record["trials"]["combined"].is_null(), "{record}");
    assert_eq!(record["terms"], serde_json::json!([]), "{record}");
}

#[test]
fn a_set_up_that_saturates_has_no_uncertainty() {
    assert_no_number("\"0.1 ms\"", "\"1 s\"", 10, "the line saturates the sensor");
    assert_no_number(
        "power = \"5 mW\"",
        "power = \"5 W\"",
        0,
        "lower the exposure",
    );
}

#[test]
fn a_set_up_without_a_line_has_no_uncertainty() {
    assert_no_number("power = \"5 mW\"", "power = 1e-9", 10, "raise the exposure");
    assert_no_number("\"0.1 ms\"", "\"1 ns\"", 0, "finds no line");
}

#[test]
fn below_half_of_the_columns_there_is_no_uncertainty() {
    // The mean of the brightest pixel fills 93 % of the range; so wide a line has several grains in a column.
    let from = "line_thickness = \"0.2 mm\"\nline_length = \"50 mm\"";
    let to = "line_thickness = \"0.5 mm\"\nline_length = \"6 mm\"";
    assert_no_number(
        from,
        to,
        10,
        "% of the columns have no line that can be trusted",
    );
}

#[test]
fn an_uncertain_set_up_has_three_answers_and_one_to_quote() {
    let angle = "angle = { value = \"30 deg\", uncertainty = \"0.3 deg\" }\n\
                 principal_row = { value = 32, uncertainty = 0.5, distribution = \"rectangular\" }";
    let folder = setup_folder("angle = \"30 deg\"", angle);
    let record = json(&run(folder.path(), "budget a.toml --trials 40 --seed 3 --json").stdout);
    let found = &record["measurement"];
    let height = found["height"].as_f64().expect("a height");
    let range = record["image"]["measuring_range"][1].as_f64();
    assert_eq!(Some(height), range, "the greatest height by default");
    let answers = found["answers"].as_array().expect("the answers");
    let methods: Vec<_> = answers.iter().map(|answer| &answer["method"]).collect();
    assert_eq!(
        methods,
        ["first_order", "propagation", "virtual_experiment"]
    );
    for answer in answers {
        let number = |key: &str| answer[key].as_f64().expect("a number");
        let (u, estimate) = (number("uncertainty"), number("estimate"));
        assert!(
            number("low") < height && height < number("high"),
            "{answer}"
        );
        assert!((estimate - height).abs() < 0.5 * u, "{answer}");
    }
    assert_eq!(found["quoted"], "first_order", "{found}");
    assert_eq!(found["validation"]["is_valid"], true, "{found}");
    let fractions = found["inputs"].as_array().expect("the inputs").iter();
    let fractions = fractions.map(|input| input["variance_fraction"].as_f64().expect("a fraction"));
    assert!((fractions.sum::<f64>() - 1.0).abs() < 1e-12, "{found}");
}

/// Returns the record of a set-up whose line is `thickness` wide behind a small pupil, and what is printed.
fn of_line(thickness: &str, trials: u32) -> (Value, String) {
    let folder = setup_folder("\"0.2 mm\"", &format!("\"{thickness}\""));
    let line = format!(
        "budget a.toml --trials {trials} --set camera.f_number=16 --set sensor.exposure=2e-5"
    );
    let output = run(folder.path(), &line);
    assert_code(&output, 0);
    let record = fs::read(folder.path().join("out/a/budget.json")).expect("the record");
    (json(&record), text(&output.stdout))
}

#[test]
fn a_line_below_two_speckles_is_quoted_by_trials() {
    // A speckle is 0.15 mm on the part.
    for (thickness, trials, method) in [
        ("0.02 mm", 40, "trials"),
        ("0.2 mm", 40, "trials"),
        ("0.6 mm", 40, "formulas"),
        ("0.02 mm", 0, "formulas"),
    ] {
        let (record, table) = of_line(thickness, trials);
        let number = |value: &Value| value.as_f64().expect("a number");
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
        assert_eq!(is_told, thickness != "0.6 mm", "{thickness}: {table}");
        let is_quoted = table.contains("(95 %, by trials). By formulas");
        assert_eq!(is_quoted, method == "trials", "{thickness}: {table}");
        if thickness == "0.02 mm" && trials > 0 {
            let by_formulas = number(&record["formulas"]["expanded"]);
            let ratio = by_formulas / number(&record["expanded"]);
            assert!((ratio - 1.0).abs() > 0.3, "far from first order: {ratio}");
        }
    }
}

#[test]
fn trials_that_refute_the_formulas_are_quoted() {
    let folder = setup_folder("window = 21", "method = \"steger\"");
    let output = run(folder.path(), "budget a.toml --trials 40");
    let record = fs::read(folder.path().join("out/a/budget.json")).expect("the record");
    assert_eq!(json(&record)["quoted"], "trials");
    let table = text(&output.stdout);
    for part in [
        "by trials). By formulas",
        "not linear under so much noise; quote the trials",
    ] {
        assert!(table.contains(part), "{part} is not in\n{table}");
    }
}

#[test]
fn what_dominates_is_of_the_answer_to_quote() {
    let row = "principal_row = { value = 32, uncertainty = 5.8, distribution = \"rectangular\" }\n[sensor]";
    let exact = ("speckle", "a larger pupil (smaller f-number)");
    let uncertain = (
        "camera.principal_row",
        "the line on a flat plate at height zero tells it",
    );
    for (to, (name, advice)) in [("[sensor]", exact), (row, uncertain)] {
        let folder = setup_folder("[sensor]", to);
        let output = run(folder.path(), "budget a.toml --trials 0");
        let record = fs::read(folder.path().join("out/a/budget.json")).expect("the record");
        assert_eq!(json(&record)["dominant"], name);
        let table = text(&output.stdout);
        let lines: Vec<&str> = table
            .lines()
            .filter(|line| line.contains(" dominates, "))
            .collect();
        let [line] = lines[..] else { panic!("{table}") };
        let begins = line
            .to_lowercase()
            .starts_with(&format!("{name} dominates"));
        assert!(begins && line.contains(advice), "{line}");
    }
}

#[test]
fn correlated_values_have_no_parts_of_the_variance() {
    let both = "distance = { value = \"300 mm\", uncertainty = \"1 mm\" }\n\
                angle = { value = \"30 deg\", uncertainty = \"0.3 deg\" }";
    let folder = setup_folder("distance = \"300 mm\"\nangle = \"30 deg\"", both);
    let path = folder.path().join("a.toml");
    let more = "\n[[correlation]]\nbetween = [\"camera.angle\", \"camera.distance\"]\ncoefficient = 0.5\n\
                [budget]\nheight = \"0.5 mm\"\n";
    let set_up = fs::read_to_string(&path).expect("the set-up") + more;
    fs::write(&path, set_up).expect("written");
    let output = run(folder.path(), "budget a.toml --trials 0 --json");
    assert_code(&output, 0);
    let found = &json(&output.stdout)["measurement"];
    assert_eq!(found["height"], 0.5e-3, "{found}");
    assert_eq!(found["correlations"][0]["coefficient"], 0.5, "{found}");
    assert_eq!(
        found["answers"].as_array().map(Vec::len),
        Some(2),
        "{found}"
    );
    assert!(found["inputs"][0].get("total_index").is_none(), "{found}");
    let output = run(
        folder.path(),
        "budget a.toml --set camera.angle.uncertainty=-1deg",
    );
    assert_code(&output, 2);
    assert!(
        message(&output).contains("`uncertainty` must be at least 0"),
        "{}",
        message(&output)
    );
}

/// Returns what is to be quoted of a set-up in which `from` is changed, and the table.
fn quoted(from: &str, to: &str) -> (Value, String) {
    let folder = setup_folder(from, to);
    let output = run(folder.path(), "budget a.toml --trials 60");
    assert_code(&output, 0);
    let record = fs::read(folder.path().join("out/a/budget.json")).expect("the record");
    let quoted = json(&record)["measurement"]["quoted"].clone();
    (quoted, text(&output.stdout))
}

#[test]
fn a_dominant_rectangular_quantity_is_quoted_by_its_distribution() {
    // 30 % of a height, whose interval ends at √3 u and not at 1.96 u.
    let pitch = "pixel_pitch = { value = \"3.45 um\", uncertainty = \"0.6 um\", distribution = \"rectangular\" }";
    let (quoted, table) = quoted("pixel_pitch = \"3.45 um\"", pitch);
    assert_eq!(quoted, "propagation", "{table}");
    assert!(
        table.contains("it is not validated, quote the propagation"),
        "{table}"
    );
}

#[test]
fn few_readings_are_quoted_with_the_factor_of_students_t() {
    let offset =
        "offset = { value = 0, uncertainty = \"0.1 mm\", degrees_of_freedom = 4 }\n[camera]";
    let folder = setup_folder("[camera]", offset);
    let output = run(
        folder.path(),
        "budget a.toml --trials 0 --json --set budget.height=0 --set average.columns=400",
    );
    let found = &json(&output.stdout)["measurement"];
    assert_eq!(found["quoted"], "first_order", "{found}");
    // The 0.975 quantile of t for 4, the offset and cot 30°. Noise adds 4 µm to 173 in quadrature, 0.03 %; ends of the
    // trials are known to a fifth of 50 µm.
    let half = 2.776_445 * 1e-4 * 3_f64.sqrt();
    for (index, tolerance) in [(0, 0.002), (1, 0.02)] {
        let [low, high] =
            ["low", "high"].map(|end| found["answers"][index][end].as_f64().expect("an end"));
        assert!(
            (0.5 * (high - low) / half - 1.0).abs() < tolerance,
            "{found}"
        );
    }
}

#[test]
fn a_detector_whose_noise_is_not_first_order_is_quoted_by_the_virtual_experiment() {
    let from = "angle = \"30 deg\"";
    let folder = setup_folder(
        from,
        "angle = { value = \"30 deg\", uncertainty = \"0.01 deg\" }",
    );
    let set_up = fs::read_to_string(folder.path().join("a.toml")).expect("the set-up");
    let (quoted, table) = quoted(SETUP, &set_up.replace("window = 21", "method = \"steger\""));
    assert_eq!(quoted, "virtual_experiment", "{table}");
    assert!(table.contains("quote the virtual experiment"), "{table}");
}

/// Who signs the certificate of a set-up whose angle is uncertain, in sections after [`SETUP`].
const CERTIFICATE: &str = r#"
[certificate]
identifier = "A-1"
performed_from = 2026-11-20
performed_to = 2026-11-23
performed_at = "laboratory"
issued = "2026-11-23"
responsible = "A. Example"

[certificate.laboratory]
name = "Lines & <heights>"
city = "Example town"
country = "DE"

[certificate.customer]
name = "Rolling mill"
city = "Example town"

[certificate.item]
name = "Line sensor"
identification = "4711"
issuer = "customer"
"#;

const UNCERTAIN_ANGLE: &str = "angle = { value = \"30 deg\", uncertainty = \"0.05 deg\" }";

#[test]
fn a_certificate_states_the_height_to_quote() {
    let setup = SETUP.replacen("angle = \"30 deg\"", UNCERTAIN_ANGLE, 1);
    let folder = setup_folder("[laser]", "[laser]");
    let file = folder.path().join("a.toml");
    let path = folder.path().join("x/certificate.xml");
    let line = "budget a.toml --trials 0 --json -o x";
    fs::write(&file, format!("{setup}{CERTIFICATE}")).expect("the set-up is written");
    let certified = || {
        let output = run(folder.path(), line);
        assert!(output.status.success(), "{}", text(&output.stderr));
        (
            json(&output.stdout),
            fs::read_to_string(&path).expect("the certificate"),
        )
    };
    let (record, certificate) = certified();
    let measurement = &record["measurement"];
    assert_eq!(measurement["quoted"], "first_order", "{record}");
    let answer = &measurement["answers"][0];
    let number = |value: &Value| value.as_f64().expect("a number");
    for (element, value) in [
        ("si:value", number(&answer["estimate"])),
        ("si:valueStandardMU", 0.05_f64.to_radians()),
        ("si:coverageProbability", 0.95),
    ] {
        let element = format!("<{element}>{value}</{element}>");
        assert!(certificate.contains(&element), "{element}: {certificate}");
    }
    let (_, expanded) = certificate.split_once("<si:valueExpandedMU>").expect("U");
    let (expanded, _) = expanded.split_once('<').expect("its end");
    let expanded: f64 = expanded.parse().expect("a number");
    let half = 0.5 * (number(&answer["high"]) - number(&answer["low"]));
    // The ends are rounded at 10⁻¹⁸ m beside a U of 10⁻⁵ m.
    assert!((expanded / half - 1.0).abs() < 1e-12, "{expanded}, {half}");
    assert!(
        certificate.contains("Lines &amp; &lt;heights&gt;"),
        "{certificate}"
    );
    assert!(
        certificate.contains("not the result of a measurement"),
        "{certificate}"
    );
    assert_eq!(certified().1, certificate, "the same bytes");
    fs::write(&file, setup).expect("the set-up is written");
    assert!(run(folder.path(), line).status.success(), "no certificate");
    assert!(
        !path.exists(),
        "that of another run would be taken for one of this"
    );
}
