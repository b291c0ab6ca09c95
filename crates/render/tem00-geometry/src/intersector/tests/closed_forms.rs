use super::*;

#[test]
fn a_plane_is_met_where_geometry_says() {
    // A wall at x = 0.5 m that faces back to the origin.
    let wall = rectangle(0.5 * DVec3::X, DVec3::Z, DVec3::Y);
    let wall = build(&[wall]);
    for tangent in [0.0, 0.3, 1.0, 1.9] {
        let ray = ray(DVec3::ZERO, DVec3::new(1.0, tangent, 0.0));
        let hit = wall.intersect(&ray).unwrap();
        let distance = 0.5 * 1.0_f64.hypot(tangent);
        // Ten roundings of numbers up to 1.1.
        assert_hit(&hit, distance, -DVec3::X, 1e-15);
        let position = DVec3::new(0.5, 0.5 * tangent, 0.0);
        assert!(hit.position.abs_diff_eq(position, 1e-15), "{hit:?}");
    }
    for (origin, toward, case) in [
        (
            DVec3::ZERO,
            DVec3::new(1.0, 2.1, 0.0),
            "beyond the edge at 1 m",
        ),
        (DVec3::ZERO, -DVec3::X, "behind"),
        (DVec3::new(0.5, -2.0, 0.0), DVec3::Y, "in the plane"),
    ] {
        assert_eq!(wall.intersect(&ray(origin, toward)), None, "{case}");
    }
}

#[test]
fn a_ball_is_met_where_geometry_says() {
    let ball = build(&[sphere(DVec3::new(0.0, 0.0, 0.5), 0.02)]);
    for miss in [0.0, 0.005, 0.019, 0.019_999_999] {
        let ray = ray(DVec3::new(miss, 0.0, 0.0), DVec3::Z);
        let hit = ball.intersect(&ray).unwrap();
        let half_chord = ((0.02 - miss) * (0.02 + miss)).sqrt();
        // The half chord c changes by Δmiss r/c for a rounding of the 0.5 m: c is 2e−5 m last.
        let tolerance = 1e-15 + 2e-16 * 0.02 / half_chord;
        assert_absolute(hit.distance, 0.5 - half_chord, tolerance);
        let normal = DVec3::new(miss, 0.0, -half_chord) / 0.02;
        // Relative to the radius, 1 / 0.02 times as much.
        assert!(
            hit.normal.abs_diff_eq(normal, 50.0 * tolerance),
            "miss = {miss}"
        );
    }
    let unit = build(&[sphere(DVec3::ZERO, 1.0)]);
    for (ball, origin, toward, case) in [
        (
            &ball,
            DVec3::new(0.020_000_001, 0.0, 0.0),
            DVec3::Z,
            "just beside",
        ),
        (&ball, DVec3::ZERO, -DVec3::Z, "behind"),
        (&unit, DVec3::X, DVec3::Y, "touching where it starts"),
    ] {
        assert_eq!(ball.intersect(&ray(origin, toward)), None, "{case}");
    }
}

#[test]
fn from_inside_the_far_side_of_a_ball_is_met_with_its_outward_normal() {
    let ball = build(&[sphere(DVec3::ONE, 0.1)]);
    for (distance, side) in [(0.04, DVec3::Z), (0.16, -DVec3::Z)] {
        let hit = ball
            .intersect(&ray(DVec3::new(1.0, 1.0, 1.06), side))
            .unwrap();
        assert_hit(&hit, distance, side, 1e-15);
    }
}

#[test]
fn triangle_normals_follow_the_order_of_corners_and_never_flip() {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mesh = Shape::from(TriangleMesh::new(vertices, vec![[0, 1, 2]]).unwrap());
    let mesh = build(&[mesh]);
    for side in [1.0, -1.0] {
        let ray = ray(DVec3::new(0.25, 0.5, side), -side * DVec3::Z);
        let hit = mesh.intersect(&ray).unwrap();
        assert_eq!(hit.normal, DVec3::Z, "seen from z = {side}");
        assert_absolute(hit.distance, 1.0, 1e-15);
        assert_eq!(hit.position, DVec3::new(0.25, 0.5, 0.0), "position");
    }
}

#[test]
fn grazing_rays_meet_a_mesh_to_a_nanometre_at_half_a_metre() {
    // A floor of two triangles, 1 m long, met 0.5 m away at 0.01°, 0.001° …
    let vertices = [(-1.0, -0.1), (1.0, -0.1), (1.0, 0.1), (-1.0, 0.1)];
    let vertices = vertices.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
    let floor = TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let floor = build(&[Shape::from(floor)]);
    for height in [0.1, 1e-4, 1e-6] {
        let target = DVec3::new(0.123, 0.03, 0.0);
        let origin = target + DVec3::new(-0.5, 0.0, height);
        let hit = floor.intersect(&ray(origin, target - origin)).unwrap();
        // The direction is rounded to 1e−16: 0.5 m · 1e−16 · 0.5 / height along the floor.
        let tolerance = 1e-15 + 2e-16 / height;
        assert!(tolerance < 1e-9, "the promise");
        assert!(hit.position.abs_diff_eq(target, tolerance), "{hit:?}");
        assert!(hit.position.z.abs() < 1e-16, "on the floor: {hit:?}");
    }
}

#[test]
fn near_hits_are_found_in_scenes_of_any_size() {
    // The same scene a million times smaller and larger; hits a thousandth of it away.
    for size in [1e-6, 1.0, 1e6] {
        let ball = build(&[
            sphere(DVec3::ZERO, size),
            sphere(3.0 * size * DVec3::X, size),
        ]);
        for gap in [0.5, 1e-3, 1e-6, 1e-9] {
            let ray = ray(size * (1.0 + gap) * DVec3::Z, -DVec3::Z);
            let hit = ball.intersect(&ray).unwrap();
            assert_absolute(hit.distance, gap * size, 5e-16 * size);
        }
    }
}

#[test]
fn a_tube_is_met_where_geometry_says() {
    let shape = tube(DVec3::ZERO, DVec3::Z, 0.1, 0.4);
    let motion = RigidMotion::about(DVec3::ONE, DVec3::new(1.0, 2.0, -1.0), 0.7).unwrap();
    let (upright, tilted) = (
        build(std::slice::from_ref(&shape)),
        build(&[shape.moved(&motion)]),
    );
    let grazing = 0.099_999;
    let half_chord = |y: f64| ((0.1 - y) * (0.1 + y)).sqrt();
    let (outside, inside) = (DVec3::new(-0.3, 0.0, 0.1), DVec3::new(0.06, 0.0, 0.1));
    let down = DVec3::new(0.1, 0.0, -0.45);
    let chord = half_chord(grazing);
    let beside = DVec3::new(-chord, grazing, 0.0) / 0.1;
    // A chord of half length c moves its ends by r / c times a rounding: 220 times at most.
    for (origin, toward, distance, normal, tolerance) in [
        (outside, DVec3::X, 0.2, -DVec3::X, 4e-16),
        (inside, DVec3::X, 0.04, DVec3::X, 4e-16),
        (inside, -DVec3::X, 0.16, -DVec3::X, 4e-16),
        (
            outside.with_y(grazing),
            DVec3::X,
            0.3 - chord,
            beside,
            1e-14,
        ),
        // Through the open end.
        (0.5 * DVec3::Z, down, down.length(), DVec3::X, 4e-16),
    ] {
        let ray = ray(origin, toward);
        assert_hit(
            &upright.intersect(&ray).unwrap(),
            distance,
            normal,
            tolerance,
        );
        let moved = Ray {
            origin: motion.point(ray.origin),
            direction: motion.direction(ray.direction),
        };
        let hit = tilted.intersect(&moved).unwrap();
        // Coordinates of 2 are rounded ten times as coarsely as those of 0.2.
        let tolerance = 20.0 * tolerance;
        assert_absolute(hit.distance, distance, tolerance);
        let point = motion.point(ray.origin + distance * ray.direction);
        assert!(hit.position.abs_diff_eq(point, tolerance), "{hit:?}");
    }
    for (origin, toward, case) in [
        (DVec3::new(-0.3, 0.0, 0.21), DVec3::X, "above"),
        (DVec3::new(-0.3, 0.101, 0.0), DVec3::X, "beside"),
        (DVec3::new(-0.3, 0.0, 0.0), -DVec3::X, "behind"),
        (DVec3::new(0.05, 0.0, 0.5), -DVec3::Z, "along the axis"),
        (DVec3::new(0.1, 0.0, 0.5), -DVec3::Z, "along the wall"),
        (
            DVec3::new(0.3, 0.0, 0.5),
            DVec3::new(-0.3, 0.0, -0.1),
            "over it",
        ),
    ] {
        assert_eq!(upright.intersect(&ray(origin, toward)), None, "{case}");
    }
}
