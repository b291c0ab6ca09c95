use glam::DMat3;
use proptest::prelude::*;

use super::*;

#[test]
fn no_ray_leaves_a_closed_mesh_through_an_edge_or_a_corner() {
    let shape = translated(&ball(10, 0.1).into(), DVec3::new(0.3, 0.2, 0.7));
    let Shape::Mesh(moved) = &shape else {
        unreachable!("still a mesh")
    };
    let intersector = build(std::slice::from_ref(&shape));
    let inside = DVec3::new(0.31, 0.19, 0.72);
    for triangle in 0..moved.mesh().triangles().len() {
        let corners = moved.mesh().corners(triangle);
        let [a, b, c] = corners.map(|corner| moved.point(corner));
        let edges = [0.5 * (a + b), 0.25 * a + 0.75 * c, 0.3 * b + 0.7 * c];
        for target in edges.into_iter().chain([a, b, c]) {
            let hit = intersector.intersect(&ray(inside, target - inside));
            let hit = hit.unwrap_or_else(|| panic!("the ray to {target} left the mesh"));
            assert!(
                hit.position.abs_diff_eq(target, 1e-15),
                "{hit:?} is not {target}"
            );
            assert!(hit.normal.dot(target - inside) > 0.0, "outward from inside");
        }
    }
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
        let (u, v) = up.any_orthonormal_pair();
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
            let (across, along) = normal.any_orthonormal_pair();
            let goes = DMat3::from_cols(across, along, normal)
                * direction(10.0_f64.powf(exponent), azimuth);
            let next = alone.intersect(&ray(alone.leave(hit.position, normal), goes));
            // From inside, a ball is met again, on its other side.
            let through = next
                .is_none_or(|next| next.distance > 1e-13 && next.normal.dot(normal) < 1.0);
            prop_assert!(if flat { next.is_none() } else { through }, "met again: {next:?}");
            prop_assert!(alone.visible(hit.position, hit.normal, hit.position + 2.0 * goes)
                == (flat || !below), "visible from the surface");
        }
    }
}

#[test]
fn no_ray_falls_through_the_edges_of_a_turned_and_scaled_grid() {
    // Heights over 60 × 60 squares of two triangles; rays to corners and to points of edges. Its
    // slopes stay below 0.12 and rays fall by 0.19 at least: they see every triangle from above.
    const SIDE: u32 = 60;
    let height = |i: u32, j: u32| 1e-3 * f64::from(7 * i).sin() * f64::from(5 * j).cos();
    let vertex =
        |i: u32, j: u32| DVec3::new(f64::from(i), f64::from(j), 60.0 * height(i, j)) / 60.0;
    let at = |i: u32, j: u32| i * (SIDE + 1) + j;
    let vertices = (0..=SIDE).flat_map(|i| (0..=SIDE).map(move |j| (i, j)));
    let triangles = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j)));
    let triangles = triangles.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    let vertices = vertices.map(|(i, j)| vertex(i, j)).collect();
    let grid = MeshInstance::from(TriangleMesh::new(vertices, triangles.collect()).unwrap());
    let turn = RigidMotion::about(DVec3::ONE, DVec3::new(3.0, -1.0, 2.0), 2.0).unwrap();
    for scale in [1.0, 1e-4] {
        let placed = grid.placed(scale, &turn).unwrap();
        let intersector = build(&[Shape::Mesh(placed.clone())]);
        let mut numbers = Numbers::new(31);
        let mut rays = Vec::new();
        for [a, b, _] in grid.mesh().triangles() {
            let [a, b] = [a, b].map(|&i| grid.mesh().vertices()[i as usize]);
            let target = a.lerp(b, (2.0 * numbers.unit()).min(1.0));
            // At the rim a ray may pass beside the grid.
            if (target.truncate() - 0.5).abs().max_element() > 0.49 {
                continue;
            }
            let from = DVec3::new(numbers.unit(), numbers.unit(), 0.3 + numbers.unit());
            let (from, target) = (placed.point(from), placed.point(target));
            rays.push(ray(from, target - from));
        }
        let mut hits = vec![None; rays.len()];
        intersector.intersect_batch(&rays, &mut hits);
        assert!(rays.len() > 5000, "{} rays", rays.len());
        for (ray, hit) in rays.iter().zip(hits) {
            assert!(hit.is_some(), "scale {scale}: {ray:?} fell through");
        }
    }
}
