use tem00_testkit::assert_absolute;

use super::*;
use crate::{Amplitudes, Arrangement, PatchDescription, Roughness, Scatterer};

const WAVELENGTH: f64 = 650e-9;

fn points(positions: &[DVec3]) -> RoughSurface {
    let scatterer = |&position: &DVec3| Scatterer {
        position,
        amplitude: Complex::new(1.0, 0.0),
    };
    RoughSurface::from_scatterers(positions.iter().map(scatterer).collect()).expect("points")
}

fn plane_wave() -> Illumination {
    Illumination::plane(WAVELENGTH, DVec3::NEG_Z).expect("a plane wave")
}

fn patch(scatterers: usize, amplitudes: Amplitudes, seed: u64) -> RoughSurface {
    RoughSurface::patch(&PatchDescription {
        centre: DVec3::ZERO,
        normal: DVec3::Z,
        along: DVec3::X,
        size: [1e-3, 1e-3],
        scatterers: [scatterers, 1],
        arrangement: Arrangement::Stratified,
        roughness: Roughness::FullyDeveloped(amplitudes),
        seed,
    })
    .expect("a patch")
}

#[test]
fn two_points_make_fringes_where_their_paths_differ_by_whole_wavelengths() {
    let slits = [DVec3::X * -0.1e-3, DVec3::X * 0.1e-3];
    let lit = points(&slits).lit_by(&plane_wave());
    for i in 0..500_u32 {
        let p = DVec3::new(f64::from(i) * 13e-6 - 3e-3, 1e-3, 0.3);
        let [r1, r2] = slits.map(|slit| slit.distance(p));
        let phase = core::f64::consts::TAU * (r1 - r2) / WAVELENGTH;
        let expected = 1.0 / (r1 * r1) + 1.0 / (r2 * r2) + 2.0 * phase.cos() / (r1 * r2);
        let intensity = lit.field_at(p).norm_sqr();
        // The phase is rounded to 2π · 4.6e5 · 2⁻⁵² = 6e−10 for each path.
        assert_absolute(intensity, expected, 4.0 * 2e-9 / (0.3 * 0.3));
    }
}

#[test]
fn source_and_receiver_may_be_exchanged() {
    let surface = patch(500, Amplitudes::ComplexGaussian, 3);
    let (a, b) = (DVec3::new(0.1, -0.05, 0.4), DVec3::new(-0.2, 0.1, 0.25));
    let through = |source: DVec3, receiver: DVec3| {
        let light = Illumination::point(WAVELENGTH, source).expect("a point source");
        surface.lit_by(&light).field_at(receiver)
    };
    let (there, back) = (through(a, b), through(b, a));
    // Two phases of 1e−9 rad and the series (7e−12) for each of 500 terms.
    assert!(
        (there - back).norm() < 1e-8 * there.norm(),
        "{there} {back}"
    );
}

#[test]
fn a_plane_holds_the_field_at_its_points() {
    let lit = patch(50, Amplitudes::ComplexGaussian, 1).lit_by(&plane_wave());
    let steps = [DVec3::new(1e-3, 0.0, 2e-4), DVec3::Y * 2e-3];
    let plane = SamplePlane::new(DVec3::Z, steps, [6, 5])
        .and_then(|plane| plane.within(4.1e-3))
        .expect("a plane");
    let field = lit.field_on(&plane);
    for y in 0..5 {
        for x in 0..6 {
            let inside = plane.point(x, y).distance(DVec3::Z) <= 4.1e-3;
            let expected = if inside {
                lit.field_at(plane.point(x, y))
            } else {
                Complex::default()
            };
            assert_eq!(field.amplitude()[(x, y)], expected, "({x}, {y})");
        }
    }
}

#[test]
fn the_field_is_finite_everywhere() {
    let surface = points(&[DVec3::ZERO, DVec3::splat(1e4), DVec3::new(0.0, 1e-12, 0.0)]);
    for light in [
        plane_wave(),
        Illumination::point(1e-10, DVec3::ZERO).expect("a point source"),
    ] {
        let lit = surface.lit_by(&light);
        for point in [
            DVec3::ZERO,
            DVec3::splat(1e-300),
            DVec3::splat(1e30),
            DVec3::new(-1e300, 1.0, 0.0),
        ] {
            assert!(lit.field_at(point).is_finite(), "at {point}");
        }
    }
}
