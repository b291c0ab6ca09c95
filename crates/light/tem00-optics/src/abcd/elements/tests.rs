use core::f64::consts::PI;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::abcd::tests::{assert_same, lens, mirror, space};

#[test]
fn a_thin_lens_is_the_limit_of_a_thick_one() {
    let thick = |thickness| {
        AbcdMatrix::thick_lens(&ThickLens {
            index: 1.5,
            front_curvature: 12.0,
            back_curvature: -8.0,
            thickness,
        })
        .unwrap()
    };
    // The lensmaker's equation: 1/f = (n − 1)(c₁ − c₂) = 10 m⁻¹.
    assert_same(&thick(0.0), &lens(0.1), 1e-14);
    // With a thickness t, 1/f falls by (n − 1)² t c₁ c₂ / n and the ray moves by t/n at slope 1.
    for thickness in [1e-6, 1e-3] {
        let focal_length = thick(thickness).focal_length().unwrap();
        let power = 10.0 + 0.25 * thickness * 12.0 * -8.0 / 1.5;
        assert!((focal_length * power - 1.0).abs() < 1e-14, "{focal_length}");
        assert!((thick(thickness).b() - thickness / 1.5).abs() < 1e-18, "B");
    }
}

#[test]
fn a_plate_is_a_path_of_the_reduced_thickness() {
    let glass = AbcdMatrix::flat_interface(1.0, 1.5).unwrap();
    let air = AbcdMatrix::flat_interface(1.5, 1.0).unwrap();
    let plate = glass.then(space(9e-3)).then(air);
    assert_same(&plate, &space(6e-3), 2e-16);
    assert!((plate.determinant() - 1.0).abs() < 2e-16, "{plate:?}");
}

#[test]
fn a_ball_lens_has_its_textbook_focal_length() {
    let diameter = 3e-3;
    for n in [1.33, 1.517, 1.77, 2.0] {
        let ball = AbcdMatrix::thick_lens(&ThickLens {
            index: n,
            front_curvature: 2.0 / diameter,
            back_curvature: -2.0 / diameter,
            thickness: diameter,
        })
        .unwrap();
        let expected = n * diameter / (4.0 * (n - 1.0));
        assert_relative(ball.focal_length().unwrap(), expected, 1e-14);
        // Both principal planes are at the centre.
        let back = ball.back_principal_plane().unwrap();
        assert!((back + 0.5 * diameter).abs() < 1e-17, "n = {n}: {back}");
        assert_absolute(ball.front_principal_plane().unwrap(), 0.5 * diameter, 1e-17);
    }
}

#[test]
fn mirrors_focus_at_half_their_radius() {
    assert_same(&mirror(4.0), &lens(0.125), 0.0);
    assert_same(&mirror(-4.0), &lens(-0.125), 0.0);
    let angle = 0.7_f64;
    let [tangential, sagittal] = AbcdMatrix::tilted_mirror(4.0, angle).unwrap();
    assert_same(&tangential, &lens(0.125 * angle.cos()), 4e-15);
    assert_same(&sagittal, &lens(0.125 / angle.cos()), 4e-15);
    let [tangential, sagittal] = AbcdMatrix::tilted_mirror(4.0, 0.0).unwrap();
    assert_same(&tangential, &sagittal, 0.0);
}

#[test]
fn a_tilted_mirror_focuses_rays_as_reflection_says() {
    // Exact reflection off a sphere of radius R, in the plane of incidence and across it: the
    // reflected rays of two close parallel ones meet the chief ray at f.
    let (curvature, angle) = (2.0, 0.5_f64);
    let [tangential, sagittal] = AbcdMatrix::tilted_mirror(curvature, angle).unwrap();
    let incident = tem00_beam::DVec3::new(angle.sin(), 0.0, angle.cos());
    let reflect = |n: tem00_beam::DVec3| incident - 2.0 * incident.dot(n) * n;
    let chief = reflect(tem00_beam::DVec3::NEG_Z);
    let h = 1e-5;
    // A surface point x = h / cos φ in the plane of incidence belongs to a ray at height h.
    for (element, height, point) in [
        (
            tangential,
            h,
            tem00_beam::DVec3::new(h / angle.cos(), 0.0, 0.0),
        ),
        (sagittal, h, tem00_beam::DVec3::new(0.0, h, 0.0)),
    ] {
        let normal = (tem00_beam::DVec3::NEG_Z - curvature * point).normalize();
        let slope = (reflect(normal) - chief).length();
        let expected = -element.transform_ray([height, 0.0])[1];
        // The chord of a rotation by 2 h/R differs from its arc by (h/R)², the sphere's sag from
        // its parabola by as much, its third order by h tan φ / R.
        assert!((slope / expected - 1.0).abs() < 1e-4, "{slope}, {expected}");
    }
}

#[test]
fn a_graded_rod_images_at_its_quarter_and_half_pitch() {
    let (n, g) = (1.6, 250.0);
    let quarter = AbcdMatrix::grin_rod(n, g, FRAC_PI_2 / g).unwrap();
    // Parallel rays meet in one point, and rays from one point become parallel.
    assert!(
        quarter.a().abs() < 1e-15 && quarter.d().abs() < 1e-15,
        "{quarter:?}"
    );
    let focal_length = quarter.focal_length().unwrap();
    assert!((focal_length * n * g - 1.0).abs() < 1e-15, "{quarter:?}");

    let half = AbcdMatrix::grin_rod(n, g, PI / g).unwrap();
    assert!(
        half.b().abs() < 1e-18 && (half.a() + 1.0).abs() < 1e-15,
        "{half:?}"
    );
    assert_same(&quarter.then(quarter), &half, 1e-13);

    let inside = AbcdMatrix::flat_interface(1.0, n)
        .unwrap()
        .then(AbcdMatrix::grin(g, 3e-3).unwrap())
        .then(AbcdMatrix::flat_interface(n, 1.0).unwrap());
    assert_same(&inside, &AbcdMatrix::grin_rod(n, g, 3e-3).unwrap(), 1e-13);
}

#[test]
fn a_graded_medium_without_gradient_is_free_space() {
    for gradient in [0.0, 1e-200, f64::MIN_POSITIVE, 1e-10] {
        let medium = AbcdMatrix::grin(gradient, 0.4).unwrap();
        assert_same(&medium, &space(0.4), 1e-16);
    }
}
