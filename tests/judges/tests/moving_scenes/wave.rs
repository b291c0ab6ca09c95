//! Rendered speckle against wave optics: the same bodies, once as a pattern that is looked up, once
//! as the waves of thousands of scatterers with exact distances.

use tem00::{
    decorrelation::{DVec2, DVec3, LensData, RigidMotions},
    numerics::Grid,
    wave::{
        Amplitudes, Arrangement, Camera, Illumination, ImageSampling, ImageWindow, Lens,
        PatchDescription, RigidMotion, RoughSurface, Roughness, displacement_between,
    },
};

use super::setting::{EYE, Setting, Step, in_speckles, speckle};

const PUPIL_DIAMETER: f64 = 6e-3;
const PUPIL_TO_IMAGE: f64 = 60e-3;
const WAVELENGTH: f64 = 650e-9;
const SPECKLE: f64 = WAVELENGTH * PUPIL_TO_IMAGE / PUPIL_DIAMETER;

/// Samples of a wave-optical image along each side, half a speckle apart, and those in its middle
/// that are looked at.
const SAMPLES: usize = 96;
const MIDDLE: usize = 56;

/// Rough surfaces, and rendered patterns, that are looked at.
const SEEDS: u64 = 4;

struct Case {
    name: &'static str,
    focus: f64,
    to_laser: DVec3,
    plate: Step,
    camera: Step,
    laser: Step,
}

impl Case {
    fn setting(&self) -> Setting {
        let focal_length = (self.focus.recip() + PUPIL_TO_IMAGE.recip()).recip();
        Setting {
            lens: LensData {
                wavelength: WAVELENGTH,
                focal_length,
                f_number: focal_length / PUPIL_DIAMETER,
                surface_to_pupil: self.focus,
                pixel_pitch: SPECKLE / 6.5,
            },
            to_laser: self.to_laser,
            distance: Some(self.to_laser.length()),
        }
    }

    /// Displacement in speckles, y up, and correlation, on the mean over rendered patterns.
    fn rendered(&self) -> (DVec2, f64) {
        let mut scene = self.setting().scene();
        scene.surfaces[0].trajectory = self.plate.trajectory();
        scene.camera_trajectory = self.camera.trajectory();
        let laser = scene.lasers[0].clone();
        scene.lasers[0] = laser.with_trajectory(self.laser.trajectory());
        let geometry = self.setting().geometry();
        mean(|seed| {
            let frames = speckle(&scene, &[0, 1], seed);
            let found = displacement_between(&frames[0], &frames[1]).expect("a maximum");
            (in_speckles(found.offset, &geometry), found.correlation)
        })
    }

    /// The same by wave optics, on the mean over rough surfaces.
    fn judged(&self) -> (DVec2, f64) {
        let lens = Lens {
            pupil_diameter: PUPIL_DIAMETER,
            focus_distance: self.focus,
            pupil_to_image: PUPIL_TO_IMAGE,
        };
        let camera = Camera::look_at([EYE, DVec3::ZERO], DVec3::Y, lens).expect("a camera");
        let sampling = ImageSampling {
            wavelength: WAVELENGTH,
            centre: camera.project(DVec3::ZERO).expect("in front of the camera"),
            step: 0.5 * SPECKLE,
            samples: SAMPLES,
        };
        let light = Illumination::point(WAVELENGTH, self.to_laser).expect("a wave");
        let window = |camera: &Camera| ImageWindow::new(camera, &sampling).expect("a window");
        let moved = camera.moved(&of_judge(&self.camera));
        let windows = [&camera, &moved].map(window);
        mean(|seed| {
            let plate = plate(seed);
            let before = windows[0].image(&plate.lit_by(&light));
            let moved = plate.moved(&of_judge(&self.plate));
            let lit = moved.lit_by(&light.moved(&of_judge(&self.laser)));
            let after = windows[1].image(&lit);
            let [before, after] = [before, after].map(|field| middle(&field.intensity()));
            let found = displacement_between(&before, &after).expect("a maximum");
            (0.5 * found.offset, found.correlation)
        })
    }
}

fn mean(of: impl Fn(u64) -> (DVec2, f64)) -> (DVec2, f64) {
    let (mut offset, mut correlation) = (DVec2::ZERO, 0.0);
    for seed in 1..=SEEDS {
        let (found, left) = of(seed);
        offset += found / SEEDS as f64;
        correlation += left / SEEDS as f64;
    }
    (offset, correlation)
}

/// A motion as the judge takes it.
fn of_judge(step: &Step) -> RigidMotion {
    let turn = RigidMotion::rotation(step.axis, step.angle, step.pivot).expect("a rotation");
    turn.then(&RigidMotion::translation(step.displacement).expect("a translation"))
}

/// A patch whose image fills most of the window; the rest is for motion and blur.
fn plate(seed: u64) -> RoughSurface {
    let side = 0.78 * SAMPLES as f64 * 0.5 * SPECKLE * EYE.z / PUPIL_TO_IMAGE;
    RoughSurface::patch(&PatchDescription {
        centre: DVec3::ZERO,
        normal: DVec3::Z,
        along: DVec3::X,
        size: [side; 2],
        scatterers: [64; 2],
        arrangement: Arrangement::Stratified,
        roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
        seed,
    })
    .expect("a patch")
}

/// The middle of an image, where no edge of the patch is seen.
fn middle(image: &Grid<f32>) -> Grid<f32> {
    let first = (SAMPLES - MIDDLE) / 2;
    Grid::from_fn(MIDDLE, MIDDLE, |x, y| image[(first + x, first + y)])
}

#[test]
fn rendered_speckle_moves_and_decorrelates_as_wave_optics_says() {
    let near = DVec3::new(-0.12, 0.05, 0.2);
    let cases = [
        Case {
            name: "plate turned off its pivot and moved, before the focus",
            focus: 0.31,
            to_laser: near,
            plate: Step {
                displacement: DVec3::new(1e-4, -1.5e-4, 1e-4),
                ..Step::about(0.05 * DVec3::Y, DVec3::new(0.3, 1.0, 0.2), 1.2e-3)
            },
            camera: Step::NONE,
            laser: Step::NONE,
        },
        Case {
            name: "camera turned, laser moved, behind the focus",
            focus: 0.29,
            to_laser: near,
            plate: Step::NONE,
            camera: Step {
                displacement: DVec3::new(3e-4, 2e-4, 0.0),
                ..Step::about(EYE, DVec3::new(0.3, -1.0, 0.5), 0.8e-3)
            },
            laser: Step::along(DVec3::new(-3e-4, 4e-4, 2e-4)),
        },
    ];
    for case in cases {
        let law = case.setting().law(&RigidMotions {
            surface: case.plate.motion(),
            camera: case.camera.motion(),
            source: case.laser.motion(),
        });
        let law_offset = law.speckle_displacement() / SPECKLE;
        let (judged, left) = case.judged();
        let (rendered, kept) = case.rendered();
        let name = case.name;
        let far = law_offset.length();
        assert!(far > 0.5, "{name}: {far} speckles tell nothing");
        // Each mean errs by a hundredth of a speckle or two.
        let error = (rendered - judged).length();
        assert!(error < 0.06, "{name}: {error:.3} of {far:.2} speckles");
        // Standard errors 1.15 h/√A/2 of four patterns 28 and 39 speckles wide, together 0.025,
        // four times.
        assert!((kept - left).abs() < 0.1, "{name}: {kept} | {left}");
        assert!((0.2..0.95).contains(&left), "{name}: {left} tells nothing");
    }
}
