use tem00_decorrelation::{DMat3, FieldSlices, MotionField};

use super::*;

const COUNT: usize = 37;

fn setup() -> FieldSetup {
    FieldSetup {
        camera: axes(),
        pupil_centre: EYE,
        orientation: ImageOrientation::ScreenUpright as u32,
        pattern_speckle_size: 4.0,
        shared_motion: MOTION,
    }
}

/// Columns of points: position, normal, motion, curvature.
fn inputs() -> [Vec<f64>; 15] {
    core::array::from_fn(|column| {
        let (start, step) = match column {
            0..2 => (-5e-3, 3e-4),
            2 => (0.0, 1e-3),
            5 => (1.0, 0.0),
            3 | 4 => (-0.3, 0.02),
            6..9 => (-1e-4, 7e-6),
            _ => (-0.5, 0.05),
        };
        let number = |i: u32| start + step * f64::from(i) * (1.0 + 0.1 * column as f64);
        (0..).take(COUNT).map(number).collect()
    })
}

fn points(inputs: &[Vec<f64>; 15], light: FieldLight) -> FieldPoints {
    let [px, py, pz, nx, ny, nz, ax, ay, az, curvature @ ..] =
        inputs.each_ref().map(|column| column.as_ptr());
    FieldPoints {
        position: [px, py, pz],
        normal: [nx, ny, nz],
        motion: [ax, ay, az],
        light: light as u32,
        source: [0.1, 0.2, 0.5],
        curvature,
    }
}

fn results(columns: &mut [Vec<f64>; 7]) -> FieldResults {
    let [a, b, c, d, correlation, e, f] = columns.each_mut().map(|column| column.as_mut_ptr());
    FieldResults {
        speckle_displacement: [a, b],
        pupil_displacement: [c, d],
        correlation,
        pattern_coordinate: [e, f],
    }
}

fn room() -> [Vec<f64>; 7] {
    [(); 7].map(|()| vec![7.0; COUNT])
}

fn evaluate(setup: &FieldSetup, points: &FieldPoints, out: &mut [Vec<f64>; 7]) -> Status {
    let imaging = Owned::new(&LENS);
    let results = results(out);
    // SAFETY: the pointers are valid, or refused.
    unsafe { tem00_imaging_motion_field(imaging.0, setup, points, COUNT, &raw const results) }
}

fn by_library(inputs: &[Vec<f64>; 15], light: FieldLight) -> [Vec<f64>; 7] {
    use tem00_decorrelation::FieldLight as L;
    let CameraAxes {
        right,
        up,
        towards_camera,
    } = axes();
    let columns = [right, up, towards_camera].map(DVec3::from_array);
    let camera = CameraFrame::from_axes(DMat3::from_cols(columns[0], columns[1], columns[2]));
    let field = MotionField::new(tem00_decorrelation::FieldSetup {
        geometry: geometry(),
        camera: camera.unwrap(),
        pupil_centre: DVec3::from_array(EYE),
        orientation: tem00_decorrelation::ImageOrientation::ScreenUpright,
        pattern_speckle_size: 4.0,
    });
    let [px, py, pz, nx, ny, nz, ax, ay, az, curvature @ ..] = inputs.each_ref().map(Vec::as_slice);
    let points = tem00_decorrelation::FieldPoints {
        position: [px, py, pz],
        normal: [nx, ny, nz],
        motion: [ax, ay, az],
        light: match light {
            FieldLight::Collimated => L::Collimated,
            FieldLight::PointSource => L::PointSource(DVec3::new(0.1, 0.2, 0.5)),
            FieldLight::Curvature => L::Curvature(curvature),
        },
    };
    let mut out = room();
    let [a, b, c, d, correlation, e, f] = &mut out;
    let slices = FieldSlices {
        speckle_displacement: [a, b],
        pupil_displacement: [c, d],
        correlation,
        pattern_coordinate: [e, f],
    };
    field
        .unwrap()
        .with_shared_motion(&motion())
        .evaluate(&points, slices);
    out
}

#[test]
fn motion_fields_are_those_of_the_library_for_each_light() {
    let inputs = inputs();
    for light in [
        FieldLight::Collimated,
        FieldLight::PointSource,
        FieldLight::Curvature,
    ] {
        let mut out = room();
        let status = evaluate(&setup(), &points(&inputs, light), &mut out);
        assert_eq!(status, Status::Ok, "{light:?}: {}", last_parameter());
        assert_eq!(out, by_library(&inputs, light), "{light:?}");
    }
}

#[test]
fn the_curvature_may_be_null_where_the_light_needs_none() {
    let inputs = inputs();
    for (light, allowed) in [
        (FieldLight::Collimated, true),
        (FieldLight::PointSource, true),
        (FieldLight::Curvature, false),
    ] {
        let points = FieldPoints {
            curvature: [ptr::null(); 6],
            ..points(&inputs, light)
        };
        let status = evaluate(&setup(), &points, &mut room());
        assert_eq!(status == Status::Ok, allowed, "{light:?}: {status:?}");
    }
}

#[test]
fn fields_are_refused_by_the_name_of_what_is_wrong() {
    let good = inputs();
    let collimated = points(&good, FieldLight::Collimated);
    let refused = |setup: &FieldSetup, points: &FieldPoints| {
        let mut out = room();
        let status = evaluate(setup, points, &mut out);
        assert_eq!(out, room(), "nothing is written");
        status
    };
    each_is_refused(
        setup(),
        [
            ("pupil_centre", |setup| setup.pupil_centre[1] = f64::NAN),
            ("orientation", |setup| setup.orientation = 2),
            ("pattern_speckle_size", |s| s.pattern_speckle_size = 0.0),
            ("camera", |setup| setup.shared_motion.camera[0] = f64::NAN),
        ],
        |wrong| refused(wrong, &collimated),
    );
    each_is_refused(
        collimated,
        [
            ("light", |points| points.light = 3),
            ("source", |points| {
                (points.light, points.source) = (FieldLight::PointSource as u32, [f64::NAN; 3]);
            }),
        ],
        |wrong| refused(&setup(), wrong),
    );
    for (column, name) in [(1, "position"), (5, "normal"), (8, "motion")] {
        let mut bad = good.clone();
        bad[column][COUNT - 1] = f64::NAN;
        let points = points(&bad, FieldLight::Collimated);
        number_is_refused(name, refused(&setup(), &points));
    }
    let mut bad = good.clone();
    bad[14][0] = f64::INFINITY;
    let points = points(&bad, FieldLight::Curvature);
    number_is_refused("curvature", refused(&setup(), &points));
}

/// A camera of extreme numbers.
fn extreme(wavelength: f64, pixel_pitch: f64) -> Option<Owned> {
    let mut handle = ptr::null_mut();
    let distances = PupilDistances {
        wavelength,
        pixel_pitch,
        ..DISTANCES
    };
    // SAFETY: the pointers are valid.
    let status = unsafe { tem00_imaging_create_distances(&raw const distances, &raw mut handle) };
    (status == Status::Ok).then_some(Owned(handle))
}

#[test]
fn no_field_is_nan_and_cameras_out_of_scale_are_refused() {
    let inputs = inputs();
    let points = points(&inputs, FieldLight::Collimated);
    let setup = FieldSetup {
        shared_motion: Motion::default(),
        ..setup()
    };
    for (wavelength, pixel_pitch, refused) in [
        (650e-9, 1e308, false),
        (5e-324, 3.45e-6, true),
        (650e-9, 5e-324, false),
        (1e-200, 1e-200, false),
        (1e-290, 1e290, true),
        (1e-100, 1e100, false),
    ] {
        let imaging = extreme(wavelength, pixel_pitch).unwrap();
        let mut out = room();
        let results = results(&mut out);
        // SAFETY: the pointers are valid.
        let status = unsafe {
            let (setup, points, results) =
                (&raw const setup, &raw const points, &raw const results);
            tem00_imaging_motion_field(imaging.0, setup, points, COUNT, results)
        };
        let case = format!("{wavelength:e} m, {pixel_pitch:e} m");
        if refused {
            number_is_refused("imaging", status);
            assert_eq!(out, room(), "{case}: nothing is written");
        } else {
            assert_eq!(status, Status::Ok, "{case}");
        }
        let numbers = out.iter().flatten().all(|number| !number.is_nan());
        assert!(numbers, "{case}: {out:?}");
    }
}

#[test]
fn results_in_one_place_are_refused() {
    let inputs = inputs();
    let mut out = room();
    let imaging = Owned::new(&LENS);
    let points = points(&inputs, FieldLight::Collimated);
    let setup = setup();
    let mut results = results(&mut out);
    results.pattern_coordinate[1] = results.correlation;
    // SAFETY: the columns are valid, and refused as they overlap.
    let status = unsafe {
        let results = &raw const results;
        tem00_imaging_motion_field(
            imaging.0,
            &raw const setup,
            &raw const points,
            COUNT,
            results,
        )
    };
    pointer_is_refused("pattern_coordinate", status);
}

fn coordinate(setup: &FieldSetup, position: [f64; 3]) -> (Status, [f64; 2]) {
    let imaging = Owned::new(&LENS);
    let mut out = [7.0; 2];
    // SAFETY: the pointers are valid.
    let status = unsafe {
        let out = out.as_mut_ptr();
        tem00_imaging_field_coordinate(imaging.0, setup, position.as_ptr(), out)
    };
    (status, out)
}

#[test]
fn a_point_at_rest_is_looked_up_where_the_field_says() {
    let setup = FieldSetup {
        shared_motion: Motion::default(),
        ..setup()
    };
    let mut inputs = inputs();
    inputs[6..9].fill(vec![0.0; COUNT]);
    let mut out = room();
    let status = evaluate(&setup, &points(&inputs, FieldLight::Collimated), &mut out);
    assert_eq!(status, Status::Ok, "{}", last_parameter());
    let mut places = Vec::new();
    for i in 0..COUNT {
        let (status, got) = coordinate(&setup, [inputs[0][i], inputs[1][i], inputs[2][i]]);
        assert_eq!(status, Status::Ok, "{}", last_parameter());
        assert_eq!(got, [out[5][i], out[6][i]], "point {i}");
        places.push(got);
    }
    assert!(places[0] != places[COUNT - 1], "{places:?}");
}

#[test]
fn a_point_out_of_sight_has_no_coordinate() {
    let behind = EYE.map(|x| 2.0 * x);
    for position in [behind, [f64::NAN; 3]] {
        let (status, out) = coordinate(&setup(), position);
        number_is_refused("position", status);
        assert_eq!(out, [7.0; 2], "nothing is written");
    }
    let flat = FieldSetup {
        pattern_speckle_size: 0.0,
        ..setup()
    };
    number_is_refused("pattern_speckle_size", coordinate(&flat, [0.0; 3]).0);
}
