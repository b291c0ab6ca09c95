//! `tem00-inspect characterise`.

use std::fs;

use super::*;

#[test]
fn characteristics_have_values_or_reasons() {
    let folder = written(SETUP);
    let line = "characterise a.toml --repetitions 4 --spp 1 --set 'camera.resolution=[120, 96]'";
    let table = said(folder.path(), line, 0).out;
    let parts = [
        "measurement noise",
        "N_M",
        "probing size error",
        "by chance",
    ];
    assert_has(&table, &parts);
    let out = folder.path().join("out/a");
    let record = read(&out.join("characteristics.json"));
    let found = json(&record);
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
    let part = "the comb of grooves needs 274 points along the profile, and there are 120";
    assert_has(&table, &[part]);
    for file in ["characteristics.html", "response.svg", "grooves.png"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    // The same seed, the same bytes, for any number of threads.
    said(folder.path(), &format!("{line} --threads 1 -o b"), 0);
    let again = fs::read_to_string(folder.path().join("b/characteristics.json"));
    assert_eq!(again.expect("it is written"), record);
}
