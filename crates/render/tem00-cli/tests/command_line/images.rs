//! `tem00 stats` on images as cameras and other programs write them.

use std::path::Path;

use png::BitDepth;

use super::{
    folder,
    helpers::{noise, pattern, rounded, write, write_png},
    patterns::{measured, stats},
    refused,
};

/// Speckle of a mean of 1, of 256 × 256 pixels.
fn speckle(folder: &Path) -> Vec<f64> {
    pattern(folder, "p.npy", [256, 64])
}

fn is_saturated(folder: &Path, arguments: &str) -> bool {
    measured(&stats(folder, arguments), "saturated fraction of pixels") > 1e-3
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
            let channel = |light| places.iter().position(|place| *place == light);
            let [bright, dim] = [0, 1].map(|light| ["R", "G", "B"][channel(light).expect("one")]);
            for (arguments, expected) in [
                ("s.png".to_owned(), true),
                (format!("s.png --channel {bright}"), true),
                (format!("s.png --channel {dim}"), false),
            ] {
                let found = is_saturated(folder.path(), &arguments);
                assert_eq!(found, expected, "{arguments}");
            }
        }
    }
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
        let mean = measured(&stats(folder.path(), "a.png"), "mean (grey levels)");
        let is_near = (mean / expected - 1.0).abs() < 1e-5;
        assert!(is_near, "{parts:?}: {mean}, not {expected}");
    }
}

#[test]
fn a_pedestal_is_warned_of_and_subtracted() {
    let folder = folder();
    let light = speckle(folder.path());
    // A mean of 100 over pedestals of all kinds: of raw frames, of cameras of 12 bits, large ones.
    for (pedestal, lowered) in [(16.0, 0.86), (64.0, 0.61), (400.0, 0.2)] {
        let file = folder.path().join("a.png");
        write_png(&file, [256, 256], BitDepth::Sixteen, |x, y| {
            let noise = 2.0 * noise(x, y);
            [rounded(100.0 * light[256 * y + x] + pedestal + noise)]
        });
        let raw = stats(folder.path(), "a.png");
        let contrast = |found| measured(found, "contrast");
        assert!((contrast(&raw) / lowered - 1.0).abs() < 0.1, "{raw}");
        let warnings = raw["warnings"].to_string();
        assert!(warnings.contains("--black-level"), "{pedestal}: {warnings}");
        let right = stats(folder.path(), &format!("a.png --black-level {pedestal}"));
        // 64 speckles along a side: 0.77 / 64 of spread, at 4 σ.
        assert!((contrast(&right) - 1.0).abs() < 0.05, "{pedestal}: {right}");
        let warnings = right["warnings"].to_string();
        assert!(!warnings.contains("--black-level"), "{warnings}");
        let factor = contrast(&right) / contrast(&raw);
        // The mean of 64 speckles along a side spreads by 1 / 64, at 2.5 σ.
        let expected = 1.0 + pedestal / 100.0;
        let is_near = (factor / expected - 1.0).abs() < 0.04;
        assert!(is_near, "{factor}, not {expected}");
    }
    for (level, part) in [
        ("-1", "0 or more"),
        ("nan", "0 or more"),
        ("70000", "not below the largest value"),
    ] {
        refused(
            folder.path(),
            &format!("stats a.png --black-level={level}"),
            &[part],
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
    write(folder.path(), "a.npy", file);
    refused(
        folder.path(),
        "stats a.npy",
        &["(0, 0) is -5", "--black-level 0"],
    );
    let mean = measured(&stats(folder.path(), "a.npy --black-level 0"), "mean");
    let expected = (0..400).map(|i| f64::from(i % 90 - 5)).sum::<f64>() / 400.0;
    assert!((mean / expected - 1.0).abs() < 1e-6, "{mean}");
}
