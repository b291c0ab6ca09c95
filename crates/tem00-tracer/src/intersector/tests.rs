use core::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::{primitive::Primitive, *};
use crate::{Rectangle, Sphere, TriangleMesh};

fn rectangle(centre: DVec3, half_u: DVec3, half_v: DVec3) -> Shape {
    Shape::Rectangle(Rectangle::new(centre, half_u, half_v).unwrap())
}

fn sphere(centre: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(centre, radius).unwrap())
}

fn build(shapes: &[Shape]) -> Intersector {
    Intersector::build(shapes).unwrap()
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray {
        origin,
        direction: direction.normalize(),
    }
}

fn direction(cosine: f64, azimuth: f64) -> DVec3 {
    let radius = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), cosine)
}

/// Uniform numbers in [0, 1) from `SplitMix64`.
fn uniforms(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * 0.5_f64.powi(53)
    }
}

/// A closed, bumpy ball around the origin: `rings` × 2 `rings` quadrilaterals, each two
/// triangles, and triangles at the poles.
fn ball(rings: u32, radius: f64) -> TriangleMesh {
    let sectors = 2 * rings;
    let mut vertices = vec![radius * DVec3::Z, -radius * DVec3::Z];
    let index = |ring: u32, sector: u32| 2 + (ring - 1) * sectors + sector % sectors;
    for ring in 1..rings {
        for sector in 0..sectors {
            let (theta, phi) = (
                PI * f64::from(ring) / f64::from(rings),
                TAU * f64::from(sector) / f64::from(sectors),
            );
            let bumpy = radius * (1.0 + 0.1 * (5.0 * theta).sin() * (3.0 * phi).cos());
            vertices.push(bumpy * direction(theta.cos(), phi));
        }
    }
    let mut triangles = Vec::new();
    for sector in 0..sectors {
        triangles.push([0, index(1, sector), index(1, sector + 1)]);
        triangles.push([1, index(rings - 1, sector + 1), index(rings - 1, sector)]);
        for ring in 1..rings - 1 {
            let (a, b) = (index(ring, sector), index(ring, sector + 1));
            let (c, d) = (index(ring + 1, sector), index(ring + 1, sector + 1));
            triangles.push([a, c, d]);
            triangles.push([a, d, b]);
        }
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn mixed_scene() -> Vec<Shape> {
    vec![
        rectangle(DVec3::new(0.0, 0.0, -0.3), 0.5 * DVec3::X, 0.4 * DVec3::Y),
        Shape::from(ball(12, 0.1)),
        sphere(DVec3::new(0.2, 0.1, 0.0), 0.05),
        sphere(DVec3::new(-0.2, 0.15, -0.1), 1e-4),
        Shape::from(ball(6, 0.004)).translated(DVec3::new(-0.1, -0.2, 0.2)),
        rectangle(
            DVec3::new(0.0, 0.2, 0.2),
            DVec3::new(0.01, 0.02, 0.02),
            DVec3::new(0.02, -0.02, 0.01),
        ),
    ]
}

/// The parts of a shape, without any hierarchy.
fn primitives(shape: &Shape) -> Vec<Primitive> {
    match shape {
        Shape::Rectangle(rectangle) => vec![Primitive::Rectangle(*rectangle)],
        Shape::Sphere(sphere) => vec![Primitive::Sphere(*sphere)],
        Shape::Cylinder(cylinder) => vec![Primitive::Cylinder(*cylinder)],
        Shape::Mesh(instance) => (0..instance.mesh().triangles().len())
            .map(|triangle| Primitive::Triangle(instance.corners(triangle)))
            .collect(),
    }
}

/// The nearest hit among all primitives: its distance, and the index of the first shape that has
/// it.
fn brute_force(shapes: &[Shape], ray: &Ray) -> Option<(f64, usize)> {
    let distances = shapes.iter().enumerate().flat_map(|(surface, shape)| {
        let primitives = primitives(shape).into_iter();
        let distances = primitives.filter_map(|primitive| primitive.distance(ray));
        distances
            .map(move |distance| (distance, surface))
            .collect::<Vec<_>>()
    });
    distances.min_by(|a, b| a.0.total_cmp(&b.0))
}

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
        assert!((hit.distance - distance).abs() < 1e-15, "{}", hit.distance);
        let position = DVec3::new(0.5, 0.5 * tangent, 0.0);
        assert!(
            hit.position.abs_diff_eq(position, 1e-15),
            "{}",
            hit.position
        );
        assert!(hit.normal.abs_diff_eq(-DVec3::X, 1e-15), "{}", hit.normal);
    }
    let past = ray(DVec3::ZERO, DVec3::new(1.0, 2.1, 0.0));
    assert_eq!(wall.intersect(&past), None, "beyond the edge at 1 m");
    let away = ray(DVec3::ZERO, -DVec3::X);
    assert_eq!(wall.intersect(&away), None, "behind");
    let along = ray(DVec3::new(0.5, -2.0, 0.0), DVec3::Y);
    assert_eq!(wall.intersect(&along), None, "in the plane");
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
        let distance = 0.5 - half_chord;
        assert!((hit.distance - distance).abs() < tolerance, "miss = {miss}");
        let normal = DVec3::new(miss, 0.0, -half_chord) / 0.02;
        // Relative to the radius, 1 / 0.02 times as much.
        assert!(
            hit.normal.abs_diff_eq(normal, 50.0 * tolerance),
            "miss = {miss}"
        );
    }
    let past = ray(DVec3::new(0.020_000_001, 0.0, 0.0), DVec3::Z);
    assert_eq!(ball.intersect(&past), None, "just beside");
    let away = ray(DVec3::ZERO, -DVec3::Z);
    assert_eq!(ball.intersect(&away), None, "behind");
    let unit = build(&[sphere(DVec3::ZERO, 1.0)]);
    let tangent = ray(DVec3::X, DVec3::Y);
    assert_eq!(unit.intersect(&tangent), None, "touching where it starts");
}

#[test]
fn from_inside_the_far_side_of_a_ball_is_met_with_its_outward_normal() {
    let ball = build(&[sphere(DVec3::ONE, 0.1)]);
    let inside = ray(DVec3::new(1.0, 1.0, 1.06), DVec3::Z);
    let hit = ball.intersect(&inside).unwrap();
    assert!((hit.distance - 0.04).abs() < 1e-15, "{}", hit.distance);
    assert!(hit.normal.abs_diff_eq(DVec3::Z, 1e-14), "{}", hit.normal);
    let back = ray(DVec3::new(1.0, 1.0, 1.06), -DVec3::Z);
    let hit = ball.intersect(&back).unwrap();
    assert!((hit.distance - 0.16).abs() < 1e-15, "{}", hit.distance);
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
        assert!((hit.distance - 1.0).abs() < 1e-15, "{}", hit.distance);
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
        assert!(
            hit.position.abs_diff_eq(target, tolerance),
            "{}",
            hit.position
        );
        assert!(
            hit.position.z.abs() < 1e-16,
            "on the floor: {}",
            hit.position.z
        );
    }
}

#[test]
fn hierarchy_and_brute_force_agree_on_every_ray() {
    let shapes = mixed_scene();
    let intersector = build(&shapes);
    let mut uniform = uniforms(1);
    let mut hits = 0;
    for i in 0..4000 {
        let mut point = || DVec3::new(uniform(), uniform(), uniform()) - 0.5;
        // Toward the middle from near and far, and anywhere.
        let (from, to) = (point(), 0.2 * point());
        let far = if i % 4 == 0 { 1e3 } else { 1.0 };
        let ray = ray(to + far * (from - to), to - from);
        let found = intersector.intersect(&ray).map(|hit| hit.distance);
        let expected = brute_force(&shapes, &ray).map(|(distance, _)| distance);
        assert_eq!(found, expected, "{ray:?}");
        hits += u32::from(found.is_some());
    }
    assert!(hits > 1000, "{hits} hits");
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
    let mut uniform = uniforms(4);
    for i in 0..4000 {
        let along = 2.0 * uniform() - 1.0;
        let edge = 1.0 - 5e-9;
        let (u, v) = match i % 4 {
            0 => (-edge, along),
            1 => (along, -edge),
            2 => (edge, along),
            _ => (along, edge),
        };
        let target = centre + u * half_u + v * half_v;
        let aside = DVec3::new(uniform() - 0.5, uniform() - 0.5, -0.2);
        for reach in [1.0, 1e4] {
            let ray = ray(target + reach * aside, -aside);
            let found = intersector.intersect(&ray).map(|hit| hit.distance);
            let expected = brute_force(&shapes, &ray).map(|(distance, _)| distance);
            assert!(
                reach > 1.0 || expected.is_some(),
                "{ray:?} aims at the rectangle"
            );
            assert_eq!(found, expected, "{ray:?}");
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
    let mut uniform = uniforms(2);
    for i in 0..2000 {
        let mut direction = DVec3::splat(if i % 2 == 0 { 0.0 } else { -0.0 });
        direction[i % 3] = if i % 4 < 2 { 1.0 } else { -1.0 };
        if i % 5 == 0 {
            // Rounded to single precision this is −0.
            direction[(i + 1) % 3] = -1e-60;
        }
        let place = 0.5 * (DVec3::new(uniform(), uniform(), uniform()) - 0.5);
        let ray = Ray {
            origin: place - direction,
            direction,
        };
        let found = intersector.intersect(&ray).map(|hit| hit.distance);
        let expected = brute_force(&shapes, &ray).map(|(distance, _)| distance);
        assert_eq!(found, expected, "{ray:?}");
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
            let error = (hit.distance - gap * size).abs();
            assert!(error < 5e-16 * size, "size {size}, gap {gap}: {error}");
        }
    }
}

#[test]
fn no_ray_leaves_a_closed_mesh_through_an_edge_or_a_corner() {
    let mesh = ball(10, 0.1);
    let shape = Shape::from(mesh).translated(DVec3::new(0.3, 0.2, 0.7));
    let Shape::Mesh(moved) = &shape else {
        unreachable!("still a mesh")
    };
    let intersector = build(std::slice::from_ref(&shape));
    let inside = DVec3::new(0.31, 0.19, 0.72);
    for triangle in 0..moved.mesh().triangles().len() {
        let corners = moved.mesh().corners(triangle);
        let [a, b, c] = corners.map(|corner| moved.point(corner));
        for target in [
            a,
            b,
            c,
            0.5 * (a + b),
            0.25 * a + 0.75 * c,
            0.3 * b + 0.7 * c,
        ] {
            let hit = intersector.intersect(&ray(inside, target - inside));
            let hit = hit.unwrap_or_else(|| panic!("the ray to {target} left the mesh"));
            assert!(
                hit.position.abs_diff_eq(target, 1e-15),
                "{} is not {target}",
                hit.position
            );
            assert!(hit.normal.dot(target - inside) > 0.0, "outward from inside");
        }
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
    let down = ray(DVec3::new(0.2, 0.6, 1.0), -DVec3::Z);
    assert_eq!(
        intersector.intersect(&down).unwrap().surface,
        0,
        "the triangles"
    );
    for i in [1, 1000, 1999] {
        let target = DVec3::splat(0.7) + (f64::from(i) + 0.2) * 1e-12 * DVec3::X;
        let tiny = ray(target + 0.3e-12 * DVec3::Y + DVec3::Z, -DVec3::Z);
        assert_eq!(
            intersector.intersect(&tiny).unwrap().surface,
            0,
            "tiny triangle {i}"
        );
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
        let hit = intersector
            .intersect(&ray(target + DVec3::Z, -DVec3::Z))
            .unwrap();
        assert_eq!(hit.surface, surface, "above {target}");
    }
    let sheet = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
    let twins = build(&[sheet.clone(), sheet.clone(), sheet]);
    let hit = twins
        .intersect(&ray(DVec3::new(0.2, 0.3, 1.0), -DVec3::Z))
        .unwrap();
    assert_eq!(hit.surface, 0, "the first of three");
}

proptest! {
    #[test]
    fn a_ray_that_leaves_a_surface_does_not_meet_it_again(
        (x, y) in (-0.9_f64..0.9, -0.9_f64..0.9),
        exponent in -12.0_f64..0.0,
        azimuth in 0.0_f64..6.3,
        tilt in (-1.0_f64..1.0, 0.0_f64..6.3),
        below in any::<bool>(),
    ) {
        // A tilted plane as rectangle and as mesh, away from the origin, and a ball; points on
        // them found from afar; rays that leave upwards by 10^exponent of a right angle.
        let up = direction(tilt.0, tilt.1);
        let frame = crate::LocalFrame::from_normal(up);
        let (u, v) = (frame.tangent(), frame.bitangent());
        let centre = DVec3::new(0.3, -0.2, 0.4);
        let corners = vec![centre - u - v, centre + u - v, centre + u + v, centre - u + v];
        let mesh = TriangleMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
        for shape in [rectangle(centre, u, v), Shape::from(mesh), sphere(centre - up, 1.0)] {
            let flat = !matches!(shape, Shape::Sphere(_));
            let alone = build(&[shape]);
            let side = if below { -1.0 } else { 1.0 };
            let above = centre + 0.7 * (x * u + y * v) + side * 0.5 * up;
            let Some(hit) = alone.intersect(&ray(above, -side * up)) else { continue };
            let normal = side * hit.normal;
            let axes = crate::LocalFrame::from_normal(normal);
            let goes = axes.to_world(direction(10.0_f64.powf(exponent), azimuth));
            let next = alone.intersect(&ray(alone.leave(hit.position, normal), goes));
            // From inside, a ball is met again, on its other side.
            let through = next.is_none_or(|next| next.distance > 1e-13 && next.normal.dot(normal) < 1.0);
            prop_assert!(if flat { next.is_none() } else { through }, "met again: {next:?}");
            prop_assert!(alone.visible(hit.position, hit.normal, hit.position + 2.0 * goes)
                == (flat || !below), "visible from the surface");
        }
    }
}

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
fn a_lamp_does_not_hide_itself_but_what_is_before_it_does() {
    let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
    let lamp = Rectangle::new(
        DVec3::new(0.3, 0.1, 0.8),
        DVec3::new(0.1, 0.0, 0.05),
        DVec3::new(0.0, -0.1, 0.0),
    )
    .unwrap();
    let post = sphere(DVec3::new(0.15, 0.05, 0.4), 0.001);
    let open = build(&[floor.clone(), Shape::Rectangle(lamp)]);
    let blocked = build(&[floor, Shape::Rectangle(lamp), post]);
    let mut uniform = uniforms(3);
    for _ in 0..500 {
        let on_lamp = lamp.point(uniform(), uniform());
        let on_floor = DVec3::new(uniform() - 0.5, uniform() - 0.5, 0.0);
        assert!(
            open.visible(on_floor, DVec3::Z, on_lamp),
            "{on_floor} to {on_lamp}"
        );
    }
    assert!(
        !blocked.visible(DVec3::ZERO, DVec3::Z, lamp.centre()),
        "the post is in the middle"
    );
    assert!(
        blocked.visible(0.1 * DVec3::X, DVec3::Z, lamp.centre()),
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
fn rays_that_are_no_rays_meet_nothing() {
    let floor = build(&[rectangle(DVec3::ZERO, DVec3::X, DVec3::Y)]);
    for (origin, direction) in [
        (DVec3::NAN, DVec3::Z),
        (DVec3::Z, DVec3::NAN),
        (DVec3::Z, DVec3::ZERO),
        (DVec3::INFINITY, -DVec3::Z),
    ] {
        assert_eq!(
            floor.intersect(&Ray { origin, direction }),
            None,
            "{origin} {direction}"
        );
    }
}

#[test]
fn scenes_without_shapes_or_of_impossible_size_are_refused() {
    let empty = Intersector::build(&[]).unwrap_err();
    assert_eq!(empty, TracerError::Missing("a surface"), "{empty}");
    for (shape, name) in [
        (sphere(DVec3::ZERO, 1e10), "coordinate of a shape"),
        (sphere(DVec3::ZERO, 1e-13), "extent of all shapes"),
        (
            sphere(DVec3::ZERO, 1.0).translated(DVec3::NAN),
            "coordinate of a shape",
        ),
    ] {
        let result = Intersector::build(&[shape]);
        assert!(
            matches!(result, Err(TracerError::OutOfRange { parameter, .. }) if parameter == name),
            "{name}: {result:?}"
        );
    }
}

#[test]
fn intersectors_are_shared_between_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Intersector>();
}
