//! A path tracer of its own under a laser line whose speckle moves with a sphere: of this library
//! it knows a handful of names.
//!
//!     cargo run --release --example host              writes out/host.png, two frames

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

#[path = "../picture/mod.rs"]
mod picture;

use std::{error::Error, f64::consts::PI, time::Duration};

use glam::{DVec2, DVec3, Vec3A};
use obvhs::bvh2::{Bvh2, builder::build_bvh2_from_tris};
use obvhs::{BvhBuildParams, ray::Ray, ray::RayHit, triangle::Triangle};
use rand::{Rng, RngExt, SeedableRng, rngs::SmallRng};
use tem00::numerics::{Grid, cast::to_f32};
use tem00::{Camera, CameraDescription, Laser, Motion, Pose, Speckle, SpeckleFrame};

const ALBEDO: f64 = 0.8;
/// What is nearer to the origin of a ray, in metres, is the surface that it starts from.
const NEAR: f64 = 1e-6;
const MESH: usize = 0;
const SPHERE: usize = 1;

struct Scene {
    camera: Camera,
    laser: Laser,
    triangles: Vec<Triangle>,
    hierarchy: Bvh2,
    /// Centre and radius.
    sphere: (DVec3, f64),
    /// Of the mesh and of the sphere.
    speckle: [SpeckleFrame; 2],
}

impl Scene {
    /// The point that a ray meets, the normal towards the ray, and the body.
    fn hit(&self, origin: DVec3, direction: DVec3) -> Option<(DVec3, DVec3, usize)> {
        let [start, along] = [origin, direction].map(|vector| vector.as_vec3a());
        let ray = Ray::new(start, along, to_f32(NEAR), f32::MAX);
        let slots = &self.hierarchy.primitive_indices;
        let triangle = |slot: usize| &self.triangles[slots[slot] as usize];
        let mut hit = RayHit::none();
        let meet = |ray: &Ray, slot: usize| triangle(slot).intersect(ray);
        let mut nearest = (f64::INFINITY, DVec3::ZERO, MESH);
        if self.hierarchy.ray_traverse(ray, &mut hit, meet) {
            let normal = triangle(hit.primitive_id as usize).compute_normal();
            nearest = (f64::from(hit.t), normal.as_dvec3(), MESH);
        }
        let (centre, radius) = self.sphere;
        let from = origin - centre;
        let b = from.dot(direction);
        let root = (b * b - from.length_squared() + radius * radius).sqrt();
        for distance in [-b - root, root - b] {
            if distance > NEAR && distance < nearest.0 {
                nearest = (distance, (from + distance * direction) / radius, SPHERE);
            }
        }
        let (distance, normal, body) = nearest;
        let towards = -normal.dot(direction).signum() * normal;
        (distance.is_finite()).then_some((origin + distance * direction, towards, body))
    }

    /// The radiance of the laser's light along a path that begins at an image point.
    fn radiance(&self, pixel: DVec2, random: &mut impl Rng) -> f64 {
        let ray = self.camera.ray(pixel);
        let (mut origin, mut direction) = (ray.origin, ray.direction);
        let (mut radiance, mut factor, mut throughput) = (0.0, None, 1.0);
        for _ in 0..3 {
            let Some((point, normal, body)) = self.hit(origin, direction) else {
                break;
            };
            // All light interferes where the camera sees it, however many surfaces it has met.
            let speckle = || self.speckle[body].factor_at(pixel, point, normal);
            factor = factor.or_else(|| Some(speckle()));
            if let Some(light) = self.laser.next_event(point) {
                let shadow = self.hit(point, light.wi);
                let distance = light.point.distance(point);
                if shadow.is_none_or(|(blocker, ..)| blocker.distance(point) > distance) {
                    let cosine = light.wi.dot(normal).max(0.0);
                    radiance += throughput * ALBEDO / PI * cosine * light.e_perp;
                }
            }
            let [u, v]: [f64; 2] = random.random();
            let (x, y) = normal.any_orthonormal_pair();
            let across = u.sqrt() * DVec2::from_angle(2.0 * PI * v);
            direction = across.x * x + across.y * y + (1.0 - u).sqrt() * normal;
            (origin, throughput) = (point, throughput * ALBEDO);
        }
        radiance * factor.unwrap_or(0.0)
    }

    /// The irradiance of the sensor, in W/m², from so many samples a pixel.
    fn render(&self, samples: u32) -> Grid<f32> {
        Grid::from_fn(self.camera.width(), self.camera.height(), |x, y| {
            let mut random = SmallRng::seed_from_u64((y << 32 | x) as u64);
            let sample = |_| {
                let [u, v]: [f64; 2] = random.random();
                let pixel = DVec2::new(x as f64 + u, y as f64 + v);
                self.camera.irradiance_per_radiance(pixel) * self.radiance(pixel, &mut random)
            };
            to_f32((0..samples).map(sample).sum::<f64>() / f64::from(samples))
        })
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let camera = Camera::new(CameraDescription {
        position: DVec3::new(0.0, -0.2, 0.22),
        pixel_pitch: 6.9e-6,
        resolution: [480, 200],
        ..CameraDescription::default()
    })?;
    let laser = Laser::line(650e-9, 0.4e-3, 12_f64.to_radians()).power(10e-3);
    let laser = laser.placed(0.25 * DVec3::Z, DVec3::ZERO, DVec3::X)?;
    let step = Pose::along(DVec3::new(0.05e-3, 0.0, 0.0))?;
    let speckle = Speckle::new(&camera, &laser, 1).for_poses(&[step]);
    let speckle = speckle.prepare()?;
    println!("{speckle}");

    let frame = |surface: Pose| -> Result<Grid<f32>, Box<dyn Error>> {
        let triangles = [strip(-20.0, 20.0, 0.0), strip(2.0, 6.0, 3.0)].concat();
        let settings = BvhBuildParams::medium_build();
        let mut moved = Motion::from(surface);
        moved.body = SPHERE;
        let scene = Scene {
            camera,
            laser: laser.clone(),
            hierarchy: build_bvh2_from_tris(&triangles, settings, &mut Duration::default()),
            triangles,
            sphere: (surface.point(DVec3::new(-4e-3, 0.0, 3e-3)), 3e-3),
            // Once per body and frame: the mesh stands still.
            speckle: [speckle.frame(&Motion::default())?, speckle.frame(&moved)?],
        };
        Ok(scene.render(16).map(|&irradiance| irradiance / 2.0))
    };
    let frames = [frame(Pose::IDENTITY)?, frame(step)?];
    println!("{}", picture::write("host", &frames)?.display());
    Ok(())
}

/// Two triangles from one x to another that rise, in millimetres.
fn strip(from: f32, to: f32, rise: f32) -> [Triangle; 2] {
    let edge = |x: f32, z: f32| [-20.0, 20.0].map(|y| 1e-3 * Vec3A::new(x, y, z));
    let ([a, b], [c, d]) = (edge(from, 0.0), edge(to, rise));
    [[a, c, b], [c, d, b]].map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
}
