use proptest::prelude::*;
use tem00_testkit::refuses;

use super::*;

/// Any grey value: usual ones, zero, huge ones, infinity and NaN.
fn any_value() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => 0.0_f32..4095.0,
        2 => Just(0.0_f32),
        1 => any::<f32>(),
        1 => prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(f32::MAX), Just(f32::MIN)],
    ]
}

fn finder(method: LineMethod) -> LineDetector {
    let (min_peak, max_lines, saturation) = (0.0, 3, 1e30);
    LineDetector::new(DetectorSettings {
        method,
        window: 17,
        min_peak,
        max_lines,
        saturation,
    })
    .unwrap()
}

#[test]
fn sensitivities_are_finite_where_the_window_moves_off_its_greatest_pixel() {
    let mut column = [0.0; 21];
    (column[7], column[12]) = (2768.6082, 3648.5037);
    (column[8], column[15]) = (f32::MIN, f32::MIN);
    for method in methods() {
        let detector = finder(method);
        let points = detector.detect_column(&column);
        assert!(!points.is_empty(), "{method}");
        for point in points {
            let sensitivities = detector.sensitivities(&column, &point);
            let all = sensitivities.iter().all(|g| g.is_finite());
            assert!(all, "{method}: {sensitivities:?}");
        }
    }
}

/// A ragged line in the dark, `before` pixels from the top of 160.
fn ragged(values: &[f32], before: usize) -> Vec<f32> {
    let mut column = vec![0.0; 160];
    column[before..before + values.len()].copy_from_slice(values);
    column
}

/// Nearly flat about its minimum, and much of the light is left over: Gauss-Newton's steps shrink
/// slowly.
#[test]
fn a_fit_of_slow_steps_is_mirrored_too() {
    let values = [
        49.048534, 137.73564, 167.82512, 149.71228, 6.5042915, 152.32921, 83.945366, 167.01836,
        124.788536, 175.42479, 76.27158, 81.605034, 124.190186, 75.99101, 67.471, 5.089039,
        112.10621,
    ];
    is_found_mirrored(&values).unwrap();
}

/// Holds positions of a line and of its mirror image together.
fn is_found_mirrored(values: &[f32]) -> Result<(), TestCaseError> {
    let column = ragged(values, 60);
    let mirrored: Vec<f32> = column.iter().rev().copied().collect();
    for method in methods() {
        let here = finder(method).detect_column(&column);
        let there = finder(method).detect_column(&mirrored);
        prop_assert_eq!(here.len(), there.len());
        for (a, b) in here.iter().zip(there.iter().rev()) {
            let sum = a.position + b.position;
            prop_assert!((sum - 160.0).abs() < 1e-7, "{method}: {a:?} {b:?}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn any_column_gives_finite_points_inside_of_it(
        column in prop::collection::vec(any_value(), 0..80),
    ) {
        for method in methods() {
            let detector = finder(method);
            for point in detector.detect_column(&column) {
                let numbers = [point.width, point.peak, point.integral, point.background];
                prop_assert!(numbers.iter().all(|x| x.is_finite()), "{method}: {point:?}");
                prop_assert!(point.width >= 0.0 && point.peak > 0.0, "{method}: {point:?}");
                let inside = 0.0..=column.len() as f64;
                prop_assert!(inside.contains(&point.position), "{method}: {point:?}");
                let sensitivities = detector.sensitivities(&column, &point);
                prop_assert!(
                    sensitivities.iter().all(|g| g.is_finite()),
                    "{method}: {sensitivities:?}"
                );
            }
        }
    }

    #[test]
    fn any_image_gives_finite_points_inside_of_it(
        values in prop::collection::vec(any_value(), 12 * 40),
    ) {
        let image = Grid::from_vec(12, 40, values).unwrap();
        for method in [LineMethod::CentreOfGravity, LineMethod::Steger { sigma: 1.0 }] {
            for point in finder(method).detect(&image).into_iter().flatten() {
                prop_assert!((0.0..=40.0).contains(&point.position), "{method}: {point:?}");
                prop_assert!(point.line < 12 * 3, "{method}: {point:?}");
            }
        }
    }

    #[test]
    fn a_line_that_moves_by_whole_pixels_is_found_moved_by_them(
        values in prop::collection::vec(1.0_f32..200.0, 12..30), before in 30..80_usize,
    ) {
        for method in methods() {
            let points = |before| finder(method).detect_column(&ragged(&values, before));
            let (here, there) = (points(before), points(before + 17));
            prop_assert_eq!(here.len(), there.len());
            for (a, b) in here.iter().zip(&there) {
                // Rounding of the number 100 and, of the widest fit, a part of 1e−9.
                prop_assert!(
                    (b.position - a.position - 17.0).abs() < 1e-8,
                    "{method}: {a:?} {b:?}"
                );
                prop_assert_eq!(a.validity, b.validity);
            }
        }
    }

    #[test]
    fn a_mirrored_line_is_found_mirrored(values in prop::collection::vec(1.0_f32..200.0, 12..30)) {
        is_found_mirrored(&values)?;
    }

    #[test]
    fn brighter_lines_are_found_at_the_same_position(
        values in prop::collection::vec(1.0_f32..200.0, 12..30), power in -10_i32..10,
    ) {
        // A power of two changes no digit.
        let scaled: Vec<f32> = values.iter().map(|value| value * f32::powi(2.0, power)).collect();
        for method in methods() {
            let here = finder(method).detect_column(&ragged(&values, 60));
            let there = finder(method).detect_column(&ragged(&scaled, 60));
            prop_assert_eq!(here.len(), there.len());
            for (a, b) in here.iter().zip(&there) {
                // Only logarithms round anew.
                prop_assert!((a.position - b.position).abs() < 1e-9, "{method}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn validity_says_what_speaks_against_a_point() {
    let settings = DetectorSettings {
        saturation: 900.0,
        ..DetectorSettings::default()
    };
    let detector = LineDetector::new(settings).unwrap();
    let bright = integrated(LENGTH, MIDDLE, 3.0);
    let dim: Vec<f32> = bright.iter().map(|v| 0.8 * v).collect();
    let mut dead = dim.clone();
    dead[190] = f32::NAN;
    for (column, expected) in [
        (&dim[..], Validity::Valid),
        (&bright, Validity::Saturated),
        // 10 pixels to the edge.
        (&dim[190..], Validity::Cut),
        (&dead, Validity::Missing),
    ] {
        assert_eq!(only(&detector, column).validity, expected);
    }
    let fitted = super::detector(LineMethod::GaussianFit, 31);
    let mut spike = vec![0.0; LENGTH];
    spike[200] = 500.0;
    let point = only(&fitted, &spike);
    assert_eq!((point.validity, point.position), (Validity::Failed, 200.5));
}

#[test]
fn marked_pixels_saturate_the_points_whose_windows_hold_them() {
    let column: Vec<f32> = integrated(LENGTH, MIDDLE, 3.0);
    let image = Grid::from_fn(3, LENGTH, |x, y| column[y] + x as f32);
    for method in methods() {
        let detector = detector(method, 31);
        let plain = detector.detect(&image);
        let none = Grid::filled(3, LENGTH, false);
        assert_eq!(detector.detect_marked(&image, &none), plain, "{method}");
        let greatest = |a: &usize, b: &usize| column[*a].total_cmp(&column[*b]);
        let middle = (0..LENGTH).max_by(greatest).unwrap();
        // At the end of the window of the second column, and far outside of that of the third.
        let places = [(1, middle + 12), (2, middle + 40)];
        let marked = Grid::from_fn(3, LENGTH, |x, y| places.contains(&(x, y)));
        let mut found = detector.detect_marked(&image, &marked);
        assert_eq!(found[1][0].validity, Validity::Saturated, "{method}");
        found[1][0].validity = plain[1][0].validity;
        assert_eq!(found, plain, "{method}");
    }
}

#[test]
fn settings_outside_of_their_range_are_refused() {
    refuses!(settings = DetectorSettings::default() => LineDetector::new(settings);
        settings.window: [0, 30, 1003],
        settings.min_peak: [-1.0, f64::NAN],
        settings.max_lines: [0, 101],
        settings.saturation: [f64::NAN, 0.0],
        settings.method as "sigma": [LineMethod::Steger { sigma: f64::NAN }],
        settings.method as "threshold": [LineMethod::ThresholdedCentreOfGravity { threshold: 1.0 }],
        settings.method as "pixels in the window": [LineMethod::Steger { sigma: 5.0 }],
    );
    for (method, window) in [(order(8), 9), (LineMethod::GaussianFit, 5)] {
        let usual = DetectorSettings::default();
        let refused = LineDetector::new(DetectorSettings {
            method,
            window,
            ..usual
        });
        assert!(refused.is_err(), "{method} in {window} pixels");
    }
}
