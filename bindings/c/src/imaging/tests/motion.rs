use tem00_decorrelation::{DMat3, DVec2, LineOfSight};

use super::*;

fn library_point(wave: tem00_decorrelation::Wavefront) -> tem00_decorrelation::SurfacePoint {
    // What `from_axes` makes of the axes may differ from them by rounding.
    let CameraAxes {
        right,
        up,
        towards_camera,
    } = axes();
    let columns = [right, up, towards_camera].map(DVec3::from_array);
    let frame = CameraFrame::from_axes(DMat3::from_cols(columns[0], columns[1], columns[2]));
    let sight = LineOfSight::new(&frame.unwrap(), DVec3::from_array(EYE)).unwrap();
    tem00_decorrelation::SurfacePoint::new(sight, DVec3::new(0.1, 0.2, 1.0), wave).unwrap()
}

fn speckle_motion(point: &SurfacePoint, orientation: ImageOrientation) -> SpeckleMotion {
    let imaging = Owned::new(&LENS);
    // SAFETY: the pointers are valid.
    answer(|out| unsafe {
        tem00_imaging_speckle_motion(imaging.0, point, &MOTION, orientation as u32, out)
    })
}

#[test]
fn speckle_motion_is_that_of_the_library() {
    use tem00_decorrelation::{ImageOrientation as O, SpeckleMotion as S, Wavefront as W};
    let to_source = DVec3::new(0.5, 0.1, 1.0);
    let astigmatic = W::astigmatic(to_source, DVec3::X, 4.0, 1.5).unwrap();
    let spherical = W::spherical(to_source, 4.0).unwrap();
    let round = SurfacePoint {
        wavefront: Wavefront {
            axis: [0.0; 3],
            curvature_across: 4.0,
            ..point().wavefront
        },
        ..point()
    };
    let orientations = [
        (ImageOrientation::ScreenUpright, O::ScreenUpright),
        (ImageOrientation::SensorInverted, O::SensorInverted),
    ];
    for (orientation, of_library) in orientations {
        for (point, wave) in [(point(), astigmatic), (round, spherical)] {
            let speckle = S::new(&geometry(), &library_point(wave), &motion(), of_library);
            let got = speckle_motion(&point, orientation);
            assert_eq!(got, speckle.into(), "{wave:?}, {orientation:?}");
            assert!(got.correlation > 0.0 && got.correlation < 1.0, "{got:?}");
        }
    }
}

#[test]
fn speckle_that_left_the_pupil_is_infinitely_far() {
    let [x, y, z] = EYE;
    let edge_on = SurfacePoint {
        normal: [z, 0.0, -x],
        ..point()
    };
    let got = speckle_motion(&edge_on, ImageOrientation::ScreenUpright);
    assert_eq!(
        got.pupil_displacement,
        [f64::INFINITY; 2],
        "seen edge-on, with y = {y}"
    );
    assert_eq!(got.correlation, 0.0, "seen edge-on");
}

#[test]
fn surface_points_and_motions_are_refused_by_the_name_of_what_is_wrong() {
    let imaging = Owned::new(&LENS);
    let refused = |point: &SurfacePoint, motion: &Motion, orientation| {
        let mut out = SpeckleMotion::default();
        // SAFETY: the pointers are valid.
        unsafe { tem00_imaging_speckle_motion(imaging.0, point, motion, orientation, &raw mut out) }
    };
    each_is_refused(
        point(),
        [
            ("axes", |point| point.camera.up = [0.0; 3]),
            ("to_pupil", |point| point.to_pupil = [f64::NAN; 3]),
            ("normal", |point| point.normal = [0.0; 3]),
            ("direction_to_source", |point| {
                point.wavefront.direction_to_source = [0.0; 3];
            }),
            ("curvature_along", |point| {
                point.wavefront.curvature_along = f64::NAN;
            }),
        ],
        |wrong| refused(wrong, &MOTION, 0),
    );
    each_is_refused(
        MOTION,
        [
            ("surface", |motion| motion.surface = [f64::NAN; 3]),
            ("camera", |motion| motion.camera = [f64::NAN; 3]),
            ("source", |motion| motion.source = [f64::NAN; 3]),
        ],
        |wrong| refused(&point(), wrong, 0),
    );
    number_is_refused("orientation", refused(&point(), &MOTION, 2));
}

#[test]
fn pattern_coordinates_are_those_of_the_library() {
    let imaging = Owned::new(&LENS);
    let (pixel, moved) = ([320.5, 17.0], [3e-6, -8e-6]);
    // SAFETY: the pointers are valid.
    let got: [f64; 2] = answer(|out: *mut [f64; 2]| unsafe {
        let out = out.cast();
        tem00_imaging_pattern_coordinate(imaging.0, pixel.as_ptr(), moved.as_ptr(), 4.0, out)
    });
    let expected = geometry().pattern_coordinate(pixel.into(), moved.into(), 4.0);
    assert_eq!(DVec2::from(got), expected, "of {pixel:?}");
    // SAFETY: the pointers are valid.
    let status = unsafe {
        let out = [0.0; 2].as_mut_ptr();
        tem00_imaging_pattern_coordinate(imaging.0, pixel.as_ptr(), moved.as_ptr(), 0.0, out)
    };
    number_is_refused("pattern_speckle_size", status);
}

fn curvature(direction: [f64; 3], [dp, dl]: [[f64; 6]; 2]) -> (Status, [f64; 6]) {
    let mut out = [7.0; 6];
    // SAFETY: the pointers are valid.
    let status = unsafe {
        let out = out.as_mut_ptr();
        tem00_curvature_from_differentials(direction.as_ptr(), dp.as_ptr(), dl.as_ptr(), out)
    };
    (status, out)
}

/// A source at 0.25 m above a surface at 45° to its light: K t = t/0.25 across z.
const DIFFERENTIALS: [[f64; 6]; 2] = [
    [1.0, 0.0, 1.0, 0.0, 1.0, 0.0],
    [-4.0, 0.0, 0.0, 0.0, -4.0, 0.0],
];

#[test]
fn curvatures_from_differentials_are_those_of_the_source() {
    let (status, got) = curvature([0.0, 0.0, 2.0], DIFFERENTIALS);
    let expected = [4.0, 0.0, 0.0, 4.0, 0.0, 0.0];
    assert_eq!(
        (status, got),
        (Status::Ok, expected),
        "xx, xy, xz, yy, yz, zz"
    );

    // A cylinder turned against the axes has all of xx, xy and yy.
    let [[a, b], [c, d]] = [[3.0, 1.0], [1.0, 2.0]];
    let cylinder = [-a, -b, 0.0, -c, -d, 0.0];
    let (_, got) = curvature([0.0, 0.0, 1.0], [[1.0, 0.0, 0.0, 0.0, 1.0, 0.0], cylinder]);
    assert_eq!(got, [a, b, 0.0, d, 0.0, 0.0], "of {cylinder:?}");
}

#[test]
fn differentials_are_refused_by_the_name_of_what_is_wrong() {
    each_is_refused(
        ([0.0, 0.0, 1.0], DIFFERENTIALS),
        [
            ("direction_to_source", |(direction, _)| {
                *direction = [0.0; 3];
            }),
            ("dp", |(_, [dp, _])| *dp = [1.0; 6]),
            ("dp", |(_, [dp, _])| dp[5] = f64::NAN),
            ("dl", |(_, [_, dl])| dl[5] = f64::INFINITY),
        ],
        |(direction, differentials)| {
            let (status, out) = curvature(*direction, *differentials);
            assert_eq!(out, [7.0; 6], "nothing is written");
            status
        },
    );
}
