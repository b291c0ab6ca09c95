//! Rays per second through the tracer's intersector, and camera samples per second of a render.
//!
//! The mesh is a displaced sphere of 262 144 triangles. Coherent rays come from a pinhole, scattered
//! ones join random points of a sphere around the mesh.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use std::{f64::consts::PI, hint::black_box, path::Path, sync::atomic::AtomicBool};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use tem00::tracer::{
    Intersector, Ray, RenderOptions, Scene, Shape, SpeckleModel, SpecklePlan, TriangleMesh,
    parse_scene, render_frame,
};

/// Rays per image side, and their square.
const SIDE: usize = 128;
const RAYS: usize = SIDE * SIDE;

/// A sphere of 512 × 256 quadrilaterals with ripples.
fn displaced_sphere() -> TriangleMesh {
    const COLUMNS: u32 = 512;
    const ROWS: u32 = 256;
    let vertex = |i: u32, j: u32| {
        let (phi, theta) = (
            2.0 * PI * f64::from(i) / f64::from(COLUMNS),
            PI * (f64::from(j) + 0.5) / f64::from(ROWS + 1),
        );
        let radius = 1.0 + 0.05 * (13.0 * phi).sin() * (17.0 * theta).sin();
        radius
            * DVec3::new(
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            )
    };
    let vertices = (0..=ROWS)
        .flat_map(|j| (0..COLUMNS).map(move |i| vertex(i, j)))
        .collect();
    let triangles = (0..ROWS)
        .flat_map(|j| (0..COLUMNS).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let at = |i: u32, j: u32| j * COLUMNS + i % COLUMNS;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    TriangleMesh::new(vertices, triangles).expect("a valid mesh")
}

fn coherent_rays() -> Vec<Ray> {
    // Seen from the equator: the triangles of the poles are slivers.
    let origin = DVec3::new(4.0, 0.0, 0.0);
    (0..RAYS)
        .map(|i| {
            let at = |k: usize| (k as f64 + 0.5) / SIDE as f64 - 0.5;
            Ray {
                origin,
                direction: DVec3::new(-1.0, 0.5 * at(i % SIDE), 0.5 * at(i / SIDE)).normalize(),
            }
        })
        .collect()
}

fn scattered_rays() -> Vec<Ray> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut point = || {
        let [u, v]: [f64; 2] = random.random();
        let (z, phi) = (2.0 * u - 1.0, 2.0 * PI * v);
        let r = (1.0 - z * z).sqrt();
        2.0 * DVec3::new(r * phi.cos(), r * phi.sin(), z)
    };
    (0..RAYS)
        .map(|_| {
            let origin = point();
            Ray {
                origin,
                direction: (point() - origin).normalize(),
            }
        })
        .collect()
}

fn intersections(criterion: &mut Criterion) {
    let shapes = [Shape::from(displaced_sphere())];
    let intersector = Intersector::build(&shapes).expect("a valid scene");
    let mut group = criterion.benchmark_group("rays, one thread");
    for (name, rays) in [
        ("coherent", coherent_rays()),
        ("scattered", scattered_rays()),
    ] {
        group.throughput(Throughput::Elements(rays.len() as u64));
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let hits = rays.iter().filter_map(|ray| intersector.intersect(ray));
                black_box(hits.map(|hit| hit.distance).sum::<f64>())
            });
        });
    }
    group.finish();
}

fn scene() -> Scene {
    let text = r#"
        [camera]
        position = [0, 0, 0.3]
        look_at = [0, 0, 0]
        focal_length = "25 mm"
        f_number = 8
        pixel_pitch = "3.45 um"
        resolution = [128, 128]
        [[laser]]
        wavelength = "650 nm"
        power = "5 mW"
        position = [0.05, 0, 0.2]
        look_at = [0, 0, 0]
        line = { fan_angle = "30 deg", thickness = "0.2 mm" }
        [[surface]]
        rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = [0.02, 0.02] }
    "#;
    parse_scene(text, Path::new(".")).expect("a valid scene")
}

fn renders(criterion: &mut Criterion) {
    let scene = scene();
    let options = RenderOptions::default();
    let plan = SpecklePlan::new(&scene, options.formulas, 0).expect("a small pattern");
    let model = SpeckleModel::generate(&scene, &plan).expect("a small pattern");
    let mut group = criterion.benchmark_group("camera samples, all threads");
    group.throughput(Throughput::Elements(
        scene.samples_per_frame(options.samples_per_pixel),
    ));
    for (name, speckle) in [
        ("laser line", None),
        ("laser line with speckle", Some(&model)),
    ] {
        group.bench_function(name, |bencher| {
            let cancel = AtomicBool::new(false);
            bencher.iter(|| render_frame(&scene, speckle, 0, &options, |_| (), &cancel));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = intersections, renders
}
criterion_main!(benches);
