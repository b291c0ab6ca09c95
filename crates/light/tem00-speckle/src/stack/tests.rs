use core::f64::consts::PI;

use proptest::prelude::*;
use tem00_numerics::{cast::to_signed, wrap_coordinate};
use tem00_testkit::assert_absolute;

use super::*;
use crate::Pupil;

fn stack(size: usize, diameter: usize, path: SlicePath) -> SpeckleStack {
    let field = PupilField::new(size, diameter, 17).unwrap();
    SpeckleStack::generate(&field, path).unwrap()
}

pub(in crate::stack) fn circle(half_period: usize) -> SlicePath {
    SlicePath::Circle { half_period }
}

fn straight(half_period: usize) -> SlicePath {
    SlicePath::Straight {
        half_period,
        length: 2,
    }
}

/// The field of the pupil at `centre`, in the frame of the lattice, at any r, in `f64`.
fn amplitude_by_definition(field: &PupilField, centre: [i64; 2], r: [f64; 2]) -> Complex<f64> {
    let [cx, cy] = field.diameter();
    let mut sum = Complex::new(0.0, 0.0);
    for ky in -64..=64 {
        for kx in -64..=64 {
            if (kx as f64 / cx).hypot(ky as f64 / cy) <= 0.5 + 1e-9 {
                let k = [kx + centre[0], ky + centre[1]];
                let p = field.phasor(k);
                let turns = [0, 1].map(|i| k[i] as f64 * r[i] / field.size()[i] as f64);
                let turns = turns[0] + turns[1];
                sum += Complex::new(f64::from(p.re), f64::from(p.im))
                    * Complex::from_polar(1.0, -2.0 * PI * turns);
            }
        }
    }
    sum / (field.phasor_count() as f64).sqrt()
}

/// The mean over all cells, at one fraction of each.
pub(in crate::stack) fn mean(stack: &SpeckleStack, [fx, fy]: [f64; 2], u: f64) -> f64 {
    let [width, height] = stack.size().map(|side| u32::try_from(side).unwrap());
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let sum: f64 = cells
        .map(|(x, y)| stack.intensity_at(f64::from(x) + fx, f64::from(y) + fy, u))
        .sum();
    sum / f64::from(width * height)
}

#[test]
fn stacks_of_a_displaced_field_are_parts_of_one_path() {
    // Slices an eighth of the pupil apart, over 16 diameters and over 4 about the fifth.
    let straight = |length| SlicePath::Straight {
        half_period: 4 * length,
        length,
    };
    let field = PupilField::new(64, 32, 17).unwrap();
    let whole = SpeckleStack::generate(&field, straight(16)).unwrap();
    let part = SpeckleStack::generate(&field.displaced([5 * 32, 0]), straight(4)).unwrap();
    for u in [-11.5, -7.25, 0.0, 0.5, 9.75, 10.5] {
        let there = whole.intensity_at(7.3, 50.6, 40.0 + u);
        // The frames of the two pupils differ by a turn that single precision rounds.
        assert_absolute(part.intensity_at(7.3, 50.6, u), there, 1e-5);
    }
}

#[test]
fn fractional_coordinates_give_the_field_of_the_lattice() {
    for path in [circle(3), straight(4), SlicePath::Still] {
        let stack = stack(64, 9, path);
        let count = stack.slice_count();
        for (x, y, u) in [
            (0.5, 0.5, 0.5),
            (63.7, 63.9, 1.25),
            (-17.3, 200.1, 2.75),
            (31.0, 8.4, 5.5),
            (12.6, 12.0, 7.9),
        ] {
            let (index, f) = wrap_coordinate(u, count);
            let here = stack.slices[index].centre;
            let step = stack
                .field()
                .shift(here, stack.slices[(index + 1) % count].centre);
            let next = [here[0] + step[0], here[1] + step[1]];
            let f = if count == 1 { 0.0 } else { f };
            let rho = stack.field().overlap(step).re;
            let field = amplitude_by_definition(stack.field(), here, [x, y]) * (1.0 - f)
                + amplitude_by_definition(stack.field(), next, [x, y]) * f;
            let variance = (1.0 - f).powi(2) + f * f + 2.0 * f * (1.0 - f) * rho;
            let expected = field.norm_sqr() / variance;
            let got = stack.intensity_at(x, y, u);
            // The spline's error at a speckle size of 7 is below 2e−5.
            let error = (got - expected).abs() / (1.0 + expected);
            assert!(
                error < 1e-4,
                "{path:?} at ({x}, {y}, {u}): {got} for {expected}"
            );
        }
    }
}

/// Over a tile of unit phasors the mean at one fraction is determined exactly by the
/// renormalisation: by Parseval's theorem it contains no noise.
#[test]
fn the_mean_is_one_between_samples_and_slices() {
    for (size, path) in [
        (48, circle(2)),
        (48, circle(8)),
        (48, straight(2)),
        (64, straight(8)),
        (96, circle(3)),
    ] {
        let field = PupilField::new(size, 24, 17).unwrap();
        let stack = SpeckleStack::generate(&field, path).unwrap();
        for fractions in [[0.5, 0.5], [0.5, 0.0], [0.25, 0.75], [0.0, 0.0]] {
            for u in [0.0, 0.5, 1.5, 2.25, 3.75] {
                // Rounding of f32, and odd terms below this rounding.
                assert_absolute(mean(&stack, fractions, u), 1.0, 3e-6);
            }
        }
    }
}

#[test]
fn blending_rounds_the_cusp_of_the_law_as_documented() {
    for (half_period, stated) in [(8, 0.2), (32, 0.06)] {
        let law = PathLaw::new(circle(half_period), &Pupil::Circle);
        let mut worst = 0.0_f64;
        for start in 0..16_u32 {
            for distance in 0..32_u32 {
                let (u, du) = (f64::from(start) / 16.0, f64::from(distance) / 16.0);
                let gamma = circle(half_period).correlation_between(u, u + du);
                worst = worst.max((gamma - law.overlap_at(du).powi(2)).abs());
            }
        }
        assert!(
            worst < stated && worst > 0.9 * stated,
            "M = {half_period}: {worst}"
        );
    }
}

#[test]
fn neighbours_are_correlated_by_the_closed_form() {
    // Rounding moves each centre by up to ½ in x and y, so the distance of two by up to √2 and
    // the overlap by up to (4/π) √2/C = 1.8/C; the roughness of the lattice rim is far smaller.
    let tolerance = |diameter: f64| 2.0 / diameter;
    for (size, diameter, path) in [
        (64, 32, circle(8)),
        (1_024, 512, circle(8)),
        (1_024, 512, straight(8)),
        (1_024, 200, straight(16)),
    ] {
        let law = PathLaw::new(path, &Pupil::Circle);
        let field = path.close(&PupilField::new(size, diameter, 0).unwrap());
        let count = path.slice_count();
        for i in [0, 3, 7] {
            for (distance, u) in (0..count).zip(0_u32..) {
                let j = (i + distance) % count;
                let shift = field.shift(
                    path.centre(to_signed(i), &field),
                    path.centre(to_signed(j), &field),
                );
                let exact = field.overlap(shift).norm_sqr();
                let closed = law.overlap_at(u.into()).powi(2);
                assert_absolute(exact, closed, tolerance(diameter as f64));
            }
        }
    }
}

#[test]
fn opposite_slices_are_uncorrelated() {
    for path in [circle(5), straight(5)] {
        let stack = stack(128, 64, path);
        for i in 0..10 {
            let gamma = stack.correlation_between(f64::from(i), f64::from(i + 5));
            // A distance short of C by √2 leaves an overlap of (8√2/3π)(√2/C)^1.5 = 4e−3.
            assert!(gamma < 2e-5, "{path:?}: γ({i}, {i} + 5) = {gamma:e}");
        }
    }
}

/// The covariance of the intensities looked up at u and at v, over some tiles.
fn looked_up(size: u32, path: SlicePath, tiles: u32, pairs: &[[f64; 2]]) -> Vec<f64> {
    let mut covariances = vec![0.0; pairs.len()];
    for seed in 0..tiles {
        let field = PupilField::new(size as usize, 32, seed.into()).unwrap();
        let stack = SpeckleStack::generate(&field, path).unwrap();
        for i in 0..size * size {
            let (x, y) = (f64::from(i % size), f64::from(i / size));
            for (covariance, [u, v]) in covariances.iter_mut().zip(pairs) {
                let [a, b] = [u, v].map(|u| stack.intensity_at(x, y, *u) - 1.0);
                *covariance += a * b / f64::from(size * size) / f64::from(tiles);
            }
        }
    }
    covariances
}

/// The spread of a covariance is at most that of the squared contrast, 1.53/C; α = 6e−5. Unit
/// phasors lower it by up to 1/N.
fn spread_of(tiles: u32) -> f64 {
    4.0 * 1.53 / 32.0 / f64::from(tiles).sqrt() + 1.0 / 797.0
}

/// For two slices of unit phasors the tile's covariance of amplitudes is the counted overlap;
/// here the intensities are compared, which holds on average over the speckles of a tile.
#[test]
fn look_ups_on_slices_and_between_correlate_as_stated() {
    const TILES: u32 = 24;
    let pairs = [
        [0.0, 1.0],
        [0.0, 2.0],
        [0.0, 0.5],
        [0.0, 1.5],
        [0.0, 10.6],
        [0.5, 1.5],
        [0.25, 0.75],
        [5.75, 6.25],
        [2.4, 4.4],
    ];
    for path in [circle(6), straight(6)] {
        let stack = stack(64, 32, path);
        for ([u, v], measured) in pairs.into_iter().zip(looked_up(64, path, TILES, &pairs)) {
            let stated = stack.correlation_between(u, v);
            assert_absolute(measured, stated, spread_of(TILES));
            // Rounded centres change the overlap by up to 1/C, and γ by twice that.
            let closed = stack.correlation_at(v);
            assert!(
                u > 0.0 || (closed - stated).abs() < 2.0 / 32.0,
                "{path:?}, 0 to {v}: {closed}, not {stated}"
            );
        }
    }
}

/// Half-way round a closed path pupils overlap from both sides. If the lattice closes with the
/// pattern the two overlaps are one wave, otherwise two.
#[test]
fn look_ups_on_opposite_sides_of_a_path_correlate_as_stated() {
    const TILES: u32 = 24;
    for (half_period, u, v, [one, two]) in [
        (1, 0.5, 1.5, [1.0, 0.5]),
        (1, 0.25, 1.25, [0.36, 0.18]),
        (2, 0.5, 2.5, [0.081, 0.041]),
    ] {
        for (size, expected) in [(64, one), (80, two)] {
            let path = straight(half_period);
            let stated = stack(size as usize, 32, path).correlation_between(u, v);
            let measured = looked_up(size, path, TILES, &[[u, v]])[0];
            let told = format!("{size}, {u} to {v}: {measured}, stated {stated}");
            assert!((measured - stated).abs() < spread_of(TILES), "{told}");
            assert!((stated - expected).abs() < 0.01, "{told}");
        }
    }
}

/// The means over all starts were measured on look-ups, in a separate trial.
#[test]
fn look_ups_from_any_start_correlate_more_than_their_slices() {
    let stack = stack(256, 128, circle(6));
    for (distance, measured) in [(0.5, 0.854), (1.0, 0.589), (2.0, 0.224)] {
        let starts = (0..120).map(|i| 0.1 * f64::from(i));
        let sum: f64 = starts
            .map(|u| stack.correlation_between(u, u + distance))
            .sum();
        assert_absolute(sum / 120.0, measured, 0.02);
    }
}

proptest! {
    #[test]
    fn the_coordinate_of_a_correlation_has_it(
        gamma in 0.001_f64..1.0, path in 0_usize..2, pupil in 0_usize..3, length in 2_usize..5,
    ) {
        let pupil = [
            Pupil::Circle, Pupil::Annulus { inner: 0.3 }, Pupil::Rectangle { height: 0.7 },
        ][pupil].clone();
        let path = [circle(6), SlicePath::Straight { half_period: 6, length }][path];
        let law = PathLaw::new(path, &pupil);
        let u = coordinate_of(&law, gamma.sqrt());
        prop_assert!((0.0..=6.0).contains(&u), "u = {u}");
        // Slopes of γ in u are below 2.
        prop_assert!((law.overlap_at(u).powi(2) - gamma).abs() < 1e-12, "u = {u}");
    }
}

fn coordinate_of(law: &PathLaw, overlap: f64) -> f64 {
    let mut coordinate = [overlap];
    law.coordinates_of(&mut coordinate);
    coordinate[0]
}

#[test]
fn a_coordinate_does_not_depend_on_those_found_beside_it() {
    for path in [SlicePath::Still, circle(6), straight(6)] {
        let law = PathLaw::new(path, &Pupil::Circle);
        let overlaps: Vec<_> = (0..400_u32)
            .map(|i| (0.618 * f64::from(i)).fract() * 1.1)
            .chain([0.0, 1.0, f64::NAN, 0.5, 0.5])
            .collect();
        let mut together = overlaps.clone();
        law.coordinates_of(&mut together);
        for (overlap, u) in overlaps.iter().zip(together) {
            let alone = coordinate_of(&law, *overlap);
            assert_eq!(u.to_bits(), alone.to_bits(), "{path:?}, {overlap}");
        }
    }
}

#[test]
fn correlations_without_a_coordinate_go_to_the_ends() {
    let longer = SlicePath::Straight {
        half_period: 6,
        length: 4,
    };
    for (path, end) in [
        (circle(6), 6.0),
        (straight(6), 6.0),
        (longer, 3.0),
        (SlicePath::Still, 0.0),
    ] {
        let stack = stack(64, 16, path);
        for gamma in [0.0, -0.5, f64::NAN, f64::NEG_INFINITY] {
            assert_absolute(stack.coordinate_of(gamma), end, 1e-12);
        }
        for gamma in [1.0, 1.5, f64::INFINITY] {
            assert!(stack.coordinate_of(gamma).abs() < 1e-12, "γ = {gamma}");
        }
    }
}

#[test]
fn memory_that_no_machine_has_is_refused() {
    let path = circle(SlicePath::MAX_HALF_PERIOD);
    // 512 TiB, more than an address has bits for.
    let bytes = path.memory_bytes([PupilField::MAX_SIZE; 2]);
    let refused = reserve(path, [PupilField::MAX_SIZE; 2]);
    assert_eq!(refused, Err(SpeckleError::Memory { bytes }));
}

#[test]
fn the_memory_is_known_before_it_is_taken() {
    let stack = stack(32, 8, circle(3));
    let bytes: usize = stack
        .slices
        .iter()
        .map(|slice| size_of_val(slice.coefficients.values()))
        .sum();
    assert_eq!(stack.memory_bytes(), bytes as u64);
    // No request overflows.
    assert_eq!(circle(usize::MAX).memory_bytes([usize::MAX; 2]), u64::MAX);
}

#[test]
fn a_limit_is_the_most_that_a_stack_may_take() {
    let field = PupilField::new(32, 8, 0).unwrap();
    let path = circle(3);
    let needed = path.memory_bytes(field.size());
    let with =
        |memory_limit| SpeckleStack::generate_with(&field, path, StackOptions { memory_limit });
    assert_eq!(with(needed).unwrap().memory_bytes(), needed);
    let limit = needed - 1;
    let refused = with(limit).unwrap_err();
    assert_eq!(refused, SpeckleError::MemoryLimit { needed, limit });
    let message = refused.to_string();
    assert!(
        message.contains(&format!("{limit} bytes, got {needed}")),
        "{message}"
    );
}

#[test]
fn the_first_of_the_slices_that_have_fallen_as_low_is_found() {
    // The overlap of two rings is least where they cross at right angles, and rises until they
    // touch.
    let law = PathLaw::new(circle(2_048), &Pupil::Annulus { inner: 0.8 });
    let overlaps: Vec<_> = law.overlaps[..2_048].iter().map(|[o, _]| *o).collect();
    let dip = (1..2_048)
        .find(|&slice| overlaps[slice] <= overlaps[slice + 1])
        .unwrap();
    assert!(dip % 8 != 0 && overlaps[dip] < overlaps[dip + 200], "{dip}");
    let u = coordinate_of(&law, overlaps[dip]);
    assert!(u > dip as f64 - 1.0 && u <= dip as f64, "{u} for {dip}");
}
