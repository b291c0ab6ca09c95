use super::*;

#[test]
fn a_sheet_one_nanometre_above_half_a_metre_of_floor_hides_the_light() {
    let floor = rectangle(0.5 * DVec3::ONE, 0.5 * DVec3::X, 0.5 * DVec3::Y);
    let sheet = translated(&floor, 1e-9 * DVec3::Z);
    let light = DVec3::new(0.5, 0.5, 1.0);
    let (open, covered) = (build(std::slice::from_ref(&floor)), build(&[floor, sheet]));
    for x in [0.1, 0.5, 0.9] {
        let point = DVec3::new(x, 0.3, 0.5);
        let above = point + 1e-9 * DVec3::Z;
        for (scene, from, normal, to, visible, case) in [
            (&open, point, DVec3::Z, light, true, "open"),
            (&open, point, -DVec3::Z, light, true, "open, normal down"),
            (&open, light, DVec3::Z, point, true, "open, from the light"),
            (&covered, point, DVec3::Z, light, false, "covered"),
            (
                &covered,
                light,
                DVec3::Z,
                point,
                false,
                "covered, from the light",
            ),
            (&covered, above, DVec3::Z, light, true, "on the sheet"),
            (
                &covered,
                above,
                DVec3::Z,
                light.with_z(0.0),
                false,
                "under it",
            ),
        ] {
            assert_eq!(scene.visible(from, normal, to), visible, "{case} at {x}");
        }
    }
}

#[test]
fn a_light_does_not_hide_itself_but_what_is_before_it_does() {
    let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
    let half_u = DVec3::new(0.1, 0.0, 0.05);
    let light = Rectangle::new(DVec3::new(0.3, 0.1, 0.8), half_u, -0.1 * DVec3::Y).unwrap();
    let post = sphere(DVec3::new(0.15, 0.05, 0.4), 0.001);
    let open = build(&[floor.clone(), Shape::Rectangle(light)]);
    let blocked = build(&[floor, Shape::Rectangle(light), post]);
    let mut numbers = Numbers::new(3);
    for _ in 0..500 {
        let on_light = light.point(numbers.unit(), numbers.unit());
        let on_floor = DVec3::new(numbers.unit() - 0.5, numbers.unit() - 0.5, 0.0);
        assert!(
            open.visible(on_floor, DVec3::Z, on_light),
            "{on_floor} to {on_light}"
        );
    }
    let sees_light = |x: f64| blocked.visible(x * DVec3::X, DVec3::Z, light.centre());
    assert_eq!(
        [0.0, 0.1].map(sees_light),
        [false, true],
        "behind the post, beside it"
    );
}

#[test]
fn a_point_sees_itself_and_what_is_outside_the_scene() {
    let floor = build(&[rectangle(DVec3::ZERO, DVec3::X, DVec3::Y)]);
    for (from, to, visible) in [(0.0, 0.0, true), (0.0, 1e6, true), (1e3, -1.0, false)] {
        let told = floor.visible(from * DVec3::Z, DVec3::Z, to * DVec3::Z);
        assert_eq!(told, visible, "from {from} m to {to} m");
    }
}

#[test]
fn a_hit_hides_what_lies_beyond_its_surface_and_not_what_lies_on_it() {
    let plate = Rectangle::new(DVec3::new(0.1, 0.2, 0.3), 0.1 * DVec3::X, 0.1 * DVec3::Y).unwrap();
    let intersector = Intersector::build(&[Shape::Rectangle(plate)]).unwrap();
    for slope in [0.0, 1.0, 30.0] {
        let direction = DVec3::new(slope, 0.0, -1.0).normalize();
        let point = plate.centre() + 0.03 * DVec3::Y;
        let origin = point - 0.7 * direction;
        let ray = Ray { origin, direction };
        let hit = intersector.intersect(&ray).unwrap();
        // Computed distances err by a few 1e−16 divided by the cosine.
        for (beyond, hidden) in [(-2e-15, false), (2e-15, false), (1e-11, true)] {
            let told = intersector.hides(&hit, &ray, 0.7 + beyond);
            assert_eq!(told, hidden, "{beyond} beyond at slope {slope}");
        }
    }
}
