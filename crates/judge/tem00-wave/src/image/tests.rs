use core::f64::consts::PI;

use proptest::prelude::*;
use tem00_numerics::jinc;
use tem00_testkit::{assert_absolute, refuses};

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

#[test]
fn a_point_in_focus_is_an_airy_pattern() {
    let window = ImageWindow::new(&camera(), &sampling(512)).expect("a window");
    let image = window.image(&points(&[DVec3::new(0.0, 0.0, -0.3)]));
    let peak = image.amplitude()[(256, 256)];
    // exp(ik · 0) from the removed sphere over the distance; 0.3 m is not a whole number of
    // wavelengths.
    assert!((peak.norm() * 0.3 - 1.0).abs() < 1e-4, "{peak}");
    for x in 256..300_usize {
        for y in [256, 256 + (x - 256) / 2] {
            let radius = ((x - 256) as f64).hypot((y - 256) as f64) / 4.0;
            let airy = jinc(PI * radius);
            let error = (image.amplitude()[(x, y)] / peak - airy).norm();
            // The fraction of a rim cell inside the pupil has an error of about 0.1; there are 400
            // of them among 12 900 cells: 0.1 √400 / 12 900 = 1.6e−4, and twice that.
            assert!(error < 3.2e-4, "{error:e} at {radius} h");
        }
    }
}

/// `Σ w U exp(−ik |p − X|) / Σ w` over a square lattice of the pupil: the perfect image of `X`.
fn image_of_point(lit: &LitSurface, focus_point: DVec3) -> Complex<f64> {
    const ACROSS: i32 = 160;
    let step = LENS.pupil_diameter / f64::from(ACROSS);
    let (mut sum, mut weights) = (Complex::new(0.0, 0.0), 0.0);
    for y in -ACROSS / 2 - 1..=ACROSS / 2 + 1 {
        for x in -ACROSS / 2 - 1..=ACROSS / 2 + 1 {
            let p = DVec3::new(f64::from(x) * step, f64::from(y) * step, 0.0);
            let weight = ((0.5 * LENS.pupil_diameter - p.length()) / step + 0.5).clamp(0.0, 1.0);
            if weight > 0.0 {
                let lens = phasor(-p.distance(focus_point) / WAVELENGTH);
                sum += weight * lens * lit.field_at(p);
                weights += weight;
            }
        }
    }
    sum / weights
}

#[test]
fn a_window_off_the_axis_is_the_perfect_image_of_every_point() {
    let camera = camera();
    for centre in [
        DVec2::ZERO,
        DVec2::new(0.024, -0.012),
        DVec2::new(-0.05, 0.03),
    ] {
        let sampling = ImageSampling {
            centre,
            // Off the axis a point's image is up to (1 + τ²)^1.5 = 2.5 times as large.
            step: SPECKLE / 3.0,
            ..sampling(96)
        };
        let window = ImageWindow::new(&camera, &sampling).expect("a window");
        let step = sampling.step;
        let sources = [[0.0, 0.0], [11.3, -4.6], [-9.1, -7.7]]
            .map(|at| camera.focus_point(centre + DVec2::from_array(at) * step));
        let lit = points(&sources);
        let image = window.image(&lit);
        let largest = largest_magnitude(image.amplitude().values());
        for (x, y) in [
            (48, 48),
            (59, 43),
            (60, 44),
            (39, 40),
            (50, 46),
            (45, 52),
            (66, 48),
        ] {
            let at = DVec2::new(x as f64 - 48.0, y as f64 - 48.0) * step;
            let expected = image_of_point(&lit, camera.focus_point(centre + at)).norm();
            let found = image.amplitude()[(x, y)].norm();
            // Two lattices differ at the rim of the pupil, here of 32 samples: 100 cells of 800,
            // each with an error of 0.1, give 1.2e−3 for each point.
            let tolerance = 3e-3;
            assert_absolute(found, expected, tolerance * largest);
        }
    }
}

#[test]
fn a_point_out_of_focus_fades_as_the_pupil_integral_says() {
    let window = ImageWindow::new(&camera(), &sampling(512)).expect("a window");
    let edge = 0.5 * LENS.pupil_diameter;
    for i in -8..=8 {
        // The waves differ by i/4 wavelengths at the edge of the pupil, four for the first zero of
        // the sinc. To first order that is 8 λ (L/D)² along the axis.
        let turns = f64::from(i) / 4.0;
        let depth = 1.0 / (1.0 / 0.3 + turns * 2.0 * WAVELENGTH / (edge * edge));
        let image = window.image(&points(&[DVec3::new(0.0, 0.0, -depth)]));
        let found = image.amplitude()[(256, 256)].norm();
        // Simpson's rule over the area of the pupil, with exact distances.
        const INTERVALS: u32 = 400;
        let integrand = |j: u32| {
            let p2 = edge * edge * f64::from(j) / f64::from(INTERVALS);
            let (r, lens) = ((p2 + depth * depth).sqrt(), (p2 + 0.09).sqrt());
            phasor((r - lens) / WAVELENGTH) / r
        };
        let simpson = (0..=INTERVALS).map(|j| match j {
            0 | INTERVALS => integrand(j),
            j if j % 2 == 1 => integrand(j) * 4.0,
            _ => integrand(j) * 2.0,
        });
        let expected = simpson.sum::<Complex<f64>>().norm() / (3.0 * f64::from(INTERVALS));
        // The rim of the lattice pupil, as for the Airy pattern, whose cells now hold up to 0.4
        // rad.
        assert_absolute(found, expected, 1e-3 / depth);
        // The law for a path that is linear in the area; the next term, (p/L)⁴ L/8 = 2e−4
        // wavelengths at the edge, is smaller still.
        let sinc = if i == 0 {
            1.0
        } else {
            (PI * turns).sin() / (PI * turns)
        };
        assert_absolute(found * depth, sinc.abs(), 2e-3);
    }
}

#[test]
#[should_panic(expected = "field and pupil differ in their samples")]
fn a_field_from_elsewhere_does_not_fit() {
    let window = ImageWindow::new(&camera(), &sampling(64)).expect("a window");
    let field = Field::new(Grid::filled(3, 3, Complex::new(1.0, 0.0)));
    let _ = window.image_through(&field);
}

#[test]
fn constructors_name_what_they_reject() {
    refuses!(sampling = sampling(64) => ImageWindow::new(&camera(), &sampling);
        sampling.wavelength: [0.0],
        sampling.centre: [DVec2::NAN, DVec2::X * 0.7],
        sampling.step: [1.1 * SPECKLE, 1e-30, f64::NAN],
        sampling.samples: [1, 1 << 14],
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_window_is_rejected_or_has_a_finite_image(
        wavelength in -10..1_i32, step in -12..5_i32, diameter in -12..5_i32, focus in -12..5_i32,
        image in -12..5_i32, off in 0.0..10.0_f64, samples in 2..40_usize
    ) {
        let power = |exponent: i32| 10.0_f64.powi(exponent);
        let lens = Lens {
            pupil_diameter: power(diameter),
            focus_distance: power(focus),
            pupil_to_image: power(image),
        };
        let camera = Camera::new(DVec3::ZERO, DMat3::IDENTITY, lens).expect("a camera");
        let sampling = ImageSampling {
            wavelength: power(wavelength),
            centre: DVec2::new(0.6, 0.8) * off * power(image),
            step: power(step),
            samples,
        };
        if let Ok(window) = ImageWindow::new(&camera, &sampling) {
            let image = window.image(&points(&[DVec3::new(1e-5, 0.0, -0.3), DVec3::Z]));
            prop_assert!(
                image.amplitude().values().iter().all(|u| u.is_finite()),
                "{:?}",
                sampling
            );
        }
    }
}
