//! `tem00 speckle` and `tem00 list`: what is known without a scene.

use super::*;

#[test]
fn the_speckle_of_a_lens_is_told_without_a_scene() {
    let line = "speckle --wavelength 650nm --focal-length 25mm --f-number 8 --distance 300mm \
                --pixel-pitch 5.672727um --json";
    let found = json(folder().path(), line);
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    assert!((number(&found["sizes"][0]["sensor"]) - 5.672_727e-6).abs() < 1e-12);
    // A pixel as large as a speckle.
    assert!((number(&found["contrast"]) - 0.711_268).abs() < 1e-5);
    let across = &found["decorrelation"][1];
    assert_eq!(across["by"], "across");
    // Half of the pattern is left at 0.2321 D, none at D.
    assert!((number(&across["half"]) - 0.725_4e-3).abs() < 1e-7);
    assert!((number(&across["none"]) - 3.125e-3).abs() < 1e-8);
    let half = &found["decorrelation"][4]["half"];
    assert!(half.is_null(), "light along the sight: {half}");
}
