//! Speckle in images, judged by wave optics from first principles: its statistics, and how thin a
//! laser line may be before its image is no pattern times an irradiance any more.

use core::f64::consts::PI;

use crate::line_image::{
    Measured, Row, blurred_profile, by_pattern, by_wave_optics, geometric_profile,
};
use tem00::{
    numerics::jinc,
    wave::{
        Arrangement, Camera, DVec2, DVec3, Field, FieldCorrelation, Grid, Illumination,
        ImageSampling, ImageWindow, Lens, PatchDescription, RoughSurface, Roughness,
    },
};

/// Images of a line, each 40 speckle sizes long.
const IMAGES: u64 = 12;

/// Four times the relative standard error 1/√(2K) of a standard deviation, from the K = 12 · 40 ·
/// π/4 speckles along the images.
const FOUR_ERRORS: f64 = 0.15;

fn rows(image: impl Fn(u64) -> Vec<Row>) -> Vec<Row> {
    (0..IMAGES).flat_map(image).collect()
}

fn by_waves(width: f64) -> Measured {
    let image = |seed| by_wave_optics(width, seed).expect("an image");
    Measured::of(&rows(image), width)
}

fn by_profile(profile: &[f64], width: f64) -> Measured {
    let image = |seed| by_pattern(profile, seed).expect("a pattern");
    Measured::of(&rows(image), width)
}

/// First order in the fluctuations, √(w ℓ / (8 √π)) with ℓ = 32 h/3π² for the points of a row.
fn centroid_noise(width: f64) -> f64 {
    (width * 32.0 / (3.0 * PI * PI) / (8.0 * PI.sqrt())).sqrt()
}

#[test]
fn centroids_of_lines_scatter_as_the_closed_form_says() {
    for width in [0.25, 1.0, 4.0] {
        let ratio = by_waves(width).centroid_noise / centroid_noise(width);
        assert!(
            (ratio - 1.0).abs() < FOUR_ERRORS,
            "w = {width} h: {ratio:.3}"
        );
    }
}

#[test]
fn a_pattern_times_the_blurred_irradiance_is_right_from_one_speckle_on() {
    for width in [1.0, 4.0] {
        let waves = by_waves(width);
        let pattern = by_profile(&blurred_profile(width), width);
        let noise = pattern.centroid_noise / waves.centroid_noise;
        let full = pattern.width / waves.width;
        // Both have the error.
        assert!(
            (noise - 1.0).abs() < FOUR_ERRORS * 2.0_f64.sqrt(),
            "w = {width} h: {noise:.3}"
        );
        assert!((full - 1.0).abs() < FOUR_ERRORS, "w = {width} h: {full:.3}");
    }
}

#[test]
fn a_line_thinner_than_a_speckle_is_no_pattern_times_an_irradiance() {
    let width = 0.25;
    let waves = by_waves(width);
    let blurred = by_profile(&blurred_profile(width), width);
    let sharp = by_profile(&geometric_profile(width), width);
    // Its image is one speckle wide, and no part of it twinkles by itself.
    assert!(
        (waves.width / blurred.width - 1.0).abs() < FOUR_ERRORS,
        "{:.3}",
        waves.width
    );
    assert!(waves.across > 0.7, "{:.3}", waves.across);
    assert!(blurred.across < 0.2, "{:.3}", blurred.across);
    // Light that interferes across the whole line leaves more contrast in a row than light that
    // was added up.
    let contrast = blurred.row_contrast / waves.row_contrast;
    assert!(contrast < 0.9, "{contrast:.3}");
    // Patterns say too much, or far too little, of its centroid.
    let noise = blurred.centroid_noise / waves.centroid_noise;
    assert!(noise > 1.2, "{noise:.3}");
    let noise = sharp.centroid_noise / waves.centroid_noise;
    assert!(noise < 0.4, "{noise:.3}");
    assert!(sharp.width < 0.35 * waves.width, "{:.3}", sharp.width);
}

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
