use core::f64::consts::PI;

use super::*;
use crate::{DMat3, Illumination, Lens, RoughSurface, Scatterer};

const WAVELENGTH: f64 = 650e-9;
const LENS: Lens = Lens {
    pupil_diameter: 5e-3,
    focus_distance: 0.3,
    pupil_to_image: 0.06,
};
/// h = λ · `pupil_to_image` / D.
const SPECKLE: f64 = 7.8e-6;

fn points(positions: &[DVec3]) -> LitSurface {
    let scatterer = |&position: &DVec3| Scatterer {
        position,
        amplitude: Complex::new(1.0, 0.0),
    };
    let light = Illumination::plane(WAVELENGTH, DVec3::NEG_Z).expect("a plane wave");
    RoughSurface::from_scatterers(positions.iter().map(scatterer).collect())
        .expect("points")
        .lit_by(&light)
}

/// A camera at the origin that looks against z, into the half-space z < 0.
fn camera() -> Camera {
    Camera::new(DVec3::ZERO, DMat3::IDENTITY, LENS).expect("a camera")
}

fn sampling(samples: usize) -> ImageSampling {
    ImageSampling {
        wavelength: WAVELENGTH,
        centre: DVec2::ZERO,
        step: SPECKLE / 4.0,
        samples,
    }
}

/// J₁ by its integral over half a turn, which the trapezoidal rule does exactly.
fn bessel_j1(x: f64) -> f64 {
    const STEPS: u32 = 64;
    let term = |i: u32| {
        let t = PI * (f64::from(i) + 0.5) / f64::from(STEPS);
        (t - x * t.sin()).cos()
    };
    (0..STEPS).map(term).sum::<f64>() / f64::from(STEPS)
}

#[test]
fn a_point_in_focus_is_an_airy_pattern() {
    let window = ImageWindow::new(&camera(), &sampling(512)).expect("a window");
    let image = window.image(&points(&[DVec3::new(0.0, 0.0, -0.3)]));
    let peak = image.amplitude()[(256, 256)];
    // exp(ik · 0) from the removed sphere over the distance; 0.3 m is whole in no way.
    assert!((peak.norm() * 0.3 - 1.0).abs() < 1e-4, "{peak}");
    for x in 256..300_usize {
        for y in [256, 256 + (x - 256) / 2] {
            let radius = ((x - 256) as f64).hypot((y - 256) as f64) / 4.0;
            let argument = PI * radius.max(1e-6);
            let airy = 2.0 * bessel_j1(argument) / argument;
            let error = (image.amplitude()[(x, y)] / peak - airy).norm();
            // The part of a rim cell inside the pupil is off by some 0.1; there are 400 of them
            // among 12 900 cells: 0.1 √400 / 12 900 = 1.6e−4, and twice that.
            assert!(error < 3.2e-4, "{error:e} at {radius} h");
        }
    }
}
