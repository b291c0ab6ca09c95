use tem00_numerics::Grid;
use tem00_speckle::PupilField;

use super::*;
use crate::comparison::Expectation;

fn measured(values: Grid<f32>) -> Measurement {
    measure(Path::new("pattern"), &loaded(values), (None, true)).expect("an image of speckle")
}

fn loaded(values: Grid<f32>) -> LoadedImage {
    LoadedImage {
        values,
        interpretation: "computed".into(),
        saturated: None,
        unit: Some(1.0),
        step: None,
    }
}

fn row<'a>(found: &'a Measurement, quantity: &str) -> &'a Row {
    let mut rows = found.rows.iter();
    let row = rows.find(|row| row.quantity == quantity);
    row.expect("the row is there")
}

fn value(found: &Measurement, quantity: &str) -> f64 {
    row(found, quantity).measured
}

/// Returns the difference from theory in tolerances.
fn deviation(found: &Measurement, quantity: &str) -> f64 {
    match row(found, quantity).theory {
        Expectation::Near { value, tolerance } => {
            (row(found, quantity).measured - value).abs() / tolerance
        }
        _ => panic!("{quantity} has a theory"),
    }
}

fn drawn(measurement: &Measurement) -> String {
    let page = page::Page {
        title: "speckle & <light>",
        curves: &measurement.curves,
    };
    page.draw().svg().to_owned()
}

/// A window out of a pattern with speckles of 4 samples, and its own brightness.
fn window(seed: u64) -> Grid<f32> {
    let pattern = PupilField::new(512, 128, seed).expect("valid").pattern();
    Grid::from_fn(400, 300, |x, y| 7.0 * pattern.values()[(x, y)])
}

#[test]
fn fully_developed_speckle_is_recognised() {
    let found = measured(window(3));
    assert!(deviation(&found, "contrast") < 1.0, "{found:?}");
    // The size spreads by 0.58 / n; the window is at least 75 speckles wide: 3 % are 4 σ.
    for axis in ["x", "y"] {
        let size = value(&found, &format!("speckle size {axis} (pixels)"));
        assert!(
            (size / 4.0 - 1.0).abs() < 0.031,
            "speckle size {axis} is {size}"
        );
    }
    assert!(
        value(&found, "KS p-value of exponential") > 1e-3,
        "{found:?}"
    );
}

#[test]
fn averaged_speckle_is_gamma_and_not_exponential() {
    let (a, b) = (window(4), window(5));
    let sum = Grid::from_fn(400, 300, |x, y| a[(x, y)] + b[(x, y)]);
    let found = measured(sum);
    assert!(
        value(&found, "KS p-value of exponential") < 1e-6,
        "{found:?}"
    );
    assert!(value(&found, "KS p-value of Gamma") > 1e-3, "{found:?}");
    // The shape is 2 to the error that is stated, and some 3/n of bias.
    let error = value(&found, "its standard error");
    assert!(
        (value(&found, "shape of Gamma") - 2.0).abs() < 4.0 * error + 1e-3,
        "{found:?}"
    );
    let page = drawn(&found);
    for text in [
        "speckle &amp; &lt;light&gt;",
        "Histogram",
        "Gamma, M = ",
        "Autocovariance",
        "Airy, x",
        "Power spectrum",
    ] {
        assert!(page.contains(text), "{text} is on the page");
    }
    assert!(!page.contains("NaN"), "every point has a place");
}

#[test]
fn speckle_below_a_pixel_is_measured_without_a_size() {
    let pattern = PupilField::new(512, 256, 6).expect("valid").pattern();
    // Every fifth sample at a speckle size of 2: nothing correlates.
    let sparse = Grid::from_fn(100, 100, |x, y| pattern.values()[(5 * x, 5 * y)]);
    let found = measured(sparse);
    let mut quantities = found.rows.iter().map(|row| &row.quantity);
    assert!(quantities.all(|name| !name.contains("size")), "{found:?}");
    let page = drawn(&found);
    assert!(!page.contains("Airy") && !page.contains("pupil"), "no size");
    assert!(
        value(&found, "KS p-value of exponential") > 1e-3,
        "{found:?}"
    );
}

#[test]
fn rounding_to_few_grey_levels_is_no_deviation() {
    for (seed, mean) in [(7, 0.5), (8, 3.0), (9, 30.0)] {
        let light = window(seed).map(|value| (value / 7.0 * mean).round());
        let found = measured(light);
        for test in ["KS", "χ²"] {
            let p_value = value(&found, &format!("{test} p-value of exponential"));
            assert!(p_value > 1e-3, "{test} at {mean} levels: {found:?}");
        }
        let off = deviation(&found, "contrast");
        assert!(off < 1.0, "{off} at {mean} levels");
    }
}

#[test]
fn black_pixels_of_a_rounded_image_are_light_below_half_a_level() {
    let found = measured(window(9).map(|value| (value / 7.0 * 30.0).round()));
    let (shape, error) = ("shape of Gamma", "its standard error");
    let [shape, error] = [shape, error].map(|quantity| row(&found, quantity).measured);
    assert!((shape - 1.0).abs() < 4.0 * error, "{shape} ± {error}");
    let none = |note: &String| !note.contains("some samples are 0");
    assert!(found.assumptions.iter().all(none), "{found:?}");
}

#[test]
fn few_grey_levels_allow_no_fit() {
    let found = measured(window(8).map(|value| (value / 7.0 * 3.0).round()));
    let quantities = found.rows.iter().map(|row| &row.quantity);
    let mut fitted =
        quantities.filter(|name| name.contains("Gamma") || name.starts_with("contrast, if"));
    assert_eq!(fitted.next(), None, "three levels");
}

/// The warning of a pedestal, if there is one.
fn pedestal(values: Grid<f32>) -> Option<String> {
    let mut warnings = measured(values).warnings.into_iter();
    warnings.find(|warning| warning.contains("--black-level"))
}

#[test]
fn a_pedestal_is_told_by_the_darkest_values() {
    // A tenth of the mean of 3500 to thirty times the mean of 70 over a black level of 64 and more.
    for (mean, level) in [
        (3_500.0, 350.0),
        (300.0, 64.0),
        (70.0, 64.0),
        (200.0, 6_000.0),
    ] {
        let raw = window(21).map(|value| (value / 7.0 * mean + level).round());
        let told = pedestal(raw).expect("a warning");
        let mut words = told.split("--black-level ").nth(1).into_iter();
        let number = words.find_map(|rest| rest.split(' ').next()?.parse::<f32>().ok());
        let number = number.expect("a number");
        // A thousandth of the pixels have less than a thousandth of the mean.
        let is_near = (number - level).abs() < 2e-3 * mean + 1.0;
        assert!(is_near, "{mean} + {level}: {told}");
    }
    let two = |degree: f32| {
        let (a, b) = (window(22), window(23));
        Grid::from_fn(400, 300, |x, y| a[(x, y)] + degree * b[(x, y)])
    };
    let many = |count: u64| {
        let patterns: Vec<_> = (30..30 + count).map(window).collect();
        Grid::from_fn(400, 300, |x, y| {
            patterns.iter().map(|p| p[(x, y)]).sum::<f32>()
        })
    };
    let coarse = |mean: f32| window(24).map(|value| (value / 7.0 * mean).round());
    for (name, values) in [
        ("one pattern", window(21)),
        ("two patterns", two(1.0)),
        ("partly polarised", two(0.3)),
        ("five patterns", many(5)),
        ("twenty patterns", many(20)),
        ("a mean of 3 levels", coarse(3.0)),
        ("a mean of 40 levels", coarse(40.0)),
    ] {
        assert_eq!(pedestal(values), None, "{name}");
    }
}

#[test]
fn pixels_without_gaps_see_the_contrast_of_their_size() {
    let pattern = PupilField::new(1024, 128, 10).expect("valid").pattern();
    // Speckles of 8 samples, on pixels of 6 × 6 samples.
    let sum = |x: usize, y: usize| {
        let samples = (0..36).map(|i| pattern.values()[(6 * x + i % 6, 6 * y + i / 6)]);
        samples.sum::<f32>()
    };
    let found = measured(Grid::from_fn(170, 170, sum));
    let off = deviation(&found, "contrast, if pixels have no gaps");
    assert!(off < 1.0, "{found:?}");
    assert!(deviation(&found, "contrast") > 2.0, "{found:?}");
    assert_eq!(
        row(&found, "contrast").verdict,
        None,
        "not judged as points"
    );
    for law in ["KS p-value of exponential", "shape of Gamma"] {
        assert_eq!(row(&found, law).theory, Expectation::Open, "{law}");
    }
    let fine = PupilField::new(1024, 512, 10).expect("valid").pattern();
    let points = measured(Grid::from_fn(1024, 1024, |x, y| fine.values()[(x, y)]));
    assert!(row(&points, "contrast").agrees(), "{points:?}");
    let gapless = row(&points, "contrast, if pixels have no gaps");
    assert_eq!(gapless.verdict, None, "not judged as areas");
}

#[test]
fn an_interval_holds_the_contrast() {
    let found = measured(window(11));
    let contrast = value(&found, "contrast");
    let [low, high] = ["from", "to"].map(|end| value(&found, &format!("contrast, {end} (95 %)")));
    assert!(low < contrast && contrast < high, "{low} {contrast} {high}");
    // ± 1.96 · 0.765 / n in the logarithm, for n = √(400 · 300) / 4 = 87; the error is estimated
    // from the samples.
    let width = (high / low).ln() / (2.0 * 1.96 * 0.765 / 86.6);
    assert!((0.8..1.25).contains(&width), "{width}");
}

#[test]
fn an_even_image_is_no_speckle() {
    let image = loaded(Grid::filled(20, 20, 1.0));
    let found = measure(Path::new("grey"), &image, (None, true));
    assert!(found.is_err(), "nothing varies");
}
