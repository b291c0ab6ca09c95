//! `tem00 speckle` and `tem00 list`: what is known without a scene.

use std::fs;

use std::process::Output;

use serde_json::Value;

use super::*;

fn tem00_with(arguments: &[&str]) -> Output {
    let folder = folder();
    let mut command = tem00(folder.path(), "");
    command
        .args(arguments)
        .output()
        .expect("the program starts")
}

const LENS: [&str; 9] = [
    "speckle",
    "--wavelength",
    "650 nm",
    "--focal-length",
    "25 mm",
    "--f-number",
    "8",
    "--distance",
    "300 mm",
];

#[test]
fn the_speckle_of_a_lens_is_told_without_a_scene() {
    let output = tem00_with(&LENS);
    assert_code(&output, 0);
    let table = text(&output.stdout);
    // h = λ F (1 + m) with m = 25/275, and λ L/D on the surface.
    for part in ["5.673 µm", "62.4 µm", "working f-number: 8.727", "47.92 mm"] {
        assert!(table.contains(part), "{part} is not in\n{table}");
    }
    assert!(!table.contains("contrast"), "no pixel is given\n{table}");

    let with_pixel = [&LENS[..], &["--pixel-pitch", "5.672727 um", "--json"]].concat();
    let output = tem00_with(&with_pixel);
    assert_code(&output, 0);
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let number = |value: &Value| value.as_f64().expect("a number");
    assert!((number(&found["sizes"][0]["sensor"]) - 5.672_727e-6).abs() < 1e-12);
    // A pixel as large as a speckle.
    assert!((number(&found["contrast"]) - 0.711_268).abs() < 1e-5);
    let across = &found["decorrelation"][1];
    assert_eq!(across["by"], "across");
    // Half of the pattern is left at 0.2321 D, none at D.
    assert!((number(&across["half"]) - 0.725_4e-3).abs() < 1e-7);
    assert!((number(&across["none"]) - 3.125e-3).abs() < 1e-8);
    let wavelength = &found["decorrelation"][4];
    assert!(
        wavelength["half"].is_null(),
        "light along the sight: {wavelength}"
    );
}

#[test]
fn impossible_lenses_are_bad_input() {
    for (option, value, part) in [
        ("--distance", "20 mm", "surface"),
        ("--wavelength", "650", "with its unit"),
        ("--f-number", "0.1", "f-number"),
    ] {
        let mut arguments = LENS;
        let place = arguments.iter().position(|&a| a == option).expect(option);
        arguments[place + 1] = value;
        let output = tem00_with(&arguments);
        assert_code(&output, 2);
        assert!(
            message(&output).contains(part),
            "{option}: {}",
            message(&output)
        );
        assert!(output.stdout.is_empty(), "{option}: nothing is data");
    }
}

#[test]
fn lists_name_what_scenes_can_name_with_its_source() {
    for (what, parts) in [
        (
            "metals",
            &["stainless_steel", "Johnson and Christy 1972"][..],
        ),
        (
            "materials",
            &["conductor", "metal, refractive_index, finish, roughness"],
        ),
        (
            "surfaces",
            &["milled", "0.8 … 6.3", "typical", "Machinery's Handbook"],
        ),
    ] {
        let output = tem00_with(&["list", what]);
        assert_code(&output, 0);
        let table = text(&output.stdout);
        for part in parts {
            assert!(table.contains(part), "{part} is not in\n{table}");
        }
    }
    // Gold is yellow because it hardly reflects blue.
    let output = tem00_with(&["list", "metals", "--wavelength", "450 nm"]);
    let table = text(&output.stdout);
    let gold = table
        .lines()
        .find(|line| line.starts_with("gold"))
        .expect("gold");
    let reflectance: f64 = gold
        .split_whitespace()
        .nth(3)
        .expect("a column")
        .parse()
        .expect("a number");
    assert!(reflectance < 0.42, "{gold}");
    assert_code(&tem00_with(&["list", "metals", "--wavelength", "10 um"]), 2);
}

#[test]
fn a_listed_surface_can_be_rendered() {
    let folder = folder();
    let milled = SCENE.replace(
        "[[surface]]",
        "[[surface]]\nconductor.finish = \"milled steel\"",
    );
    fs::write(folder.path().join("a.toml"), milled).expect("written");
    assert_code(&run(folder.path(), "render a.toml --spp 1"), 0);
}
