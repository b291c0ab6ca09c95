//! Speckle by one call per hit against the library that is called.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

mod refusals;

use core::{
    f64::consts::FRAC_PI_4,
    ffi::CStr,
    ptr::{dangling_mut, null, null_mut},
};

use tem00_decorrelation::pupil_overlap_correlation;
use tem00_shading::{BeamShape, DMat3, DVec2, Laser, LaserDescription, Motion};

use super::*;
use crate::{
    light::*,
    status::Status,
    testing::{Owned, each_is_refused, last, refuses},
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
    motions: null(),
    motion_count: 0,
    points: null(),
    normals: null(),
    point_count: 0,
    memory_limit: 64 << 20,
    looks: 2,
    polarisation: 0.5,
    threads: 1,
};

const ORIGIN: [f64; 3] = [0.0; 3];
const NORMAL: [f64; 3] = [0.0, 0.0, 1.0];

fn camera(description: &CameraDescription) -> Owned<Camera> {
    Owned::new(tem00_camera_create, description, tem00_camera_destroy)
}

fn spot() -> Owned<Light> {
    Owned::new(tem00_light_create_spot, &SPOT, tem00_light_destroy)
}

fn elliptic() -> Owned<Light> {
    Owned::new(tem00_light_create_elliptic, &ELLIPTIC, tem00_light_destroy)
}

fn line(description: &LineDescription) -> Owned<Light> {
    Owned::new(tem00_light_create_line, description, tem00_light_destroy)
}

/// Speckle of a light for these motions.
fn speckle(light: &Owned<Light>, motions: &[BodyMotion]) -> Owned<Speckle> {
    let description = &SpeckleDescription {
        motions: motions.as_ptr(),
        motion_count: motions.len(),
        ..DESCRIPTION
    };
    let camera = camera(&CAMERA);
    Owned {
        handle: ask!(tem00_speckle_create(
            camera.handle,
            light.handle,
            description
        )),
        destroy: tem00_speckle_destroy,
    }
}

fn frame(speckle: &Owned<Speckle>, motion: &BodyMotion) -> Owned<SpeckleFrame> {
    Owned {
        handle: ask!(tem00_speckle_frame_create(speckle.handle, motion)),
        destroy: tem00_speckle_frame_destroy,
    }
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
            spectrum: tem00_coherence::Spectrum::monochromatic(650e-9).unwrap(),
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
                tem00_speckle_frame_factors(frame.handle, p, n, count, batch.as_mut_ptr()),
                tem00_speckle_factors_since(speckle.handle, w, p, n, count, since.as_mut_ptr()),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 2], "{}", last()[0]);
        library.factors_since(&was, &is, &normal, &mut expected);
        assert_eq!(since, expected);

        let info: SpeckleInfo = ask!(tem00_speckle_describe(speckle.handle));
        // SAFETY: the text belongs to the speckle.
        let summary = unsafe { CStr::from_ptr(info.summary) };
        assert_eq!(summary.to_str().unwrap(), library.to_string());
        assert_eq!(info.memory_bytes, library.memory_bytes());
        let size = library.geometry().speckle_size_in_pixels();
        assert_eq!(info.speckle_size, size);

        drop((speckle, light));
        let beside = DVec2::new(40.0, 30.5);
        for (i, (point, in_batch)) in is.iter().zip(batch).enumerate() {
            let (frame, n) = (frame.handle, normals[i].as_ptr());
            let (p, pixel, normal) = (points[i].as_ptr(), beside.as_ref().as_ptr(), normal[i]);
            let shift = of_library.shift(*point, normal);
            agree! {
                point;
                tem00_speckle_frame_factor(frame, p, n) = of_library.factor(*point, normal);
                tem00_speckle_frame_factor_at(frame, pixel, p, n) =
                    of_library.factor_at(beside, *point, normal);
                tem00_speckle_frame_average(frame, p, n) = of_library.average(*point, normal);
                tem00_speckle_frame_shift(frame, p, n) = SpeckleShift {
                    displacement: shift.map_or([0.0; 2], |shift| shift.displacement.to_array()),
                    pupil_shift: shift.map_or(f64::INFINITY, |shift| shift.pupil),
                    correlation: shift.map_or(0.0, |shift| pupil_overlap_correlation(shift.pupil)),
                };
            }
            assert_eq!(in_batch, of_library.factor(*point, normal), "at {point:?}");
        }
    }
}

#[test]
fn points_are_seen_where_the_library_sees_them() {
    let camera = camera(&CAMERA);
    let point = [2e-3, -1e-3, 3e-4];
    let expected = library_camera().project(point.into()).unwrap();
    agree! { point; tem00_camera_project(camera.handle, point.as_ptr()) = expected.to_array(); }
}
