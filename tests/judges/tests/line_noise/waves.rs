use tem00::statistics::{
    laws::{SpeckledLine, imaged_line_centroid_deviation, line_centroid_deviation},
    t_test_mean,
};

use crate::line_image::{
    Row, blurred_profile, by_pattern, by_wave_optics, geometric_profile, positions,
};

/// Images of a line, each 40 speckle sizes long.
const IMAGES: u64 = 12;

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

fn by_waves(width: f64, images: u64) -> Vec<Vec<Row>> {
    let image = |seed| by_wave_optics(width, seed).expect("an image");
    (0..images).map(image).collect()
}

fn by_profile(profile: &[f64], images: u64) -> Vec<Vec<Row>> {
    let image = |seed| by_pattern(profile, seed).expect("a pattern");
    (0..images).map(image).collect()
}

#[test]
fn moments_of_lines_of_any_width_scatter_as_waves_say() {
    for width in [0.25, 1.0, 4.0] {
        let images = by_waves(width, IMAGES);
        for rows in [1, 4] {
            let pixels: Vec<_> = images.iter().map(|i| rows_of_pixels(i, rows)).collect();
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
    // Independent rows for a standard error of 1.6 %, a third of what is allowed.
    const MANY: u64 = 38;
    let width = 4.0;
    let waves = deviation(&by_waves(width, MANY));
    let pattern = deviation(&by_profile(&blurred_profile(width), MANY));
    let law = line_centroid_deviation(width, 0.0);
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
    for (width, blurred_over_waves) in [(0.25, 1.865), (0.5, 1.189)] {
        let waves = deviation(&by_waves(width, IMAGES));
        let blurred = deviation(&by_profile(&blurred_profile(width), IMAGES)) / waves;
        let sharp = deviation(&by_profile(&geometric_profile(width), IMAGES)) / waves;
        let line = SpeckledLine::new(width, 0.0).expect("a line");
        let sharp_over_waves =
            line.centroid_deviation() / imaged_line_centroid_deviation(width, 0.0);
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
