use std::sync::Arc;

use super::*;

/// The mesh with its vertices where an instance has them.
fn baked(instance: &MeshInstance) -> TriangleMesh {
    let vertices = instance.mesh().vertices().iter();
    let vertices = vertices.map(|vertex| instance.point(*vertex)).collect();
    TriangleMesh::new(vertices, instance.mesh().triangles().to_vec()).unwrap()
}

#[test]
fn instances_are_met_as_the_meshes_that_stand_where_they_do() {
    let mut numbers = Numbers::new(21);
    let mesh = Arc::new(soup(500, 40.0, &mut numbers));
    let instances = [0.0, 1.0, 2.0].map(|angle| {
        let pivot = DVec3::new(0.3, -0.2, 0.1);
        let axis = DVec3::new(1.0, angle, -0.5);
        let motion = RigidMotion::about(pivot, axis, angle).unwrap();
        let motion = motion.then(&RigidMotion::along(0.2 * angle * DVec3::X).unwrap());
        let scale = 1e-2 * (1.0 + angle);
        let mesh = MeshInstance::new(Arc::clone(&mesh));
        mesh.placed(scale, &motion).unwrap()
    });
    let as_instances = build(&instances.clone().map(Shape::Mesh));
    let as_meshes = build(&instances.map(|instance| Shape::from(baked(&instance))));
    let mut met = [0; 3];
    for ray in rays(4000, 1.0, &mut numbers) {
        let hit = as_instances.intersect(&ray);
        assert_eq!(hit, as_meshes.intersect(&ray), "{ray:?}");
        if let Some(hit) = hit {
            met[hit.surface] += 1;
        }
    }
    assert!(met.iter().all(|&count| count > 30), "all are met: {met:?}");
}

#[test]
fn an_instance_far_smaller_than_the_scene_is_met_exactly() {
    // Balls of 0.1 pm and 1 nm, for which coordinates of a metre are coarser than single precision,
    // and one of a micrometre.
    let mesh = Arc::new(ball(8, 1.0));
    let place = DVec3::new(0.7, 0.6, 0.5);
    for scale in [1e-13, 1e-9, 1e-6] {
        let motion = RigidMotion::along(place).unwrap();
        let tiny = MeshInstance::new(Arc::clone(&mesh)).placed(scale, &motion);
        let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
        let shapes = [floor, Shape::Mesh(tiny.unwrap())];
        let intersector = build(&shapes);
        let mut numbers = Numbers::new(22);
        let mut hits = 0;
        for _ in 0..500 {
            let aside = 1.2 * scale * (2.0 * DVec3::from_array(numbers.units()) - 1.0);
            let from = DVec3::new(numbers.unit(), numbers.unit(), 2.0);
            let ray = ray(from, place + aside - from);
            let hit = assert_found(&intersector, &shapes, &ray);
            hits += usize::from(hit.is_some_and(|hit| hit.surface == 1));
        }
        assert!(hits > 100, "scale {scale:e}: {hits} meet the ball");
    }
}

#[test]
fn a_hundred_thousand_instances_are_told_apart() {
    const SIDE: usize = 316;
    let corners = vec![-DVec3::X - DVec3::Y, DVec3::X - DVec3::Y, DVec3::Y];
    let mesh = MeshInstance::from(TriangleMesh::new(corners, vec![[0, 1, 2]]).unwrap());
    let place = |i: usize| DVec3::new((i % SIDE) as f64, (i / SIDE) as f64, 0.0) * 1e-2;
    let shapes: Vec<_> = (0..SIDE * SIDE)
        .map(|i| {
            let motion = RigidMotion::along(place(i)).unwrap();
            Shape::Mesh(mesh.placed(4e-3, &motion).unwrap())
        })
        .collect();
    let intersector = build(&shapes);
    for i in (0..SIDE * SIDE).step_by(97) {
        let hit = intersector.intersect(&ray(place(i) + DVec3::Z, -DVec3::Z));
        assert_eq!(hit.map(|hit| hit.surface), Some(i), "instance {i}");
    }
}

/// A ball of flat triangles with the normals of the sphere through its corners.
fn round_ball(rings: u32) -> TriangleMesh {
    let mesh = ball(rings, 1.0);
    let vertices: Vec<_> = mesh.vertices().iter().map(|v| v.normalize()).collect();
    let normals = vertices.iter().map(|normal| 3.0 * normal).collect();
    TriangleMesh::with_normals(vertices, normals, mesh.triangles().to_vec()).unwrap()
}

#[test]
fn shading_normals_of_a_ball_are_those_of_the_sphere() {
    let rings = 40;
    let turn = RigidMotion::about(DVec3::ONE, DVec3::new(1.0, 2.0, 3.0), 1.0).unwrap();
    let ball = MeshInstance::from(round_ball(rings))
        .placed(0.5, &turn)
        .unwrap();
    let centre = ball.point(DVec3::ZERO);
    let intersector = build(&[Shape::Mesh(ball)]);
    let mut numbers = Numbers::new(23);
    let mut worst = 0.0_f64;
    for _ in 0..2000 {
        let outward = direction(2.0 * numbers.unit() - 1.0, TAU * numbers.unit());
        let aside = 0.3 * direction(2.0 * numbers.unit() - 1.0, TAU * numbers.unit());
        let hit = intersector.intersect(&ray(centre + 2.0 * outward, aside - 2.0 * outward));
        let hit = hit.unwrap();
        assert_absolute(hit.shading_normal.length(), 1.0, 4e-16);
        let sphere = (hit.position - centre).normalize();
        worst = worst.max((hit.shading_normal - sphere).length());
        // Normals interpolated between those of a sphere are proportional to the interpolated
        // corners: they point exactly to the hit. Coordinates of 2.5 are rounded to 2 × 2⁻⁵³, some
        // ten times each, relative to a radius of 0.5.
        assert!(worst < 3e-14, "off by {worst:e}");
        // The flat triangle's own normal is up to half its extent, π / 40, off.
        assert!(hit.normal.dot(sphere) > 0.99, "outward");
    }
}

#[test]
fn shading_normals_stay_on_the_side_of_the_triangle() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let shading = |normals: Vec<DVec3>| {
        let mesh = TriangleMesh::with_normals(corners.clone(), normals, vec![[0, 1, 2]]);
        let intersector = build(&[Shape::from(mesh.unwrap())]);
        let hit = intersector.intersect(&ray(DVec3::new(0.25, 0.25, -1.0), DVec3::Z));
        let hit = hit.unwrap();
        assert_eq!(hit.normal, DVec3::Z, "the triangle's own normal");
        hit.shading_normal
    };
    let tilted = DVec3::new(0.6, 0.0, 0.8);
    for (normals, expected, case) in [
        (vec![tilted; 3], tilted, "tilted"),
        (vec![-tilted; 3], tilted, "turned around"),
        (vec![DVec3::X; 3], DVec3::Z, "in the triangle"),
        (vec![DVec3::ZERO; 3], DVec3::Z, "none"),
        (vec![tilted, DVec3::ZERO, DVec3::ZERO], tilted, "only one"),
        // The weights are a half, a quarter and a quarter.
        (vec![tilted, -tilted, -tilted], DVec3::Z, "cancelled"),
    ] {
        let shading = shading(normals);
        // Three products of numbers up to 1 and a normalisation.
        assert!(shading.abs_diff_eq(expected, 4e-16), "{case}: {shading}");
    }
}
