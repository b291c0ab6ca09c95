use proptest::prelude::*;
use tem00_testkit::assert_absolute;

use super::*;
use crate::Transmission;

fn pupils() -> Vec<Pupil> {
    // Without any symmetry, and with a phase.
    let drawn = Grid::from_fn(13, 11, |x, y| {
        let place = (x * x + 3 * y) as f64;
        let magnitude = if (x + 2 * y).is_multiple_of(5) {
            0.0
        } else {
            1.0 / (1.0 + 0.01 * place)
        };
        let value = Complex::from_polar(magnitude, 0.1 * place);
        #[expect(clippy::cast_possible_truncation, reason = "transmissions are f32")]
        Complex::new(value.re as f32, value.im as f32)
    });
    vec![
        Pupil::Circle,
        Pupil::Annulus { inner: 0.37 },
        Pupil::Annulus { inner: 0.5 },
        Pupil::Rectangle { height: 0.6 },
        Pupil::Gaussian { radius: 0.4 },
        Pupil::Sampled(Transmission::from_complex(drawn).unwrap()),
    ]
}

/// The definition of the pupils, point by point, for whole diameters in whole numbers.
fn inside(pupil: &Pupil, diameter: i64, [x, y]: [i64; 2]) -> bool {
    let (r2, c2) = (4 * (x * x + y * y), diameter * diameter);
    let c = diameter as f64;
    match pupil {
        Pupil::Circle | Pupil::Gaussian { .. } => r2 <= c2,
        Pupil::Annulus { inner } => r2 <= c2 && r2 as f64 >= (inner * c).powi(2),
        Pupil::Rectangle { height } => {
            2 * x.abs() <= diameter && ((2 * y.abs()) as f64) <= height * c
        }
        Pupil::Sampled(_) => 2 * x.abs() <= diameter && 2 * y.abs() <= diameter,
    }
}

/// Every point of a mask with its transmission.
fn points(mask: &Mask) -> Vec<([i64; 2], Complex<f64>)> {
    let mut points = Vec::new();
    for (j, row) in mask.rows.iter().enumerate() {
        for i in row.columns() {
            let k = [mask.corner[0] + to_signed(i), mask.corner[1] + to_signed(j)];
            let weight = mask
                .weights(j)
                .map_or(Complex::new(1.0, 0.0), |w| to_c64(w[i]));
            points.push((k, weight));
        }
    }
    points
}

#[test]
fn the_mask_holds_the_points_of_the_definition() {
    for pupil in pupils() {
        for diameter in [8, 9, 13, 32, 33] {
            let mask = Mask::new(&pupil, [diameter as f64; 2], [0.0; 2]);
            let expected: Vec<_> = (-diameter..=diameter)
                .flat_map(|y| (-diameter..=diameter).map(move |x| [x, y]))
                .filter(|&k| inside(&pupil, diameter, k))
                .collect();
            let got: Vec<_> = points(&mask).iter().map(|(k, _)| *k).collect();
            assert_eq!(got, expected, "{pupil:?}, diameter {diameter}");
        }
    }
}

#[test]
fn the_number_of_points_of_a_disc_is_that_of_the_gauss_circle_problem() {
    // Lattice points with |k| ≤ 4, 5, 10: OEIS A000328.
    for (diameter, count) in [(8.0, 49), (10.0, 81), (20.0, 317)] {
        let mask = Mask::new(&Pupil::Circle, [diameter; 2], [0.0; 2]);
        assert_eq!(mask.count(), count, "diameter {diameter}");
        assert_absolute(mask.effective_count(), count as f64, 1e-9);
    }
}

#[test]
fn the_points_of_an_ellipse_are_counted_in_whole_numbers() {
    // (3 kx)² + (4 ky)² ≤ (3 · 4 · 5)² for diameters of 40 and 30.
    let mask = Mask::new(&Pupil::Circle, [40.0, 30.0], [0.0; 2]);
    let expected = (-20_i32..=20)
        .flat_map(|x| (-15_i32..=15).map(move |y| (3 * x).pow(2) + (4 * y).pow(2)))
        .filter(|&r2| r2 <= 3_600)
        .count();
    assert_eq!(mask.count(), expected);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_displaced_mask_holds_the_points_around_its_centre(
        cx in 8.0_f64..20.0, cy in 8.0_f64..20.0, fx in -0.5_f64..0.5, fy in -0.5_f64..0.5,
        index in 0_usize..6,
    ) {
        let pupil = &pupils()[index];
        let mask = Mask::new(pupil, [cx, cy], [fx, fy]);
        let got: Vec<_> = points(&mask).iter().map(|(k, _)| *k).collect();
        let position = |[x, y]: [i64; 2]| [(x as f64 - fx) / cx, (y as f64 - fy) / cy];
        let expected: Vec<_> = (-12..=12)
            .flat_map(|y| (-12..=12).map(move |x| [x, y]))
            .filter(|&k| {
                let [x, y] = position(k);
                match pupil {
                    Pupil::Circle | Pupil::Gaussian { .. } => x.hypot(y) <= 0.5,
                    Pupil::Annulus { inner } => (0.5 * inner..=0.5).contains(&x.hypot(y)),
                    Pupil::Rectangle { height } => x.abs() <= 0.5 && y.abs() <= 0.5 * height,
                    Pupil::Sampled(_) => x.abs() <= 0.5 && y.abs() <= 0.5,
                }
            })
            .collect();
        prop_assert_eq!(got, expected);
        for (k, weight) in points(&mask) {
            let [x, y] = position(k);
            let expected = match pupil {
                Pupil::Gaussian { radius } => (-(x * x + y * y) / (radius * radius)).exp(),
                Pupil::Sampled(drawn) => to_c64(drawn.at([x, y])).norm(),
                _ => 1.0,
            };
            // Weights are f32.
            prop_assert!((weight.norm() - expected).abs() < 1e-7, "at {k:?}: {weight}");
        }
    }

    #[test]
    fn the_correlation_is_the_sum_over_the_mask(
        x in -40.0_f64..40.0, y in -40.0_f64..40.0, index in 0_usize..6,
        fx in -0.5_f64..0.5, fy in -0.5_f64..0.5,
    ) {
        let size = [25, 31];
        let mask = Mask::new(&pupils()[index], [11.0, 13.0], [fx, fy]);
        let term = |(k, weight): &([i64; 2], Complex<f64>)| {
            let turns = k[0] as f64 * x / 25.0 + k[1] as f64 * y / 31.0;
            weight.norm_sqr() * Complex::cis(-2.0 * PI * turns)
        };
        let points = points(&mask);
        let power: f64 = points.iter().map(|(_, w)| w.norm_sqr()).sum();
        let sum: Complex<f64> = points.iter().map(term).sum();
        let correlation = mask.correlation([x, y], size);
        // Sums of up to 168 terms of rounding 2⁻⁵³ and of phases up to 70 · 2⁻⁵³.
        prop_assert!((correlation - sum / power).norm() < 1e-12, "{correlation} | {}", sum / power);
        prop_assert!((mask.power() - power).abs() < 1e-12 * power);
    }
}

#[test]
fn the_overlap_is_the_sum_over_the_shared_points() {
    for pupil in pupils() {
        for (diameter, fraction) in [([8.0, 8.0], [0.0, 0.0]), ([9.0, 11.5], [0.3, -0.2])] {
            let mask = Mask::new(&pupil, diameter, fraction);
            let points = points(&mask);
            for shift in [
                [0, 0],
                [1, 0],
                [-3, 5],
                [9, 0],
                [0, 8],
                [i64::MAX, i64::MIN],
            ] {
                let mut expected = Complex::new(0.0, 0.0);
                for (k, a) in &points {
                    for (l, b) in &points {
                        let there = [0, 1].map(|i| i128::from(l[i]) + i128::from(shift[i]));
                        if k.map(i128::from) == there {
                            expected += a * b.conj();
                        }
                    }
                }
                let error = (mask.overlap(shift) - expected).norm();
                assert!(error < 1e-12, "{pupil:?} at {shift:?}: {error:e}");
            }
        }
    }
}
