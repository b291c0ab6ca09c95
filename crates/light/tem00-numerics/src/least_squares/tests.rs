use tem00_testkit::assert_absolute;

use super::{LeastSquaresError, Residual, minimise_residuals};

/// y = p₀ + p₁ x, fitted to (0, 1), (1, 2), (2, 4), (3, 4).
fn line(p: &[f64; 2], i: usize) -> Residual<2> {
    let (x, y) = ([0.0, 1.0, 2.0, 3.0][i], [1.0, 2.0, 4.0, 4.0][i]);
    Residual {
        value: y - p[0] - p[1] * x,
        slopes: [-1.0, -x],
    }
}

#[test]
fn straight_line_has_its_textbook_solution() {
    let minimum = minimise_residuals([100.0, -70.0], 4, line).unwrap();
    // By hand: S_x = 6, S_xx = 14, S_y = 11, S_xy = 22, det = 4 · 14 − 6² = 20.
    let expected = [
        (14.0 * 11.0 - 6.0 * 22.0) / 20.0,
        (4.0 * 22.0 - 6.0 * 11.0) / 20.0,
    ];
    let covariance = [[14.0 / 20.0, -6.0 / 20.0], [-6.0 / 20.0, 4.0 / 20.0]];
    for i in 0..2 {
        let error = minimum.state[i] - expected[i];
        // The search stops when the sum may fall by 1e−14 of itself: 1e−7 of √sum.
        assert!(error.abs() < 1e-7, "p{i}: {error:e}");
        for (j, expected) in covariance[i].into_iter().enumerate() {
            assert_absolute(minimum.covariance[i][j], expected, 1e-14);
        }
    }
    // Residuals −0.1, −0.2, 0.7, −0.4.
    assert_absolute(minimum.sum_of_squares, 0.7, 1e-13);
}

#[test]
fn units_of_parameters_and_residuals_do_not_matter() {
    let plain = minimise_residuals([100.0, -70.0], 4, line).unwrap();
    let scaled = minimise_residuals([100.0 * 1e9, -70.0 * 1e-9], 4, |p, i| {
        let Residual { value, slopes } = line(&[p[0] * 1e-9, p[1] * 1e9], i);
        Residual {
            value: 1e5 * value,
            slopes: [1e5 * slopes[0] * 1e-9, 1e5 * slopes[1] * 1e9],
        }
    })
    .unwrap();
    let ratio = scaled.covariance[0][1] / plain.covariance[0][1] * 1e10;
    assert!((ratio - 1.0).abs() < 1e-13, "{ratio}");
    assert_absolute(scaled.state[0] / plain.state[0] / 1e9, 1.0, 1e-7);
}

#[test]
fn curved_valley_is_followed_to_its_end() {
    // H. H. Rosenbrock's function, Computer Journal 3, 175, 1960.
    let minimum = minimise_residuals([-1.2, 1.0], 2, |[x, y], i| match i {
        0 => Residual {
            value: 10.0 * (y - x * x),
            slopes: [-20.0 * x, 10.0],
        },
        _ => Residual {
            value: 1.0 - x,
            slopes: [-1.0, 0.0],
        },
    })
    .unwrap();
    for parameter in minimum.state {
        assert!((parameter - 1.0).abs() < 1e-12, "{minimum:?}");
    }
}

#[test]
fn steps_that_overshoot_are_taken_back() {
    // Newton's method for the root of the arc tangent diverges from starts beyond 1.39.
    let minimum = minimise_residuals([20.0], 1, |&[x], _| Residual {
        value: x.atan(),
        slopes: [1.0 / (1.0 + x * x)],
    });
    let [x] = minimum.unwrap().state;
    assert!(x.abs() < 1e-12, "{x}");
}

#[test]
fn parameters_without_influence_are_reported() {
    let same = |p: &[f64; 2], i: usize| Residual {
        value: line(&[p[0] + p[1], 0.0], i).value,
        slopes: [-1.0, -1.0],
    };
    let blind = |p: &[f64; 2], i: usize| Residual {
        value: line(&[p[0], 0.0], i).value,
        slopes: [-1.0, 0.0],
    };
    let results = [
        minimise_residuals([0.0; 2], 4, same),
        minimise_residuals([0.0; 2], 4, blind),
    ];
    for result in results {
        assert!(
            matches!(result, Err(LeastSquaresError::Undetermined)),
            "{result:?}"
        );
    }
}

#[test]
fn residuals_that_are_not_numbers_end_the_search() {
    let result = minimise_residuals([0.0], 3, |_, _| Residual {
        value: f64::NAN,
        slopes: [1.0],
    });
    assert!(
        matches!(result, Err(LeastSquaresError::NotConverged)),
        "{result:?}"
    );
}
