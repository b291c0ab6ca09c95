use std::path::Path;

use tem00_config::{Format, parse_document};
use tem00_testkit::rows;

use super::*;

const FORMAT: Format = Format {
    noun: "test",
    keys: &["sensor"],
    uncertain: &[],
    help: "",
};

fn read(text: &str) -> Result<SensorDescription, String> {
    parse_document(text, Path::new("."), FORMAT, |document| {
        read_sensor(document, 5e-6)
    })
    .map_err(|error| error.to_string())
}

#[test]
fn two_keys_make_a_typical_sensor() {
    let got = read("[sensor]\nquantum_efficiency = 0.6\nexposure = \"2 ms\"").unwrap();
    let expected = SensorDescription {
        quantum_efficiency: 0.6,
        exposure_time: 2e-3,
        pixel_pitch: 5e-6,
        ..SensorDescription::typical(12)
    };
    assert_eq!(got, expected);
}

#[test]
fn every_key_is_read() {
    let text = "[sensor]\nquantum_efficiency = 0.6\nexposure = 0.5\nbit_depth = 10\ngain = 0.07\n\
                black_level = 20\nfull_well = 12000\ndark_noise = 5\ndark_current = 7\n\
                prnu = 0.01\ndsnu = 2\nfill_factor = 0.8\nserial_number = 4711";
    let expected = SensorDescription {
        quantum_efficiency: 0.6,
        gain: 0.07,
        dark_noise: 5.0,
        dark_current: 7.0,
        full_well: 12_000.0,
        prnu: 0.01,
        dsnu: 2.0,
        bit_depth: 10,
        black_level: 20.0,
        pixel_pitch: 5e-6,
        fill_factor: 0.8,
        exposure_time: 0.5,
        serial_number: 4_711,
    };
    assert_eq!(read(text).unwrap(), expected);
}

#[test]
fn a_gain_that_is_not_told_makes_a_full_well_the_largest_value() {
    let text = "[sensor]\nquantum_efficiency = 0.6\nexposure = 0.5\nbit_depth = 8\n\
                full_well = 20000\nblack_level = 5";
    let gain = read(text).unwrap().gain;
    assert!((gain * 20_000.0 - 250.0).abs() < 1e-9, "gain {gain}");
}

#[test]
fn mistakes_are_named_at_their_place() {
    let usual = "[sensor]\nquantum_efficiency = 0.6\nexposure = \"2 ms\"\n";
    let table = r#"
        => text: the file needs a sensor
        [sensor]\nexposure = 1 => `quantum_efficiency`
        [sensor]\nquantum_efficiency = 0.6 => `exposure`
        [sensor]\nquantum_efficency = 0.6 => :2:1: unknown key `quantum_efficency`
        [sensor]\nquantum_efficiency = 6\nexposure = 1 => :2:22: quantum_efficiency must be
        [sensor]\nquantum_efficiency = 0.6\nexposure = "2 mm" => :3:12: `exposure` must be a duration
        [sensor]\nquantum_efficiency = 0.6\nexposure = "auto" => :3:12: `exposure` must be a duration, got "auto"
        USUAL bit_depth = 9 => :4:13: bit_depth must be 8, 10, 12, 14 or 16, got 9
        USUAL bit_depth = 4 => :4:13: `bit_depth` must be a whole number
        USUAL full_well = 0 => :4:13: full_well must be from 1
        USUAL black_level = 5000 => :4:15: black_level must be
        USUAL prnu = nan => :4:8:
        USUAL dsnu = -1 => :4:8: dsnu must be from 0
        USUAL gain = 0 => :4:8: gain must be above 0
        USUAL serial_number = -3 => :4:17: `serial_number` must be a whole number
        USUAL fill_factor = 1.2 => :4:15: fill_factor must be above 0 and at most 1
    "#;
    for [text, part] in rows(table) {
        let message = read(&text.replace("USUAL ", usual)).unwrap_err();
        assert!(message.contains(&part), "{text}\n{message}");
    }
}
