//! Displacement of the speckle in the image, in focus and out of it.

use tem00::{
    decorrelation::{ImagingGeometry, PupilDistances, SpeckleMotion},
    wave::{
        Amplitudes, Arrangement, Camera, DVec2, DVec3, Field, Grid, ImageSampling, ImageWindow,
        Lens, PatchDescription, RoughSurface, Roughness, displacement_between,
    },
};

use super::{
    geometries::{self, frontal, moved, slid, tilted, v},
    scene::{Motion, Scene, States, WAVELENGTH, plane, point_source},
};

pub(crate) const PUPIL_DIAMETER: f64 = 6e-3;
pub(crate) const PUPIL_TO_IMAGE: f64 = 60e-3;
const SAMPLES: usize = 96;
const MIDDLE: usize = 56;

pub(crate) const SPECKLE: f64 = WAVELENGTH * PUPIL_TO_IMAGE / PUPIL_DIAMETER;
const STEP: f64 = 0.5 * SPECKLE;

struct Case {
    name: &'static str,
    scene: Scene,
    motion: Motion,
    /// Depth in focus, in metres.
    focus: f64,
}

fn focused(case: geometries::Case, focus: f64) -> Case {
    let geometries::Case {
        name,
        scene,
        motion,
        ..
    } = case;
    Case {
        name,
        scene,
        motion,
        focus,
    }
}

impl Case {
    fn geometry(&self) -> ImagingGeometry {
        ImagingGeometry::from_distances(PupilDistances {
            wavelength: WAVELENGTH,
            surface_to_pupil: self.focus,
            pupil_to_image: PUPIL_TO_IMAGE,
            pupil_diameter: PUPIL_DIAMETER,
            pixel_pitch: STEP,
        })
        .expect("a camera")
    }

    /// The displacement by the law, in speckles.
    fn law(&self) -> DVec2 {
        let before = self.scene.configuration();
        let after = States::from(self.motion).after(&before);
        let motion = SpeckleMotion::between(&self.geometry(), &before, &after);
        motion.speckle_displacement() / SPECKLE
    }

    /// Equation (5) as Bergmann et al. 2016 print it, upright and in speckles.
    fn printed_law(&self) -> DVec2 {
        let angles = tem00_paper::EulerAngles::between(&self.scene.frame(), self.scene.normal);
        let (axes, angles) = angles.expect("angles");
        let motion = axes.transpose() * self.motion.surface;
        let magnification = self.geometry().magnification();
        -tem00_paper::image_displacement(magnification, angles, motion) / SPECKLE
    }

    /// The displacement by waves, in speckles.
    fn measured(&self, seeds: u64) -> DVec2 {
        measured(&self.scene, &self.motion.into(), self.focus, seeds).0
    }
}

/// Measures what becomes of the speckle in the image, with the lens focused at a depth: its
/// displacement in speckles, y up, and the correlation that is left, on the mean over some surfaces.
pub(crate) fn measured(scene: &Scene, states: &States, focus: f64, seeds: u64) -> (DVec2, f64) {
    let lens = Lens {
        pupil_diameter: PUPIL_DIAMETER,
        focus_distance: focus,
        pupil_to_image: PUPIL_TO_IMAGE,
    };
    let camera = scene.camera();
    let camera = Camera::new(camera.pupil_centre(), camera.axes(), lens).expect("a camera");
    let sampling = ImageSampling {
        wavelength: WAVELENGTH,
        centre: camera.project(DVec3::ZERO).expect("in front of the camera"),
        step: STEP,
        samples: SAMPLES,
    };
    let window = |camera: &Camera| ImageWindow::new(camera, &sampling).expect("a window");
    let windows = [
        window(&camera),
        window(&camera.moved(&states.camera.judge())),
    ];
    let light = scene.light.wave.moved(&states.source.judge());
    let shift = |seed| {
        let surface = patch(scene, seed);
        let before = windows[0].image(&surface.lit_by(&scene.light.wave));
        let surface = surface.moved(&states.surface.judge());
        let after = windows[1].image(&surface.lit_by(&light));
        displacement_between(&middle(&before), &middle(&after)).expect("a maximum")
    };
    let shifts: Vec<_> = (1..=seeds).map(shift).collect();
    let count = seeds as f64;
    (
        shifts
            .iter()
            .map(|shift| shift.offset * STEP / SPECKLE)
            .sum::<DVec2>()
            / count,
        shifts.iter().map(|shift| shift.correlation).sum::<f64>() / count,
    )
}

/// A patch whose image fills most of the window; the rest is for motion and blur.
fn patch(scene: &Scene, seed: u64) -> RoughSurface {
    let side = 0.78 * SAMPLES as f64 * STEP * scene.eye.length() / PUPIL_TO_IMAGE;
    RoughSurface::patch(&PatchDescription {
        centre: DVec3::ZERO,
        normal: scene.normal,
        along: DVec3::X,
        size: [side; 2],
        scatterers: [64; 2],
        arrangement: Arrangement::Stratified,
        roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
        seed,
    })
    .expect("a patch")
}

/// The middle of the image, where no edge of the patch is seen: an edge that moves otherwise than
/// the speckle would draw the maximum towards itself.
fn middle(image: &Field) -> Grid<f32> {
    let intensity = image.intensity();
    let first = (SAMPLES - MIDDLE) / 2;
    Grid::from_fn(MIDDLE, MIDDLE, |x, y| intensity[(first + x, first + y)])
}

fn cases() -> Vec<Case> {
    let collimated = plane(v(0.5, 0.2, 1.0));
    let near = point_source(v(-0.12, 0.05, 0.2));
    let off_axis = |scene: Scene| scene.seen(v(0.04, 0.05, 0.3), v(-0.03, 0.02, 0.0));
    let oblique = off_axis(frontal(tilted(20.0, 0.0), near));
    let level = frontal(DVec3::Z, collimated);
    let camera = moved([0.0; 3], [0.15, -0.1, 0.3], [0.0; 3]);
    let mut cases = vec![
        level.case("in focus, sideways", slid(0.2, -0.1, 0.0)),
        frontal(tilted(30.0, 10.0), collimated).case("in focus, tilted", slid(0.15, 0.1, 0.1)),
        off_axis(level).case("off the axis", slid(0.1, 0.15, 0.2)),
        oblique.case("off the axis, source near", slid(-0.1, 0.1, 0.2)),
        off_axis(level).case("camera moves", camera),
    ]
    .into_iter()
    .map(|case| focused(case, 0.3))
    .collect::<Vec<_>>();
    let lit_near = frontal(DVec3::Z, near);
    let both = moved([0.6, 0.3, 0.0], [0.6, 0.3, 0.0], [0.0; 3]);
    for focus in [0.31, 0.29] {
        let alone = lit_near.case("out of focus", slid(0.2, 0.1, 0.0));
        let together = lit_near.case("out of focus, with the camera", both);
        cases.extend([alone, together].map(|case| focused(case, focus)));
    }
    cases
}

#[test]
fn speckle_moves_in_the_image_as_the_law_says() {
    for case in cases() {
        let measured = case.measured(3);
        let expected = case.law();
        let error = (measured - expected).length();
        let (name, far) = (case.name, expected.length());
        // Four times the error of the cross-correlation of 28 × 28 speckles.
        assert!(error < 0.02, "{name}: {error:.4} of {far:.2} speckles");
    }
}

#[test]
fn a_surface_that_approaches_an_oblique_camera_does_not_move_as_equation_5_is_printed() {
    let level = frontal(DVec3::Z, plane(v(-0.3, 0.0, 1.0)));
    let oblique = level.seen(v(0.15, 0.0, 0.2598), DVec3::ZERO);
    let case = focused(oblique.case("seen at 30°", slid(0.0, 0.0, 0.3)), 0.3);
    let measured = case.measured(2);
    let ours = case.law();
    assert!(ours.length() > 4.0, "{ours} tells nothing");
    // As printed it goes the other way.
    for expected in [ours, -case.printed_law()] {
        let miss = (measured - expected).length();
        assert!(miss < 0.04, "{measured}, not {expected}");
    }
}
