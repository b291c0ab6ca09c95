use super::*;

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn numbers_are_refused_exactly_outside_what_is_allowed() {
    type Check = fn(f64) -> Result<(), Failure>;
    let checks: [(Check, &[f64], &[f64]); 6] = [
        (
            |x| check_coordinates("x", &[x]),
            &[0.0, -1e30, 1e30],
            &[1.000_001e30, -1.000_001e30],
        ),
        (
            |x| check_number("x", x).map(drop),
            &[0.0, f64::MAX, -f64::MAX],
            &[],
        ),
        (
            |x| check_variate("x", x).map(drop),
            &[0.0, 1.0 - f64::EPSILON],
            &[1.0, -1e-300],
        ),
        (
            |x| check_length("x", x).map(drop),
            &[0.0, 1e30],
            &[-1e-300, 1.000_001e30],
        ),
        (
            |x| check_size("x", x).map(drop),
            &[1e-300, 1e30],
            &[0.0, -1e-300, 1.000_001e30],
        ),
        (
            |x| unit_vector("x", [0.0, 0.6 * x, 0.8 * x]).map(drop),
            &[1.0, -1e-300, 1e-300, 1e30],
            &[0.0, 2e30],
        ),
    ];
    for (i, (check, allowed, refused)) in checks.into_iter().enumerate() {
        for &x in allowed {
            assert_eq!(check(x), Ok(()), "check {i} allows {x:e}");
        }
        for &x in refused.iter().chain(&NOT_FINITE) {
            assert!(check(x).is_err(), "check {i} refuses {x:e}");
        }
    }
}

#[test]
fn a_refusal_names_the_parameter_the_place_the_value_and_what_is_allowed() {
    let cases = [
        (
            check_coordinates("x", &[1.0, 2.0, f32::NAN]),
            "x[2] must be finite and within ±1e30, got NaN",
        ),
        (
            check_length("distance", -2.5).map(drop),
            "distance must be from 0 to 1e30, got -2.5e0",
        ),
        (unit_vector("wi", [0.0; 3]).map(drop), "wi must not be zero"),
        (
            code("path", 2, &['a', 'b']).map(drop),
            "path must be 0 to 1, got 2",
        ),
        (
            code("path", u32::MAX, &['a', 'b']).map(drop),
            "path must be 0 to 1, got 4294967295",
        ),
    ];
    for (result, message) in cases {
        let failure = result.unwrap_err();
        assert_eq!(failure.message, message);
        let name = message.split(['[', ' ']).next().unwrap();
        assert_eq!(failure.parameter, name, "{message}");
    }
    assert_eq!(code("path", 1, &['a', 'b']), Ok('b'), "a code");
}

#[test]
fn results_may_be_infinite_but_not_nan() {
    let results = [0.0, f64::INFINITY, f64::NAN];
    assert_eq!(check_result("motion", &results[..2]), Ok(()), "infinite");
    let failure = check_result("motion", &results).unwrap_err();
    assert_eq!(failure.parameter, "motion", "{}", failure.message);
}

#[test]
fn directions_of_any_length_become_unit_vectors_and_those_of_length_1_keep_their_bits() {
    for length in [1e-300, 0.5, 0.999, 3.0, 1e30] {
        let unit = unit_vector("x", [0.0, -0.6 * length, 0.8 * length]).unwrap();
        for (got, expected) in unit.into_iter().zip([0.0, -0.6, 0.8]) {
            // Two roundings of the length, one of the quotient.
            assert!(
                (got - expected).abs() <= 4.0 * f64::EPSILON,
                "length {length:e}: {got}"
            );
        }
    }
    let rounded = [0.6_f32, -0.8, 1e-9].map(f64::from);
    assert_eq!(unit_vector("x", rounded), Ok(rounded), "single precision");
}
