use std::fs;

use serde_json::Value;

use super::{budget::SETUP, folder, run, text};

/// A folder with a set-up of few pixels, changed in one place.
fn small(from: &str, to: &str) -> tempfile::TempDir {
    let folder = folder();
    let narrow = SETUP.replacen("[640, 64]", "[120, 96]", 1);
    assert!(narrow.contains(from), "{from} is in the set-up");
    fs::write(folder.path().join("a.toml"), narrow.replacen(from, to, 1)).expect("it is written");
    folder
}

#[test]
fn characteristics_have_values_or_reasons() {
    let folder = small("[laser]", "[laser]");
    let line = "characterise a.toml --repetitions 4 --spp 2";
    let output = run(folder.path(), line);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    for part in [
        "measurement noise",
        "N_M",
        "probing size error",
        "by chance",
    ] {
        assert!(table.contains(part), "{part}: {table}");
    }
    let out = folder.path().join("out/a");
    let read = fs::read(out.join("characteristics.json")).expect("it is written");
    let found: Value = serde_json::from_slice(&read).expect("it is JSON");
    let rows = found["characteristics"].as_array().expect("rows");
    assert_eq!(rows.len(), 17);
    for row in rows {
        assert!(row["definition"].is_string(), "{row}");
        assert_eq!(
            row["value"].is_null(),
            row["uncertainty"].is_null(),
            "{row}"
        );
    }
    let value = |key: &str| {
        let row = rows.iter().find(|row| row["key"] == key).expect(key);
        row["value"].as_f64()
    };
    assert!(value("measurement_noise") > value("instrument_noise"));
    // A comb of 16 Σ 2^(−k/2) + 12 · 16 = 245.8 columns does not fit into nine tenths of 120.
    assert_eq!(value("resolution_along_profile"), None);
    assert!(
        table.contains("the comb of grooves needs 274 points along the profile, and there are 120"),
        "{table}"
    );
    for file in ["characteristics.html", "response.svg", "grooves.png"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    // The same seed, the same bytes, for any number of threads.
    let again = run(folder.path(), &format!("{line} --threads 1 -o b"));
    assert!(again.status.success(), "{}", text(&again.stderr));
    let again = fs::read(folder.path().join("b/characteristics.json")).expect("it is written");
    assert_eq!(read, again);
}
