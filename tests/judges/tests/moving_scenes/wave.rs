//! Rendered speckle against wave optics: the same bodies, once as a pattern that is looked up, once
//! as the waves of thousands of scatterers with exact distances.

use tem00::{
    decorrelation::{DVec2, DVec3, LensData},
    wave::displacement_between,
};

use crate::wave_judges_decorrelation::{
    geometries::frontal,
    image::{PUPIL_DIAMETER, PUPIL_TO_IMAGE, SPECKLE, measured},
    scene::{Body, States, WAVELENGTH, point_source},
};

use super::setting::{EYE, Setting, in_speckles, speckle};

/// Rough surfaces, and rendered patterns, that are looked at.
const SEEDS: u64 = 4;

struct Case {
    name: &'static str,
    focus: f64,
    states: States,
}

const TO_LASER: DVec3 = DVec3::new(-0.12, 0.05, 0.2);

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
            to_laser: TO_LASER,
            distance: Some(TO_LASER.length()),
        }
    }

    /// Displacement in speckles, y up, and correlation, on the mean over rendered patterns.
    fn rendered(&self) -> (DVec2, f64) {
        let (scene, geometry) = (
            self.setting().moving(&self.states),
            self.setting().geometry(),
        );
        let (mut offset, mut correlation) = (DVec2::ZERO, 0.0);
        for seed in 1..=SEEDS {
            let frames = speckle(&scene, &[0, 1], seed);
            let found = displacement_between(&frames[0], &frames[1]).expect("a maximum");
            offset += in_speckles(found.offset, &geometry) / SEEDS as f64;
            correlation += found.correlation / SEEDS as f64;
        }
        (offset, correlation)
    }
}

#[test]
fn rendered_speckle_moves_and_decorrelates_as_wave_optics_says() {
    let cases = [
        Case {
            name: "plate turned off its pivot and moved, before the focus",
            focus: 0.31,
            states: States {
                surface: Body {
                    translation: DVec3::new(1e-4, -1.5e-4, 1e-4),
                    ..Body::about(0.05 * DVec3::Y, DVec3::new(0.3, 1.0, 0.2), 1.2e-3)
                },
                ..States::default()
            },
        },
        Case {
            name: "camera turned, laser moved, behind the focus",
            focus: 0.29,
            states: States {
                camera: Body {
                    translation: DVec3::new(3e-4, 2e-4, 0.0),
                    ..Body::about(EYE, DVec3::new(0.3, -1.0, 0.5), 0.8e-3)
                },
                source: Body::along(DVec3::new(-3e-4, 4e-4, 2e-4)),
                ..States::default()
            },
        },
    ];
    for case in cases {
        let law = case.setting().law(&case.states);
        let law_offset = law.speckle_displacement() / SPECKLE;
        let lit = frontal(DVec3::Z, point_source(TO_LASER));
        let (judged, left) = measured(&lit, &case.states, case.focus, SEEDS);
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
