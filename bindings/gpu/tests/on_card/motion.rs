//! Displacement and correlation of speckle on a card against the library in double precision.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, DMat3, DVec2, DVec3, FieldLight, FieldPoints,
    FieldSetup, FieldSlices, Illumination, ImageOrientation, ImagingGeometry, MotionField,
    PupilDistances, RigidMotion, RigidMotions, SpeckleMotion, Wavefront, closed_form::WGSL,
};
use tem00_gpu::Gpu;
use tem00_speckle::{Pupil, PupilField, SlicePath, SpeckleStack};

use crate::kernel::evaluate;

/// Imaging, vector to the pupil, normal, motion, rotation, kind of light, source and curvature.
type Input = [f32; 39];
/// Speckle and pupil displacement, pattern coordinate, correlation.
type Output = [f32; 7];

const BODY: &str = "
    let imaging = Tem00Imaging(
        vector(0u), input(3u), vector(4u), input(7u), vector(8u), input(11u),
        input(12u), input(13u), vec2(0.0),
    );
    let motion = vector(22u);
    let source = vector(30u);
    let curvature = mat3x3(
        input(33u), input(34u), input(35u),
        input(34u), input(36u), input(37u),
        input(35u), input(37u), input(38u),
    );
    var light = tem00_collimated(source);
    if input(29u) == 1.0 { light = tem00_point_source(source, motion); }
    if input(29u) == 2.0 { light = tem00_wavefront(source, curvature, motion); }
    let rotation = vec4(vector(25u), input(28u));
    let moved = tem00_speckle_motion(imaging, vector(16u), vector(19u), motion, rotation, light);
    output(0u, moved.speckle_displacement.x);
    output(1u, moved.speckle_displacement.y);
    output(2u, moved.pupil_displacement.x);
    output(3u, moved.pupil_displacement.y);
    output(4u, moved.pattern_coordinate.x);
    output(5u, moved.pattern_coordinate.y);
    output(6u, moved.correlation);
";

/// What the host defines.
const HOST: &str = "
    fn vector(i: u32) -> vec3<f32> { return vec3(input(i), input(i + 1u), input(i + 2u)); }
    fn tem00_slice_overlaps(slice: u32) -> vec2<f32> { return vec2(1.0); }
";

fn on_card(inputs: &[Input]) -> Vec<Output> {
    let gpu = Gpu::new().expect("an adapter");
    evaluate(&gpu, &format!("{WGSL}{HOST}"), BODY, inputs)
}

/// A camera at the origin with a pupil of 1/`ratio` of its distance from the surface in focus.
fn field(ratio: f64, orientation: ImageOrientation) -> MotionField {
    let geometry = ImagingGeometry::from_distances(PupilDistances {
        wavelength: 650e-9,
        surface_to_pupil: 0.3,
        pupil_to_image: 0.1,
        pupil_diameter: 0.3 / ratio,
        pixel_pitch: 3.45e-6,
    });
    let target = DVec3::new(0.2, -0.5, 0.4);
    MotionField::new(FieldSetup {
        geometry: geometry.expect("a geometry"),
        camera: CameraFrame::look_at(DVec3::ZERO, target, DVec3::Y).expect("a view"),
        pupil_centre: DVec3::ZERO,
        orientation,
        pattern_speckle_size: 4.0,
    })
    .expect("a field")
}

struct Random(ChaCha8Rng);

impl Random {
    fn within(&mut self, size: f64) -> f64 {
        self.0.random_range(-size..size)
    }

    fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.within(size)))
    }

    /// A vector to the pupil, near the surface in focus; one in 16 from behind the camera.
    fn sight(&mut self, camera: &CameraFrame) -> DVec3 {
        let depth = 0.3 * (1.0 + self.within(0.3));
        let depth = if self.within(1.0) > 0.875 {
            -depth
        } else {
            depth
        };
        let across = camera.right() * self.within(0.4) + camera.up() * self.within(0.4);
        (camera.towards_camera() + across) * depth
    }

    /// A motion and the vector part of a rotation that move the speckle over much of the pupil.
    fn motion(&mut self, field: &MotionField) -> (DVec3, DVec3) {
        let (geometry, camera) = (field.setup().geometry, field.setup().camera);
        let diameter = geometry.pupil_diameter();
        let [right, up] = [(); 2].map(|()| self.within(0.4 * diameter));
        let towards = self.within(geometry.axial_decorrelation_length().min(diameter));
        let motion = camera.right() * right + camera.up() * up + camera.towards_camera() * towards;
        (motion, self.vector(0.2 * diameter / 0.3))
    }

    /// One of the kinds of light on a side of a surface.
    fn light(&mut self, normal: DVec3) -> [f64; 10] {
        let direction = (normal + self.vector(0.5)).normalize();
        let [along, across] = [(); 2].map(|()| self.within(8.0));
        let wave = Wavefront::astigmatic(direction, self.vector(1.0), along, across);
        let k = wave.expect("a wave").curvature().to_cols_array();
        let kind = self.0.random_range(0..3_u8);
        let source = if kind == 1 {
            direction * (0.3 + self.within(0.2))
        } else {
            direction
        };
        let [x, y, z] = source.to_array();
        [kind.into(), x, y, z, k[0], k[1], k[2], k[4], k[5], k[8]]
    }

    fn input(&mut self, field: &MotionField) -> Input {
        let imaging = field.to_rows().expect("a field in f32");
        let to_pupil = self.sight(&field.setup().camera);
        let normal = to_pupil.normalize() + self.vector(0.5);
        let (motion, turn) = self.motion(field);
        let [x, y, z] = turn.to_array();
        let rotation = [x, y, z, (1.0 - turn.length_squared()).sqrt()];
        let mut numbers = Vec::new();
        numbers.extend(to_pupil.to_array());
        // Of any length, to either side.
        numbers.extend((normal * self.within(3.0)).to_array());
        numbers.extend(motion.to_array());
        numbers.extend(rotation);
        numbers.extend(self.light(normal));
        let numbers = numbers.into_iter().map(single);
        let all: Vec<_> = imaging.into_iter().flatten().chain(numbers).collect();
        all.try_into().expect("39 numbers")
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
fn single(x: f64) -> f32 {
    x as f32
}

fn vector(input: &Input, i: usize) -> DVec3 {
    DVec3::new(input[i].into(), input[i + 1].into(), input[i + 2].into())
}

/// The motion about the point.
fn rigid(input: &Input, point: DVec3) -> RigidMotion {
    let (turn, cosine) = (vector(input, 25), f64::from(input[28]));
    let length = turn.length().hypot(cosine);
    let (turn, cosine) = (turn / length, cosine / length);
    let rotated = |v: DVec3| v + 2.0 * turn.cross(cosine * v + turn.cross(v));
    let rotation = DMat3::from_cols(rotated(DVec3::X), rotated(DVec3::Y), rotated(DVec3::Z));
    let motion = vector(input, 22);
    RigidMotion::new(rotation, point + motion - rotation * point).expect("a rotation")
}

fn illumination(input: &Input, point: DVec3) -> Illumination {
    let (source, k) = (vector(input, 30), |i: usize| f64::from(input[i]));
    match input[29] {
        0.0 => Illumination::collimated(source),
        1.0 => Illumination::point_source(point + source),
        _ => {
            let [xx, xy, xz, yy, yz, zz] = [33, 34, 35, 36, 37, 38].map(k);
            let tensor = DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
            Wavefront::from_tensor(source, tensor).and_then(|wave| Illumination::near(point, wave))
        }
    }
    .expect("light")
}

/// What the library says in double precision: the motion, and the correlation at the peak without its revivals.
fn between(field: &MotionField, input: &Input) -> Option<(SpeckleMotion, f64)> {
    let FieldSetup {
        geometry,
        camera,
        orientation,
        ..
    } = field.setup();
    let point = -vector(input, 16);
    let before = Configuration::new(ConfigurationData {
        wavelength: geometry.wavelength(),
        point,
        normal: vector(input, 19),
        illumination: illumination(input, point),
        camera: *camera,
        pupil: DVec3::ZERO,
    })
    .ok()?;
    let after = before
        .moved(&RigidMotions {
            surface: rigid(input, point),
            ..RigidMotions::default()
        })
        .ok()?;
    let motion = SpeckleMotion::between(geometry, &before, &after, *orientation);
    motion.pupil_displacement?;
    let [z0, z1] = [before, after].map(|state| state.sight().depth());
    let axial = (z0 - z1) / (z0 * z1) / geometry.axial_decorrelation_length_at(1.0);
    let left = if axial.abs() < 1.0 {
        motion.correlation
    } else {
        0.0
    };
    Some((motion, left))
}

fn pair(output: &Output, i: usize) -> DVec2 {
    DVec2::new(output[i].into(), output[i + 1].into())
}

/// Compares all points and returns how many were decorrelated, and how many left in part.
fn compare(field: &MotionField, inputs: &[Input]) -> [usize; 2] {
    let geometry = &field.setup().geometry;
    let (diameter, scale) = (
        geometry.pupil_diameter(),
        geometry.principal_distance() / 0.2,
    );
    let samples = 4.0 / geometry.speckle_size();
    let (mut gone, mut partial) = (0, 0);
    for (input, output) in inputs.iter().zip(on_card(inputs)) {
        let Some((motion, left)) = between(field, input) else {
            assert_eq!(output[6].to_bits(), 0, "{input:?}: {output:?}");
            assert_eq!(output[2..4], [1e18; 2], "{input:?}: {output:?}");
            gone += 1;
            continue;
        };
        let pupil = motion.pupil_displacement.expect("a displacement");
        // The part that exceeds the pupil has only as many digits as it has.
        let close = 1e-6 * diameter.max(pupil.length());
        let error = (pair(&output, 2) - pupil).length();
        assert!(error < close, "pupil off by {error:e}, {input:?}: {pupil}");
        let speckle = motion.speckle_displacement();
        let error = (pair(&output, 0) - speckle).length();
        assert!(error < close * scale, "speckle off by {error:e}, {input:?}");
        let error = (f64::from(output[6]) - left).abs();
        assert!(error < 1e-5, "γ off by {error:e}, {input:?}: {left}");
        let image = image_of(field, vector(input, 22) - vector(input, 16));
        let error = (pair(&output, 4) - (image - speckle) * samples).length();
        // The axes of the camera have units of 6e-8.
        let close = samples * (5e-7 * geometry.principal_distance() + close * scale);
        assert!(error < close, "pattern off by {error:e}, {input:?}");
        partial += usize::from(left > 0.05 && left < 0.95);
    }
    [gone, partial]
}

/// The image of a point, from the pupil, in metres.
fn image_of(field: &MotionField, from_pupil: DVec3) -> DVec2 {
    let FieldSetup {
        geometry,
        camera,
        orientation,
        ..
    } = field.setup();
    let across = DVec2::new(from_pupil.dot(camera.right()), from_pupil.dot(camera.up()));
    let tangents = across / -from_pupil.dot(camera.towards_camera());
    let sign = match orientation {
        ImageOrientation::ScreenUpright => 1.0,
        ImageOrientation::SensorInverted => -1.0,
    };
    tangents * (sign * geometry.principal_distance())
}

#[test]
fn motions_are_those_between_two_states() {
    let mut random = Random(ChaCha8Rng::seed_from_u64(5));
    for ratio in [10.0, 100.0, 400.0] {
        for orientation in [
            ImageOrientation::ScreenUpright,
            ImageOrientation::SensorInverted,
        ] {
            let field = field(ratio, orientation);
            let inputs: Vec<_> = (0..4000).map(|_| random.input(&field)).collect();
            let [gone, partial] = compare(&field, &inputs);
            assert!(
                gone > 100 && partial > 800,
                "{gone} decorrelated, {partial} in part"
            );
        }
    }
}

#[test]
fn points_without_sight_or_light_are_decorrelated() {
    let field = field(100.0, ImageOrientation::ScreenUpright);
    let camera = field.setup().camera;
    let (axis, right) = (camera.towards_camera(), camera.right());
    let still = [0.0, 0.0, 0.0, 1.0];
    // Lit 80° from the normal, and tilted by 40° either way: to the light, and away from it.
    let slanting = axis * 80_f64.to_radians().cos() + right * 80_f64.to_radians().sin();
    let tilted = |angle: f64| (camera.up() * (0.5 * angle).sin()).extend((0.5 * angle).cos());
    let tilts = [40_f64, -40.0].map(|angle| tilted(angle.to_radians()).to_array());
    let sphere = [-8.0, 0.0, 0.0, -8.0, 0.0, 0.0];
    let none = DVec3::ZERO;
    let cases = [
        (axis, axis, none, still, 0.0, axis, true),
        (-axis, axis, none, still, 0.0, axis, false),
        (axis, axis, axis * 0.31, still, 0.0, axis, false),
        (axis, right, none, still, 0.0, axis, false),
        (axis, axis, none, tilts[0], 0.0, slanting, true),
        (axis, axis, none, tilts[1], 0.0, slanting, false),
        (axis, axis, axis * 0.1, still, 1.0, axis * 0.1, false),
        (axis, axis, DVec3::Z * -0.125, still, 2.0, DVec3::Z, false),
    ];
    let inputs = cases.map(|(sight, normal, motion, rotation, kind, source, _)| {
        let mut input = [0.0; 39];
        let imaging = field.to_rows().expect("a field in f32");
        input[..16].copy_from_slice(imaging.as_flattened());
        let mut put =
            |i: usize, v: DVec3| input[i..i + 3].copy_from_slice(&v.to_array().map(single));
        put(16, sight * 0.3);
        put(19, normal);
        put(22, motion);
        put(30, source);
        input[25..29].copy_from_slice(&rotation.map(single));
        input[29] = single(kind);
        input[33..].copy_from_slice(&sphere.map(single));
        input
    });
    for ((case, input), output) in cases.iter().zip(&inputs).zip(on_card(&inputs)) {
        assert_eq!(between(&field, input).is_some(), case.6, "{case:?}");
        let there = output[2].abs() < 1e6 && output[6] >= 0.0;
        let gone = output[2..4] == [1e18; 2] && output[6] == 0.0;
        assert_eq!([there, gone], [case.6, !case.6], "{case:?}: {output:?}");
    }
}

#[test]
fn small_motions_are_those_of_a_motion_field() {
    let mut random = Random(ChaCha8Rng::seed_from_u64(6));
    let plain = field(400.0, ImageOrientation::ScreenUpright);
    let diameter = plain.setup().geometry.pupil_diameter();
    let mut inputs: Vec<_> = (0..3000).map(|_| random.input(&plain)).collect();
    for input in &mut inputs {
        // What is of second order, L (K a)², is below 4e-7 of the pupil.
        let motion = random.vector(0.003 * diameter).to_array();
        input[22..25].copy_from_slice(&motion.map(single));
        input[25..29].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
    }
    for (input, output) in inputs.iter().zip(on_card(&inputs)) {
        let [speckle_x, speckle_y, x, y, left, ..] = in_field(&plain, input);
        if left == 0.0 {
            assert_eq!(output[6].to_bits(), 0, "{input:?}: {output:?}");
            continue;
        }
        let error = (pair(&output, 2) - DVec2::new(x, y)).length();
        assert!(error < 1e-6 * diameter, "pupil off by {error:e}, {input:?}");
        let error = (pair(&output, 0) - DVec2::new(speckle_x, speckle_y)).length();
        assert!(
            error < 1e-6 * diameter,
            "speckle off by {error:e}, {input:?}"
        );
        let error = (f64::from(output[6]) - left).abs();
        assert!(error < 1e-5, "γ off by {error:e}, {input:?}: {left}");
    }
}

/// The results of a field of motions for one point.
fn in_field(field: &MotionField, input: &Input) -> [f64; 7] {
    let number = |i: usize| [f64::from(input[i])];
    let position = -vector(input, 16);
    let [px, py, pz] = position.to_array().map(|x| [x]);
    let normal = [19, 20, 21].map(number);
    let motion = [22, 23, 24].map(number);
    let curvature = [33, 34, 35, 36, 37, 38].map(number);
    let points = FieldPoints {
        position: [&px, &py, &pz],
        normal: normal.each_ref().map(|x| x.as_slice()),
        motion: motion.each_ref().map(|x| x.as_slice()),
        light: match input[29] {
            0.0 => FieldLight::Collimated,
            1.0 => FieldLight::PointSource(position + vector(input, 30)),
            _ => FieldLight::Curvature(curvature.each_ref().map(|x| x.as_slice())),
        },
    };
    let mut out = [[0.0]; 7];
    let [a, b, c, d, e, f, g] = &mut out;
    field.evaluate(
        &points,
        FieldSlices {
            speckle_displacement: [a, b],
            pupil_displacement: [c, d],
            correlation: e,
            pattern_coordinate: [f, g],
        },
    );
    out.map(|[x]| x)
}

#[test]
fn coordinates_are_those_of_the_stack() {
    let gpu = Gpu::new().expect("an adapter");
    let paths = [
        SlicePath::Still,
        SlicePath::Circle { half_period: 6 },
        SlicePath::Straight {
            half_period: 12,
            length: 3,
        },
    ];
    for pupil in [
        Pupil::Circle,
        Pupil::Annulus { inner: 0.6 },
        Pupil::Rectangle { height: 0.5 },
    ] {
        for path in paths {
            let field = PupilField::new(64, 24, 7)
                .and_then(|field| field.with_pupil(pupil.clone()))
                .expect("a field");
            let stack = SpeckleStack::generate(&field, path).expect("a stack");
            let overlaps = path.overlaps(&pupil).expect("overlaps");
            let entries: Vec<_> = overlaps
                .iter()
                .map(|[a, b]| format!("vec2({a:e}, {b:e})"))
                .collect();
            let source = format!(
                "{WGSL}
                const TABLE = array({});
                fn tem00_slice_overlaps(slice: u32) -> vec2<f32> {{ return TABLE[slice]; }}",
                entries.join(", "),
            );
            let correlations: Vec<_> = (0_u8..=250).map(|i| [f32::from(i) / 250.0]).collect();
            let body = format!(
                "output(0u, tem00_slice_coordinate(input(0u), {}u));",
                overlaps.len()
            );
            for ([correlation], [u]) in
                correlations
                    .iter()
                    .zip(evaluate(&gpu, &source, &body, &correlations))
            {
                let expected = stack.coordinate_of(f64::from(*correlation));
                assert!(
                    (f64::from(u) - expected).abs() < 2e-6,
                    "{path:?}, {pupil:?}, γ = {correlation}: {u}, not {expected}"
                );
            }
        }
    }
}
