//! How fast light that met two rough surfaces changes when they move.

use core::f64::consts::TAU;

use tem00::{
    numerics::disc_overlap,
    wave::{Complex, DVec3, RigidMotion},
};

use super::{
    corner::{Corner, DISTANCE},
    several_surfaces::right_angle,
    sums::{Moments, assert_agrees, assert_refutes, covariance, for_surfaces},
};

/// Plates before each wall.
const PLATES: usize = 20;

/// What is left of squared correlations in a patch that has 99.3 % of the light of a point.
const PATCH: f64 = 0.9932 * 0.9932;

/// The overlap of the pupil with itself, displaced by so many metres.
fn of_pupil(corner: &Corner, across: f64) -> f64 {
    disc_overlap(across / (2.0 * DISTANCE * corner.view.sin_aperture))
}

/// The correlation of the fields of two frames of the multiple light, against the change of phase
/// of the single light: it moves across the pupil as if the plate were the source, and the path by
/// way of each place of the wall changes by another length.
fn multiple(corner: &Corner, motion: &RigidMotion) -> Complex<f64> {
    let to_pupil = corner.view.to_pupil.normalize();
    let pupil = to_pupil * DISTANCE;
    let across = (motion.point(pupil) - pupil).reject_from(to_pupil);
    let seen = motion.point(DVec3::ZERO);
    let (mut sum, mut all) = (Complex::new(0.0, 0.0), 0.0);
    for from in corner.lit_part() {
        let moved = motion.point(from);
        let source = corner.path_from_source(moved) - corner.path_from_source(from);
        let change = source + moved.distance(seen) - from.length();
        let change = change - corner.path_from_source(seen);
        let weight = from.length_squared().recip();
        sum += Complex::from_polar(weight, TAU / corner.view.wavelength * change);
        all += weight;
    }
    of_pupil(corner, across.length()) * sum / all
}

/// The correlation of the fields of two frames of the single light of a far source, before and
/// after a turn in the plane of incidence and a shift across it.
fn single(corner: &Corner, turn: f64, shift: f64) -> f64 {
    let [cos_in, cos_out] =
        [corner.view.to_source, corner.view.to_pupil].map(|direction| direction.normalize().z);
    of_pupil(
        corner,
        shift + turn * DISTANCE * (cos_in + cos_out) / cos_out,
    )
}

struct Scene {
    name: &'static str,
    source: Option<f64>,
    turn: f64,
    /// Along the edge, in metres.
    shift: f64,
    /// Correlations known of single and of multiple light.
    known: [f64; 2],
}

#[test]
fn frames_of_single_multiple_and_mixed_light_follow_the_paths_that_a_motion_changes() {
    let scenes = [
        Scene {
            name: "turn by 0.3 mrad",
            source: None,
            turn: 0.3e-3,
            shift: 0.0,
            known: [0.972, 0.66],
        },
        Scene {
            name: "turn by 3 mrad",
            source: None,
            turn: 3e-3,
            shift: 0.0,
            known: [0.739, 0.006],
        },
        Scene {
            name: "shift by 1 mm",
            source: None,
            turn: 0.0,
            shift: 1e-3,
            known: [0.762, 0.762],
        },
        Scene {
            name: "shift by 0.1 mm before a point source",
            source: Some(0.2),
            turn: 0.0,
            shift: 0.1e-3,
            known: [0.951, 0.096],
        },
    ];
    for scene in scenes {
        let corner = Corner {
            source: scene.source,
            sites: [1000, 200],
            ..right_angle()
        };
        let turn = RigidMotion::rotation(DVec3::Y, scene.turn, DVec3::ZERO).expect("a turn");
        let shift = RigidMotion::translation(DVec3::Y * scene.shift).expect("a motion");
        let motion = turn.then(&shift);
        let wave_numbers = [TAU / corner.view.wavelength];
        let frames = [RigidMotion::IDENTITY, motion].map(|m| corner.waves(&wave_numbers, &m));
        let surfaces = for_surfaces(600, 9, |random| {
            let amplitudes = corner.amplitudes(PLATES, random);
            let frames = frames.each_ref().map(|waves| waves.fields(&amplitudes));
            let of = |frames: [Vec<Vec<f64>>; 2]| {
                let both = frames.map(|mut frame| frame.remove(0));
                Moments::of_products([&both[0], &both[1]], &both, [0, 0], [PLATES, 1])
            };
            [
                of([0, 1].map(|i| frames[i].intensities(0.0, false))),
                of([0, 1].map(|i| frames[i].multiple_alone())),
                of([0, 1].map(|i| frames[i].intensities(1.0, false))),
            ]
        });
        // A point source joins the pupil at its own distance, which is that of the camera.
        let doubled = if scene.source.is_some() { 2.0 } else { 1.0 };
        let first = single(&corner, scene.turn, doubled * scene.shift);
        let second = multiple(&corner, &motion);
        let laws = [
            first.powi(2),
            second.norm_sqr(),
            (0.5 * (first + second)).norm_sqr(),
        ];
        let waves =
            [0, 1, 2].map(|i| covariance(&surfaces.iter().map(|s| s[i]).collect::<Vec<_>>()));
        for (i, light) in ["single", "multiple", "mixed"].into_iter().enumerate() {
            let name = format!("{light} light, {}", scene.name);
            assert_agrees(&name, waves[i], laws[i] / PATCH, 0.02);
        }
        for (law, known) in laws.iter().zip(scene.known) {
            assert!((law - known).abs() < 0.015, "{}: {law}", scene.name);
        }
        if laws[0] - laws[1] > 0.01 {
            assert_refutes("multiple as single light", waves[1], laws[0] / PATCH);
            // Patterns of their own for both, whose common phase is lost.
            let without_phase = (0.5 * (first + second.norm())).powi(2) / PATCH;
            if without_phase - laws[2] > 0.1 {
                assert_refutes("mixed light without a phase", waves[2], without_phase);
            }
        }
    }
}
