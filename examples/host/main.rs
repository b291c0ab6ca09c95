//! A path tracer of its own under a laser line whose speckle moves with a sphere: all that it knows of this library are
//! the names of one line.
//!
//!     cargo run --release --example host              writes out/host.png, two frames

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

struct Scene<'a> {
    camera: Camera,
    laser: Laser,
    triangles: Vec<Triangle>,
    hierarchy: Bvh2,
    /// Centre and radius.
    sphere: (DVec3, f64),
    /// The speckle of the mesh and of the sphere.
    speckle: [SpeckleFrame<'a>; 2],
}

/// A point of a body, and the normal towards the ray.
type Hit = (DVec3, DVec3, usize);

impl Scene<'_> {
    fn hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let ray = Ray::new(
            origin.as_vec3a(),
            direction.as_vec3a(),
            to_f32(NEAR),
            f32::MAX,
        );
        let triangle =
            |slot: usize| &self.triangles[self.hierarchy.primitive_indices[slot] as usize];
        let (mut hit, meet) = (RayHit::none(), |ray: &Ray, slot| {
            triangle(slot).intersect(ray)
        });
        let is_met = self.hierarchy.ray_traverse(ray, &mut hit, meet);
        let mut nearest = is_met.then(|| {
            let normal = triangle(hit.primitive_id as usize).compute_normal();
            (f64::from(hit.t), normal.as_dvec3(), 0)
        });
        let (centre, radius) = self.sphere;
        let (from, b) = (origin - centre, (origin - centre).dot(direction));
        let root = (b * b - from.length_squared() + radius * radius).sqrt();
        let distance = if -b - root > NEAR {
            -b - root
        } else {
            root - b
        };
        if distance > NEAR && nearest.is_none_or(|(other, ..)| distance < other) {
            nearest = Some((distance, (from + distance * direction) / radius, 1));
        }
        let (distance, normal, body) = nearest?;
        let normal = if normal.dot(direction) < 0.0 {
            normal
        } else {
            -normal
        };
        Some((origin + distance * direction, normal, body))
    }

    fn radiance(&self, pixel: DVec2, random: &mut impl Rng) -> f64 {
        let ray = self.camera.ray(pixel);
        let (mut origin, mut direction) = (ray.origin, ray.direction);
        let (mut radiance, mut factor, mut throughput) = (0.0, None, 1.0);
        for _ in 0..3 {
            let Some((point, normal, body)) = self.hit(origin, direction) else {
                break;
            };
            // All light interferes where the camera sees it, however many surfaces it has met.
            factor = factor.or_else(|| Some(self.speckle[body].factor_at(pixel, point, normal)));
            if let Some(light) = self.laser.next_event(point) {
                let distance = |other: DVec3| other.distance(point);
                let blocker = self.hit(point, light.wi);
                let is_free = blocker.is_none_or(|hit| distance(hit.0) > distance(light.point));
                let cosine = if is_free {
                    light.wi.dot(normal).max(0.0)
                } else {
                    0.0
                };
                radiance += throughput * ALBEDO / PI * cosine * light.e_perp;
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
            let sum: f64 = (0..samples)
                .map(|_| {
                    let [u, v]: [f64; 2] = random.random();
                    let pixel = DVec2::new(x as f64 + u, y as f64 + v);
                    self.camera.irradiance_per_radiance(pixel) * self.radiance(pixel, &mut random)
                })
                .sum();
            to_f32(sum / f64::from(samples))
        })
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let camera = Camera::new(CameraDescription {
        position: DVec3::new(0.0, -0.2, 0.22),
        resolution: [480, 240],
        pixel_pitch: 6.9e-6,
        ..CameraDescription::default()
    })?;
    let laser = Laser::line(650e-9, 0.4e-3, 12_f64.to_radians()).power(10e-3);
    let laser = laser.placed(0.25 * DVec3::Z, DVec3::ZERO, DVec3::X)?;
    let step = Pose::along(DVec3::new(0.05e-3, 0.0, 0.0))?;
    let speckle = Speckle::new(&camera, &laser, 1)
        .for_poses(&[step])
        .prepare()?;
    println!("{speckle}");

    let triangles: Vec<_> = slope(-20.0, 20.0, 0.0)
        .into_iter()
        .chain(slope(2.0, 6.0, 3.0))
        .collect();
    let frame = |pose: Pose| -> Result<Grid<f32>, Box<dyn Error>> {
        let moved = Motion {
            body: 1,
            ..pose.into()
        };
        let scene = Scene {
            camera,
            laser: laser.clone(),
            hierarchy: build_bvh2_from_tris(
                &triangles,
                BvhBuildParams::medium_build(),
                &mut Duration::ZERO,
            ),
            triangles: triangles.clone(),
            sphere: (pose.point(DVec3::new(-4e-3, 0.0, 3e-3)), 3e-3),
            speckle: [speckle.frame(&Motion::default())?, speckle.frame(&moved)?],
        };
        Ok(scene.render(64))
    };
    let frames = [frame(Pose::IDENTITY)?, frame(step)?];
    let brightest = frames[0]
        .values()
        .iter()
        .fold(0.0_f32, |most, &value| most.max(value));
    let frames = frames.map(|frame| frame.map(|&value| 20.0 * value / brightest));
    println!("{}", picture::write("host", &frames)?.display());
    Ok(())
}

/// A strip from one x to another that rises, in millimetres.
fn slope(from: f32, to: f32, rise: f32) -> [Triangle; 2] {
    let at = |x: f32, y: f32, z: f32| 1e-3 * Vec3A::new(x, y, z);
    let [a, b] = [-20.0, 20.0].map(|y| at(from, y, 0.0));
    let [c, d] = [-20.0, 20.0].map(|y| at(to, y, rise));
    [
        Triangle {
            v0: a,
            v1: c,
            v2: b,
        },
        Triangle {
            v0: c,
            v1: d,
            v2: b,
        },
    ]
}
