//! The statistics of speckle in images, judged by wave optics from first principles.

use core::f64::consts::PI;

use tem00::{
    numerics::jinc,
    wave::{
        Arrangement, Camera, DVec2, DVec3, Field, FieldCorrelation, Grid, Illumination,
        ImageSampling, ImageWindow, Lens, PatchDescription, RoughSurface, Roughness,
    },
};

/// Images of a surface with heights of 2 µm, in samples of a quarter of the speckle size.
fn images() -> Vec<Grid<tem00::wave::Complex<f64>>> {
    const WAVELENGTH: f64 = 650e-9;
    let lens = Lens {
        pupil_diameter: 20e-3,
        focus_distance: 0.3,
        pupil_to_image: 0.06,
    };
    let eye = DVec3::new(0.0, 0.0, 0.3);
    let camera = Camera::look_at([eye, DVec3::ZERO], DVec3::Y, lens).expect("a camera");
    let speckle = WAVELENGTH * lens.pupil_to_image / lens.pupil_diameter;
    let sampling = ImageSampling {
        wavelength: WAVELENGTH,
        centre: DVec2::ZERO,
        step: speckle / 4.0,
        samples: 128,
    };
    let window = ImageWindow::new(&camera, &sampling).expect("a window");
    let light = Illumination::plane(WAVELENGTH, DVec3::new(-0.3, 0.0, -1.0)).expect("a wave");
    let image = |seed| {
        let surface = RoughSurface::patch(&PatchDescription {
            centre: DVec3::ZERO,
            normal: DVec3::Z,
            along: DVec3::X,
            size: [26.0 * WAVELENGTH * 0.3 / 20e-3; 2],
            scatterers: [182; 2],
            arrangement: Arrangement::Lattice,
            roughness: Roughness::Heights {
                rms: 2e-6,
                correlation_length: 0.0,
            },
            seed,
        });
        let surface = surface.expect("a patch");
        middle(&window.image(&surface.lit_by(&light)))
    };
    (0..6).map(image).collect()
}

/// The middle of an image, 16 speckle sizes wide.
fn middle(image: &Field) -> Grid<tem00::wave::Complex<f64>> {
    Grid::from_fn(64, 64, |x, y| image.amplitude()[(32 + x, 32 + y)])
}

#[test]
fn the_image_of_a_rough_surface_has_the_autocovariance_of_a_round_pupil() {
    let images = images();
    for lag in [2, 4, 6] {
        let mut correlation = FieldCorrelation::default();
        for image in &images {
            let part = |first| Grid::from_fn(64 - lag, 64, |x, y| image[(first + x, y)]);
            correlation.add(&part(0), &part(lag));
        }
        // 6 · 16² · π/4 speckles.
        let measured = correlation.estimate_from_speckles(1200.0).expect("light");
        let law = jinc(PI * lag as f64 / 4.0).powi(2);
        let deviation = (measured.value - law) / measured.standard_error;
        assert!(
            deviation.abs() < 4.0,
            "lag {lag}: {measured:?}, law {law:.4}"
        );
    }
}
