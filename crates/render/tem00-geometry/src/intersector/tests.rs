mod batches;
mod brute_force;
mod closed_forms;
mod instances;
mod visibility;
mod watertight;

use core::f64::consts::{PI, TAU};

use tem00_decorrelation::RigidMotion;
use tem00_testkit::{Numbers, assert_absolute};

use super::{primitive::Primitive, *};
use crate::{Cylinder, MeshInstance, Rectangle, Sphere, TriangleMesh, hierarchy::MeshHierarchy};

fn rectangle(centre: DVec3, half_u: DVec3, half_v: DVec3) -> Shape {
    Shape::Rectangle(Rectangle::new(centre, half_u, half_v).unwrap())
}

fn sphere(centre: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(centre, radius).unwrap())
}

fn tube(centre: DVec3, axis: DVec3, radius: f64, length: f64) -> Shape {
    Shape::Cylinder(Cylinder::new(centre, axis, radius, length).unwrap())
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

/// A point in the cube of side 1 about the origin.
fn anywhere(numbers: &mut Numbers) -> DVec3 {
    DVec3::from_array(numbers.units()) - 0.5
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

fn translated(shape: &Shape, displacement: DVec3) -> Shape {
    shape.moved(&RigidMotion::along(displacement).unwrap())
}

fn mixed_scene() -> Vec<Shape> {
    let (u, v) = (DVec3::new(0.01, 0.02, 0.02), DVec3::new(0.02, -0.02, 0.01));
    let axis = DVec3::new(1.0, 0.2, 0.3);
    vec![
        rectangle(DVec3::new(0.0, 0.0, -0.3), 0.5 * DVec3::X, 0.4 * DVec3::Y),
        Shape::from(ball(12, 0.1)),
        sphere(DVec3::new(0.2, 0.1, 0.0), 0.05),
        sphere(DVec3::new(-0.2, 0.15, -0.1), 1e-4),
        translated(&ball(6, 0.004).into(), DVec3::new(-0.1, -0.2, 0.2)),
        rectangle(DVec3::new(0.0, 0.2, 0.2), u, v),
        tube(DVec3::new(0.35, -0.3, 0.0), axis, 0.03, 0.2),
    ]
}

/// Triangles without order, of all sizes from 1 down to 1e−3 of `size`, of which many are slivers.
fn soup(triangles: u32, size: f64, numbers: &mut Numbers) -> TriangleMesh {
    let mut vertices = Vec::new();
    for _ in 0..triangles {
        let mut point = || size * (anywhere(numbers));
        let (a, u, v) = (point(), point(), point());
        let extent = 10.0_f64.powf(-3.0 * numbers.unit());
        let sliver = 10.0_f64.powf(-8.0 * numbers.unit() * numbers.unit());
        vertices.extend([a, a + extent * u, a + extent * (u + sliver * v)]);
    }
    let corners = (0..triangles).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    TriangleMesh::new(vertices, corners.collect()).unwrap()
}

/// Rays through pixels of a pinhole and from anywhere to anywhere, in turns of 100, in a scene
/// within `size` of the origin.
fn rays(count: usize, size: f64, numbers: &mut Numbers) -> Vec<Ray> {
    let eye = size * DVec3::new(0.3, 0.2, 1.4);
    (0..count)
        .map(|i| {
            let mut point = || size * (anywhere(numbers));
            let pixel = (i / 100) as f64;
            let corner = 0.4 * size * DVec3::new(pixel.sin(), pixel.cos(), 0.0);
            let target = corner + 0.01 * point();
            match i / 100 % 2 {
                0 => ray(eye, target - eye),
                _ => ray(point(), point()),
            }
        })
        .collect()
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

/// Asserts that a ray has the hit that a search of all primitives finds, at the same distance, and
/// returns it.
#[track_caller]
fn assert_found(intersector: &Intersector, shapes: &[Shape], ray: &Ray) -> Option<Hit> {
    let found = intersector.intersect(ray);
    let expected = brute_force(shapes, ray).map(|(distance, _)| distance);
    assert_eq!(found.map(|hit| hit.distance), expected, "{ray:?}");
    found
}

/// Asserts that a hit lies at a distance on a surface that faces along a normal.
#[track_caller]
fn assert_hit(hit: &Hit, distance: f64, normal: DVec3, tolerance: f64) {
    assert_absolute(hit.distance, distance, tolerance);
    assert!(hit.normal.abs_diff_eq(normal, 10.0 * tolerance), "{hit:?}");
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
        let ray = Ray { origin, direction };
        assert_eq!(floor.intersect(&ray), None, "{origin} {direction}");
    }
}

#[test]
fn scenes_without_shapes_or_of_impossible_size_are_refused() {
    let empty = Intersector::build(&[]).unwrap_err();
    assert_eq!(empty.parameter, "number of shapes", "{empty}");
    for (shape, name) in [
        (sphere(DVec3::ZERO, 1e10), "coordinate of a shape"),
        (sphere(DVec3::ZERO, 1e-13), "extent of all shapes"),
        (
            translated(&sphere(f64::MAX * DVec3::X, 1.0), f64::MAX * DVec3::X),
            "coordinate of a shape",
        ),
    ] {
        let refused = Intersector::build(&[shape]).unwrap_err();
        assert_eq!(refused.parameter, name, "{refused}");
    }
}

#[test]
fn intersectors_are_shared_between_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Intersector>();
}
