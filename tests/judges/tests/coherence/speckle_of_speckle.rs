//! Light by way of a wall so small that its own speckle is as large as what the camera resolves.

use core::f64::consts::TAU;

use tem00::{
    coherence::cascade_variance,
    wave::{DVec3, RigidMotion},
};

use super::{
    bench::plane_of_incidence,
    corner::{Corner, Wall},
    sums::{Moments, assert_agrees, contrast, for_surfaces},
};

/// Plates before each wall.
const PLATES: usize = 12;

/// A round part of a wall in the direction of a mirror, where the plate looks alike from there and
/// from the camera.
fn small_part(relative_aperture: f64) -> Corner {
    let view = plane_of_incidence(50.0, 40.0);
    let to_wall = view.to_pupil * DVec3::new(-1.0, -1.0, 1.0);
    let distance = 2e-3;
    let half_angle = (relative_aperture * view.sin_aperture).asin();
    let (first, second) = to_wall.any_orthonormal_pair();
    let diameter = 2.0 * distance * half_angle.tan();
    Corner {
        view,
        wall: Wall {
            centre: to_wall * distance,
            sides: [first * diameter, second * diameter],
            is_round: true,
        },
        source: None,
        sites: [160, 60],
    }
}

#[test]
fn a_small_lit_part_makes_speckle_of_speckle() {
    for (relative_aperture, known) in [(0.5, 1.435), (1.0, 1.237), (2.0, 1.086)] {
        let corner = small_part(relative_aperture);
        let wave_number = TAU / corner.view.wavelength;
        let waves = corner.waves(&[wave_number], &RigidMotion::IDENTITY);
        let surfaces = for_surfaces(20_000, 10, |random| {
            let fields = waves.fields(&corner.amplitudes(PLATES, random));
            Moments::new(&fields.multiple_alone()[0], &fields.intensities(0.0, false))
        });
        let law = (1.0 + 2.0 * cascade_variance(relative_aperture).expect("a ratio")).sqrt();
        assert!((law - known).abs() < 1e-3);
        let name = format!("r = {relative_aperture}");
        assert_agrees(&name, contrast(&surfaces), law, 0.03);
    }
}
