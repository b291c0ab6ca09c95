use super::*;

fn fields(size: usize, diameter: usize, seeds: u64) -> Vec<PupilField> {
    (0..seeds)
        .map(|seed| PupilField::new(size, diameter, seed).unwrap())
        .collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = to_f64(values.len());
    values.sum::<f64>() / count
}

/// Mean of (I(r) − 1)(I(r + lag) − 1) over the tile.
fn autocovariance(pattern: &SpecklePattern, [x, y]: [i64; 2]) -> f64 {
    let (size, values) = (pattern.size(), pattern.values());
    mean((0..size * size).map(|index| {
        let (column, row) = (index % size, index / size);
        let there = values.wrapped(to_i64(column) + x, to_i64(row) + y);
        (f64::from(values[(column, row)]) - 1.0) * (f64::from(*there) - 1.0)
    }))
}

/// U(r) by its definition, in `f64`.
fn amplitude_by_definition(field: &PupilField, offset: [i64; 2], r: [f64; 2]) -> Complex<f64> {
    let half = to_i64(field.diameter() / 2);
    let mut sum = Complex::new(0.0, 0.0);
    for ky in -half..=half {
        for kx in -half..=half {
            if 4 * (kx * kx + ky * ky) > to_i64(field.diameter().pow(2)) {
                continue;
            }
            let p = field.phasor([kx + offset[0], ky + offset[1]]);
            #[expect(clippy::cast_precision_loss, reason = "small integers")]
            let turns = (kx as f64 * r[0] + ky as f64 * r[1]) / to_f64(field.size());
            let wave = Complex::from_polar(1.0, -2.0 * PI * turns);
            sum += Complex::new(f64::from(p.re), f64::from(p.im)) * wave;
        }
    }
    sum / to_f64(field.phasor_count()).sqrt()
}

#[test]
fn the_field_is_the_sum_over_the_pupil() {
    for (size, diameter) in [(17, 8), (24, 12), (25, 11), (36, 9)] {
        let field = PupilField::new(size, diameter, 5).unwrap();
        for offset in [[0, 0], [-3, 7], [to_i64(size) - 1, 2]] {
            let amplitude = field.field_at(offset);
            let pattern = field.pattern_at(offset);
            for (x, y) in [(0, 0), (1, 0), (0, 1), (5, 11), (size - 1, size - 2)] {
                let expected = amplitude_by_definition(&field, offset, [to_f64(x), to_f64(y)]);
                let got = amplitude.values()[(x, y)];
                let error =
                    (f64::from(got.re) - expected.re).hypot(f64::from(got.im) - expected.im);
                // An f32 transform of 600 points: a few 2⁻²⁴ of the norm 1.
                assert!(
                    error < 2e-6,
                    "Q = {size}, {offset:?}, ({x}, {y}): {error:e}"
                );
                let intensity = f64::from(pattern.values()[(x, y)]);
                assert!(
                    (intensity - expected.norm_sqr()).abs() < 1e-5,
                    "{intensity}"
                );
            }
        }
    }
}

#[test]
fn the_mean_of_every_tile_is_one() {
    for (size, diameter) in [(16, 8), (63, 31), (128, 64), (100, 20)] {
        for field in fields(size, diameter, 4) {
            let pattern = field.pattern();
            let mean = mean(pattern.values().values().iter().map(|&i| f64::from(i)));
            // Parseval; the phasors and the transform are rounded to f32.
            assert!((mean - 1.0).abs() < 1e-6, "Q = {size}: mean {mean}");
        }
    }
}

#[test]
fn squared_contrast_is_one_less_one_over_the_phasor_count() {
    const TILES: u32 = 24;
    for (size, diameter) in [(48, 8), (64, 32), (128, 32)] {
        let fields = fields(size, diameter, u64::from(TILES));
        let expected = 1.0 - 1.0 / to_f64(fields[0].phasor_count());
        let squared = mean(fields.iter().map(|f| autocovariance(&f.pattern(), [0, 0])));
        // One tile's squared contrast has the standard deviation 1.53/C; α = 6e−5.
        let tolerance = 4.0 * 1.53 / to_f64(diameter) / f64::from(TILES).sqrt();
        assert!(
            (squared - expected).abs() < tolerance,
            "{squared} for {expected}"
        );
    }
}

#[test]
fn autocovariance_is_the_squared_mask_transform() {
    const TILES: u32 = 24;
    let unit = fields(64, 16, u64::from(TILES));
    for phasors in [Phasors::Unit, Phasors::Gaussian] {
        let fixed_mean = match phasors {
            Phasors::Unit => 1.0 / to_f64(unit[0].phasor_count()),
            Phasors::Gaussian => 0.0,
        };
        let patterns: Vec<_> = unit
            .iter()
            .map(|field| field.clone().with_phasors(phasors).pattern())
            .collect();
        for lag in [[0, 0], [1, 0], [0, 1], [2, 2], [-3, 1], [5, 0], [20, 9]] {
            let covariance = mean(patterns.iter().map(|p| autocovariance(p, lag)));
            #[expect(clippy::cast_precision_loss, reason = "small integers")]
            let mu = unit[0].amplitude_correlation(lag.map(|l| l as f64));
            let expected = mu * mu - fixed_mean;
            // The deviation of a covariance is at most that of the squared contrast, 1.53/C;
            // Gaussian phasors add 2/√N ≈ 2.26/C of a fluctuating mean. α = 6e−5.
            let deviation = if phasors == Phasors::Unit { 1.53 } else { 2.73 };
            let tolerance = 4.0 * deviation / 16.0 / f64::from(TILES).sqrt();
            let difference = covariance - expected;
            assert!(
                difference.abs() < tolerance,
                "{phasors:?} at {lag:?}: {difference}"
            );
        }
    }
}

#[test]
fn airy_pattern_is_the_correlation_with_the_effective_diameter() {
    let field = PupilField::new(256, 32, 0).unwrap();
    for lag in [1.0, 2.5, 4.0, 8.0, 11.0, 16.0] {
        let argument = PI * lag * field.effective_diameter() / 256.0;
        let airy = tem00_numerics::jinc(argument).powi(2);
        let exact = field.amplitude_correlation([lag, 0.0]).powi(2);
        // The lattice disc is not quite round: at most 1.2e−3 along the axes at C = 32.
        assert!(
            (exact - airy).abs() < 1.3e-3,
            "at {lag}: {exact} and {airy}"
        );
    }
}

#[test]
fn intensity_has_no_spectrum_beyond_the_pupil_diameter() {
    let (size, diameter) = (80, 17);
    let pattern = PupilField::new(size, diameter, 3).unwrap().pattern();
    let intensity = pattern.values().map(|&i| Complex::new(i, 0.0));
    let spectrum = Fft2::new(size, size)
        .unwrap()
        .forward(&intensity, |x, y, value| {
            let along = |k| crate::mask::signed(k, size);
            (along(x).pow(2) + along(y).pow(2), value.norm() / 6_400.0)
        });
    let (mut inside, mut outside) = (0.0_f32, 0.0_f32);
    for &(k2, magnitude) in spectrum.values() {
        if k2 > to_i64(diameter * diameter) {
            outside = outside.max(magnitude);
        } else if k2 > 0 {
            inside = inside.max(magnitude);
        }
    }
    // Rounding of 6400 values of 1e−7 each, averaged.
    assert!(outside < 1e-6, "spectrum {outside:e} beyond the support");
    assert!(inside > 0.01, "no spectrum inside the support: {inside}");
}

#[test]
fn displaced_pupils_share_the_phasors_of_their_overlap() {
    let field = PupilField::new(48, 20, 11).unwrap();
    let here = field.field();
    for shift in [[3, 0], [-4, 9], [20, 0], [45, 50]] {
        let there = field.field_at(shift);
        let mut sum = Complex::new(0.0, 0.0);
        for y in 0..48_u32 {
            for x in 0..48_u32 {
                #[expect(clippy::cast_precision_loss, reason = "small integers")]
                let turns =
                    (shift[0] as f64 * f64::from(x) + shift[1] as f64 * f64::from(y)) / 48.0;
                let frame = Complex::from_polar(1.0, -2.0 * PI * turns);
                let index = (x as usize, y as usize);
                let (a, b) = (here.values()[index], there.values()[index]);
                let product = a * b.conj();
                sum += Complex::new(f64::from(product.re), f64::from(product.im)) * frame.conj();
            }
        }
        // Parseval: the mean of U₁ U₂* in the common frame is the number of shared phasors.
        let correlation = sum / 2_304.0;
        let error = (correlation - field.overlap(shift)).norm();
        assert!(error < 1e-6, "{shift:?}: {correlation}");
    }
}

#[test]
fn gaussian_phasors_let_the_mean_of_a_tile_fluctuate() {
    const TILES: u32 = 200;
    let variance = mean(fields(32, 16, u64::from(TILES)).into_iter().map(|field| {
        let pattern = field.with_phasors(Phasors::Gaussian).pattern();
        (mean(pattern.values().values().iter().map(|&i| f64::from(i))) - 1.0).powi(2)
    }));
    // The mean of N = 197 exponentials has the variance 1/N. The estimate from n tiles deviates
    // by √((2 + 6/N)/n) of it: 3.3 standard deviations, α = 1e−3.
    let ratio = variance * 197.0;
    let tolerance = 3.3 * (2.03 / f64::from(TILES)).sqrt();
    assert!((ratio - 1.0).abs() < tolerance, "variance · N = {ratio}");
}

#[test]
fn sizes_without_a_pattern_are_refused() {
    let diameter = |diameter, size| Err(SpeckleError::Diameter { diameter, size });
    assert_eq!(PupilField::new(256, 129, 0), diameter(129, 256));
    assert_eq!(PupilField::new(255, 128, 0), diameter(128, 255));
    assert_eq!(PupilField::new(256, 7, 0), diameter(7, 256));
    assert_eq!(PupilField::new(0, 0, 0), diameter(0, 0));
    assert_eq!(
        PupilField::new(1_000_000, 500_000, 0),
        Err(SpeckleError::Size(1_000_000))
    );
    let message = PupilField::new(256, 129, 0).unwrap_err().to_string();
    assert!(
        message.contains("129") && message.contains("128 of 256"),
        "the message says the value and what is allowed: {message}"
    );
}

#[test]
fn fields_cross_threads() {
    fn check<T: Send + Sync>() {}
    check::<PupilField>();
    check::<crate::SpeckleStack>();
    check::<crate::paper::BilinearStack>();
}

#[cfg(feature = "parallel")]
#[test]
fn patterns_are_the_same_bits_for_any_number_of_threads() {
    let field = PupilField::new(96, 40, 8).unwrap();
    let with_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| field.pattern_at([5, 6]))
    };
    assert_eq!(with_threads(1), with_threads(3));
}
