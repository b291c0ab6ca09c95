use core::f64::consts::{PI, TAU};

use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::{Moments, synthetic::field_tile};

fn total_charge(found: &[Singularity]) -> i32 {
    found
        .iter()
        .map(|singularity| i32::from(singularity.charge))
        .sum()
}

/// The turns of the phase along the corners of a cell, from the angles.
fn turns_by_angles(corners: [Complex<f32>; 4]) -> f64 {
    let step = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        let difference =
            f64::from(b.im).atan2(f64::from(b.re)) - f64::from(a.im).atan2(f64::from(a.re));
        difference - TAU * (difference / TAU).round()
    };
    (0..4).map(step).sum::<f64>() / TAU
}

#[test]
fn charges_are_the_turns_of_the_angle() {
    let field = field_tile(128, 32, 1);
    let found = phase_singularities(&field, Boundary::Periodic).unwrap();
    let mut expected = Vec::new();
    for y in 0..128 {
        for x in 0..128 {
            let (x1, y1) = ((x + 1) % 128, (y + 1) % 128);
            let corners = [(x, y), (x1, y), (x1, y1), (x, y1)].map(|at| field[at]);
            let turns = turns_by_angles(corners);
            if turns.abs() > 0.5 {
                let charge = if turns > 0.0 { 1 } else { -1 };
                expected.push(Singularity { x, y, charge });
            }
        }
    }
    assert_eq!(found, expected);
    assert!(found.len() > 200, "{}", found.len());
}

#[test]
fn a_finite_field_has_the_cells_inside() {
    let field = field_tile(64, 32, 2);
    let all = phase_singularities(&field, Boundary::Periodic).unwrap();
    let inside = phase_singularities(&field, Boundary::Finite).unwrap();
    let is_inside = |s: &Singularity| s.x < 63 && s.y < 63;
    assert!(
        all.iter().any(|s| s.x == 63) && all.iter().any(|s| s.y == 63),
        "none at the edges"
    );
    let expected: Vec<_> = all.into_iter().filter(is_inside).collect();
    assert_eq!(inside, expected);
    let line = Grid::filled(1, 9, Complex::new(1.0, 0.0));
    assert_eq!(phase_singularities(&line, Boundary::Finite), Ok(Vec::new()));
}

/// `σ_k² / 2π` for the lattice points of a disc, close to π / 8h².
fn density_of_the_lattice(size: usize, diameter: i32) -> f64 {
    let radius = diameter / 2;
    let (mut sum, mut count) = (0.0, 0.0);
    for y in -radius..=radius {
        for x in -radius..=radius {
            if x * x + y * y <= radius * radius {
                sum += f64::from(x * x);
                count += 1.0;
            }
        }
    }
    TAU * sum / count / (size * size) as f64
}

#[test]
fn coarse_samples_show_too_many_as_stated() {
    let count = |h: usize| -> f64 {
        let counts = (0..12).map(|seed| {
            let field = field_tile(24 * h, 24, seed);
            phase_singularities(&field, Boundary::Periodic)
                .unwrap()
                .len() as f64
        });
        counts.sum()
    };
    let fine = count(16);
    for h in [3_u8, 4, 8] {
        let squared = f64::from(h).powi(2);
        let excess = (count(usize::from(h)) / fine - 1.0) * squared;
        // The same fields: of the 1.5/h² · 2600 spurious ones, in pairs, Poisson's error, 3.3 σ.
        let pairs = 0.75 / squared * fine;
        let tolerance = 3.3 * 1.5 / pairs.sqrt() + 0.1;
        assert_absolute(excess, 1.5, tolerance);
    }
}

#[test]
fn drawn_speckle_has_the_density_and_its_spread_as_stated() {
    const TILES: u64 = 150;
    let (size, diameter) = (128, 16);
    let measure = |seed| {
        VortexDensity::from_field(&field_tile(size, diameter, seed), Boundary::Periodic).unwrap()
    };
    let densities: Vec<_> = (0..TILES).map(measure).collect();
    let values: Vec<_> = densities.iter().map(VortexDensity::value).collect();
    let moments = Moments::from_samples(&values).unwrap();
    let error = densities
        .iter()
        .map(VortexDensity::standard_error)
        .sum::<f64>()
        / TILES as f64;
    // A spread from 150 tiles has a relative error of 1/√300 = 5.8 %, here 3.3 σ.
    assert_relative(moments.standard_deviation(), error, 0.19);
    // The mean over the tiles, 3.3 σ; the fraction stated for h = 8 has a relative error of a
    // fifth.
    let exact = density_of_the_lattice(size, 16) * (1.0 + 1.5 / 64.0);
    let tolerance = 3.3 * moments.standard_error() / exact + 0.3 / 64.0;
    assert_relative(moments.mean(), exact, tolerance);
    let h = densities[0].speckle_size().unwrap();
    assert_relative(h, (PI / 8.0 / values[0]).sqrt(), 1e-15);
}

proptest! {
    #[test]
    fn charges_cancel_in_any_periodic_field(
        width in 1_usize..7,
        height in 1_usize..7,
        parts in proptest::collection::vec((-2_i8..=2, -2_i8..=2), 36),
    ) {
        // Small integers: zeros and opposite phasors abound.
        let field = Grid::from_fn(width, height, |x, y| {
            let (re, im) = parts[6 * y + x];
            Complex::new(f32::from(re), f32::from(im))
        });
        let found = phase_singularities(&field, Boundary::Periodic).unwrap();
        prop_assert_eq!(total_charge(&found), 0);
    }
}
