//! `tem00 stats` on images as cameras and other programs write them.

use std::{fs, path::Path};

use png::BitDepth;
use serde_json::Value;

use super::{
    assert_code, folder,
    helpers::{noise, rounded, write_png},
    message, run,
};

fn stats(folder: &Path, arguments: &str) -> Value {
    let output = run(folder, &format!("stats {arguments} --json"));
    assert_code(&output, 0);
    serde_json::from_slice(&output.stdout).expect("JSON and nothing else")
}

fn measured(found: &Value, quantity: &str) -> Option<f64> {
    let mut rows = found["rows"].as_array().expect("rows").iter();
    rows.find(|row| row["quantity"] == quantity)?["measured"].as_f64()
}

#[test]
fn saturation_of_speckle_is_one_judgement_whatever_the_bits_and_where_they_lie() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let light = speckle(folder.path());
    // The largest value and the step of two values: 10, 12 and 14 bits, in the lower and the upper bits of a word, and
    // values clipped by what a camera computes.
    for (largest, step) in [
        (4_095, 1),
        (1_023, 1),
        (16_383, 1),
        (65_520, 16),
        (65_472, 64),
        (65_535, 1),
        (3_931, 1),
        (235, 1),
    ] {
        let full = f64::from(largest);
        for (exposure, is_clipped) in [(0.9, false), (1.5, true)] {
            let case = format!("{largest} in steps of {step}, exposure {exposure}");
            write_png(&path("s.png"), [256, 256], BitDepth::Sixteen, |x, y| {
                let value = if is_clipped { 0.2 } else { 0.04 } * full * light[256 * y + x];
                [rounded(
                    (f64::from(step) * (value / f64::from(step)).round()).min(full),
                )]
            });
            let found = stats(folder.path(), "s.png");
            let share = measured(&found, "saturated fraction of pixels");
            assert_eq!(share > Some(1e-3), is_clipped, "{case}: {share:?}");
        }
    }
}

#[test]
fn a_pixel_is_saturated_if_one_of_its_channels_is() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let pattern = speckle(folder.path());
    let colours = [[0, 1, 2], [2, 0, 1], [1, 2, 0]];
    for (depth, full) in [(BitDepth::Eight, 255.0), (BitDepth::Sixteen, 4_095.0)] {
        for places in colours {
            let pixel = |lights: [f64; 3]| {
                places.map(|place: usize| rounded((full * lights[place]).min(full)))
            };
            write_png(&path("s.png"), [256, 256], depth, |x, y| {
                pixel([0.2, 0.04, 0.02].map(|part| part * pattern[256 * y + x]))
            });
            let bright = ["R", "G", "B"][places.iter().position(|place| *place == 0).expect("one")];
            let dim = ["R", "G", "B"][places.iter().position(|place| *place == 1).expect("one")];
            for (channel, is_saturated) in [
                (String::new(), true),
                (format!("--channel {bright}"), true),
                (format!("--channel {dim}"), false),
            ] {
                let share = measured(
                    &stats(folder.path(), &format!("s.png {channel}")),
                    "saturated fraction of pixels",
                );
                assert_eq!(share > Some(1e-3), is_saturated, "{channel}: {share:?}");
            }
        }
    }
}

/// Speckle of a mean of 1, as `tem00 pattern` makes it.
fn speckle(folder: &Path) -> Vec<f64> {
    let size = "pattern -o p.npy --size 256 --diameter 64 --seed 5";
    assert_code(&run(folder, size), 0);
    let file = fs::read(folder.join("p.npy")).expect("the pattern");
    let values = file[file.len() - 4 * 256 * 256..].chunks_exact(4);
    let value = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    values.map(|bytes| value(bytes).into()).collect()
}

#[test]
fn mean_grey_levels_are_those_of_a_channel() {
    let folder = folder();
    let light = speckle(folder.path());
    let file = folder.path().join("a.png");
    let mean_of = |part: f64| {
        let values = light
            .iter()
            .map(|light| f64::from(rounded((part * light).min(255.0))));
        values.sum::<f64>() / light.len() as f64
    };
    let (red, green, blue) = (11.0, 7.0, 3.0);
    for (parts, depth, step, expected) in [
        (
            [red, green, blue],
            BitDepth::Eight,
            1,
            (mean_of(red) + mean_of(green) + mean_of(blue)) / 3.0,
        ),
        ([red; 3], BitDepth::Eight, 1, mean_of(red)),
        // Values in the upper bits of a word.
        ([red; 3], BitDepth::Sixteen, 16, mean_of(red)),
        (
            [green, red, green],
            BitDepth::Sixteen,
            256,
            (2.0 * mean_of(green) + mean_of(red)) / 3.0,
        ),
    ] {
        write_png(&file, [256, 256], depth, |x, y| {
            parts.map(|part| step * rounded((part * light[256 * y + x]).min(255.0)))
        });
        let mean = measured(&stats(folder.path(), "a.png"), "mean (grey levels)").expect("a row");
        assert!(
            (mean / expected - 1.0).abs() < 1e-5,
            "{parts:?}: {mean}, not {expected}"
        );
    }
}

#[test]
fn a_pedestal_is_warned_of_and_subtracted() {
    let folder = folder();
    let light = speckle(folder.path());
    // A mean of 100 over pedestals of all kinds: of raw frames, of cameras of 12 bits, large ones.
    for (pedestal, lowered) in [(16.0, 0.86), (64.0, 0.61), (400.0, 0.2)] {
        write_png(
            &folder.path().join("a.png"),
            [256, 256],
            BitDepth::Sixteen,
            |x, y| {
                [rounded(
                    100.0 * light[256 * y + x] + pedestal + 2.0 * noise(x, y),
                )]
            },
        );
        let raw = stats(folder.path(), "a.png");
        let contrast = |found: &Value| measured(found, "contrast").expect("a contrast");
        assert!((contrast(&raw) / lowered - 1.0).abs() < 0.1, "{raw}");
        let warnings = raw["warnings"].to_string();
        assert!(warnings.contains("--black-level"), "{pedestal}: {warnings}");
        let right = stats(folder.path(), &format!("a.png --black-level {pedestal}"));
        // 64 speckles along a side: 0.77 / 64 of spread, at 4 σ.
        assert!(
            (contrast(&right) - 1.0).abs() < 0.05,
            "{pedestal}: {}",
            contrast(&right)
        );
        assert!(
            !right["warnings"].to_string().contains("--black-level"),
            "{right}"
        );
        let factor = contrast(&right) / contrast(&raw);
        // The mean of 64 speckles along a side spreads by 1 / 64, at 2.5 σ.
        let expected = 1.0 + pedestal / 100.0;
        assert!(
            (factor / expected - 1.0).abs() < 0.04,
            "{factor}, not {expected}"
        );
    }
    for (level, part) in [
        ("-1", "0 or more"),
        ("nan", "0 or more"),
        ("70000", "not below the largest value"),
    ] {
        let output = run(folder.path(), &format!("stats a.png --black-level={level}"));
        assert_code(&output, 2);
        assert!(
            message(&output).contains(part),
            "{level}: {}",
            message(&output)
        );
    }
}

#[test]
fn signed_numbers_are_light_about_a_black_level() {
    let folder = folder();
    let values: Vec<u8> = (0..400_i16)
        .flat_map(|i| (i % 90 - 5).to_le_bytes())
        .collect();
    let header = "{'descr': '<i2', 'fortran_order': False, 'shape': (20, 20, 1), }";
    let mut file = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    file.extend(format!("{header:<117}\n").bytes());
    file.extend(values);
    fs::write(folder.path().join("a.npy"), file).expect("the array");
    let refused = run(folder.path(), "stats a.npy");
    assert_code(&refused, 2);
    let told = message(&refused);
    assert!(
        told.contains("(0, 0) is -5") && told.contains("--black-level 0"),
        "{told}"
    );
    let mean = measured(&stats(folder.path(), "a.npy --black-level 0"), "mean").expect("a mean");
    let expected = (0..400).map(|i| f64::from(i % 90 - 5)).sum::<f64>() / 400.0;
    assert!((mean / expected - 1.0).abs() < 1e-6, "{mean}");
}

#[test]
fn photographs_that_claim_more_than_they_hold_are_refused_at_once() {
    let folder = folder();
    let photograph = include_bytes!("../../../tem00-report/src/image/raw_file/data/grey.jpg");
    let mut claim = photograph.to_vec();
    let frame = claim
        .windows(2)
        .position(|pair| pair == [0xff, 0xc0])
        .expect("a frame");
    // 4096 rows of 65,535 pixels, and 41 kB of a comment.
    claim[frame + 5..frame + 9].copy_from_slice(&[0x10, 0x00, 0xff, 0xff]);
    let comment = [&[0xff, 0xfe, 0xa0, 0x02][..], &[b' '; 0xa000]].concat();
    claim.splice(2..2, comment);
    fs::write(folder.path().join("claim.jpg"), claim).expect("the file");
    // The coded data of the photograph begin behind the header of its scan, of ten bytes.
    let scan = photograph
        .windows(2)
        .position(|pair| pair == [0xff, 0xda])
        .expect("a scan")
        + 10;
    let coded = photograph.len() - 2 - scan;
    for kept in [coded / 50, coded / 2, coded - 4] {
        let cut = [&photograph[..scan + kept], &[0xff, 0xd9]].concat();
        fs::write(folder.path().join(format!("cut_{kept}.jpg")), cut).expect("the file");
    }
    fs::write(folder.path().join("whole.jpg"), photograph).expect("the file");
    assert_code(&run(folder.path(), "stats whole.jpg"), 0);
    for name in ["claim.jpg".to_owned()]
        .into_iter()
        .chain([coded / 50, coded / 2, coded - 4].map(|kept| format!("cut_{kept}.jpg")))
    {
        let start = std::time::Instant::now();
        let output = run(folder.path(), &format!("stats {name}"));
        assert_code(&output, 2);
        let told = message(&output);
        let part = if name == "claim.jpg" {
            "cannot hold"
        } else {
            "before its last pixel"
        };
        assert!(told.contains(part), "{name}: {told}");
        assert!(start.elapsed().as_secs() < 5, "{name} took its time");
    }
}
