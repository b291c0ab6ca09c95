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
fn gold_hardly_reflects_blue() {
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
