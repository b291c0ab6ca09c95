use core::f64::consts::PI;
use std::sync::LazyLock;

use tem00::statistics::{
    laws::{SpeckledLine, imaged_line_centroid_deviation, line_centroid_deviation},
    t_test_mean,
};

use crate::line_image::{
    Measured, Row, blurred_profile, by_pattern, by_wave_optics, geometric_profile, positions,
};

/// Images of a line, each 40 speckle sizes long.
const IMAGES: usize = 12;

/// A correct law fails a test of one width with this probability at a given set of seeds.
const SIGNIFICANCE: f64 = 1e-3;

/// 3.3 relative standard errors of a standard deviation: rows are independent at distances of 0.76
/// speckle sizes, and a moment of a thin line, the product of two amplitudes, has up to three times
/// the variance of its square that a Gaussian has.
const CHANCE: f64 = 0.16;

/// Returns the means over rows, four to a speckle size, that stand for pixels of `rows` of them.
fn rows_of_pixels(image: &[Row], rows: usize) -> Vec<Row> {
    let mean = |rows: &[Row]| {
        let sum = |x: usize| rows.iter().map(|row| row[x]).sum::<f64>();
        let count = rows.len() as f64;
        (0..rows[0].len()).map(|x| sum(x) / count).collect()
    };
    image.chunks_exact(rows).map(mean).collect()
}

/// Returns the mean square of the first moments of the rows of each image, in units of the mean
/// power.
fn moments(images: &[Vec<Row>]) -> Vec<f64> {
    let rows = || images.iter().flatten();
    let powers = rows().map(|row| row.iter().sum::<f64>());
    let power = powers.sum::<f64>() / rows().count() as f64;
    let moment = |row: &Row| positions().zip(row).map(|(x, i)| x * i).sum::<f64>() / power;
    let square = |rows: &Vec<Row>| {
        rows.iter().map(|row| moment(row).powi(2)).sum::<f64>() / rows.len() as f64
    };
    images.iter().map(square).collect()
}

fn deviation(images: &[Vec<Row>]) -> f64 {
    let squares = moments(images);
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// A line by its 1/e² half-width in speckle sizes, and its images by waves.
struct Line {
    width: f64,
    images: Vec<Vec<Row>>,
}

impl Line {
    fn new(width: f64, images: usize) -> Self {
        let image = |seed| by_wave_optics(width, seed).expect("an image");
        Self {
            width,
            images: (0..images as u64).map(image).collect(),
        }
    }

    fn measured(&self) -> Measured {
        measured(&self.images[..IMAGES], self.width)
    }

    /// As many images of the line as a pattern times a profile.
    fn by_profile(&self, profile: fn(f64) -> Row) -> Vec<Vec<Row>> {
        let profile = profile(self.width);
        let image = |seed| by_pattern(&profile, seed).expect("a pattern");
        (0..self.images.len() as u64).map(image).collect()
    }
}

/// The lines of all tests. Of the wide one so many images that independent rows leave a standard
/// error of 1.6 %, a third of what is allowed.
static LINES: [LazyLock<Line>; 4] = [
    LazyLock::new(|| Line::new(0.25, IMAGES)),
    LazyLock::new(|| Line::new(0.5, IMAGES)),
    LazyLock::new(|| Line::new(1.0, IMAGES)),
    LazyLock::new(|| Line::new(4.0, 38)),
];

fn measured(images: &[Vec<Row>], width: f64) -> Measured {
    Measured::of(&images.concat(), width)
}

#[test]
fn moments_of_lines_of_any_width_scatter_as_waves_say() {
    let [quarter, _, one, wide] = &LINES;
    for line in [quarter, one, wide] {
        let width = line.width;
        for rows in [1, 4] {
            let images = line.images[..IMAGES].iter();
            let pixels: Vec<_> = images.map(|image| rows_of_pixels(image, rows)).collect();
            let row_height = if rows == 1 { 0.0 } else { 1.0 };
            let law = imaged_line_centroid_deviation(width, row_height);
            let test = t_test_mean(&moments(&pixels), law * law).expect("images that differ");
            assert!(
                test.p_value > SIGNIFICANCE,
                "w = {width} h, p = {row_height} h: {:.4} h | {law:.4} h, p = {:e}",
                deviation(&pixels),
                test.p_value
            );
        }
    }
}

#[test]
fn wide_lines_scatter_as_their_closed_form_says() {
    let [.., line] = &LINES;
    let waves = deviation(&line.images);
    let pattern = deviation(&line.by_profile(blurred_profile));
    let law = line_centroid_deviation(line.width, 0.0);
    // First order of the blurred pattern at this width, by the quadrature named below.
    for (name, measured, expected) in [("waves", waves, law), ("pattern", pattern, 0.989 * law)] {
        let ratio = measured / expected;
        assert!(
            (ratio - 1.0).abs() < 0.05,
            "{name}: {ratio:.3} of what is expected"
        );
    }
}

#[test]
fn patterns_say_too_much_of_thin_lines_if_blurred_and_too_little_if_sharp() {
    for (line, blurred_over_waves) in LINES.iter().zip([1.865, 1.189]) {
        let width = line.width;
        let waves = deviation(&line.images);
        let [blurred, sharp] = [blurred_profile, geometric_profile]
            .map(|profile| deviation(&line.by_profile(profile)) / waves);
        let law = SpeckledLine::new(width, 0.0).expect("a line");
        let sharp_over_waves =
            law.centroid_deviation() / imaged_line_centroid_deviation(width, 0.0);
        // Both of a ratio have the error. The number for the blurred line is from
        // ∫ (d/df [exp(−π²w²f²/2) chat(f)] / 2π)² S(f) df.
        for (ratio, expected) in [(blurred, blurred_over_waves), (sharp, sharp_over_waves)] {
            assert!(
                (ratio / expected - 1.0).abs() < CHANCE * 2.0_f64.sqrt(),
                "w = {width} h: {ratio:.3} | {expected:.3}"
            );
        }
    }
}

/// Four times the relative standard error 1/√(2K) of a standard deviation, from the K = 12 · 40 ·
/// π/4 speckles along the images.
const FOUR_ERRORS: f64 = 0.15;

#[test]
fn centroids_of_lines_scatter_as_the_closed_form_says() {
    let [quarter, _, one, wide] = &LINES;
    for line in [quarter, one, wide] {
        let width = line.width;
        // First order in the fluctuations, √(w ℓ / (8 √π)) with ℓ = 32 h/3π² for the points of a
        // row.
        let law = (width * 32.0 / (3.0 * PI * PI) / (8.0 * PI.sqrt())).sqrt();
        let ratio = line.measured().centroid_noise / law;
        assert!(
            (ratio - 1.0).abs() < FOUR_ERRORS,
            "w = {width} h: {ratio:.3}"
        );
    }
}

#[test]
fn a_pattern_times_the_blurred_irradiance_is_right_from_one_speckle_on() {
    for line in &LINES[2..] {
        let (width, waves) = (line.width, line.measured());
        let pattern = measured(&line.by_profile(blurred_profile)[..IMAGES], width);
        let noise = pattern.centroid_noise / waves.centroid_noise;
        let full = pattern.width / waves.width;
        // Both have the error.
        assert!(
            (noise - 1.0).abs() < FOUR_ERRORS * 2.0_f64.sqrt(),
            "w = {width} h: {noise:.3}"
        );
        assert!((full - 1.0).abs() < FOUR_ERRORS, "w = {width} h: {full:.3}");
    }
}

#[test]
fn a_line_thinner_than_a_speckle_is_no_pattern_times_an_irradiance() {
    let [line, ..] = &LINES;
    let waves = line.measured();
    let [blurred, sharp] = [blurred_profile, geometric_profile]
        .map(|profile| measured(&line.by_profile(profile), line.width));
    // Its image is one speckle wide, and no part of it twinkles by itself.
    assert!(
        (waves.width / blurred.width - 1.0).abs() < FOUR_ERRORS,
        "{:.3}",
        waves.width
    );
    assert!(waves.across > 0.7, "{:.3}", waves.across);
    assert!(blurred.across < 0.2, "{:.3}", blurred.across);
    // Light that interferes across the whole line leaves more contrast in a row than light that
    // was added up.
    let contrast = blurred.row_contrast / waves.row_contrast;
    assert!(contrast < 0.9, "{contrast:.3}");
    // Patterns say too much, or far too little, of its centroid.
    let noise = blurred.centroid_noise / waves.centroid_noise;
    assert!(noise > 1.2, "{noise:.3}");
    let noise = sharp.centroid_noise / waves.centroid_noise;
    assert!(noise < 0.4, "{noise:.3}");
    assert!(sharp.width < 0.35 * waves.width, "{:.3}", sharp.width);
}
