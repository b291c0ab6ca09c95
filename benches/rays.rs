//! Rays per second through the tracer's intersector, and the time to build its hierarchy.
//!
//! An open box of [−1, 1]³ m with a displaced sphere of 1 thousand, 262 thousand and 1 million
//! triangles, and a square area light of 0.5 m under its ceiling. Camera rays come 64 to a pixel of
//! a 512² image, shadow rays go from where those end to points of the area light, second rays leave
//! there as from a diffuse surface, and scattered rays join random points of a sphere.
//!
//! The peer is the CWBVH of obvhs over the same triangles, one ray at a time; the rectangles are
//! two triangles each. It follows closest hits twice: in single precision with its own triangle
//! test, and with the tracer's watertight test in double precision.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use std::{f64::consts::PI, hint::black_box, time::Duration};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use obvhs::{
    BvhBuildParams, cwbvh::CwBvh, cwbvh::builder::build_cwbvh_from_tris, ray::RayHit,
    triangle::Triangle,
};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use tem00::camera::Ray;
use tem00::geometry::{Hit, Intersector, Rectangle, Segment, Shape, TriangleMesh};
use tem00::tracer::LocalFrame;

/// Every eighth pixel of a 512² image in both directions, and the rays of each.
const PIXELS: usize = 64;
const PITCH: usize = 8;
const SAMPLES: usize = 64;

/// A sphere of `columns` × `rows` quadrilaterals with ripples.
fn displaced_sphere(columns: u32, rows: u32) -> TriangleMesh {
    let vertex = |i: u32, j: u32| {
        let phi = 2.0 * PI * f64::from(i) / f64::from(columns);
        let theta = PI * (f64::from(j) + 0.5) / f64::from(rows + 1);
        let radius = 0.5 + 0.025 * (13.0 * phi).sin() * (17.0 * theta).sin();
        radius * direction(theta.cos(), phi) - 0.2 * DVec3::Y
    };
    let places = |rows: u32| (0..rows).flat_map(move |j| (0..columns).map(move |i| (i, j)));
    let vertices = places(rows + 1).map(|(i, j)| vertex(i, j)).collect();
    let triangles = places(rows).flat_map(|(i, j)| {
        let at = |i: u32, j: u32| j * columns + i % columns;
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(vertices, triangles.collect()).expect("a valid mesh")
}

fn direction(cosine: f64, azimuth: f64) -> DVec3 {
    let radius = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), cosine)
}

/// The walls of the box, open towards +z, and the area light.
fn rectangles() -> Vec<Rectangle> {
    let [x, y, z] = DVec3::AXES;
    let light = (0.99 * y, 0.25 * x, 0.25 * z);
    let walls = [(-y, z, x), (y, x, z), (-z, x, y), (-x, y, z), (x, z, y)];
    let all = walls.into_iter().chain([light]);
    all.map(|(centre, u, v)| Rectangle::new(centre, u, v).expect("a valid rectangle"))
        .collect()
}

fn shapes(columns: u32, rows: u32) -> Vec<Shape> {
    let mesh = Shape::from(displaced_sphere(columns, rows));
    let walls = rectangles().into_iter().map(Shape::Rectangle);
    walls.chain([mesh]).collect()
}

/// Rays of each kind, and the segments to the area light.
struct Work {
    camera: Vec<Ray>,
    second: Vec<Ray>,
    scattered: Vec<Ray>,
    shadows: Vec<Segment>,
}

impl Work {
    fn new(intersector: &Intersector) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let camera = camera_rays(&mut random);
        let (mut second, mut shadows) = (Vec::new(), Vec::new());
        for ray in &camera {
            let Some(hit) = intersector.intersect(ray) else {
                continue;
            };
            let [u, v, cosine, azimuth]: [f64; 4] = random.random();
            shadows.push(Segment {
                from: hit.position,
                from_normal: hit.normal,
                to: DVec3::new(0.5 * u - 0.25, 0.99, 0.5 * v - 0.25),
            });
            let normal = hit.normal * -hit.normal.dot(ray.direction).signum();
            let leaves = direction(cosine.sqrt(), 2.0 * PI * azimuth);
            second.push(Ray {
                origin: intersector.leave(hit.position, normal),
                direction: LocalFrame::from_normal(normal).to_world(leaves),
            });
        }
        Self {
            camera,
            second,
            scattered: scattered_rays(&mut random),
            shadows,
        }
    }
}

fn camera_rays(random: &mut ChaCha8Rng) -> Vec<Ray> {
    let side = (PIXELS * PITCH) as f64;
    (0..PIXELS * PIXELS * SAMPLES)
        .map(|i| {
            let [u, v]: [f64; 2] = random.random();
            let pixel = i / SAMPLES;
            let x = ((pixel % PIXELS * PITCH) as f64 + u) / side - 0.5;
            let y = 0.5 - ((pixel / PIXELS * PITCH) as f64 + v) / side;
            Ray {
                origin: 3.5 * DVec3::Z,
                direction: DVec3::new(0.8 * x, 0.8 * y, -1.0).normalize(),
            }
        })
        .collect()
}

fn scattered_rays(random: &mut ChaCha8Rng) -> Vec<Ray> {
    let mut point = || {
        let [u, v]: [f64; 2] = random.random();
        0.9 * direction(2.0 * u - 1.0, 2.0 * PI * v)
    };
    (0..65_536)
        .map(|_| {
            let origin = point();
            Ray {
                origin,
                direction: (point() - origin).normalize(),
            }
        })
        .collect()
}

/// The same scene in the peer.
struct Peer {
    boxes: CwBvh,
    triangles: Vec<Triangle>,
    corners: Vec<[DVec3; 3]>,
}

impl Peer {
    fn new(mesh: &TriangleMesh) -> Self {
        let corners = |corners: &[u32; 3]| corners.map(|index| mesh.vertices()[index as usize]);
        let mut corners: Vec<_> = mesh.triangles().iter().map(corners).collect();
        for rectangle in rectangles() {
            let [a, b, c, d] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                .map(|(u, v)| rectangle.point(u, v));
            corners.extend([[a, b, c], [a, c, d]]);
        }
        let triangles: Vec<_> = corners.iter().copied().map(triangle).collect();
        let preset = BvhBuildParams::slow_build();
        let boxes = build_cwbvh_from_tris(&triangles, preset, &mut Duration::default());
        Self {
            boxes,
            triangles,
            corners,
        }
    }

    fn meet(&self, ray: &obvhs::ray::Ray, slot: usize) -> f32 {
        self.triangles[self.boxes.primitive_indices[slot] as usize].intersect(ray)
    }

    fn intersect(&self, ray: &Ray) -> f32 {
        let mut hit = RayHit::none();
        let meet = |ray: &obvhs::ray::Ray, slot: usize| self.meet(ray, slot);
        self.boxes.ray_traverse(endless(ray), &mut hit, meet);
        hit.t
    }

    /// Decides in double precision; the bounds of the traversal are not padded for it.
    fn intersect_exactly(&self, ray: &Ray) -> f64 {
        let sheared = ShearedRay::new(ray);
        let mut nearest = f64::INFINITY;
        let meet = |_: &obvhs::ray::Ray, slot: usize| {
            let corners = &self.corners[self.boxes.primitive_indices[slot] as usize];
            if let Some(distance) = sheared.distance(corners) {
                nearest = nearest.min(distance);
            }
            #[expect(clippy::cast_possible_truncation, reason = "the peer is in f32")]
            let end = nearest as f32;
            end
        };
        self.boxes
            .ray_traverse(endless(ray), &mut RayHit::none(), meet);
        nearest
    }

    fn visible(&self, segment: &Segment) -> bool {
        let way = segment.to - segment.from;
        let (origin, direction) = (segment.from.as_vec3a(), way.normalize().as_vec3a());
        #[expect(clippy::cast_possible_truncation, reason = "the peer is in f32")]
        let end = way.length() as f32 - 1e-4;
        let ray = obvhs::ray::Ray::new(origin, direction, 1e-4, end);
        let meet = |ray: &obvhs::ray::Ray, slot: usize| self.meet(ray, slot);
        self.boxes.ray_traverse_miss(ray, meet)
    }
}

/// A ray with the shear that turns it into the third axis (Woop, Benthin and Wald 2013), as in the
/// tracer.
struct ShearedRay {
    origin: DVec3,
    axes: [usize; 3],
    shear: DVec3,
}

impl ShearedRay {
    fn new(ray: &Ray) -> Self {
        let direction = ray.direction;
        let main = direction.abs().max_position();
        let axes = [(main + 1) % 3, (main + 2) % 3, main];
        let shear = DVec3::new(direction[axes[0]], direction[axes[1]], 1.0) / direction[main];
        Self {
            origin: ray.origin,
            axes,
            shear,
        }
    }

    fn to_local(&self, point: DVec3) -> DVec3 {
        let offset = point - self.origin;
        let [x, y, z] = self.axes.map(|axis| offset[axis]);
        DVec3::new(x - self.shear.x * z, y - self.shear.y * z, self.shear.z * z)
    }

    fn distance(&self, corners: &[DVec3; 3]) -> Option<f64> {
        let [a, b, c] = corners.map(|corner| self.to_local(corner));
        let area = |p: DVec3, q: DVec3| p.x * q.y - p.y * q.x;
        let weights = DVec3::new(area(c, b), area(a, c), area(b, a));
        let outside = weights.min_element() < 0.0 && weights.max_element() > 0.0;
        let distance = weights.dot(DVec3::new(a.z, b.z, c.z)) / weights.element_sum();
        (!outside && distance > 0.0).then_some(distance)
    }
}

fn endless(ray: &Ray) -> obvhs::ray::Ray {
    let (origin, direction) = (ray.origin.as_vec3a(), ray.direction.as_vec3a());
    obvhs::ray::Ray::new(origin, direction, 1e-6, f32::MAX)
}

fn triangle(corners: [DVec3; 3]) -> Triangle {
    let [v0, v1, v2] = corners.map(|corner| corner.as_vec3a());
    Triangle { v0, v1, v2 }
}

fn intersections(criterion: &mut Criterion) {
    for (columns, rows) in [(32, 16), (512, 256), (1000, 500)] {
        let shapes = shapes(columns, rows);
        let intersector = Intersector::build(&shapes).expect("a valid scene");
        let peer = Peer::new(&displaced_sphere(columns, rows));
        let work = Work::new(&intersector);
        let name = format!("{} triangles, one thread", 2 * columns * rows);
        let mut group = criterion.benchmark_group(name);
        for (kind, rays) in [
            ("camera", &work.camera),
            ("second", &work.second),
            ("scattered", &work.scattered),
        ] {
            let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
            group.throughput(Throughput::Elements(rays.len() as u64));
            group.bench_function(format!("{kind}, batch"), |bencher| {
                bencher.iter(|| intersector.intersect_batch(black_box(rays), &mut hits));
            });
            group.bench_function(format!("{kind}, one by one"), |bencher| {
                let met = |ray: &&Ray| intersector.intersect(ray).is_some();
                bencher.iter(|| rays.iter().filter(met).count());
            });
            group.bench_function(format!("{kind}, obvhs"), |bencher| {
                bencher.iter(|| rays.iter().map(|ray| peer.intersect(ray)).sum::<f32>());
            });
            group.bench_function(format!("{kind}, obvhs with our test"), |bencher| {
                let exactly = |ray| peer.intersect_exactly(ray);
                bencher.iter(|| rays.iter().map(exactly).sum::<f64>());
            });
        }
        let mut visible = vec![false; work.shadows.len()];
        let segments = &work.shadows;
        group.throughput(Throughput::Elements(segments.len() as u64));
        group.bench_function("shadow, batch", |bencher| {
            bencher.iter(|| intersector.visible_batch(black_box(segments), &mut visible));
        });
        group.bench_function("shadow, one by one", |bencher| {
            let visible = |way: &&Segment| intersector.visible(way.from, way.from_normal, way.to);
            bencher.iter(|| segments.iter().filter(visible).count());
        });
        group.bench_function("shadow, obvhs", |bencher| {
            bencher.iter(|| segments.iter().filter(|way| peer.visible(way)).count());
        });
        group.finish();
    }
}

fn hierarchies(criterion: &mut Criterion) {
    let mesh = displaced_sphere(1000, 500);
    let mut group = criterion.benchmark_group("hierarchy of 1 000 000 triangles");
    group.bench_function("build", |bencher| {
        // A mesh that is placed anew has no hierarchy yet.
        let fresh = || [Shape::from(mesh.clone())];
        let build = |shapes: [Shape; 1]| Intersector::build(&shapes).expect("a valid scene");
        bencher.iter_batched(fresh, build, criterion::BatchSize::PerIteration);
    });
    group.bench_function("obvhs", |bencher| bencher.iter(|| Peer::new(&mesh)));
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = intersections, hierarchies
}
criterion_main!(benches);
