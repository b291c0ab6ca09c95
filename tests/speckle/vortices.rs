//! Phase singularities of generated fields.

use core::f64::consts::TAU;

use proptest::prelude::*;
use tem00::{
    speckle::{Phasors, PupilField},
    statistics::{
        Boundary, Moments,
        estimate::{VortexDensity, phase_singularities},
        t_test_mean,
    },
};

use super::lattice::{Lattice, cases, shapes};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_charges_of_a_tile_cancel(case in cases(20..120, 8.0)) {
        let field = case.field().speckle(case.offset, case.defocus);
        let found = phase_singularities(field.values(), Boundary::Periodic).expect("a finite field");
        let charge: i64 = found.iter().map(|vortex| i64::from(vortex.charge)).sum();
        prop_assert!(!found.is_empty(), "a field without singularities");
        prop_assert_eq!(charge, 0);
    }
}

/// The root of the determinant of the wave numbers' covariances, over 2π, per squared sample; and what
/// counting by cells adds.
fn expected_density(field: &PupilField, offset: [f64; 2]) -> [f64; 2] {
    let [xx, xy, yy] = Lattice::of(field, offset).wave_numbers();
    // The stated 1.5/h² of a disc, whose σ² is π²/4h², in terms of the greater σ².
    [(xx * yy - xy * xy).sqrt() / TAU, 0.61 * xx.max(yy)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn singularities_are_as_dense_as_the_wave_numbers_spread(
        seed in any::<u64>(), size in [160_usize..240, 160_usize..240], speckle_size in 11.0_f64..14.0,
        shape in shapes(), offset in [-9.0_f64..9.0, -9.0_f64..9.0], defocus in -3.0_f64..3.0,
    ) {
        const TILES: u64 = 24;
        let field = PupilField::from_speckle_size(size, speckle_size, seed)
            .and_then(|field| field.with_pupil(shape.pupil()))
            .expect("a valid field")
            .with_phasors(Phasors::Gaussian);
        let densities: Vec<_> = (0..TILES)
            .map(|tile| {
                let field = field.clone().with_seed(seed.wrapping_add(tile));
                let tile = field.speckle(offset, defocus);
                VortexDensity::from_field(tile.values(), Boundary::Periodic).expect("a field").value()
            })
            .collect();
        let [expected, excess] = expected_density(&field, offset);
        let moments = Moments::from_samples(&densities).expect("densities");
        let error = moments.standard_error() / expected;
        prop_assert!(error < 0.04, "nothing is seen with an error of {error}");
        let nearest = moments.mean().clamp(expected, expected * (1.0 + 1.5 * excess));
        let test = t_test_mean(&densities, nearest).expect("densities");
        // 12 cases at 5e−6: α = 6e−5.
        prop_assert!(test.p_value > 5e-6, "{} | {expected}: {test:?}", moments.mean());
    }
}
