use core::f64::consts::FRAC_PI_2;

use super::*;

/// The largest entry of the difference of two systems.
fn distance(one: &AstigmaticSystem, other: &AstigmaticSystem) -> f64 {
    let pairs = one.blocks().into_iter().flatten();
    pairs
        .zip(other.blocks().into_iter().flatten())
        .map(|(p, q)| largest((p - q).abs()))
        .fold(0.0, f64::max)
}

fn system() -> AstigmaticSystem {
    AstigmaticSystem::cylinder_lens(0.1, 0.3)
        .unwrap()
        .then(AstigmaticSystem::free_space(0.25).unwrap())
        .then(AstigmaticSystem::thin_lens(-0.4).unwrap())
        .then(AstigmaticSystem::image_rotation(1.1).unwrap())
}

#[test]
fn crossed_cylinder_lenses_are_one_lens() {
    let crossed = AstigmaticSystem::cylinder_lens(0.2, 0.7)
        .unwrap()
        .then(AstigmaticSystem::cylinder_lens(0.2, 0.7 + FRAC_PI_2).unwrap());
    let lens = AstigmaticSystem::thin_lens(0.2).unwrap();
    // Powers of 5 m⁻¹, a few roundings.
    assert!(distance(&crossed, &lens) < 5e-15, "{crossed:?}");
}

#[test]
fn a_cylinder_lens_bends_along_its_direction_only() {
    for (rotation, along) in [(0.0, DVec2::X), (FRAC_PI_2, DVec2::Y)] {
        let lens = AstigmaticSystem::cylinder_lens(0.5, rotation).unwrap();
        let [position, slope] = lens.transform_ray([DVec2::ONE, DVec2::ZERO]);
        assert_eq!(position, DVec2::ONE, "a thin lens moves no ray");
        let want = along * -2.0;
        assert!((slope - want).length() < 1e-15, "{rotation}: {slope}");
    }
}

#[test]
fn rays_pass_one_system_after_the_other() {
    let (first, path) = (system(), AstigmaticSystem::free_space(0.3).unwrap());
    let second = path
        .then(AstigmaticSystem::cylinder_lens(0.7, -0.4).unwrap())
        .then(first);
    let ray = [DVec2::new(1e-3, -2e-3), DVec2::new(-5e-3, 1e-3)];
    let at_once = first.then(second).transform_ray(ray);
    let in_turn = second.transform_ray(first.transform_ray(ray));
    for (one, other) in at_once.into_iter().zip(in_turn) {
        // Entries of about 10, a few dozen roundings.
        assert!((one - other).length() < 1e-15, "{one}, {other}");
    }
    // Written out for a distance: x + 0.3 s.
    let [position, slope] = path.transform_ray(ray);
    let want = DVec2::new(-0.5e-3, -1.7e-3);
    assert!((position - want).length() < 1e-18, "{position}");
    assert_eq!(slope, ray[1], "free space bends no ray");
}

#[test]
fn a_system_of_two_axes_acts_along_each() {
    let x = AbcdMatrix::new(0.5, 0.2, -2.0, 1.0).unwrap();
    let y = AbcdMatrix::new(1.0, 0.3, 1.0, 1.2).unwrap();
    let system = AstigmaticSystem::from_axes([x, y], 0.4).unwrap();
    assert!((system.index_ratio() - 0.9).abs() < 1e-15, "{system:?}");
    assert!(AstigmaticSystem::new(system.blocks()).is_ok(), "{system:?}");
    for (matrix, angle) in [(x, 0.4), (y, 0.4 + FRAC_PI_2)] {
        let along = DVec2::from_angle(angle);
        let [position, slope] = system.transform_ray([1e-3 * along, 2e-3 * along]);
        let [height, tilt] = matrix.transform_ray([1e-3, 2e-3]);
        assert!((position - height * along).length() < 1e-17, "{position}");
        assert!((slope - tilt * along).length() < 1e-17, "{slope}");
    }
    let lens = AbcdMatrix::thin_lens(0.2).unwrap();
    let straight = AbcdMatrix::identity();
    let cylinder = AstigmaticSystem::from_axes([lens, straight], 0.3).unwrap();
    let same = AstigmaticSystem::cylinder_lens(0.2, 0.3).unwrap();
    assert!(distance(&cylinder, &same) < 5e-15, "{cylinder:?}");
    let glass = AstigmaticSystem::from_axes([x, lens], 0.3);
    assert!(
        matches!(glass, Err(e) if e.parameter() == "determinant"),
        "{glass:?}"
    );
    let turned = AstigmaticSystem::from_axes([x, y], f64::NAN);
    assert!(
        matches!(turned, Err(e) if e.parameter() == "rotation"),
        "{turned:?}"
    );
}

#[test]
fn image_rotation_turns_from_x_to_y() {
    let turn = AstigmaticSystem::image_rotation(FRAC_PI_2).unwrap();
    let [position, slope] = turn.transform_ray([DVec2::X, DVec2::Y]);
    assert!((position - DVec2::Y).length() < 1e-15, "{position}");
    assert!((slope + DVec2::X).length() < 1e-15, "{slope}");
}

#[test]
fn entries_make_the_system_they_came_from() {
    let again = AstigmaticSystem::new(system().blocks()).unwrap();
    assert!(distance(&again, &system()) < 1e-300, "{again:?}");
    assert!((again.index_ratio() - 1.0).abs() < 1e-13, "{again:?}");
    let one = DMat2::IDENTITY;
    let glass = AstigmaticSystem::new([[one, DMat2::ZERO], [DMat2::ZERO, one / 1.5]]).unwrap();
    assert!((glass.index_ratio() - 1.0 / 1.5).abs() < 1e-15, "{glass:?}");
    let back = glass.then(system());
    assert!((back.index_ratio() - 1.0 / 1.5).abs() < 1e-15, "{back:?}");
}

#[test]
fn matrices_of_no_system_are_rejected() {
    let [[a, b], [c, d]] = system().blocks();
    let off = DMat2::from_cols_array(&[0.0, 1e-3, 0.0, 0.0]);
    let one = DMat2::IDENTITY;
    let skewed = DMat2::from_cols_array(&[0.0, 1.0, -1.0, 0.0]);
    let nan = AstigmaticSystem::new([[a, b], [DMat2::NAN, d]]);
    assert!(
        matches!(nan, Err(e) if e.parameter() == "matrix"),
        "{nan:?}"
    );
    for blocks in [
        [[a + off, b], [c, d]],
        [[a, b + off], [c, d]],
        [[a, b], [c + off, d]],
        [[a, b], [c, d + off]],
        [[a, b], [c, -d]],
        [[a * 1e200, b], [c, d * 1e200]],
        [[one * 1e200, skewed * 1e200], [DMat2::ZERO, one * 1e-200]],
        [[DMat2::ZERO; 2]; 2],
    ] {
        let result = AstigmaticSystem::new(blocks);
        assert!(
            matches!(result, Err(e) if e.parameter() == "matrix"),
            "{blocks:?}: {result:?}"
        );
    }
    // Symmetric products alone do not do, nor does one symmetric product.
    let stretch = DMat2::from_diagonal(DVec2::new(2.0, 1.0));
    for blocks in [
        [[stretch, DMat2::ZERO], [DMat2::ZERO, one]],
        [[one, skewed], [DMat2::ZERO, one]],
        [[one, DMat2::ZERO], [skewed, one]],
    ] {
        let result = AstigmaticSystem::new(blocks);
        assert!(result.is_err(), "{blocks:?}");
    }
}

#[test]
fn impossible_elements_are_rejected() {
    for bad in [f64::NAN, f64::INFINITY, 1e31] {
        let result = AstigmaticSystem::free_space(bad);
        assert!(
            matches!(result, Err(e) if e.parameter() == "length"),
            "{bad}"
        );
    }
    for bad in [f64::NAN, f64::INFINITY, 0.0, 1e-31] {
        for result in [
            AstigmaticSystem::thin_lens(bad),
            AstigmaticSystem::cylinder_lens(bad, 0.1),
        ] {
            assert!(
                matches!(result, Err(e) if e.parameter() == "focal_length"),
                "{bad}"
            );
        }
    }
    for result in [
        AstigmaticSystem::cylinder_lens(1.0, f64::NAN),
        AstigmaticSystem::image_rotation(f64::INFINITY),
    ] {
        assert!(
            matches!(result, Err(e) if e.parameter() == "rotation"),
            "{result:?}"
        );
    }
}
