//! The speckle of hits on a card against the library in double precision.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00_beam::{FanGeometry, FocusCurve, LineProfile};
use tem00_decorrelation::CorrelationLaw;
use tem00_gpu::{Gpu, GpuStack};
use tem00_shading::{
    BeamShape, Camera, CameraDescription, DVec2, DVec3, Laser, LaserDescription, Motion, Pose,
    Speckle, WGSL,
};
use tem00_speckle::SpeckleStack;

use crate::{factors, kernel::evaluate};

/// The frame, a point and its normal.
type Input = [f32; 62];

const BODY: &str = "
    let frame = Tem00SpeckleFrame(
        vector(0u), input(3u), vector(4u), input(7u), vector(8u), input(11u), vector(12u), \
            input(15u),
        row(16u), vector(20u), input(23u), row(24u), vector(28u), input(31u),
        vector(32u), input(35u), vector(36u), input(39u), vector(40u), input(43u), vector(44u), \
            input(47u),
        vec2(input(48u), input(49u)), vec2(input(50u), input(51u)), row(52u),
    );
    let at = tem00_speckle(frame, vector(56u), vector(59u));
    output(0u, at.displacement.x);
    output(1u, at.displacement.y);
    output(2u, at.correlation);
    output(3u, at.slice);
    output(4u, f32(at.seen));
";

/// What the host defines.
const HOST: &str = "
    fn vector(i: u32) -> vec3<f32> { return vec3(input(i), input(i + 1u), input(i + 2u)); }
    fn row(i: u32) -> vec4<f32> { return vec4(vector(i), input(i + 3u)); }
    fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> { return vec2(1.0); }
    fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> { return vec4(1.0); }
";

struct Random(ChaCha8Rng);

/// A camera and a laser, both as they are in the reference state, and what has moved since.
struct Scene {
    camera: Camera,
    laser: Laser,
    motion: Motion,
    /// A motion in another frame.
    other: Motion,
    /// Points as they are now, with unit normals.
    hits: Vec<(DVec3, DVec3)>,
}

impl Random {
    fn within(&mut self, size: f64) -> f64 {
        self.0.random_range(-size..size)
    }

    fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.within(size)))
    }

    /// A place some 0.3 m above the scene, of numbers that f32 holds.
    fn place(&mut self) -> DVec3 {
        single(DVec3::new(
            self.within(0.2),
            self.within(0.2),
            0.3 + self.within(0.1),
        ))
    }

    /// A turn about a point near the scene, and a step.
    fn pose(&mut self, turn: f64, step: f64) -> Pose {
        let turn = Pose::about(self.vector(0.01), self.vector(1.0), turn * self.within(1.0));
        turn.unwrap().then(&Pose::along(self.vector(step)).unwrap())
    }

    /// A laser near the camera, so that what comes nearer keeps some speckle.
    fn laser(&mut self, eye: DVec3, is_line: bool) -> Laser {
        let line_direction = DVec3::new(1.0, self.within(1.0), 0.0);
        let radius = 2e-4 * (1.0 + self.within(0.5));
        let shape = if is_line {
            BeamShape::Line {
                waist_radius: radius,
                m_squared: 1.2,
                fan: FanGeometry {
                    fan_angle: 0.3,
                    apex_offset: 0.01 + self.within(5e-3),
                    focus_distance: 0.3 + self.within(0.1),
                    focus_curve: [FocusCurve::EqualDistance, FocusCurve::EqualPlane]
                        [usize::from(self.within(1.0) > 0.0)],
                },
                profile: LineProfile::Powell { edge: 0.05 },
            }
        } else {
            BeamShape::Spot {
                waist_radius: [radius, 3.0 * radius],
                waist_distance: [0.3 + self.within(0.1), self.within(0.5)],
                m_squared: [1.0, 1.3],
            }
        };
        // The scene lies beside the middle of a fan.
        let beside = if is_line { 0.05 } else { 0.0 } * line_direction;
        let (origin, target) = (eye + self.vector(0.05), self.vector(1e-3) + beside);
        let spot = Laser::spot(650e-9, radius).placed(origin, target, line_direction);
        let description = LaserDescription {
            shape,
            ..spot.unwrap().description().clone()
        };
        Laser::new(description).unwrap()
    }

    /// A scene in which the pupil moves by some tenths of its diameter, and points by some tenths
    /// of the axial length.
    fn scene(&mut self, number: u32) -> Scene {
        let eye = self.place();
        let f_number = [2.8, 5.6, 16.0][number as usize % 3];
        let camera = Camera::new(CameraDescription {
            position: eye,
            look_at: self.vector(2e-3),
            focus_distance: eye.length() * (1.0 + self.within(0.05)),
            focal_length: 16e-3,
            f_number,
            resolution: [80, 60],
            ..CameraDescription::default()
        });
        let camera = camera.unwrap();
        let laser = self.laser(eye, number % 2 == 1);
        let diameter = camera.pupil_diameter();
        let axial_length = 8.0 * laser.wavelength() * (eye.length() / diameter).powi(2);
        let nearer = axial_length.min(0.1) * self.within(1.0);
        let lift = Pose::along(eye.normalize() * nearer).unwrap();
        // Camera and laser move in one scene of two.
        let mut other = |turn: f64| match number % 4 > 1 {
            true => self.pose(turn * diameter, 0.1 * diameter),
            false => Pose::IDENTITY,
        };
        let (camera_pose, laser_pose) = (other(0.1), other(0.1));
        let motion = Motion {
            body: number as usize % 3,
            surface: self.pose(0.1 * diameter, 0.1 * diameter).then(&lift),
            camera: camera_pose,
            laser: laser_pose,
        };
        let hits = (0..200).map(|_| {
            let point = self.vector(1e-3);
            let facing = (eye - point).normalize() + self.vector(1.0);
            (
                single(motion.surface.point(point)),
                single(facing.normalize()),
            )
        });
        // And one behind the lens.
        let behind = [(single(2.0 * eye), DVec3::Z)];
        let hits = hits.chain(behind).collect();
        Scene {
            camera,
            laser,
            motion,
            other: Motion::default(),
            hits,
        }
    }
}

impl Scene {
    fn speckle(&self) -> Speckle {
        Speckle::new(&self.camera, &self.laser, 7)
            .for_motions([self.motion, self.other])
            .within(64 << 20)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
fn rounded(v: DVec3) -> [f32; 3] {
    v.to_array().map(|x| x as f32)
}

fn single(v: DVec3) -> DVec3 {
    DVec3::from_array(rounded(v).map(f64::from))
}

/// A frame on the other side of the reference state than the one that has moved farthest.
fn opposite() -> Scene {
    let camera = Camera::new(CameraDescription {
        position: DVec3::new(0.0, 0.125, 0.25),
        resolution: [80, 60],
        ..CameraDescription::default()
    });
    let laser = Laser::spot(650e-9, 2e-4).placed(DVec3::Z * 0.5, DVec3::ZERO, DVec3::X);
    let [motion, other] = [1e-4, -3e-4].map(|x| Pose::along(DVec3::X * x).unwrap().into());
    let hit = |i: i32| (single(DVec3::X * 1e-5 * f64::from(i)), DVec3::Z);
    Scene {
        camera: camera.unwrap(),
        laser: laser.unwrap(),
        motion,
        other,
        hits: (-50..50).map(hit).collect(),
    }
}

fn scenes(count: u32) -> Vec<Scene> {
    let mut random = Random(ChaCha8Rng::seed_from_u64(5));
    (0..count).map(|number| random.scene(number)).collect()
}

/// The unit roundoff of the card, twice: that of a difference.
const EPSILON: f64 = 1.2e-7;

#[test]
fn displacements_and_correlations_are_those_of_the_law() {
    let gpu = Gpu::new().expect("an adapter");
    let source = [
        tem00_decorrelation::closed_form::WGSL,
        tem00_speckle::closed_form::WGSL,
        WGSL,
        HOST,
    ]
    .concat();
    // Points that have kept a part: all, and those that moved across and along at once. And new
    // ones.
    let mut partial = [0; 3];
    for scene in scenes(30) {
        let prepared = scene.speckle().prepare().unwrap();
        let frame = prepared.frame(&scene.motion).unwrap();
        let kernel = scene.speckle().for_kernel().unwrap();
        let stack = SpeckleStack::generate(kernel.field(), kernel.path()).unwrap();
        let rows = kernel.rows(&scene.motion).unwrap();
        let inputs: Vec<Input> = scene
            .hits
            .iter()
            .map(|&(point, normal)| {
                let numbers = rows.as_flattened().iter().copied();
                let numbers = numbers.chain(rounded(point)).chain(rounded(normal));
                numbers.collect::<Vec<_>>().try_into().unwrap()
            })
            .collect();
        // Samples per slope of the line of sight, and per pixel.
        let per_slope = f64::from(rows[3][3]);
        // That of the tighter waist, at L < 0.4 m.
        let [along, across, ..] = rows[12].map(f64::from);
        let rayleigh_squared = if along > 0.0 {
            along.min(across)
        } else {
            across
        };
        let geometry = prepared.geometry();
        let diameter = geometry.pupil_diameter();
        let eye = scene.motion.camera.point(scene.camera.position());
        let samples = per_slope * geometry.pixel_pitch() / geometry.principal_distance();
        let found: Vec<[f32; 5]> = evaluate(&gpu, &source, BODY, &inputs);
        for (&(point, normal), [x, y, correlation, slice, seen]) in scene.hits.iter().zip(found) {
            let Some(shift) = frame.shift(point, normal) else {
                assert!(seen < 0.5, "{point} is in sight");
                continue;
            };
            let [x, y, correlation] = [x, y, correlation].map(f64::from);
            // From one axial length on the revivals are left out.
            let is_left = shift.axial.abs() < 1.0 && shift.pupil.is_finite();
            let across = if is_left { shift.across.length() } else { 1.0 };
            let expected = CorrelationLaw::AtPeak.correlation(across, shift.axial);
            // What moves in the pupil is off by 4 ε of all motions: more near a waist, and by its
            // slant where a surface is not seen from above. The slope of γ is 8/π at most.
            let origin = scene.motion.surface.inverse().point(point);
            let moved = (point - origin).length() + 0.1 * diameter * (1.0 + across);
            let cosine = normal.dot((eye - point).normalize()).abs();
            let pupil = 4.0 * EPSILON * moved * (1.0 + 0.16 / rayleigh_squared) / cosine;
            let error = (correlation - expected).abs();
            assert!(
                error < 1e-5 + 2.6 * pupil / diameter,
                "{point}, {normal}: γ = {correlation}, not {expected}"
            );
            let looked_up = stack.correlation_at(slice.into());
            assert!(
                (looked_up - expected).abs() < 2e-5 + 2.6 * pupil / diameter,
                "{point}, {normal}: u = {slice} has γ = {looked_up}, not {expected}"
            );
            // At L > 0.2 m, and with a defocus of less than 1 per metre.
            let upwards = DVec2::new(1.0, -1.0);
            let apart = DVec2::new(x, y) - shift.displacement * upwards * samples;
            let allowed = per_slope * (4.0 * EPSILON * moved / 0.2 + pupil);
            assert!(
                apart.length() < allowed,
                "{point}, {normal}: {apart} samples apart, not {allowed}"
            );
            let kept = (0.05..0.95).contains(&expected);
            partial[0] += u32::from(kept);
            partial[1] += u32::from(kept && shift.axial.abs() > 0.1 && across > 0.05);
            partial[2] += u32::from(shift.pupil.is_infinite());
        }
    }
    assert!(
        partial[0] > 1000 && partial[1] > 500 && partial[2] > 10,
        "{partial:?}"
    );
}

#[test]
fn factors_are_those_of_the_library() {
    let gpu = Gpu::new().expect("an adapter");
    let (mut worst, mut squares, mut count) = (0.0_f64, 0.0, 0.0);
    for scene in scenes(24).into_iter().chain([opposite()]) {
        let kernel = scene.speckle().for_kernel().unwrap();
        let stack = GpuStack::generate(&gpu, kernel.field(), kernel.path()).unwrap();
        let rows = kernel.rows(&scene.motion).unwrap();
        let row = |v| {
            let [x, y, z] = rounded(v);
            [x, y, z, 0.0]
        };
        let hits = scene
            .hits
            .iter()
            .map(|&(point, normal)| [row(point), row(normal)]);
        let found = factors::on_card(&gpu, &stack, &rows, &hits.collect::<Vec<_>>()).unwrap();
        let prepared = scene.speckle().prepare().unwrap();
        let frame = prepared.frame(&scene.motion).unwrap();
        // The rms change of the amplitude by ε of the principal distance: half a wave over a
        // speckle at the rim.
        let step = EPSILON * f64::from(rows[3][3]) * core::f64::consts::FRAC_PI_2
            / kernel.field().speckle_size();
        for (&(point, normal), factor) in scene.hits.iter().zip(found) {
            let apart = (frame.factor(point, normal) - f64::from(factor)).abs() / step;
            worst = worst.max(apart);
            squares += apart * apart;
            count += 1.0;
        }
    }
    // Coordinates are off by ε in rms, and by 4 ε at worst where the amplitude changes five times
    // as fast.
    let rms = f64::sqrt(squares / count);
    assert!(rms < 1.0 && worst < 20.0, "{rms} in rms, {worst} at worst");
}

#[test]
fn the_example_agrees_with_the_library() {
    factors::main().unwrap();
}
