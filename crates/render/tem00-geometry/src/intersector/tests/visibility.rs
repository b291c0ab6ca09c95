use super::*;

#[test]
fn a_sheet_one_nanometre_above_half_a_metre_of_floor_hides_the_light() {
    let floor = rectangle(0.5 * DVec3::ONE, 0.5 * DVec3::X, 0.5 * DVec3::Y);
    let sheet = floor.translated(1e-9 * DVec3::Z);
    let light = DVec3::new(0.5, 0.5, 1.0);
    let (open, covered) = (build(std::slice::from_ref(&floor)), build(&[floor, sheet]));
    for x in [0.1, 0.5, 0.9] {
        let point = DVec3::new(x, 0.3, 0.5);
        assert!(open.visible(point, DVec3::Z, light), "open at {x}");
        assert!(
            open.visible(point, -DVec3::Z, light),
            "open, normal down, at {x}"
        );
        assert!(!covered.visible(point, DVec3::Z, light), "covered at {x}");
        assert!(
            !covered.visible(light, DVec3::Z, point),
            "covered at {x}, seen from the light"
        );
        assert!(open.visible(light, DVec3::Z, point), "open, from there");
        let above = point + 1e-9 * DVec3::Z;
        assert!(
            covered.visible(above, DVec3::Z, light),
            "on the sheet at {x}"
        );
        assert!(
            !covered.visible(above, DVec3::Z, light.with_z(0.0)),
            "under it at {x}"
        );
    }
}

#[test]
fn a_light_does_not_hide_itself_but_what_is_before_it_does() {
    let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
    let light = Rectangle::new(
        DVec3::new(0.3, 0.1, 0.8),
        DVec3::new(0.1, 0.0, 0.05),
        DVec3::new(0.0, -0.1, 0.0),
    )
    .unwrap();
    let post = sphere(DVec3::new(0.15, 0.05, 0.4), 0.001);
    let open = build(&[floor.clone(), Shape::Rectangle(light)]);
    let blocked = build(&[floor, Shape::Rectangle(light), post]);
    let mut uniform = uniforms(3);
    for _ in 0..500 {
        let on_light = light.point(uniform(), uniform());
        let on_floor = DVec3::new(uniform() - 0.5, uniform() - 0.5, 0.0);
        assert!(
            open.visible(on_floor, DVec3::Z, on_light),
            "{on_floor} to {on_light}"
        );
    }
    assert!(
        !blocked.visible(DVec3::ZERO, DVec3::Z, light.centre()),
        "the post is in the middle"
    );
    assert!(
        blocked.visible(0.1 * DVec3::X, DVec3::Z, light.centre()),
        "beside the post"
    );
}

#[test]
fn a_point_sees_itself_and_what_is_outside_the_scene() {
    let floor = build(&[rectangle(DVec3::ZERO, DVec3::X, DVec3::Y)]);
    assert!(floor.visible(DVec3::ZERO, DVec3::Z, DVec3::ZERO), "itself");
    assert!(
        floor.visible(DVec3::ZERO, DVec3::Z, 1e6 * DVec3::Z),
        "far away"
    );
    let below = DVec3::new(0.0, 0.0, -1.0);
    assert!(
        !floor.visible(1e3 * DVec3::Z, DVec3::Z, below),
        "through the floor"
    );
}

#[test]
fn a_hit_hides_what_lies_beyond_its_surface_and_not_what_lies_on_it() {
    let plate = Rectangle::new(DVec3::new(0.1, 0.2, 0.3), 0.1 * DVec3::X, 0.1 * DVec3::Y).unwrap();
    let intersector = Intersector::build(&[Shape::Rectangle(plate)]).unwrap();
    for slope in [0.0, 1.0, 30.0] {
        let direction = DVec3::new(slope, 0.0, -1.0).normalize();
        let point = plate.centre() + 0.03 * DVec3::Y;
        let ray = Ray {
            origin: point - 0.7 * direction,
            direction,
        };
        let hit = intersector.intersect(&ray).unwrap();
        // Computed distances err by a few 1e−16 divided by the cosine.
        for (distance, hidden) in [
            (0.7 - 2e-15, false),
            (0.7 + 2e-15, false),
            (0.7 + 1e-11, true),
        ] {
            let told = intersector.hides(&hit, &ray, distance);
            assert_eq!(told, hidden, "{distance} at slope {slope}");
        }
    }
}
