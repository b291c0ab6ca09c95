//! A refusal names the parameter, its value and what is allowed.

use std::error::Error;

use tem00_numerics::{Fft2Error, Grid};
use tem00_statistics as s;
use tem00_statistics::StatisticsError;

#[test]
fn refusals_name_the_parameter_the_value_and_what_is_allowed() {
    let spot = s::LitArea::Disc { diameter: -1.0 };
    let image = Grid::filled(4, 4, 1.0);
    let other = Grid::filled(4, 5, 1.0);
    let dark = s::Contrast::from_samples(&[-1.0, 0.5]);
    let rows = [
        (
            s::GammaIntensity::new(0.5).err(),
            "shape must be from 1 to 1e6, got 0.5",
        ),
        (
            s::GammaIntensity::from_contrast(1.5).err(),
            "contrast must be from 0.001 to 1, got 1.5",
        ),
        (
            s::PartiallyPolarised::new(1.5).err(),
            "degree must be a degree of polarisation from 0 to 1, got 1.5",
        ),
        (
            s::JointIntensity::new(1.0).err(),
            "amplitude_correlation must be at least 0 and below 1, got 1",
        ),
        (
            s::CoherentBackground::new(-1.0).err(),
            "beam_ratio must be finite and not negative, got -1",
        ),
        (
            s::IncoherentSum::new(&[1.0, 2.0, -3.0]).err(),
            "weights must be finite and not negative, got -3 at position 2",
        ),
        (
            s::IncoherentSum::new(&[0.0]).err(),
            "weights must be of a positive sum, got 0",
        ),
        (
            s::PhasorSum::new(3).err(),
            "count must be from 8 to 1000000 phasors, got 3",
        ),
        (
            s::ObjectiveSpeckle::new(1e-6, -1.0, spot).err(),
            "distance must be positive and finite, in metres, got -1",
        ),
        (
            s::ObjectiveSpeckle::new(1e-6, 1.0, spot).err(),
            "area must be positive and finite in every length, in metres, got -1",
        ),
        (
            s::SpeckledLine::new(0.0, 1.0).err(),
            "radius must be from 0.01 to 1e6, got 0",
        ),
        (
            s::Contrast::from_samples(&[1.0, 2.0])
                .and_then(|c| c.confidence_interval(95.0))
                .err(),
            "level must be between 0 and 1, got 95",
        ),
        (
            dark.err(),
            "samples must be of a mean that is positive and above their rounding errors, got -0.25",
        ),
        (
            s::Moments::from_samples(&[1.0]).err(),
            "samples must number at least 2, got 1",
        ),
        (
            s::GammaFit::by_likelihood(&[3.0, 0.0]).err(),
            "samples must be positive, got 0 at position 1",
        ),
        (
            s::t_test_mean(&[1.0, 1.0], 0.0).err(),
            "samples must be of more than one value, got 1",
        ),
        (
            s::t_test_mean(&[1.0, 2.0], f64::NAN).err(),
            "mean must be finite, got NaN",
        ),
        (
            s::local_contrast(&image, 9).err(),
            "window must be at least 2 pixels wide and fit into the image of 4 × 4, got 9",
        ),
        (
            s::pearson_correlation(&image, &other).err(),
            "size of both grids must be the same, got 4 × 4 and 4 × 5",
        ),
        (
            s::kolmogorov_smirnov(&[1.0], |_| 2.0).err(),
            "distribution function must return values in [0, 1], got 2 at 1",
        ),
        (
            s::chi_squared(&[1], &[], 0).err(),
            "bins must be as many observed as expected, got 1 and 0",
        ),
        (
            s::chi_squared(&[9], &[-1.0], 1).err(),
            "expected must be finite and not negative, got -1 at position 0",
        ),
        (
            s::chi_squared(&[9], &[9.0], 1).err(),
            "bins with five expected counts must outnumber the constraints, got 1 and 1",
        ),
        (
            s::decorrelated_samples(&image, 0).err(),
            "stride must be at least 1, got 0",
        ),
    ];
    for (error, text) in rows {
        assert_eq!(error.map(|error| error.to_string()).as_deref(), Some(text));
    }
}

#[test]
fn the_parameter_is_the_argument_that_was_given() {
    let image = Grid::filled(4, 4, 1.0);
    let other = Grid::filled(4, 5, 1.0);
    let refusals = [
        (s::IncoherentSum::new(&[-1.0]).err(), "weights"),
        (s::pearson_correlation(&image, &other).err(), "second"),
        (s::kolmogorov_smirnov(&[1.0], |_| 2.0).err(), "cumulative"),
        (s::chi_squared(&[1], &[], 0).err(), "expected"),
        (s::chi_squared(&[9], &[9.0], 1).err(), "constraints"),
        (s::GammaFit::by_likelihood(&[0.0, 1.0]).err(), "samples"),
        (s::local_contrast(&image, 1).err(), "window"),
        (
            s::autocovariance(&other, s::Boundary::Periodic).err(),
            "samples",
        ),
    ];
    for (error, parameter) in refusals {
        let name = error.map(|error| error.parameter());
        assert_eq!(name, Some(parameter), "{error:?}");
    }
}

#[test]
fn a_refused_transform_is_the_source() {
    let error = StatisticsError::from(Fft2Error::Empty);
    let source = error.source().map(ToString::to_string);
    assert_eq!(source, Some(Fft2Error::Empty.to_string()));
}
