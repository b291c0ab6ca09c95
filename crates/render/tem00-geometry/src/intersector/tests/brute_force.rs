use tem00_testkit::on_threads;

use super::*;

#[test]
fn hierarchy_and_brute_force_agree_on_every_ray() {
    let shapes = mixed_scene();
    let intersector = build(&shapes);
    let mut numbers = Numbers::new(1);
    let mut hits = 0;
    for i in 0..4000 {
        let mut point = || anywhere(&mut numbers);
        // Toward the middle from near and far, and anywhere.
        let (from, to) = (point(), 0.2 * point());
        let far = if i % 4 == 0 { 1e3 } else { 1.0 };
        let ray = ray(to + far * (from - to), to - from);
        hits += u32::from(assert_found(&intersector, &shapes, &ray).is_some());
    }
    assert!(hits > 1000, "{hits} hits");
}

/// A ball of more triangles than one thread builds a tree of, between two plates of two triangles.
fn ball_between_plates() -> TriangleMesh {
    let ball = ball(120, 0.3);
    let mut vertices = ball.vertices().to_vec();
    let mut triangles = ball.triangles().to_vec();
    for z in [-0.4, 0.4] {
        let plate = u32::try_from(vertices.len()).unwrap();
        vertices.extend(
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z)),
        );
        triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|i| plate + i)));
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

#[test]
fn hierarchy_of_many_triangles_and_brute_force_agree() {
    let shapes = [Shape::from(ball_between_plates())];
    let intersector = build(&shapes);
    let mut numbers = Numbers::new(5);
    let mut surfaces = [0; 2];
    for _ in 0..60 {
        let mut point = || anywhere(&mut numbers);
        let (from, to) = (2.0 * point(), 0.8 * point());
        let ray = ray(from, to - from);
        if let Some(hit) = assert_found(&intersector, &shapes, &ray) {
            surfaces[usize::from(hit.position.z.abs() > 0.39)] += 1;
        }
    }
    assert!(
        surfaces.iter().all(|&hits| hits > 10),
        "{surfaces:?} hits of ball and plates"
    );
}

#[test]
fn hierarchy_is_the_same_for_any_number_of_threads() {
    let mesh = ball_between_plates();
    let corners = |triangle| mesh.corners(triangle);
    let build = || MeshHierarchy::build(mesh.triangles().len(), corners);
    let alone = on_threads(1, build);
    for threads in [2, 3] {
        assert!(on_threads(threads, build) == alone, "{threads} threads");
    }
}

#[test]
fn a_nanometre_inside_an_edge_is_found_from_anywhere() {
    // Boxes end at the edges, and single precision moves them and the rays by up to 1e−7 of
    // the scene, by more for rays that start far away.
    let (half_u, half_v) = (0.3 * DVec3::X, 0.2 * DVec3::Y);
    let centre = DVec3::new(0.7, 1.3, 0.1);
    let shapes = [
        rectangle(centre, half_u, half_v),
        rectangle(centre + 0.3 * DVec3::Z, 0.01 * DVec3::X, 0.01 * DVec3::Y),
    ];
    let intersector = build(&shapes);
    let mut numbers = Numbers::new(4);
    for i in 0..4000 {
        let along = 2.0 * numbers.unit() - 1.0;
        let edge = 1.0 - 5e-9;
        let (u, v) = match i % 4 {
            0 => (-edge, along),
            1 => (along, -edge),
            2 => (edge, along),
            _ => (along, edge),
        };
        let target = centre + u * half_u + v * half_v;
        let aside = DVec3::new(numbers.unit() - 0.5, numbers.unit() - 0.5, -0.2);
        for reach in [1.0, 1e4] {
            let ray = ray(target + reach * aside, -aside);
            let found = assert_found(&intersector, &shapes, &ray);
            assert!(
                reach > 1.0 || found.is_some(),
                "{ray:?} aims at the rectangle"
            );
        }
    }
}

#[test]
fn the_nearest_of_many_close_sheets_is_found() {
    for gap in [1e-3, 1e-5, 1e-7, 1e-9] {
        let sheet = |i: i32| {
            let height = f64::from(i) * gap;
            rectangle(0.5 * DVec3::ONE + height * DVec3::Z, DVec3::X, DVec3::Y)
        };
        let stack: Vec<Shape> = (0..20).map(sheet).collect();
        let stack = build(&stack);
        for (from, nearest) in [(3.0, 19), (-3.0, 0)] {
            let origin = DVec3::new(0.3, 0.1, from);
            let toward = DVec3::new(0.4, 0.6, 0.5) - origin;
            let hit = stack.intersect(&ray(origin, toward)).unwrap();
            assert_eq!(hit.surface, nearest, "gap {gap:e} from z = {from}");
        }
    }
}

#[test]
fn axis_parallel_rays_are_found_whatever_the_sign_of_zero() {
    let shapes = mixed_scene();
    let intersector = build(&shapes);
    let mut numbers = Numbers::new(2);
    for i in 0..2000 {
        let mut direction = DVec3::splat(if i % 2 == 0 { 0.0 } else { -0.0 });
        direction[i % 3] = if i % 4 < 2 { 1.0 } else { -1.0 };
        if i % 5 == 0 {
            // Rounded to single precision this is −0.
            direction[(i + 1) % 3] = -1e-60;
        }
        let place = 0.5 * (anywhere(&mut numbers));
        let ray = Ray {
            origin: place - direction,
            direction,
        };
        assert_found(&intersector, &shapes, &ray);
    }
}

#[test]
fn coincident_and_nested_shapes_do_not_break_the_hierarchy() {
    // Two thousand copies of a triangle, as many too small for single precision to tell apart,
    // and spheres in spheres.
    let mut vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mut triangles = vec![[0, 1, 2]; 2000];
    for i in 0..2000_u32 {
        let place = DVec3::splat(0.7) + f64::from(i) * 1e-12 * DVec3::X;
        vertices.extend([place, place + 1e-12 * DVec3::X, place + 1e-12 * DVec3::Y]);
        triangles.push([3 * i + 3, 3 * i + 4, 3 * i + 5]);
    }
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    let nested = (0..100).map(|i| sphere(DVec3::splat(-0.5), 0.5_f64.powi(i)));
    let shapes: Vec<Shape> = std::iter::once(Shape::from(mesh)).chain(nested).collect();
    let intersector = build(&shapes);
    let tiny = [1, 1000, 1999].map(|i| {
        let target = DVec3::splat(0.7) + (f64::from(i) + 0.2) * 1e-12 * DVec3::X;
        target + 0.3e-12 * DVec3::Y
    });
    for target in [DVec3::new(0.2, 0.6, 0.0)].into_iter().chain(tiny) {
        let hit = intersector.intersect(&ray(target + DVec3::Z, -DVec3::Z));
        assert_eq!(hit.unwrap().surface, 0, "{target}");
    }
    let from_within = ray(DVec3::splat(-0.5), DVec3::new(0.2, -1.0, 0.3));
    let hit = intersector.intersect(&from_within).unwrap();
    assert_eq!(hit.surface, 100, "the smallest sphere");
    // 2⁻⁹⁹ m, beside coordinates of 0.5 m: the origin is the centre itself.
    assert!(hit.distance < 1.6e-30, "{:e}", hit.distance);
}

#[test]
fn the_surface_is_the_index_of_the_shape_and_ties_go_to_the_first() {
    let shapes = mixed_scene();
    let intersector = build(&shapes);
    for (target, surface) in [
        (DVec3::new(0.4, 0.3, -0.3), 0),
        (DVec3::new(0.0, 0.0, 0.0), 1),
        (DVec3::new(0.2, 0.1, 0.0), 2),
        (DVec3::new(-0.2, 0.15, -0.1), 3),
        (DVec3::new(-0.1, -0.2, 0.2), 4),
        (DVec3::new(0.0, 0.2, 0.2), 5),
    ] {
        let hit = intersector.intersect(&ray(target + DVec3::Z, -DVec3::Z));
        assert_eq!(hit.unwrap().surface, surface, "above {target}");
    }
    let sheet = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
    let twins = build(&[sheet.clone(), sheet.clone(), sheet]);
    let hit = twins.intersect(&ray(DVec3::new(0.2, 0.3, 1.0), -DVec3::Z));
    assert_eq!(hit.unwrap().surface, 0, "the first of three");
}

#[test]
fn a_hundred_thousand_coincident_triangles_are_built_and_met() {
    const COPIES: usize = 100_000;
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.9, 0.9, 0.0)];
    let mut triangles = vec![[0, 1, 2]; COPIES];
    triangles.push([1, 3, 2]);
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    // A quadratic step would take minutes.
    let intersector = build(&[Shape::from(mesh)]);
    for (x, y, met) in [(0.2, 0.3, true), (0.6, 0.6, true), (-0.01, 0.5, false)] {
        let down = ray(DVec3::new(x, y, 1.0), -DVec3::Z);
        let hit = intersector.intersect(&down);
        assert_eq!(hit.is_some(), met, "above ({x}, {y})");
        assert_absolute(hit.map_or(1.0, |hit| hit.distance), 1.0, 1e-15);
    }
}
