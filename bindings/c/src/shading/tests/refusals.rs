use super::*;

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
        // SAFETY: the pointers are valid.
        |description, camera| unsafe { tem00_camera_create(description, camera) },
    );
}

#[test]
fn speckle_is_refused_by_the_name_of_what_is_wrong() {
    let camera = camera(&CAMERA);
    let light = spot();
    let create = |description: *const SpeckleDescription, speckle: *mut _| {
        // SAFETY: the pointers are valid, or null, which is refused.
        unsafe { tem00_speckle_create(camera.handle, light.handle, description, speckle) }
    };
    each_is_refused(
        DESCRIPTION,
        [
            ("looks", |d| d.looks = 0),
            ("looks", |d| d.looks = 2000),
            ("polarisation", |d| d.polarisation = f64::NAN),
            ("threads", |d| d.threads = 2000),
        ],
        create,
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
        |motions, speckle| {
            let description = SpeckleDescription {
                motions: motions.cast(),
                motion_count: 3,
                ..DESCRIPTION
            };
            create(&raw const description, speckle)
        },
    );
    let mut wrong = [DESCRIPTION; 4];
    wrong[0].motion_count = 1;
    wrong[1].point_count = 1;
    (wrong[2].point_count, wrong[2].points) = (1, ORIGIN.as_ptr());
    wrong[3].memory_limit = 1000;
    let pointer = Status::InvalidPointer;
    let expected = [
        ("motions", pointer),
        ("points", pointer),
        ("normals", pointer),
        ("memory_limit", Status::Memory),
    ];
    for (description, (name, status)) in wrong.iter().zip(expected) {
        let mut speckle = dangling_mut();
        refuses(name, status, create(description, &raw mut speckle));
        assert!(speckle.is_null(), "{description:?} made speckle");
    }
}

#[test]
fn frames_that_the_speckle_does_not_hold_are_refused() {
    let speckle = speckle(&spot(), &[sliding(1e-4, 0.0); 3]);
    each_is_refused(
        sliding(1e-4, 0.0),
        [
            ("motion", |motion| *motion = sliding(5e-3, 0.0)),
            ("motion.camera.rotation", |motion| {
                let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
                motion.camera.rotation = mirror.to_cols_array_2d();
            }),
        ],
        |motion, frame| {
            // SAFETY: the pointers are valid.
            let status = unsafe { tem00_speckle_frame_create(speckle.handle, motion, frame) };
            let [message, parameter] = last();
            assert!(message.starts_with(&parameter), "{message}");
            status
        },
    );
}

#[test]
fn null_overlap_and_points_out_of_sight_are_refused_by_name() {
    let (camera, light) = (camera(&CAMERA), spot());
    let speckle = speckle(&light, &[]);
    let still = BodyMotion::default();
    let frame = frame(&speckle, &still);
    let mut room = [0.25; 12];
    let (mut made, mut framed, still) = (null_mut(), null_mut(), &raw const still);
    let (p, above, nan) = (ORIGIN.as_ptr(), NORMAL.as_ptr(), [f64::NAN; 3].as_ptr());
    let (c, l, s, f) = (camera.handle, light.handle, speckle.handle, frame.handle);
    let d: *const SpeckleDescription = &DESCRIPTION;
    let (column, out) = (room.as_mut_ptr(), room.as_mut_ptr().wrapping_add(9));
    refused! {
        InvalidArgument {
            "point" tem00_camera_project(c, above, out);
            "point" tem00_camera_project(c, nan, out);
        }
        InvalidPointer {
            "camera" tem00_camera_create(&CAMERA, null_mut());
            "camera" tem00_camera_project(null(), p, out);
            "point" tem00_camera_project(c, null(), out);
            "pixel" tem00_camera_project(c, p, null_mut());
            "camera" tem00_speckle_create(null(), l, d, &raw mut made);
            "light" tem00_speckle_create(c, null(), d, &raw mut made);
            "description" tem00_speckle_create(c, l, null(), &raw mut made);
            "info" tem00_speckle_describe(s, null_mut());
            "speckle" tem00_speckle_frame_create(null(), still, &raw mut framed);
            "motion" tem00_speckle_frame_create(s, null(), &raw mut framed);
            "frame" tem00_speckle_frame_factor(null(), p, p, out);
            "point" tem00_speckle_frame_factor(f, null(), p, out);
            "normal" tem00_speckle_frame_factor(f, p, null(), out);
            "factor" tem00_speckle_frame_factor(f, p, p, null_mut());
            "pixel" tem00_speckle_frame_factor_at(f, null(), p, p, out);
            "average" tem00_speckle_frame_average(f, p, p, null_mut());
            "shift" tem00_speckle_frame_shift(f, p, p, null_mut());
            "points" tem00_speckle_frame_factors(f, null(), p, 1, out);
            "factors" tem00_speckle_frame_factors(f, column, p, 4, out);
            "previous" tem00_speckle_factors_since(s, null(), p, p, 1, out);
            "factors" tem00_speckle_factors_since(s, p, p, column, 1, column.wrapping_add(2));
        }
    }
    // SAFETY: no number is read or written.
    let none = unsafe { tem00_speckle_frame_factors(f, null(), null(), 0, null_mut()) };
    assert_eq!(none, Status::Ok, "no points");
    assert_eq!(room, [0.25; 12], "nothing is written");
    assert!(made.is_null() && framed.is_null(), "nothing is made");
}
