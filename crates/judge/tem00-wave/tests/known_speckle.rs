//! Speckle of the direct sum against closed forms that need no theory of its motion.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

use core::f64::consts::PI;

use tem00_testkit::assert_absolute;
use tem00_wave::{
    Amplitudes, Arrangement, Camera, Complex, DVec2, DVec3, FieldCorrelation, Illumination,
    ImageSampling, ImageWindow, Lens, PatchDescription, RigidMotion, RoughSurface, Roughness,
    SamplePlane, Scatterer, displacement_between,
};

const WAVELENGTH: f64 = 650e-9;
/// Distance from the patch to the pupil, in metres.
const DISTANCE: f64 = 0.3;
const MAGNIFICATION: f64 = 0.2;
/// Speckle size λ · `pupil_to_image` / D in the image.
const SPECKLE: f64 = 7.8e-6;

const LENS: Lens = Lens {
    pupil_diameter: 5e-3,
    focus_distance: DISTANCE,
    pupil_to_image: MAGNIFICATION * DISTANCE,
};

/// A square patch in the plane z = 0.
fn patch(side: f64, scatterers: usize, seed: u64) -> PatchDescription {
    PatchDescription {
        centre: DVec3::ZERO,
        normal: DVec3::Z,
        along: DVec3::X,
        size: [side, side],
        scatterers: [scatterers, scatterers],
        arrangement: Arrangement::Stratified,
        roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
        seed,
    }
}

fn surface(patch: &PatchDescription) -> RoughSurface {
    RoughSurface::patch(patch).expect("a patch")
}

fn collimated() -> Illumination {
    Illumination::plane(WAVELENGTH, DVec3::NEG_Z).expect("a plane wave")
}

fn camera() -> Camera {
    Camera::look_at([DVec3::Z * DISTANCE, DVec3::ZERO], DVec3::Y, LENS).expect("a camera")
}

fn window(step: f64, samples: usize) -> ImageWindow {
    ImageWindow::new(
        &camera(),
        &ImageSampling {
            wavelength: WAVELENGTH,
            centre: DVec2::ZERO,
            step,
            samples,
        },
    )
    .expect("a window")
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 {
        1.0
    } else {
        (PI * x).sin() / (PI * x)
    }
}

#[test]
fn fields_in_the_pupil_are_correlated_as_van_cittert_and_zernike_say() {
    const REPETITIONS: u64 = 300;
    let side = 1e-3;
    // A speckle is λL/W = 195 µm wide; the samples are many speckles apart.
    let speckle = WAVELENGTH * DISTANCE / side;
    let samples = |shift: f64| {
        let steps = [DVec3::X * 5.3 * speckle, DVec3::Y * 6.1 * speckle];
        SamplePlane::new(DVec3::new(shift * speckle, 0.0, DISTANCE), steps, [3, 3])
            .expect("a plane")
    };
    for shift in [0.25, 0.5, 1.0] {
        let mut correlation = FieldCorrelation::default();
        for seed in 0..REPETITIONS {
            let lit = surface(&patch(side, 16, seed)).lit_by(&collimated());
            // The reference phase of each sample: distances to the centre of the patch.
            let field = |plane: &SamplePlane| {
                let mut field = lit.field_on(plane).amplitude().clone();
                for y in 0..3 {
                    for x in 0..3 {
                        let turns = plane.point(x, y).length() / WAVELENGTH;
                        let phase = -2.0 * PI * (turns - turns.round());
                        field[(x, y)] *= Complex::from_polar(1.0, phase);
                    }
                }
                field
            };
            correlation.add(&field(&samples(0.0)), &field(&samples(shift)));
        }
        let estimate = correlation.estimate().expect("many repetitions");
        let expected = sinc(shift).powi(2);
        // 2700 independent speckles: the bias (1 − γ)²/2700 stays below the error.
        let off = (estimate.value - expected) / estimate.standard_error.max(1.0 / 2_700.0);
        assert!(off.abs() < 4.0, "{estimate:?} at {shift}, not {expected}");
    }
}

type State<'a> = (&'a RoughSurface, &'a Illumination, &'a Camera);

/// Displacement of the speckle on the pupil, in metres.
fn pupil_displacement(before: State<'_>, after: State<'_>) -> DVec2 {
    const STEP: f64 = 60e-6;
    let intensity = |(surface, light, camera): State<'_>| {
        let plane = camera.pupil_plane(STEP, 64).expect("a plane");
        surface.lit_by(light).field_on(&plane).intensity()
    };
    let shift = displacement_between(&intensity(before), &intensity(after)).expect("a maximum");
    shift.offset * STEP
}

#[test]
fn speckle_on_the_pupil_moves_as_every_optician_knows() {
    let surface = surface(&patch(1e-3, 40, 2));
    let (plane, camera) = (collimated(), camera());
    let near = Illumination::point(WAVELENGTH, DVec3::Z * DISTANCE).expect("a point source");
    let by =
        |x: f64, y: f64| RigidMotion::translation(DVec3::new(x, y, 0.0)).expect("a translation");
    let tilt = RigidMotion::rotation(DVec3::Y, 0.4e-3, DVec3::ZERO).expect("a rotation");
    let still = (&surface, &plane, &camera);
    let lit_near = (&surface, &near, &camera);
    let aside = surface.moved(&by(0.2e-3, -0.1e-3));
    let cases = [
        // With collimated light, the speckle moves as the surface does.
        (
            still,
            (&aside, &plane, &camera),
            DVec2::new(0.2e-3, -0.1e-3),
        ),
        // With a source as near as the pupil, twice as far.
        (
            lit_near,
            (&aside, &near, &camera),
            DVec2::new(0.4e-3, -0.2e-3),
        ),
        // A moving source alone moves it the other way.
        (
            lit_near,
            (&surface, &near.moved(&by(0.0, 0.2e-3)), &camera),
            DVec2::new(0.0, -0.2e-3),
        ),
        // A tilted surface throws it like a mirror, by twice the angle.
        (
            still,
            (&surface.moved(&tilt), &plane, &camera),
            DVec2::new(2.0 * 0.4e-3 * DISTANCE, 0.0),
        ),
        // A camera that moves leaves it behind.
        (
            still,
            (&surface, &plane, &camera.moved(&by(0.2e-3, 0.1e-3))),
            DVec2::new(-0.2e-3, -0.1e-3),
        ),
    ];
    for (before, after, expected) in cases {
        let found = pupil_displacement(before, after);
        // These laws are of first order: relative errors of motion over distance, 0.2 mm / 0.3 m.
        assert!(
            (found - expected).length() < 2e-7,
            "{found}, not {expected}"
        );
    }
}

#[test]
fn the_image_of_a_surface_moves_with_it() {
    let window = window(3e-6, 128);
    let surface = surface(&patch(1.4e-3, 60, 4));
    let motion = RigidMotion::translation(DVec3::new(60e-6, -30e-6, 0.0)).expect("a translation");
    let [before, after] = [&surface, &surface.moved(&motion)]
        .map(|surface| window.image(&surface.lit_by(&collimated())).intensity());
    let shift = displacement_between(&before, &after).expect("a maximum");
    let expected = DVec2::new(60e-6, -30e-6) * MAGNIFICATION / 3e-6;
    // The speckle on the lens moves by 67 µm of 5 mm, which leaves a correlation of ρ = 0.98. Of K
    // = 1000 speckles of h = 2.6 samples, the displacement scatters by √(1 − ρ²) / (ρ k √K) = 0.01
    // with the rms wave number k = π/(2h). Four of them, for the length of two components.
    assert!(
        (shift.offset - expected).length() < 0.04,
        "{shift:?}, not {expected}"
    );
}

/// Scatterers along a side of the patch for [`squared_contrast`].
const SCATTERERS: usize = 18;

/// Squared contrast of the image over many surfaces of a patch that is 12 h wide.
fn squared_contrast(arrangement: Arrangement, amplitudes: Amplitudes) -> f64 {
    const SURFACES: u64 = 500;
    // The patch fills the picture.
    let window = window(0.75 * SPECKLE, 16);
    let side = 12.0 * SPECKLE / MAGNIFICATION;
    let (mut count, mut mean, mut square) = (0.0, 0.0, 0.0);
    for seed in 0..SURFACES {
        let surface = surface(&PatchDescription {
            arrangement,
            roughness: Roughness::FullyDeveloped(amplitudes),
            ..patch(side, SCATTERERS, seed)
        });
        let image = window.image(&surface.lit_by(&collimated()));
        // The middle, away from what the period brings in.
        for row in image.amplitude().rows().skip(4).take(8) {
            for intensity in row[4..12].iter().map(|u| u.norm_sqr()) {
                count += 1.0;
                mean += intensity;
                square += intensity * intensity;
            }
        }
    }
    square * count / (mean * mean) - 1.0
}

/// `(∫|h|²)² / ∫|h|⁴` of the image h of a point, in m² on the sensor.
fn area_of_point_image() -> f64 {
    // |h|⁴ holds frequencies up to 2/h, so that samples h/4 apart sum it exactly.
    let step = SPECKLE / 4.0;
    let window = window(step, 256);
    let point = Scatterer {
        position: DVec3::ZERO,
        amplitude: Complex::new(1.0, 0.0),
    };
    let surface = RoughSurface::from_scatterers(vec![point]).expect("a point");
    let image = window.image(&surface.lit_by(&collimated()));
    let [second, fourth] = [2, 4].map(|power| {
        let values = image.amplitude().values().iter();
        values.map(|u| u.norm().powi(power)).sum::<f64>() * step * step
    });
    second * second / fourth
}

#[test]
fn few_scatterers_in_a_resolution_cell_bias_the_contrast() {
    use Amplitudes::{ComplexGaussian, Unit};
    let density = (SCATTERERS as f64 / (12.0 * SPECKLE)).powi(2);
    let effective = density * area_of_point_image();
    assert!(effective > 3.0 && effective < 8.0, "N = {effective}");
    for (arrangement, amplitudes, bias) in [
        (Arrangement::Lattice, ComplexGaussian, 0.0),
        (Arrangement::Lattice, Unit, -1.0),
        (Arrangement::Random, Unit, 1.0),
        (Arrangement::Random, ComplexGaussian, 2.0),
    ] {
        let found = squared_contrast(arrangement, amplitudes);
        let expected = 1.0 + bias / effective;
        // 500 surfaces with 28 speckles each: √(8/14 000) = 0.024, four of them.
        assert_absolute(found, expected, 0.096);
    }
}
