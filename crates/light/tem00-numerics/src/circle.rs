//! Points of the unit circle at fractions of a turn.
//!
//! Random angles are drawn as fractions of a turn, for which sine and cosine need no argument
//! reduction and take a third of the time of the general functions.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Returns the point of the unit circle at the angle 2π `turn`, for `turn` in [0, 1].
///
/// Both coordinates err by less than 3e−16.
pub fn circle_point_at_turn(turn: f64) -> [f64; 2] {
    // The number of the nearest quarter and the remainder are exact.
    let quarters = 4.0 * turn;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is one of the numbers from 0 to 4"
    )]
    let nearest = (quarters + 0.5) as u32;
    let [x, y] = at_small_angle(FRAC_PI_2 * (quarters - f64::from(nearest)));
    // Turning by a quarter is exact, too. A table avoids a branch, which processors predict badly
    // here.
    let [cos, sin] = QUARTERS[nearest as usize % 4];
    [cos * x - sin * y, sin * x + cos * y]
}

/// The points of the circle at the quarters of a turn.
const QUARTERS: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

/// Returns the point of the unit circle at the angle π/4 `fraction`, for `fraction` in [−1, 1].
///
/// Both coordinates err by less than 3e−16.
#[inline(always)]
pub fn circle_point_at_eighth(fraction: f64) -> [f64; 2] {
    at_small_angle(FRAC_PI_4 * fraction)
}

/// Taylor series of cosine and sine: up to π/4 the remainder is below 5e−17.
#[inline(always)]
fn at_small_angle(angle: f64) -> [f64; 2] {
    const fn inverse_factorial(n: u32) -> f64 {
        let (mut product, mut factor) = (1.0, 1);
        while factor < n {
            factor += 1;
            product *= factor as f64;
        }
        1.0 / product
    }
    const COSINE: [f64; 8] = [
        inverse_factorial(16),
        -inverse_factorial(14),
        inverse_factorial(12),
        -inverse_factorial(10),
        inverse_factorial(8),
        -inverse_factorial(6),
        inverse_factorial(4),
        -inverse_factorial(2),
    ];
    const SINE: [f64; 7] = [
        -inverse_factorial(15),
        inverse_factorial(13),
        -inverse_factorial(11),
        inverse_factorial(9),
        -inverse_factorial(7),
        inverse_factorial(5),
        -inverse_factorial(3),
    ];
    let square = angle * angle;
    let series = |terms: &[f64]| terms.iter().fold(0.0, |sum, term| sum * square + term);
    [
        1.0 + square * series(&COSINE),
        angle + angle * square * series(&SINE),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_those_of_the_general_functions() {
        for index in 0..=100_000 {
            let turn = f64::from(index) / 100_000.0;
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * turn);
            // The argument of the general functions is rounded: up to 4.4e−16 for numbers up to 2π.
            let [x, y] = circle_point_at_turn(turn);
            assert!(
                (x - cos).abs() <= 8e-16 && (y - sin).abs() <= 8e-16,
                "{turn}"
            );
        }
    }

    #[test]
    fn eighths_are_those_of_the_general_functions() {
        for index in -10_000..=10_000 {
            let fraction = f64::from(index) / 10_000.0;
            let (sin, cos) = libm::sincos(FRAC_PI_4 * fraction);
            let [x, y] = circle_point_at_eighth(fraction);
            // Two roundings of numbers up to 1, and the rounding of the general functions.
            assert!(
                (x - cos).abs() <= 4e-16 && (y - sin).abs() <= 4e-16,
                "{fraction}"
            );
        }
    }

    #[test]
    fn quarter_turns_are_exact() {
        let [right, up, left, down] = QUARTERS;
        let corners = [right, up, left, down, right];
        for (turn, corner) in [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().zip(corners) {
            let point = circle_point_at_turn(turn);
            let [x, y] = [0, 1].map(|i| point[i] - corner[i]);
            assert!(x == 0.0 && y == 0.0, "{turn}: {point:?}");
        }
    }
}
