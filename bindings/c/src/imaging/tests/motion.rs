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
    let refused = |point: SurfacePoint, motion: Motion, orientation| {
        let mut out = SpeckleMotion::default();
        // SAFETY: the pointers are valid.
        refusal(unsafe {
            tem00_imaging_speckle_motion(
                imaging.0,
                &raw const point,
                &raw const motion,
                orientation,
                &raw mut out,
            )
        })
    };
    let nan = [f64::NAN; 3];
    let bad_point = |change: fn(&mut SurfacePoint)| {
        let mut point = point();
        change(&mut point);
        refused(point, MOTION, 0)
    };
    assert_eq!(
        bad_point(|p| p.camera.up = [0.0; 3]),
        argument("axes"),
        "camera"
    );
    assert_eq!(
        bad_point(|p| p.to_pupil = [f64::NAN; 3]),
        argument("to_pupil"),
        "sight"
    );
    assert_eq!(
        bad_point(|p| p.normal = [0.0; 3]),
        argument("normal"),
        "normal"
    );
    assert_eq!(
        bad_point(|p| p.wavefront.direction_to_source = [0.0; 3]),
        argument("direction_to_source"),
        "light"
    );
    assert_eq!(
        bad_point(|p| p.wavefront.curvature_along = f64::NAN),
        argument("curvature_along"),
        "curvature"
    );
    for (name, motion) in [
        (
            "surface",
            Motion {
                surface: nan,
                ..MOTION
            },
        ),
        (
            "camera",
            Motion {
                camera: nan,
                ..MOTION
            },
        ),
        (
            "source",
            Motion {
                source: nan,
                ..MOTION
            },
        ),
    ] {
        assert_eq!(refused(point(), motion, 0), argument(name), "{name}");
    }
    assert_eq!(refused(point(), MOTION, 2), argument("orientation"), "2");
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
    assert_eq!(
        refusal(status),
        argument("pattern_speckle_size"),
        "of speckle of no size"
    );
}
