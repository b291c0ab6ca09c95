//! A corner of two rough plates; `tests/judges` holds the contrast of its light to the light of the
//! wall summed.

use core::sync::atomic::AtomicBool;
use tem00_testkit::on_threads;

use glam::DVec3;
use tem00_coherence::{PeakShape, Spectrum};
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_tracer::{Frame, LaserDescription};

use super::*;
use crate::{render_frame, testing};

const WAVELENGTH: f64 = 650e-9;

/// Plates at right angles: the floor, which the camera sees, and a wall, which a beam of the given
/// waist radius lights from the side.
fn corner(spectrum: Spectrum, waist_radius: f64) -> Scene {
    let aim = DVec3::new(0.0, 0.0, 15e-3);
    let position = DVec3::new(0.4, 0.0, 0.2);
    let laser = LaserDescription {
        spectrum,
        look_at: aim,
        ..testing::spot(position, waist_radius)
    };
    let floor = testing::plate(DVec3::new(25e-3, 0.0, 0.0), DVec3::Z, [50e-3, 50e-3]);
    let mut wall = testing::plate(DVec3::new(0.0, 0.0, 25e-3), DVec3::X, [50e-3, 50e-3]);
    wall.name = "wall".into();
    let seen = DVec3::new(12e-3, 0.0, 0.0);
    let mut camera = testing::camera(seen + DVec3::new(0.1, 0.0, 0.28), [160, 120]);
    camera.look_at = seen;
    camera.focus_distance = (camera.position - seen).length();
    camera.pixel_pitch = 1.2e-6;
    camera.depth_of_field = false;
    let mut scene = testing::scene(camera, &[laser], floor);
    scene.surfaces.push(wall);
    // The closed form is for one further surface.
    scene.render.max_depth = Some(2);
    scene
}

fn gaussian(linewidth: f64) -> Spectrum {
    if linewidth == 0.0 {
        return Spectrum::monochromatic(WAVELENGTH).unwrap();
    }
    Spectrum::new(WAVELENGTH, linewidth, PeakShape::Gaussian).unwrap()
}

fn render(scene: &Scene, frame: u32, seed: u64) -> Frame {
    let model = testing::speckle(scene, seed);
    let options = RenderOptions {
        samples_per_pixel: 4,
        seed,
        ..scene.render
    };
    let go_on = AtomicBool::new(false);
    render_frame(scene, Some(&model), frame, &options, &|_| (), &go_on).unwrap()
}

#[test]
fn frames_of_a_survey_have_the_same_bits_for_any_number_of_threads() {
    let scene = corner(gaussian(0.1e-9), 20e-3);
    let render_on = |threads| on_threads(threads, || render(&scene, 0, 3));
    assert_eq!(render_on(1), render_on(3), "one thread and three");
}

#[test]
fn a_small_spot_on_the_wall_makes_speckle_of_speckle() {
    for waist_radius in [0.05e-3, 0.15e-3] {
        let scene = corner(gaussian(0.0), waist_radius);
        let floor = DVec3::new(12e-3, 0.0, 0.0);
        let to_pupil = scene.camera.position() - floor;
        let sin_aperture = 0.5 * scene.camera.pupil_diameter() / to_pupil.length();
        let l = to_pupil.normalize();
        // The spot on the wall, in steps of a quarter of its radius, as directions across the line
        // of sight.
        let axis = || (-8..=8).map(|i| 0.25 * f64::from(i) * waist_radius);
        let spot: Vec<_> = axis()
            .flat_map(|y| axis().map(move |z| DVec3::new(0.0, y, 15e-3 + z)))
            .filter_map(|wall| {
                let lit = scene.lasers[0].next_event(wall)?;
                let direction = (wall - floor).normalize();
                let across = direction - direction.dot(l) / l.z * DVec3::Z;
                Some((across / (2.0 * sin_aperture), lit.e_perp))
            })
            .collect();
        let (mut sum, mut whole) = (0.0, 0.0);
        for (a, first) in &spot {
            for (b, second) in &spot {
                sum += first * second * pupil_overlap_correlation(a.distance(*b));
                whole += first * second;
            }
        }
        let law = (1.0 + 2.0 * sum / whole).sqrt();
        let notes = cascade_notes(&scene).unwrap();
        let [note] = notes.as_slice() else {
            panic!("{notes:?}")
        };
        assert_eq!((note.surface.as_str(), note.laser), ("plate", 0));
        // The note has the place where it is highest, of an image that is small against its
        // distance from the wall.
        assert!((note.contrast - law).abs() < 0.05, "{note} for {law}");
    }
    let wide = corner(gaussian(0.0), 20e-3);
    assert_eq!(cascade_notes(&wide).unwrap(), []);
}
