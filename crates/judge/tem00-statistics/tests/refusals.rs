//! What no law, estimate or test has an answer for is refused: by the name of the argument.

use std::error::Error;

use tem00_numerics::{Fft2Error, Grid};
use tem00_statistics::{estimate::*, laws::*, test::*, *};
use tem00_testkit::refuses;

const UP: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;

/// Values that vary, some of them bad.
fn image(bad: f32) -> Grid<f32> {
    let mut image = Grid::from_fn(4, 6, |x, y| 1.0 + ((x + y * y) % 3) as f32);
    image.values_mut()[5] = bad;
    image
}

fn field(bad: f32) -> Grid<num_complex::Complex<f32>> {
    image(bad).map(|&re| num_complex::Complex::new(re, 0.5))
}

fn lags([x, y]: [f64; 2]) -> Grid<f32> {
    Grid::from_fn(64, 64, |i, j| {
        let [i, j] = [i, j].map(|n| n.min(64 - n) as f64);
        #[expect(clippy::cast_possible_truncation, reason = "images are f32")]
        let value = airy_autocovariance((i / x).hypot(j / y)) as f32;
        value
    })
}

#[test]
fn laws() {
    refuses!(shape = 2.0 => GammaIntensity::new(shape);
        shape: [0.0, 0.999, -1.0, 1.1e6, NAN, UP]);
    refuses!(contrast = 0.5 => GammaIntensity::from_contrast(contrast);
        contrast: [0.0, -0.5, 1.1, 1e-200, NAN]);
    refuses!(degree = 1.0 => PartiallyPolarised::new(degree); degree: [-1e-9, 1.000_001, NAN, UP]);
    refuses!(amplitude_correlation = 0.0 => JointIntensity::new(amplitude_correlation);
        amplitude_correlation: [-0.1, 1.0, 1.5, NAN]);
    refuses!(beam_ratio = 0.0 => CoherentBackground::new(beam_ratio); beam_ratio: [-1e-9, NAN, UP]);
    refuses!(contrast = 1.0 => CoherentBackground::from_contrast(contrast);
        contrast: [0.0, 1.1, NAN]);
    refuses!(weights = vec![1.0, 2.0] => IncoherentSum::new(&weights);
        weights: [vec![], vec![0.0; 2], vec![1.0, -1.0], vec![1.0, NAN], vec![UP]]);
    refuses!(count = 8 => PhasorSum::new(count); count: [0, 1, 7, 1_000_001, usize::MAX]);
    let different =
        |count: usize| IncoherentSum::new(&(1..=count).map(|i| i as f64).collect::<Vec<_>>());
    refuses!(weights = IncoherentSum::MAX_DIFFERENT => different(weights);
        weights: [IncoherentSum::MAX_DIFFERENT + 1]);
    refuses!(wavelength = 1e-6, distance = 1.0, area = LitArea::Disc { diameter: 1e-3 }
        => ObjectiveSpeckle::new(wavelength, distance, area);
        wavelength: [0.0, -1.0, NAN, UP],
        distance: [0.0, -1.0, NAN, UP],
        area: [
            LitArea::Disc { diameter: 0.0 },
            LitArea::Disc { diameter: NAN },
            LitArea::Rectangle { width: 1.0, height: UP },
            LitArea::Rectangle { width: -1.0, height: 1.0 },
            LitArea::GaussianSpot { radius: NAN },
        ],
    );
}

#[test]
fn lines_and_pixels() {
    refuses!(radius = 1.0, row_height = 1.0 => SpeckledLine::new(radius, row_height);
        radius: [0.0, NAN], row_height: [-1.0, UP]);
    let line = SpeckledLine::new(1.0, 1.0).expect("a line");
    refuses!(half_width = 1.0 => line.with_window(half_width); half_width: [0.0, NAN]);
    let column = PixelColumn {
        size: [0.6, 0.5],
        pitch: [0.8, 0.7],
        pixels: 24,
        averaged_columns: 1,
    };
    refuses!(column = column => PixelAutocovariance::new(&column);
        column.size: [[1.0, 0.5], [0.6, NAN]],
        column.pitch: [[0.0, 0.7], [0.8, UP]],
        column.pixels: [0, 6000],
        column.averaged_columns: [0],
    );
}

#[test]
fn estimates() {
    let (dark, flat) = (Grid::filled(4, 6, 0.0), Grid::filled(4, 6, 0.1));
    for boundary in [Boundary::Periodic, Boundary::Finite] {
        refuses!(samples = image(1.0) => autocovariance(&samples, boundary);
            samples: [flat.clone(), image(f32::NAN)]);
        refuses!(samples = field(1.0) => phase_singularities(&samples, boundary);
            samples: [field(f32::INFINITY)]);
    }
    let line = Grid::filled(1, 9, num_complex::Complex::new(1.0, 0.0));
    refuses!(samples = field(1.0) => VortexDensity::from_field(&samples, Boundary::Finite);
        samples: [line.clone()]);
    let none = VortexDensity::from_field(&line, Boundary::Periodic).expect("a field");
    assert_eq!((none.count(), none.speckle_size()), (0, None));
    refuses!(samples = image(1.0) => power_spectrum(&samples);
        samples: [flat.clone(), image(f32::NAN)]);
    refuses!(samples = image(1.0), step = [1.0; 2] => radial_average(&samples, step);
        samples: [image(f32::NAN)], step: [[1.0, 0.0]]);
    refuses!(samples = image(1.0), stride = 1 => decorrelated_samples(&samples, stride);
        samples: [image(f32::NAN)], stride: [0]);
    refuses!(samples = image(1.0), window = 4 => local_contrast(&samples, window);
        samples: [dark.clone(), image(f32::NAN)], window: [0, 1, 5]);
    let half = Grid::from_fn(20, 6, |x, _| if x < 10 { 1.0 } else { 0.0 });
    refuses!(samples = image(1.0), window = 3 => FlatImage::new(&samples, window);
        samples: [half, image(f32::NAN)], window: [0, 1, 7]);
    refuses!(samples = image(1.0), second = image(2.0) => pearson_correlation(&samples, &second);
        samples: [flat.clone()], second: [Grid::filled(6, 4, 1.0)]);
    refuses!(lags = lags([4.0; 2]) => SpeckleSize::from_autocovariance(&lags);
        lags: [dark], lags as "samples": [image(f32::NAN)],
        lags as "speckle size along y": [self::lags([4.0, 0.9])],
        lags as "autocovariance along x": [self::lags([80.0, 4.0])],
        lags as "autocovariance": [Grid::filled(1, 1, 1.0)],
    );
}

#[test]
fn samples() {
    refuses!(samples = vec![1.0, 2.0] => Moments::from_samples(&samples);
        samples: [vec![], vec![1.0], vec![1.0, UP]]);
    refuses!(samples = vec![1.0, 2.0] => Contrast::from_samples(&samples);
        samples: [vec![1.0], vec![1.0, UP], vec![0.0; 2], vec![-1.0, 1.0], vec![-2.0, 1.0]]);
    for fit in [GammaFit::by_moments::<f64>, GammaFit::by_likelihood::<f64>] {
        refuses!(samples = vec![1.0, 2.0] => fit(&samples);
            samples: [vec![2.0; 3], vec![1.0], vec![-1.0, 0.5], vec![NAN, 0.5]]);
    }
    refuses!(samples = vec![1.0, 2.0] => GammaFit::by_likelihood(&samples);
        samples: [vec![1.0, 2.0, 0.0]]);
    let contrast = Contrast::from_samples(&[1.0, 2.0]).expect("a contrast");
    refuses!(speckle_size = 1.0 => contrast.with_speckle_size(speckle_size);
        speckle_size: [0.0, -1.0, NAN, UP]);
    refuses!(level = 0.9 => contrast.confidence_interval(level);
        level: [0.0, 1.0, 95.0, -0.1, NAN]);
}

#[test]
fn tests_of_hypotheses() {
    refuses!(samples = vec![0.5], cumulative = 1.0 => kolmogorov_smirnov(&samples, |_| cumulative);
        samples: [vec![], vec![NAN]], cumulative: [2.0, NAN]);
    refuses!(expected = vec![9.0; 3], constraints = 1
        => chi_squared(&[9; 3], &expected, constraints);
        expected: [vec![9.0], vec![9.0, -1.0, 9.0], vec![NAN; 3], vec![UP; 3]], constraints: [3]);
    refuses!(samples = vec![1.0, 2.0], mean = 1.0 => t_test_mean(&samples, mean);
        samples: [vec![1.0; 2]], mean: [UP, NAN]);
    let quantiles: Vec<f64> = (0..100)
        .map(|i| -(1.0 - (f64::from(i) + 0.5) / 100.0).ln())
        .collect();
    refuses!(samples = quantiles.clone() => GoodnessOfFit::new(&samples, exponential_cumulative);
        samples: [vec![1.0, NAN]]);
    refuses!(cumulative = 0.0 => GoodnessOfFit::new(&quantiles, |_| cumulative);
        cumulative: [-0.1, 1.5, NAN]);
    let rounded: Vec<f64> = quantiles.iter().map(|x| x.round()).collect();
    let levels = GreyLevels::from_values(&rounded).expect("few levels");
    refuses!(samples = rounded.clone(), cumulative = 0.0
        => GoodnessOfFit::of_rounded(&samples, &levels, |_| cumulative);
        samples: [vec![]], cumulative: [-0.1, 1.5, NAN]);
}

#[test]
fn messages_say_what_is_allowed_and_what_was_given() {
    let image = Grid::filled(4, 4, 1.0);
    let messages = [
        (
            IncoherentSum::new(&[1.0, 2.0, -3.0]).err(),
            "weights must be finite and not negative, got -3 at index 2",
        ),
        (
            Moments::from_samples(&[1.0]).err(),
            "samples must be at least 2, got 1",
        ),
        (
            GammaFit::by_likelihood(&[3.0, 0.0]).err(),
            "samples must be positive, got 0 at index 1",
        ),
        (
            local_contrast(&image, 9).err(),
            "window must be at least 2 pixels wide and fit into the image of 4 × 4, got 9",
        ),
        (
            pearson_correlation(&image, &Grid::filled(4, 5, 1.0)).err(),
            "second must be 4 wide and 4 high, like the first grid, got [4, 5]",
        ),
        (
            kolmogorov_smirnov(&[1.0], |_| 2.0).err(),
            "cumulative must be from 0 to 1 at 1, got 2",
        ),
        (
            chi_squared(&[1], &[], 0).err(),
            "expected must be as many as the 1 observed counts, got 0",
        ),
        (
            chi_squared(&[9], &[9.0], 1).err(),
            "bins with five expected counts must outnumber the constraints, got 1 and 1",
        ),
    ];
    for (error, text) in messages {
        assert_eq!(error.map(|error| error.to_string()).as_deref(), Some(text));
    }
    let error = StatisticsError::from(Fft2Error::Empty);
    let source = error.source().map(ToString::to_string);
    assert_eq!(source, Some(Fft2Error::Empty.to_string()));
}
