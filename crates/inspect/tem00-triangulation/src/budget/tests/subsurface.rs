//! Light from below the surface of the part.

use tem00_numerics::cast::to_usize;

use super::*;
use crate::Subsurface;

/// Marble in red light.
const MARBLE: Subsurface = Subsurface {
    material: None,
    transport_length: 1e-3 / 2.19,
    absorption: 2.1,
    refractive_index: 1.5,
    anisotropy: 0.0,
    boundary_slope: 0.0,
    surface_fraction: 0.0,
};

/// Returns the centre of the light of a line within `window` pixels of that centre, from the place
/// where the line enters.
fn centre(line: &ImagedLine, window: f64) -> f64 {
    const STEP: f64 = 0.1;
    let profile = line.profile(100.0);
    let light: Vec<_> = (-600..600)
        .map(|step| STEP * f64::from(step))
        .map(|place| [place, profile.at(place)])
        .collect();
    (0..100).fold(0.0, |centre, _| {
        let seen = light
            .iter()
            .filter(|[place, _]| (place - centre).abs() <= window);
        let [moment, sum] = seen.fold([0.0; 2], |[moment, sum], [place, light]| {
            [moment + place * light, sum + light]
        });
        moment / sum
    })
}

#[test]
fn marble_reads_too_low_by_what_the_window_sees() {
    // Heights in µm by photons that were counted where they leave, of a line of 0.2 mm: its centre
    // within 0.5 and 0.2 mm of itself.
    for (angle, counted) in [
        (20_f64, [-164e-6, -140e-6]),
        (30.0, [-153e-6, -122e-6]),
        (45.0, [-125e-6, -92e-6]),
    ] {
        for (window, expected) in [0.5e-3, 0.2e-3].into_iter().zip(counted) {
            let angle = angle.to_radians();
            // Lens and pixels blur the line little at f/4.
            let setup = setup_of(|d| {
                d.camera.angle = angle;
                d.camera.f_number = 4.0;
                d.sensor.pixel_pitch = 1.7e-6;
                d.surface.subsurface = MARBLE;
            });
            let pixels = setup.magnification() * angle.cos() / 1.7e-6;
            let line = setup.line();
            let shift = centre(line, window * pixels);
            let height = setup.height_at(line.position + shift).unwrap();
            assert_relative(height, expected, 0.02);
            // A detector counts the light above the background: less of the long tail.
            let detected = budget_of(|d| {
                d.camera.angle = angle;
                d.detector.window = to_usize(0.5 * window * pixels) * 2 + 1;
                d.surface.subsurface = MARBLE;
            });
            let detected = detected.subsurface().unwrap().height;
            let ratio = detected / height;
            assert!((0.8..1.0).contains(&ratio), "{angle}, {window}: {ratio}");
        }
    }
}

#[test]
fn light_of_the_boundary_alone_makes_no_shift() {
    let bare = budget_of(|_| ());
    assert!(bare.subsurface().is_none());
    let coated = budget_of(|d| {
        d.surface.subsurface = Subsurface {
            surface_fraction: 1.0,
            ..MARBLE
        };
    });
    let shift = coated.subsurface().unwrap();
    assert!(shift.position.abs() < 1e-3, "{shift:?}");
    let speckle = [&bare, &coated].map(|budget| budget.contribution(Source::Speckle));
    // One by the law of waves for a Gaussian line, one by a pattern times the line.
    assert_relative(speckle[1], speckle[0], 0.05);
}
