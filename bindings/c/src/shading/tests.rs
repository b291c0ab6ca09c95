//! Speckle by one call per hit against the library that is called.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

use core::{f64::consts::FRAC_PI_4, ffi::CStr, ptr};

use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, Illumination, ImagingGeometry, LensData,
    RigidMotions, SpeckleMotion, pupil_overlap_correlation,
};
use tem00_shading::{BeamShape, DMat3, DVec2, Laser, LaserDescription, Motion};

use super::*;
use crate::{
    light::*,
    status::{Status, tem00_last_error},
    testing::{answer, each_is_refused, number_is_refused, pointer_is_refused, refusal},
};

/// Looks straight down at the origin, through a lens that distorts, at a sensor that is tilted.
const CAMERA: CameraDescription = CameraDescription {
    position: [0.0, 0.0, 0.3],
    look_at: [0.0; 3],
    up: [0.0, 1.0, 0.0],
    focal_length: 25e-3,
    f_number: 8.0,
    focus_distance: 0.3,
    pixel_pitch: 3.45e-6,
    resolution: [96, 64],
    principal_offset: [3.0, -2.0],
    tilt: [0.1, 0.3],
    distortion: [-0.1, 0.05, 0.01],
};

/// Shines straight down, with its waist on the plane z = 0. Its axes have no rounding.
const PLACEMENT: Placement = Placement {
    origin: [0.25, 0.0, 0.5],
    direction: [0.0, 0.0, -3.0],
    fan_axis: [2.0, 0.0, 0.0],
};

const SPOT: SpotDescription = SpotDescription {
    placement: Placement {
        origin: [0.0, 0.0, 0.5],
        ..PLACEMENT
    },
    wavelength: 650e-9,
    power: 5e-3,
    waist_radius: 5e-3,
    waist_distance: 0.5,
    m_squared: 1.0,
};

const ELLIPTIC: EllipticDescription = EllipticDescription {
    placement: PLACEMENT,
    wavelength: 650e-9,
    power: 4e-3,
    waist_radius: [5e-3, 3e-3],
    waist_distance: [0.5, 0.3],
    m_squared: [1.0, 1.2],
    rotation: FRAC_PI_4,
};

static ANGLES: [f64; 2] = [-1.0, 1.0];
static POWERS: [f64; 2] = [1.0, 2.0];

const LINE: LineDescription = LineDescription {
    placement: PLACEMENT,
    wavelength: 650e-9,
    power: 2e-3,
    waist_radius: 1e-4,
    m_squared: 1.2,
    fan_angle: 1.5,
    apex_offset: 2e-3,
    focus_distance: 0.5,
    focus_curve: FocusCurve::EqualPlane as u32,
    profile: LineProfile::Tabulated as u32,
    edge: 0.0,
    angles: ANGLES.as_ptr(),
    powers: POWERS.as_ptr(),
    knot_count: 2,
};

/// Two looks of light that is half polarised.
const DESCRIPTION: SpeckleDescription = SpeckleDescription {
    seed: 11,
    motions: ptr::null(),
    motion_count: 0,
    points: ptr::null(),
    normals: ptr::null(),
    point_count: 0,
    memory_limit: 64 << 20,
    looks: 2,
    polarisation: 0.5,
    threads: 1,
};

const ORIGIN: [f64; 3] = [0.0; 3];
const NORMAL: [f64; 3] = [0.0, 0.0, 1.0];

/// Handles that free themselves.
struct Owned<T>(*mut T, unsafe extern "C" fn(*mut T));

impl<T> Drop for Owned<T> {
    fn drop(&mut self) {
        // SAFETY: it was created by the interface and is not used again.
        unsafe { (self.1)(self.0) };
    }
}

fn message() -> String {
    // SAFETY: the text is that of this thread, and no call fails meanwhile.
    let text = unsafe { CStr::from_ptr(tem00_last_error()) };
    text.to_str().unwrap().to_owned()
}

/// Makes a handle by one of the functions that take a description.
fn made<D, T>(
    create: unsafe extern "C" fn(*const D, *mut *mut T) -> Status,
    description: &D,
    destroy: unsafe extern "C" fn(*mut T),
) -> Owned<T> {
    // SAFETY: the pointers are valid.
    let handle = answer(ptr::null_mut(), |out| unsafe { create(description, out) });
    Owned(handle, destroy)
}

fn camera(description: &CameraDescription) -> Owned<Camera> {
    made(tem00_camera_create, description, tem00_camera_destroy)
}

fn spot() -> Owned<Light> {
    made(tem00_light_create_spot, &SPOT, tem00_light_destroy)
}

fn elliptic() -> Owned<Light> {
    made(tem00_light_create_elliptic, &ELLIPTIC, tem00_light_destroy)
}

fn line(description: &LineDescription) -> Owned<Light> {
    made(tem00_light_create_line, description, tem00_light_destroy)
}

/// Speckle of a light for these motions.
fn speckle(light: &Owned<Light>, motions: &[BodyMotion]) -> Owned<Speckle> {
    seen_by(&CAMERA, light, motions)
}

/// The same by another camera.
fn seen_by(
    lens: &CameraDescription,
    light: &Owned<Light>,
    motions: &[BodyMotion],
) -> Owned<Speckle> {
    let description = &SpeckleDescription {
        motions: motions.as_ptr(),
        motion_count: motions.len(),
        ..DESCRIPTION
    };
    let camera = camera(lens);
    // SAFETY: the pointers are valid.
    let create = |out| unsafe { tem00_speckle_create(camera.0, light.0, description, out) };
    Owned(answer(ptr::null_mut(), create), tem00_speckle_destroy)
}

fn frame(speckle: &Owned<Speckle>, motion: &BodyMotion) -> Owned<SpeckleFrame> {
    // SAFETY: the pointers are valid.
    let create = |out| unsafe { tem00_speckle_frame_create(speckle.0, motion, out) };
    Owned(answer(ptr::null_mut(), create), tem00_speckle_frame_destroy)
}

fn shift(frame: &Owned<SpeckleFrame>, point: &[f64; 3], normal: &[f64; 3]) -> SpeckleShift {
    let (point, normal) = (point.as_ptr(), normal.as_ptr());
    // SAFETY: the pointers are valid.
    answer(SpeckleShift::default(), |out| unsafe {
        tem00_speckle_frame_shift(frame.0, point, normal, out)
    })
}

/// A body that slides, beside a camera and a light that stand still.
fn sliding(x: f64, y: f64) -> BodyMotion {
    BodyMotion {
        surface: along(x, y, 0.0),
        ..BodyMotion::default()
    }
}

fn along(x: f64, y: f64, z: f64) -> Pose {
    Pose {
        translation: [x, y, z],
        ..Pose::default()
    }
}

/// All three move, and the body turns about an axis that is none of the world's.
fn motion() -> (BodyMotion, Motion) {
    let turn = tem00_shading::Pose::about(DVec3::X * 0.01, DVec3::new(1.0, 2.0, 0.5), 2e-3);
    let turn = turn.unwrap();
    let [camera, light] = [[0.0, 2e-4, 1e-4], [1e-4, 0.0, 0.0]];
    let along = tem00_shading::Pose::along;
    let motion = BodyMotion {
        body: 1,
        surface: Pose {
            rotation: turn.rotation().transpose().to_cols_array_2d(),
            translation: turn.translation().to_array(),
        },
        camera: self::along(camera[0], camera[1], camera[2]),
        light: self::along(light[0], light[1], light[2]),
    };
    let expected = Motion {
        body: 1,
        surface: tem00_shading::Pose::new(turn.rotation(), turn.translation()).unwrap(),
        camera: along(camera.into()).unwrap(),
        laser: along(light.into()).unwrap(),
    };
    (motion, expected)
}

/// Points in the image and a few others: out of sight, beyond all scales, NaN and infinite.
fn places() -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let place = |i: u32| [f64::from(i % 12) - 5.5, f64::from(i / 12) - 5.5, 0.0].map(|x| x * 1e-4);
    let mut points: Vec<_> = (0..140).map(place).collect();
    points.extend([
        [0.0, 0.0, 1.0],
        [1e300; 3],
        [f64::NAN; 3],
        [f64::INFINITY; 3],
    ]);
    let normals = (0..points.len()).map(|i| if i % 40 == 39 { [f64::NAN; 3] } else { NORMAL });
    let normals = normals.collect();
    (points, normals)
}

/// Lights by the interface, and lasers by the library.
fn lights() -> [(Owned<Light>, Laser); 4] {
    let placed = |placement: &Placement, power, line_direction, shape| {
        let position = DVec3::from_array(placement.origin);
        let laser = Laser::new(LaserDescription {
            line: tem00_coherence::SpectralLine::monochromatic(650e-9).unwrap(),
            power,
            position,
            look_at: position - DVec3::Z,
            line_direction,
            shape,
        });
        laser.unwrap()
    };
    let beam = |waist_radius, waist_distance, m_squared| BeamShape::Spot {
        waist_radius,
        waist_distance,
        m_squared,
    };
    let fan = |profile| BeamShape::Line {
        waist_radius: 1e-4,
        m_squared: 1.2,
        fan: tem00_beam::FanGeometry {
            fan_angle: 1.5,
            apex_offset: 2e-3,
            focus_distance: 0.5,
            focus_curve: tem00_beam::FocusCurve::EqualPlane,
        },
        profile,
    };
    let (round, oval) = (
        beam([5e-3; 2], [0.5; 2], [1.0; 2]),
        beam([5e-3, 3e-3], [0.5, 0.3], [1.0, 1.2]),
    );
    let flat = tem00_beam::LineProfile::Powell { edge: 0.1 };
    let table = tem00_beam::AngularProfile::new(&ANGLES, &POWERS).unwrap();
    let table = tem00_beam::LineProfile::Tabulated(table);
    let powell = LineDescription {
        profile: LineProfile::Powell as u32,
        edge: 0.1,
        ..LINE
    };
    // The y axis of a light that goes down is that of the world turned about.
    let (sine, cosine) = ELLIPTIC.rotation.sin_cos();
    let turned = DVec3::new(cosine, -sine, 0.0);
    let x = DVec3::X;
    [
        (spot(), placed(&SPOT.placement, 5e-3, x, round)),
        (elliptic(), placed(&PLACEMENT, 4e-3, turned, oval)),
        (line(&powell), placed(&PLACEMENT, 2e-3, x, fan(flat))),
        (line(&LINE), placed(&PLACEMENT, 2e-3, x, fan(table))),
    ]
}

fn library_camera() -> tem00_shading::Camera {
    let mut description = tem00_shading::CameraDescription {
        resolution: CAMERA.resolution,
        principal_point: Some(DVec2::new(51.0, 30.0)),
        ..tem00_shading::CameraDescription::default()
    };
    (description.tilt.angle, description.tilt.azimuth) = (0.1, 0.3);
    let bent = &mut description.distortion;
    (bent.k1, bent.k2, bent.k3) = (-0.1, 0.05, 0.01);
    tem00_shading::Camera::new(description).unwrap()
}

fn library(laser: &Laser, motion: Motion) -> PreparedSpeckle {
    tem00_shading::Speckle::new(&library_camera(), laser, 11)
        .for_motions([motion])
        .within(64 << 20)
        .looks(2)
        .polarisation(0.5)
        .prepare()
        .unwrap()
}

#[test]
fn answers_are_those_of_the_library_to_the_last_bit() {
    let (motion, of_library) = motion();
    let (points, normals) = places();
    let previous: Vec<_> = points.iter().map(|&[x, y, z]| [x - 1e-4, y, z]).collect();
    let [was, is, normal] = [&previous, &points, &normals]
        .map(|column| column.iter().map(|&v| v.into()).collect::<Vec<DVec3>>());
    let count = points.len();
    for (light, laser) in lights() {
        let library = library(&laser, of_library);
        let speckle = speckle(&light, &[motion]);
        let frame = frame(&speckle, &motion);
        let of_library = library.frame(&of_library).unwrap();

        let [mut batch, mut since, mut expected] = [0.0; 3].map(|zero| vec![zero; count]);
        let [w, p, n] = [&previous, &points, &normals].map(|column| column.as_ptr().cast());
        // SAFETY: the handles and the columns are valid.
        let statuses = unsafe {
            [
                tem00_speckle_frame_factors(frame.0, p, n, count, batch.as_mut_ptr()),
                tem00_speckle_factors_since(speckle.0, w, p, n, count, since.as_mut_ptr()),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 2], "{}", message());
        library.factors_since(&was, &is, &normal, &mut expected);
        assert_eq!(since, expected);

        let info = SpeckleInfo {
            summary: ptr::null(),
            speckle_size: 0.0,
            memory_bytes: 0,
        };
        // SAFETY: the pointers are valid.
        let info = answer(info, |out| unsafe {
            tem00_speckle_describe(speckle.0, out)
        });
        // SAFETY: the text belongs to the speckle.
        let summary = unsafe { CStr::from_ptr(info.summary) };
        assert_eq!(summary.to_str().unwrap(), library.to_string());
        assert_eq!(info.memory_bytes, library.memory_bytes());
        let size = library.geometry().speckle_size_in_pixels();
        assert_eq!(info.speckle_size, size);

        drop((speckle, light));
        let beside = DVec2::new(40.0, 30.5);
        for (i, (point, in_batch)) in is.iter().zip(batch).enumerate() {
            let (p, n) = (points[i].as_ptr(), normals[i].as_ptr());
            let (frame, pixel) = (frame.0, beside.as_ref().as_ptr());
            // SAFETY: the handle and the pointers are valid.
            let found = unsafe {
                [
                    answer(0.0, |out| tem00_speckle_frame_factor(frame, p, n, out)),
                    answer(0.0, |out| {
                        tem00_speckle_frame_factor_at(frame, pixel, p, n, out)
                    }),
                    answer(0.0, |out| tem00_speckle_frame_average(frame, p, n, out)),
                ]
            };
            let factor = of_library.factor(*point, normal[i]);
            let at = of_library.factor_at(beside, *point, normal[i]);
            let average = of_library.average(*point, normal[i]);
            assert_eq!(found, [factor, at, average], "at {point:?}");
            assert_eq!(in_batch, factor, "at {point:?}");
            // SAFETY: the handle and the pointers are valid.
            let shift = answer(SpeckleShift::default(), |out| unsafe {
                tem00_speckle_frame_shift(frame, p, n, out)
            });
            let expected = of_library.shift(*point, normal[i]);
            assert_eq!(shift, expected.into(), "at {point:?}");
            let left = expected.map_or(0.0, |shift| pupil_overlap_correlation(shift.pupil));
            assert_eq!(shift.correlation, left, "at {point:?}");
        }
    }
}

#[test]
fn shifts_are_those_of_the_law_between_two_states() {
    // At f/2 one axial decorrelation length is 3 mm; the light diverges, and the focus lies behind.
    let description = CameraDescription {
        f_number: 2.0,
        focus_distance: 0.31,
        resolution: [16, 12],
        principal_offset: [0.0; 2],
        tilt: [0.0; 2],
        distortion: [0.0; 3],
        ..CAMERA
    };
    let spot = SpotDescription {
        waist_radius: 30e-6,
        waist_distance: 0.0,
        ..SPOT
    };
    let light = made(tem00_light_create_spot, &spot, tem00_light_destroy);
    let laser = Laser::spot(650e-9, 30e-6)
        .focused_at(0.0)
        .placed(spot.placement.origin.into(), DVec3::ZERO, DVec3::X)
        .unwrap();
    let geometry = ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 2.0,
        surface_to_pupil: 0.31,
        pixel_pitch: 3.45e-6,
    });
    let geometry = geometry.unwrap();
    let mut k = 0.0;
    // Squares times the golden ratio: even, and independent of each other.
    let mut draw = |limit: f64| {
        k += 1.0;
        limit * (2.0 * f64::fract(k * k * 0.618_033_988_749_894_9) - 1.0)
    };
    let mut pose = |slide: f64, turn: f64| {
        let axis = DVec3::new(draw(1.0), draw(1.0), 1.0);
        let turned = tem00_shading::Pose::about(DVec3::ZERO, axis, draw(turn)).unwrap();
        let along = DVec3::new(draw(slide), draw(slide), draw(slide));
        turned.then(&tem00_shading::Pose::along(along).unwrap())
    };
    let of_c = |pose: &tem00_shading::Pose| Pose {
        rotation: pose.rotation().transpose().to_cols_array_2d(),
        translation: pose.translation().to_array(),
    };
    let mut told = 0;
    for _ in 0..24 {
        let [surface, camera, source] = [pose(2e-3, 5e-3), pose(2e-4, 1e-3), pose(1e-3, 1e-3)];
        let motion = BodyMotion {
            body: 0,
            surface: of_c(&surface),
            camera: of_c(&camera),
            light: of_c(&source),
        };
        let place = 0.1 * pose(0.03, 0.0).translation();
        let normal = (pose(0.5, 0.0).translation() + DVec3::Z).normalize();
        let seen = surface.point(place);
        let lit = |laser: &Laser, point| {
            Illumination::collimated(laser.wave_direction_at(point)).unwrap()
        };
        let before = Configuration::new(ConfigurationData {
            wavelength: 650e-9,
            point: place,
            normal,
            illumination: lit(&laser, place),
            camera: CameraFrame::look_at(CAMERA.position.into(), DVec3::ZERO, DVec3::Y).unwrap(),
            pupil: CAMERA.position.into(),
        });
        let before = before.unwrap();
        let motions = RigidMotions {
            surface,
            camera,
            ..RigidMotions::default()
        };
        let after = before
            .moved_into(&motions, lit(&laser.moved(&source), seen))
            .unwrap();
        let law = SpeckleMotion::between(&geometry, &before, &after);
        let normal = surface.direction(normal).to_array();
        let speckle = seen_by(&description, &light, &[motion]);
        let found = shift(&frame(&speckle, &motion), &seen.to_array(), &normal);
        let [x, y] = (law.speckle_displacement() / 3.45e-6).to_array();
        let error = (found.displacement[0] - x).hypot(found.displacement[1] + y);
        assert!(error < 1e-8, "{error} pixels off: {found:?}, {law:?}");
        // The polynomial of what a motion along the axis takes.
        let error = found.correlation - law.correlation;
        assert!(error.abs() < 1e-5, "off by {error}: {found:?}, {law:?}");
        told += i32::from((0.1..0.9).contains(&law.correlation));
    }
    assert!(told > 12, "only {told} tell anything");
}

#[test]
fn points_are_seen_where_the_library_sees_them() {
    let camera = camera(&CAMERA);
    let project = |point: &[f64; 3], out: *mut [f64; 2]| {
        // SAFETY: the pointers are valid.
        unsafe { tem00_camera_project(camera.0, point.as_ptr(), out.cast()) }
    };
    let point = [2e-3, -1e-3, 3e-4];
    let seen = answer([0.0; 2], |out| project(&point, out));
    let expected = library_camera().project(point.into()).unwrap();
    assert_eq!(seen, expected.to_array());
    for unseen in [[0.0, 0.0, 1.0], [f64::NAN; 3]] {
        let mut out = [7.0; 2];
        number_is_refused("point", project(&unseen, &raw mut out));
        assert_eq!(out, [7.0; 2], "nothing is written");
    }
}

#[test]
fn cameras_are_refused_by_the_name_of_what_is_wrong() {
    each_is_refused(
        CAMERA,
        [
            ("look_at", |d| d.look_at = d.position),
            ("look_at", |d| d.position[1] = f64::NAN),
            ("up", |d| d.up = [0.0, 0.0, 2.0]),
            ("focal_length", |d| d.focal_length = 0.0),
            ("f_number", |d| d.f_number = 0.4),
            ("focus_distance", |d| d.focus_distance = 0.02),
            ("pixel_pitch", |d| d.pixel_pitch = f64::NAN),
            ("resolution", |d| d.resolution = [0, 64]),
            ("principal_offset", |d| d.principal_offset[1] = f64::NAN),
            ("tilt", |d| d.tilt[0] = 1.6),
            ("distortion", |d| d.distortion[2] = f64::INFINITY),
        ],
        |description| {
            let mut camera = ptr::dangling_mut();
            // SAFETY: the pointers are valid.
            let status = unsafe { tem00_camera_create(description, &raw mut camera) };
            assert!(camera.is_null(), "{description:?} made a camera");
            status
        },
    );
}

#[test]
fn speckle_is_refused_by_the_name_of_what_is_wrong() {
    let camera = camera(&CAMERA);
    let create = |light: &Owned<Light>, description: &SpeckleDescription| {
        let mut speckle = ptr::dangling_mut();
        // SAFETY: the pointers are valid, or null, which is refused.
        let status =
            unsafe { tem00_speckle_create(camera.0, light.0, description, &raw mut speckle) };
        assert!(speckle.is_null(), "{description:?} made speckle");
        status
    };
    let light = spot();
    each_is_refused(
        DESCRIPTION,
        [
            ("looks", |d| d.looks = 0),
            ("looks", |d| d.looks = 2000),
            ("polarisation", |d| d.polarisation = f64::NAN),
            ("threads", |d| d.threads = 2000),
        ],
        |description| create(&light, description),
    );
    each_is_refused(
        [motion().0; 3],
        [
            ("motions[2].surface.rotation", |[.., d]| {
                d.surface.rotation[1][1] = 0.9;
            }),
            ("motions[0].camera.translation", |[d, ..]| {
                d.camera.translation[1] = f64::NAN;
            }),
            ("motions[1].light.rotation", |[_, d, _]| {
                d.light.rotation[0][0] = f64::NAN;
            }),
        ],
        |motions| {
            let (motions, motion_count) = (motions.as_ptr(), motions.len());
            let description = SpeckleDescription {
                motions,
                motion_count,
                ..DESCRIPTION
            };
            create(&light, &description)
        },
    );
    let mut wrong = [DESCRIPTION; 4];
    wrong[0].motion_count = 1;
    wrong[1].point_count = 1;
    (wrong[2].point_count, wrong[2].points) = (1, ORIGIN.as_ptr());
    for (name, description) in ["motions", "points", "normals"].iter().zip(&wrong) {
        pointer_is_refused(name, create(&light, description));
    }
    wrong[3].memory_limit = 1000;
    let memory = (Status::Memory, "memory_limit".to_owned());
    assert_eq!(refusal(create(&light, &wrong[3])), memory, "{}", message());
}

#[test]
fn frames_that_the_speckle_does_not_hold_are_refused() {
    let speckle = speckle(&spot(), &[sliding(1e-4, 0.0); 3]);
    let mut mirrored = BodyMotion::default();
    mirrored.camera.rotation = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)).to_cols_array_2d();
    let far = sliding(5e-3, 0.0);
    for (name, motion) in [("motion", far), ("motion.camera.rotation", mirrored)] {
        let mut frame = ptr::dangling_mut();
        // SAFETY: the pointers are valid.
        let status =
            unsafe { tem00_speckle_frame_create(speckle.0, &raw const motion, &raw mut frame) };
        number_is_refused(name, status);
        assert!(
            message().starts_with(name) && frame.is_null(),
            "{}",
            message()
        );
    }
}

#[test]
fn null_and_overlap_are_refused_by_name() {
    let (camera, light) = (camera(&CAMERA), spot());
    let speckle = speckle(&light, &[]);
    let frame = frame(&speckle, &BodyMotion::default());
    let still = BodyMotion::default();
    let mut column = [0.25; 12];
    let (mut made, mut framed) = (ptr::null_mut(), ptr::null_mut());
    let (p, null) = (ORIGIN.as_ptr(), ptr::null());
    let (c, l, s, f) = (camera.0, light.0, speckle.0, frame.0);
    let (no_camera, no_light, no_speckle, no_frame) =
        (ptr::null(), ptr::null(), ptr::null(), ptr::null());
    let d: *const SpeckleDescription = &DESCRIPTION;
    // SAFETY: the pointers are valid, or null or overlap, which is refused.
    unsafe {
        let (column, out) = (column.as_mut_ptr(), &raw mut column[9]);
        let project = tem00_camera_project;
        pointer_is_refused("camera", tem00_camera_create(&CAMERA, ptr::null_mut()));
        pointer_is_refused("camera", project(no_camera, p, out));
        pointer_is_refused("point", project(c, null, out));
        pointer_is_refused("pixel", project(c, p, ptr::null_mut()));
        let create = tem00_speckle_create;
        pointer_is_refused("camera", create(no_camera, l, d, &raw mut made));
        pointer_is_refused("light", create(c, no_light, d, &raw mut made));
        pointer_is_refused("description", create(c, l, ptr::null(), &raw mut made));
        pointer_is_refused("info", tem00_speckle_describe(s, ptr::null_mut()));
        let create = tem00_speckle_frame_create;
        pointer_is_refused(
            "speckle",
            create(no_speckle, &raw const still, &raw mut framed),
        );
        pointer_is_refused("motion", create(s, ptr::null(), &raw mut framed));
        let factor = tem00_speckle_frame_factor;
        pointer_is_refused("frame", factor(no_frame, p, p, out));
        pointer_is_refused("point", factor(f, null, p, out));
        pointer_is_refused("normal", factor(f, p, null, out));
        pointer_is_refused("factor", factor(f, p, p, ptr::null_mut()));
        pointer_is_refused(
            "average",
            tem00_speckle_frame_average(f, p, p, ptr::null_mut()),
        );
        pointer_is_refused("shift", tem00_speckle_frame_shift(f, p, p, ptr::null_mut()));
        let factors = tem00_speckle_frame_factors;
        pointer_is_refused("points", factors(f, null, p, 1, out));
        pointer_is_refused("factors", factors(f, column, p, 4, out));
        let since = tem00_speckle_factors_since;
        pointer_is_refused("previous", since(s, null, p, p, 1, out));
        pointer_is_refused("factors", since(s, p, p, column, 1, column.add(2)));
        assert_eq!(
            factors(f, null, null, 0, ptr::null_mut()),
            Status::Ok,
            "no points"
        );
    }
    assert_eq!(column, [0.25; 12], "nothing is written");
    assert!(made.is_null() && framed.is_null(), "nothing is made");
}

#[test]
fn threads_may_share_them() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<(Camera, Speckle, SpeckleFrame)>();
}
