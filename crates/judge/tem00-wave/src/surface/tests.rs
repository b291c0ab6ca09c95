use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::{Arrangement, DVec2};

fn patch(arrangement: Arrangement, roughness: Roughness) -> PatchDescription {
    PatchDescription {
        centre: DVec3::new(0.1, -0.2, 0.3),
        normal: DVec3::new(0.0, -1.0, 2.0),
        along: DVec3::new(1.0, 1.0, 0.5),
        size: [3e-3, 2e-3],
        scatterers: [60, 40],
        arrangement,
        roughness,
        seed: 5,
    }
}

const GAUSSIAN: Roughness = Roughness::FullyDeveloped(Amplitudes::ComplexGaussian);

/// Coordinates of a scatterer along the sides and the normal, from the centre.
fn local(patch: &PatchDescription, scatterer: &Scatterer) -> DVec3 {
    let normal = patch.normal.normalize();
    let second = normal.cross(patch.along).normalize();
    let from_centre = scatterer.position - patch.centre;
    DVec3::new(
        from_centre.dot(second.cross(normal)),
        from_centre.dot(second),
        from_centre.dot(normal),
    )
}

#[test]
fn a_stratified_patch_has_one_scatterer_in_each_cell() {
    for (arrangement, expected) in [
        (Arrangement::Stratified, true),
        (Arrangement::Lattice, true),
        (Arrangement::Random, false),
    ] {
        let patch = patch(arrangement, GAUSSIAN);
        let surface = RoughSurface::patch(&patch).expect("a patch");
        let mut cells = vec![0; 60 * 40];
        for scatterer in surface.scatterers() {
            let at = local(&patch, scatterer);
            // Rounding of a position of 0.4 m.
            assert!(at.z.abs() < 1e-15, "{at} off the plane");
            let cell = (at.truncate() + DVec2::new(1.5e-3, 1e-3)) / 50e-6;
            assert!(
                cell.min_element() >= 0.0 && cell.x < 60.0 && cell.y < 40.0,
                "{cell}"
            );
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a cell of the patch"
            )]
            let index = cell.y as usize * 60 + cell.x as usize;
            cells[index] += 1;
        }
        let one_each = cells.iter().all(|&count| count == 1);
        assert_eq!(one_each, expected, "{arrangement:?}");
    }
}

#[test]
fn a_surface_scatters_its_area_per_steradian() {
    let patch = patch(Arrangement::Lattice, GAUSSIAN);
    let surface = RoughSurface::patch(&patch).expect("a patch");
    let power = |surface: &RoughSurface| -> f64 {
        let scatterers = surface.scatterers().iter();
        scatterers.map(|s| s.amplitude.norm_sqr()).sum()
    };
    // The mean of 2400 exponential numbers scatters by 2 %.
    assert_relative(power(&surface), 6e-6, 0.08);
    let unit = Roughness::FullyDeveloped(Amplitudes::Unit);
    let surface = RoughSurface::patch(&PatchDescription {
        roughness: unit,
        ..patch
    })
    .expect("a patch");
    assert_relative(power(&surface), 6e-6, 1e-12);
}

#[test]
fn a_seed_is_a_surface() {
    for arrangement in [Arrangement::Stratified, Arrangement::Random] {
        let patch = patch(arrangement, GAUSSIAN);
        let surface =
            |seed| RoughSurface::patch(&PatchDescription { seed, ..patch }).expect("a patch");
        assert_eq!(surface(1), surface(1));
        let (one, other) = (surface(1), surface(2));
        let pairs = one.scatterers().iter().zip(other.scatterers());
        for (a, b) in pairs {
            assert!(
                a.position != b.position && a.amplitude != b.amplitude,
                "shared"
            );
        }
    }
}

#[test]
fn heights_of_a_large_surface_have_the_right_correlation_at_all_lags() {
    // 200 × 200 scatterers 10 µm apart. With a correlation length of 20 µm there are π (ℓ² / 2) /
    // 100 µm² = 6.3 scatterers per independent height, 6400 of those; below 5 µm all are
    // independent.
    for correlation_length in [20e-6, 5e-6, 4e-6, 0.0] {
        let roughness = Roughness::Heights {
            rms: 2e-6,
            correlation_length,
        };
        let patch = PatchDescription {
            scatterers: [200, 200],
            size: [2e-3, 2e-3],
            ..patch(Arrangement::Lattice, roughness)
        };
        let surface = RoughSurface::patch(&patch).expect("a patch");
        let height = |scatterer| local(&patch, scatterer).z / 2e-6;
        let heights: Vec<f64> = surface.scatterers().iter().map(height).collect();
        let fourth = heights.iter().map(|h| h.powi(4)).sum::<f64>() / 40_000.0;
        // √(96/6400) = 0.12; four of them.
        assert_absolute(fourth, 3.0, 0.49);
        for [dx, dy] in [[0, 0], [1, 0], [0, 1], [2, 1], [3, 0], [2, 3], [8, 0]] {
            let (mut sum, mut count) = (0.0, 0.0);
            for y in 0..200 - dy {
                for x in 0..200 - dx {
                    sum += heights[y * 200 + x] * heights[(y + dy) * 200 + x + dx];
                    count += 1.0;
                }
            }
            let lag2 = (dx * dx + dy * dy) as f64 * 100e-12;
            let expected = match lag2 {
                0.0 => 1.0,
                _ => (-lag2 / correlation_length.powi(2)).exp(),
            };
            // √(2/6400) = 1.8 % for the variance, less elsewhere; four of them.
            assert_absolute(sum / count, expected, 0.07);
        }
    }
}

#[test]
fn heights_keep_scatterers_over_their_places() {
    let roughness = Roughness::Heights {
        rms: 2e-6,
        correlation_length: 100e-6,
    };
    let rough = patch(Arrangement::Stratified, roughness);
    let flat = PatchDescription {
        roughness: GAUSSIAN,
        ..rough
    };
    let [rough_surface, flat_surface] =
        [rough, flat].map(|p| RoughSurface::patch(&p).expect("a patch"));
    for (a, b) in rough_surface
        .scatterers()
        .iter()
        .zip(flat_surface.scatterers())
    {
        let (a, b) = (local(&rough, a), local(&flat, b));
        assert!((a - b).truncate().length() < 1e-15, "{a} over {b}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_patch_is_rejected_or_finite(
        centre in -20..8_i32, side in -20..8_i32, ratio in -3..3_i32,
        rms in -20..8_i32, length in -20..8_i32, columns in 1..20_usize
    ) {
        let power = |exponent: i32| 10.0_f64.powi(exponent);
        let patch = PatchDescription {
            centre: DVec3::splat(power(centre)),
            size: [power(side), power(side + ratio)],
            scatterers: [columns, 7],
            ..patch(
                Arrangement::Random,
                Roughness::Heights { rms: power(rms), correlation_length: power(length) },
            )
        };
        if let Ok(surface) = RoughSurface::patch(&patch) {
            prop_assert!(
                surface.scatterers().iter().all(|s| s.position.is_finite()),
                "{:?}",
                patch
            );
        }
    }
}
