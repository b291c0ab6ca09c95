use core::f64::consts::TAU;

use proptest::prelude::*;
use tem00_numerics::cast::to_c64;
use tem00_testkit::assert_absolute;

use super::*;
use crate::{Phasors, Pupil, Transmission};

fn pupils() -> impl Strategy<Value = Pupil> {
    prop_oneof![
        Just(Pupil::Circle),
        (0.1_f64..0.6).prop_map(|inner| Pupil::Annulus { inner }),
        (0.6_f64..1.0).prop_map(|height| Pupil::Rectangle { height }),
        (0.4_f64..2.0).prop_map(|radius| Pupil::Gaussian { radius }),
        (0.1_f32..3.0).prop_map(drawn),
    ]
}

/// A pupil without symmetry, with aberrations.
fn drawn(phase: f32) -> Pupil {
    let grid = Grid::from_fn(7, 9, |x, y| {
        let place = (2 * x + y * y) as f32;
        Complex::from_polar(1.0 / (1.0 + 0.02 * place), phase * place)
    });
    Pupil::Sampled(Transmission::from_complex(grid).unwrap())
}

/// U(r) by its definition, in `f64`, over a wide square of the lattice.
fn amplitude_by_definition(
    field: &PupilField,
    offset: [f64; 2],
    defocus: f64,
    r: [usize; 2],
) -> Complex<f64> {
    let centre = [0, 1].map(|i| offset[i] * field.diameter()[i]);
    #[expect(clippy::cast_possible_truncation, reason = "small numbers")]
    let nearest = centre.map(|c| c.round() as i64);
    let (mut sum, mut power) = (Complex::new(0.0, 0.0), 0.0);
    for ky in -20..=20 {
        for kx in -20..=20 {
            let k = [kx, ky];
            let at = [0, 1].map(|i| nearest[i] + k[i]);
            let p = [0, 1].map(|i| (at[i] as f64 - centre[i]) / field.diameter()[i]);
            let t = to_c64(field.pupil().transmission(p));
            let turns = [0, 1].map(|i| k[i] as f64 * r[i] as f64 / field.size()[i] as f64);
            let rho2 = 4.0 * (p[0] * p[0] + p[1] * p[1]);
            let turns = defocus * rho2 - (turns[0] + turns[1]);
            sum += t * to_c64(field.phasor(at)) * Complex::cis(TAU * turns);
            power += t.norm_sqr();
        }
    }
    sum / power.sqrt()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_field_is_the_sum_over_the_pupil(
        seed: u64, width in 26_usize..60, height in 26_usize..60, speckle_size in 2.0_f64..3.0,
        x in -40.0_f64..40.0, y in -40.0_f64..40.0, defocus in -2.5_f64..2.5,
        pupil in pupils(), gaussian: bool,
    ) {
        let field = PupilField::from_speckle_size([width, height], speckle_size, seed).unwrap();
        let phasors = if gaussian { Phasors::Gaussian } else { Phasors::Unit };
        let field = field.with_pupil(pupil).unwrap().with_phasors(phasors);
        for (offset, defocus) in [([x, y], defocus), ([x, y], 0.0), ([0.0; 2], defocus)] {
            let amplitude = field.speckle(offset, defocus);
            let pattern = field.pattern_at(offset, defocus);
            for r in [[0, 0], [1, 0], [0, 1], [5, 11], [width - 1, height - 2]] {
                let expected = amplitude_by_definition(&field, offset, defocus, r);
                let error = (to_c64(amplitude.values()[(r[0], r[1])]) - expected).norm();
                // An f32 transform of a few thousand points of norm 1, and three f32 factors.
                prop_assert!(error < 3e-6, "{r:?}: {error:e}");
                let intensity = f64::from(pattern.values()[(r[0], r[1])]);
                prop_assert!((intensity - expected.norm_sqr()).abs() < 2e-5, "{intensity}");
            }
        }
    }

    #[test]
    fn samples_of_the_phasors_give_the_pattern_of_the_phasors(
        seed: u64, x in -0.7_f64..0.7, y in -0.7_f64..0.7, defocus in -4.0_f64..4.0,
        exponent in -30_i32..30, pupil in pupils(),
    ) {
        let synthetic = PupilField::from_speckle_size([40, 50], 2.5, seed).unwrap();
        let brightness = 10.0_f32.powi(exponent);
        // Wide enough for every displacement: 14 + 10 points to either side.
        let samples = Grid::from_fn(51, 60, |i, j| {
            synthetic.phasor([to_signed(i) - 25, to_signed(j) - 30]) * brightness
        });
        let measured = PupilField::from_samples(samples, [40, 50], 2.5).unwrap();
        let [synthetic, measured] =
            [synthetic, measured].map(|field| field.with_pupil(pupil.clone()).unwrap());
        for (offset, defocus) in [([0.0; 2], 0.0), ([x, y], defocus)] {
            let expected = synthetic.speckle(offset, defocus);
            let got = measured.speckle(offset, defocus);
            for (a, b) in expected.values().values().iter().zip(got.values().values()) {
                // Samples are scaled three times, in f32 at the end of each.
                prop_assert!((a - b).norm() < 3e-6, "{a} | {b}");
            }
            let mean = mean(measured.pattern_at(offset, defocus).values().values());
            prop_assert!((mean - 1.0).abs() < 1e-6, "mean {mean}");
        }
    }
}

fn mean(values: &[f32]) -> f64 {
    values.iter().map(|&i| f64::from(i)).sum::<f64>() / values.len() as f64
}

/// Mean of (a(r) − 1)(b(r + lag) − 1) over the tile.
fn covariance(a: &SpecklePattern, b: &SpecklePattern, [x, y]: [i64; 2]) -> f64 {
    let [width, height] = a.size();
    let mut sum = 0.0;
    for j in 0..height {
        for i in 0..width {
            let there = b.values().wrapped(to_signed(i) + x, to_signed(j) + y);
            sum += (f64::from(a.values()[(i, j)]) - 1.0) * (f64::from(*there) - 1.0);
        }
    }
    sum / (width * height) as f64
}

/// |∫ over the lens of two unit discs, 2s apart, of exp(2πi a |p|²)|² / π², p about its middle: the
/// correlation of displacement and defocus at the lag where it is largest.
fn tracked_correlation(s: f64, a: f64) -> f64 {
    const STEPS: usize = 200_000;
    let end = (1.0 - s * s).sqrt();
    let sum: Complex<f64> = (0..STEPS)
        .map(|i| {
            let rho = (i as f64 + 0.5) / STEPS as f64 * end;
            let share = if rho <= 1.0 - s {
                1.0
            } else {
                2.0 / PI
                    * ((1.0 - s * s - rho * rho) / (2.0 * s * rho))
                        .clamp(-1.0, 1.0)
                        .asin()
            };
            2.0 * rho * share * Complex::cis(TAU * a * rho * rho)
        })
        .sum();
    (sum * end / STEPS as f64).norm_sqr()
}

#[test]
fn defocus_decorrelates_as_the_overlap_integral_says() {
    const TILES: u32 = 24;
    let field = PupilField::new(128, 32, 0).unwrap();
    for (s, a) in [
        (0.0, 0.25),
        (0.0, 0.5),
        (0.0, 1.0),
        (0.25, 0.5),
        (0.25, -1.0),
        (0.5, 0.25),
    ] {
        // 4 a s speckle sizes of 4 samples: whole numbers.
        #[expect(clippy::cast_possible_truncation, reason = "a few samples")]
        let lag = (-4.0 * a * s * field.speckle_size()).round() as i64;
        let (mut tracked, mut opposite) = (0.0, 0.0);
        for seed in 0..TILES {
            let field = field.clone().with_seed(seed.into());
            let (here, there) = (field.pattern(), field.pattern_at([0.0, s], a));
            tracked += covariance(&here, &there, [0, lag]) / f64::from(TILES);
            opposite += covariance(&here, &there, [0, -lag]) / f64::from(TILES);
        }
        let expected = tracked_correlation(s, a);
        if s == 0.0 {
            // sinc²(π a): the closed form of Li and Chiang. Midpoints err by their spacing squared.
            let closed = tem00_numerics::sinc(PI * a).powi(2);
            assert!((expected - closed).abs() < 1e-8, "{expected} | {closed}");
        }
        // A tile's covariance deviates by at most 1.53/C; unit phasors lower it by up to 1/N.
        let tolerance = 4.0 * 1.53 / 32.0 / f64::from(TILES).sqrt() + 1.0 / 797.0;
        assert_absolute(tracked, expected, tolerance);
        if lag != 0 && expected > 0.2 {
            // The pattern has moved, and to this side.
            assert!(
                opposite < tracked - 2.0 * tolerance,
                "({s}, {a}): {opposite} | {tracked}"
            );
        }
    }
}

#[test]
fn a_pupil_that_has_moved_far_meets_new_phasors() {
    let field = PupilField::new(64, 32, 1).unwrap();
    let here = field.pattern();
    // Two diameters are the size of the pattern; more than all are its multiples.
    for diameters in [1.25, 2.0, 4.0, 1_024.0, -2.0, 65_536.0, 1e6] {
        for offset in [[diameters, 0.0], [0.0, diameters], [diameters, diameters]] {
            let gamma = covariance(&here, &field.pattern_at(offset, 0.0), [0, 0]);
            // √(Σ_m A(m)²)/N² = 0.77/C for independent tiles; α = 6e−5 for each of 21.
            assert!(gamma.abs() < 4.0 * 0.77 / 32.0, "{offset:?}: {gamma}");
        }
    }
}

#[test]
fn no_finite_view_fails() {
    let field = PupilField::new(32, 16, 1).unwrap();
    for x in [
        1e-300,
        1e-30,
        1e15,
        -1e30,
        1e300,
        f64::MAX,
        f64::MIN_POSITIVE,
    ] {
        for (offset, defocus) in [
            ([x, 0.0], 0.0),
            ([0.3, -x], 0.0),
            ([0.0; 2], x),
            ([x; 2], x),
        ] {
            let mean = mean(field.pattern_at(offset, defocus).values().values());
            assert!((mean - 1.0).abs() < 1e-6, "{offset:?}, {defocus:e}: {mean}");
        }
    }
}

#[test]
fn a_pupil_without_light_sees_nothing() {
    let samples = Grid::from_fn(40, 40, |x, _| {
        Complex::new(if x < 20 { 1e-30 } else { 0.0 }, 0.0)
    });
    let field = PupilField::from_samples(samples, [64; 2], 4.0).unwrap();
    for (offset, expected) in [
        ([0.0, 0.0], 1.0),
        ([-1.2, 0.0], 1.0),
        ([0.6, 0.0], 0.0),
        ([9.0, 9.0], 0.0),
    ] {
        let mean = mean(field.pattern_at(offset, 0.5).values().values());
        assert!((mean - expected).abs() < 1e-6, "{offset:?}: {mean}");
    }
    let dark = PupilField::from_samples(Grid::filled(3, 3, ZERO), [64; 2], 4.0).unwrap();
    assert!(
        mean(dark.pattern().values().values()) <= 0.0,
        "light from nowhere"
    );
}

/// Threads fill the aperture in pieces as wide as there are threads.
#[test]
fn an_aperture_is_the_same_in_pieces() {
    let samples = Grid::from_fn(40, 33, |x, y| Complex::new(x as f32 - 9.5, y as f32));
    let seeded = PupilField::new(64, 30, 1).unwrap();
    let fields = [
        seeded
            .clone()
            .with_pupil(Pupil::Annulus { inner: 0.4 })
            .unwrap(),
        seeded.clone().with_pupil(drawn(0.3)).unwrap(),
        PupilField::from_samples(samples, [64; 2], 2.1).unwrap(),
        seeded,
    ];
    for field in &fields {
        for (offset, defocus) in [([0.0; 2], 0.0), ([0.1, -0.77], 0.4)] {
            let aperture = field.aperture(offset, defocus);
            let [width, height] = aperture.extent();
            for y in 0..height {
                let mut whole = vec![ZERO; width];
                aperture.fill(0..width, y, &mut whole);
                for piece in [1, 7, 8, 64] {
                    let mut pieces = vec![Complex::new(f32::NAN, 0.0); width];
                    for (index, values) in pieces.chunks_mut(piece).enumerate() {
                        let start = index * piece;
                        aperture.fill(start..start + values.len(), y, values);
                    }
                    assert_eq!(pieces, whole, "row {y} in pieces of {piece}");
                }
            }
        }
    }
}

#[test]
fn reused_memory_changes_no_bit() {
    let mut scratch = SpeckleScratch::default();
    let fields = [
        PupilField::new(64, 20, 1).unwrap(),
        PupilField::from_speckle_size([64, 64], 2.1, 2).unwrap(),
        PupilField::new(64, 20, 3)
            .unwrap()
            .with_pupil(Pupil::Annulus { inner: 0.4 })
            .unwrap(),
        PupilField::new(64, 20, 4)
            .unwrap()
            .with_pupil(drawn(0.3))
            .unwrap(),
        PupilField::new(64, 20, 1).unwrap(),
    ];
    let mut intensity = Grid::filled(64, 64, f32::NAN);
    let mut amplitude = Grid::filled(64, 64, Complex::new(f32::NAN, 0.0));
    for field in &fields {
        for (offset, defocus) in [([0.1, -0.77], 0.4), ([3.0, 0.2], 0.0)] {
            field.pattern_into(offset, defocus, &mut intensity, &mut scratch);
            field.speckle_into(offset, defocus, &mut amplitude, &mut scratch);
            assert_eq!(&intensity, field.pattern_at(offset, defocus).values());
            assert_eq!(&amplitude, field.speckle(offset, defocus).values());
        }
    }
}

#[test]
#[should_panic(expected = "is not finite")]
fn an_offset_of_nan_panics() {
    let _ = PupilField::new(32, 16, 1)
        .unwrap()
        .pattern_at([f64::NAN, 0.0], 0.0);
}

#[test]
#[should_panic(expected = "output and array differ in size")]
fn a_grid_of_another_size_panics() {
    let mut grid = Grid::filled(32, 31, 0.0);
    let field = PupilField::new(32, 16, 1).unwrap();
    field.pattern_into([0.0; 2], 0.0, &mut grid, &mut SpeckleScratch::default());
}
