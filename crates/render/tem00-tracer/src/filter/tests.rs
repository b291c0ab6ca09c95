use core::f64::consts::PI;

use tem00_testkit::{assert_absolute, assert_relative, refuses};

use super::*;

fn filters() -> [Filter; 4] {
    let gaussian = |radius, standard_deviation| Filter::Gaussian {
        radius,
        standard_deviation,
    };
    [
        Filter::default(),
        Filter::Box { radius: 1.7 },
        gaussian(1.5, 0.5),
        gaussian(4.0, 0.5),
    ]
}

/// ∫ k(x) f(x) dx by Simpson's rule, in steps that end at the joints of the kernels.
fn integral(filter: Filter, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 4000;
    let h = filter.radius() / f64::from(STEPS);
    let value = |i: u32| {
        let x = h * f64::from(i);
        let weight = match i {
            0 | STEPS => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        weight * (filter.kernel(x) * f(x) + filter.kernel(-x) * f(-x))
    };
    (0..=STEPS).map(value).sum::<f64>() * h / 3.0
}

/// The mean of weight times value along one axis, by the midpoint rule over the uniform number.
fn mean(filter: Filter, f: impl Fn(f64) -> f64) -> f64 {
    const POINTS: u32 = 1 << 17;
    let sampler = FilterSampler::new(filter).unwrap();
    let values = (0..POINTS).map(|i| {
        let (x, weight) = sampler.sample_axis(2.0 * (f64::from(i) + 0.5) / f64::from(POINTS) - 1.0);
        weight * f(x)
    });
    values.sum::<f64>() / f64::from(POINTS)
}

#[test]
fn samples_have_the_moments_and_the_frequency_response_of_the_kernel() {
    for filter in filters() {
        let norm = integral(filter, |_| 1.0);
        // Where the kernel is small, as at the ends of a long tail and next to zeros, a point
        // stands for a long piece of x: the midpoint rule errs by up to the weight of a point,
        // 2^−17, at each of up to six such positions.
        let tolerance = 4e-5;
        assert_absolute(mean(filter, |_| 1.0), 1.0, tolerance);
        for power in 1..=4 {
            let expected = integral(filter, |x| x.powi(power)) / norm;
            let scale = filter.radius().powi(power);
            assert_absolute(mean(filter, |x| x.powi(power)), expected, tolerance * scale);
        }
        for frequency in [0.25, 0.5, 1.0] {
            let wave = |x: f64| (2.0 * PI * frequency * x).cos();
            assert_absolute(mean(filter, wave), integral(filter, wave) / norm, tolerance);
        }
    }
}

#[test]
fn the_density_is_that_of_the_drawn_positions() {
    for filter in filters() {
        let sampler = FilterSampler::new(filter).unwrap();
        let Some(table) = sampler.table else { continue };
        for i in 1..1000 {
            let (target, h) = (f64::from(i) / 1000.0, 1e-9);
            let (low, high) = (table.sample(target - h).0, table.sample(target + h).0);
            let (_, density) = table.sample(target);
            // Differences err by ε/h; over the end of a piece the density changes its slope.
            assert_absolute((high - low) / (2.0 * h) * density, 1.0, 1e-6);
        }
    }
}

#[test]
fn kernels_end_at_their_radius() {
    let gaussian = Filter::Gaussian {
        radius: 1.0,
        standard_deviation: 0.5,
    };
    assert_relative(gaussian.kernel(0.5), (-0.5_f64).exp(), 1e-15);
    for filter in filters() {
        let beyond = filter.radius() * 1.001;
        assert!(filter.kernel(beyond).abs() <= 0.0, "{filter:?} ends");
    }
}

#[test]
fn strata_stay_strata() {
    for filter in filters() {
        let sampler = FilterSampler::new(filter).unwrap();
        let mut last = -filter.radius();
        for i in 0..5000 {
            let u = (f64::from(i) + 0.5) / 5000.0;
            let offset = sampler.sample([u, 0.5]).offset.x;
            let is_in_order = offset >= last && offset <= filter.radius();
            assert!(is_in_order, "{filter:?} at {u}: {offset} after {last}");
            let mirrored = sampler.sample([0.5, 1.0 - u]).offset.y;
            // The uniform numbers themselves are mirrored to rounding; the slope of the inverse
            // grows to some 1e6 next to zeros of the density.
            assert!((mirrored + offset).abs() < 1e-9, "{filter:?} at {u}");
            last = offset;
        }
    }
}

#[test]
fn the_box_of_one_pixel_leaves_samples_as_they_are() {
    let sampler = FilterSampler::new(Filter::default()).unwrap();
    for u in [0.0, 0.1, 1.0 / 3.0, 0.7, 1.0 - 0.5 * f64::EPSILON] {
        let sample = sampler.sample([u, 0.25]);
        assert_eq!(sample.offset, DVec2::new(u - 0.5, -0.25), "at {u}");
        assert_absolute(sample.weight, 1.0, 0.0);
    }
}

#[test]
fn weights_are_nearly_equal() {
    for filter in filters() {
        let sampler = FilterSampler::new(filter).unwrap();
        let magnitude = integral(filter, |x| filter.kernel(x).signum()) / integral(filter, |_| 1.0);
        for i in 0..1000 {
            let (x, weight) = sampler.sample_axis(f64::from(2 * i + 1) / 1000.0 - 1.0);
            assert!(weight * filter.kernel(x) >= 0.0, "{filter:?}: sign at {x}");
            // A straight piece misses a curved kernel by (radius/256)² k″/8: 1 % where the kernel
            // has come down to a tenth of a percent.
            if filter.kernel(x).abs() > 1e-3 {
                let relative = weight.abs() / magnitude - 1.0;
                assert!(relative.abs() < 1e-2, "{filter:?}: {weight} at {x}");
            }
        }
    }
}

#[test]
fn every_number_gives_a_sample() {
    for filter in filters() {
        let sampler = FilterSampler::new(filter).unwrap();
        let table = sampler.table.iter().flat_map(|table| {
            let mut ends = vec![0.0, 1.0 - f64::EPSILON, 1.0];
            ends.extend((0..100).map(|i| table.sample(f64::from(i) / 100.0).0));
            ends
        });
        for signed in table {
            let (x, weight) = sampler.sample_axis(-signed.min(1.0));
            assert!(x.abs() <= filter.radius(), "{filter:?}: {x}");
            assert!(weight.is_finite(), "{filter:?}: {weight}");
        }
    }
}

#[test]
fn impossible_filters_are_refused() {
    refuses!(radius = 1.0 => FilterSampler::new(Filter::Box { radius });
        radius: [0.0, f64::NAN, 17.0]);
    refuses!(standard_deviation = 0.5
        => FilterSampler::new(Filter::Gaussian { radius: 1.0, standard_deviation });
        standard_deviation: [0.1, f64::INFINITY]);
}
