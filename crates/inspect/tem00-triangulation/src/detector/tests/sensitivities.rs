use tem00_testkit::assert_absolute;

use super::*;

const SIGMA: f64 = 2.5;

#[test]
fn of_the_centre_of_gravity_are_the_lever_arms() {
    let detector = detector(LineMethod::CentreOfGravity, 31);
    let column = integrated(LENGTH, MIDDLE + 0.2, SIGMA);
    let point = only(&detector, &column);
    let sensitivities = detector.sensitivities(&column, &point);
    for (i, found) in sensitivities.iter().enumerate().take(216).skip(185) {
        let lever = (i as f64 + 0.5 - point.position) / point.integral;
        // The 370 pixels of the background take the sum of the window, 31 · 0.2 / 370 of a pixel.
        // The difference over 1e−4 of the peak errs by the square of that, the rest is rounding
        // over it. The ends of the window, at e^(−18) of the peak, move the position by 1e−7 for
        // each pixel that it moves.
        assert_absolute(found - lever, 0.0, 1e-9 * lever.abs() + 1e-10);
    }
    let outside = 31.0 * (point.position - MIDDLE) / (370.0 * point.integral);
    assert_absolute(sensitivities[3], outside, 1e-11);
}

/// Returns the change of a position over the step of a column, by its sensitivities.
fn moved(sensitivities: &[f64], [more, less]: [&[f32]; 2], step: f64) -> f64 {
    let motion = more
        .iter()
        .zip(less)
        .map(|(m, l)| f64::from(m - l) / (2.0 * step));
    sensitivities.iter().zip(motion).map(|(g, d)| g * d).sum()
}

#[test]
fn follow_a_line_that_moves_and_ignore_a_background_that_rises() {
    // Σ g_i dI_i/dc is the derivative of the position by c: 1 but for the derivative of the bias.
    // Rounding of f32 over the step: 1e−7/1e−2 each.
    let step = 0.01;
    for method in methods() {
        let detector = detector(method, 31);
        for phase in [-0.35, 0.1, 0.2] {
            let at = |off: f64| integrated(LENGTH, MIDDLE + phase + off, SIGMA);
            let (column, more, less) = (at(0.0), at(step), at(-step));
            let position = |column: &[f32]| only(&detector, column).position;
            let expected = (position(&more) - position(&less)) / (2.0 * step);
            let sensitivities = detector.sensitivities(&column, &only(&detector, &column));
            let moved = moved(&sensitivities, [&more, &less], step);
            // The difference errs by step²/6 of the third derivative of the position: up to 40
            // where linear interpolation, whose flanks change at the middle of a pixel, is near to
            // that.
            assert_absolute(moved, expected, 7e-4);
            assert!(
                (expected - 1.0).abs() < 0.7,
                "{method} at {phase} follows: {expected}"
            );
            let sum: f64 = sensitivities.iter().sum();
            assert!(
                sum.abs() < 1e-12,
                "{method}: a background moves it by {sum}"
            );
        }
    }
}

#[test]
fn take_the_window_along_with_a_line_that_has_wings() {
    // A line that moves on by a pixel is found a pixel further on: over all positions in a pixel Σ
    // g_i dI_i/dc is 1 in the mean, with the light that the window loses at one end and gains at
    // the other.
    let line = |centre: f64| -> Vec<f32> {
        let wings = |i: usize| 1000.0 / (1.0 + ((i as f64 + 0.5 - centre) / 2.0).powi(2));
        (0..LENGTH).map(|i| to_f32(wings(i))).collect()
    };
    for (method, by_window) in [
        (LineMethod::CentreOfGravity, 0.1),
        (LineMethod::IteratedCentreOfGravity, 0.0),
        (LineMethod::Parabola, 0.0),
    ] {
        let detector = detector(method, 21);
        let follows = |phase: u32| {
            let centre = MIDDLE + (f64::from(phase) + 0.5) / 32.0 - 0.5;
            let column = line(centre);
            let sensitivities = detector.sensitivities(&column, &only(&detector, &column));
            let step = 0.01;
            moved(
                &sensitivities,
                [&line(centre + step), &line(centre - step)],
                step,
            )
        };
        let mean = (0..32).map(follows).sum::<f64>() / 32.0;
        // What the ends of the window are worth changes over a pixel, and the vertex of the
        // smoothed column does not move evenly: a twentieth of the fraction of the window.
        assert_absolute(mean, 1.0, 1e-3 + 0.05 * by_window);
    }
}

#[test]
fn of_columns_without_a_line_are_zero() {
    let detector = detector(LineMethod::GaussianFit, 31);
    let point = only(&detector, &integrated(LENGTH, MIDDLE, SIGMA));
    assert_eq!(detector.sensitivities(&[7.0; 50], &point), [0.0; 50]);
    assert_eq!(detector.sensitivities(&[], &point), [] as [f64; 0]);
}
