//! The functions of a camera against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

use core::{ffi::CStr, ptr};

use tem00_decorrelation::{
    CameraFrame, DMat3, DVec2, DVec3, FieldSlices, LensData, LineOfSight, MotionField,
    ThickLensData,
};

use super::*;
use crate::status::{Status, tem00_last_error_parameter};

const LENS: LensDescription = LensDescription {
    wavelength: 650e-9,
    focal_length: 25e-3,
    f_number: 8.0,
    pupil_magnification: 1.0,
    focus_kind: Focus::SurfaceToPupil as u32,
    focus: 0.3,
    pixel_pitch: 3.45e-6,
};

const DISTANCES: PupilDistances = PupilDistances {
    wavelength: 650e-9,
    surface_to_pupil: 0.3,
    pupil_to_image: 75e-3,
    pupil_diameter: 10e-3,
    pixel_pitch: 3.45e-6,
};

const EYE: [f64; 3] = [0.02, -0.03, 0.3];

/// A camera that frees itself.
struct Owned(*mut Imaging);

impl Drop for Owned {
    fn drop(&mut self) {
        // SAFETY: it was created by the interface and is not used again.
        unsafe { tem00_imaging_destroy(self.0) };
    }
}

impl Owned {
    fn new(lens: &LensDescription) -> Self {
        let mut imaging = ptr::null_mut();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_imaging_create_lens(lens, &raw mut imaging) };
        assert_eq!(status, Status::Ok, "{}", last_parameter());
        Self(imaging)
    }

    fn info(&self) -> ImagingInfo {
        // SAFETY: the pointers are valid.
        answer(|out| unsafe { tem00_imaging_describe(self.0, out) })
    }
}

fn last_parameter() -> String {
    // SAFETY: the text is that of this thread, and no call fails meanwhile.
    let text = unsafe { CStr::from_ptr(tem00_last_error_parameter()) };
    text.to_str().unwrap().to_owned()
}

fn refusal(status: Status) -> (Status, String) {
    (status, last_parameter())
}

fn argument(name: &str) -> (Status, String) {
    (Status::InvalidArgument, name.to_owned())
}

/// Asks the interface, which must succeed.
fn answer<R: Default>(question: impl FnOnce(*mut R) -> Status) -> R {
    let mut result = R::default();
    assert_eq!(
        question(&raw mut result),
        Status::Ok,
        "{}",
        last_parameter()
    );
    result
}

fn geometry() -> ImagingGeometry {
    ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    })
    .unwrap()
}

fn frame() -> CameraFrame {
    CameraFrame::look_at(DVec3::from_array(EYE), DVec3::ZERO, DVec3::Y).unwrap()
}

fn axes() -> CameraAxes {
    let (target, up) = ([0.0; 3], [0.0, 1.0, 0.0]);
    let mut axes = CameraAxes {
        right: [0.0; 3],
        up: [0.0; 3],
        towards_camera: [0.0; 3],
    };
    // SAFETY: the pointers are valid.
    let status = unsafe {
        tem00_camera_axes_look_at(EYE.as_ptr(), target.as_ptr(), up.as_ptr(), &raw mut axes)
    };
    assert_eq!(status, Status::Ok, "{}", last_parameter());
    axes
}

/// The light falls slantwise and diverges, more along x than across.
fn point() -> SurfacePoint {
    SurfacePoint {
        camera: axes(),
        to_pupil: EYE,
        normal: [0.1, 0.2, 1.0],
        wavefront: Wavefront {
            direction_to_source: [0.5, 0.1, 1.0],
            axis: [1.0, 0.0, 0.0],
            curvature_along: 4.0,
            curvature_across: 1.5,
        },
    }
}

const MOTION: Motion = Motion {
    surface: [1e-4, 2e-4, -3e-5],
    camera: [-2e-5, 1e-5, 4e-5],
    source: [3e-5, -6e-5, 1e-5],
};

fn motion() -> tem00_decorrelation::Motion {
    tem00_decorrelation::Motion {
        surface: DVec3::new(1e-4, 2e-4, -3e-5),
        camera: DVec3::new(-2e-5, 1e-5, 4e-5),
        source: DVec3::new(3e-5, -6e-5, 1e-5),
    }
}

#[test]
fn a_thin_lens_is_that_of_the_library() {
    assert_eq!(
        Owned::new(&LENS).info(),
        ImagingInfo::new(&geometry()),
        "{LENS:?}"
    );
}

#[test]
fn each_number_of_a_camera_is_the_one_of_its_name() {
    let info = Owned::new(&LensDescription {
        pupil_magnification: 0.8,
        focal_length: 50e-3,
        f_number: 4.0,
        focus_kind: Focus::Magnification as u32,
        focus: 0.5,
        ..LENS
    })
    .info();
    // L = f (1/m + 1/m_p), d = f (m + m_p), F_w = F (1 + m/m_p), h = λ F_w, 8 λ (L/D)².
    let expected = [
        (info.wavelength, 650e-9),
        (info.focal_length, 50e-3),
        (info.f_number, 4.0),
        (info.working_f_number, 6.5),
        (info.pupil_diameter, 12.5e-3),
        (info.pupil_magnification, 0.8),
        (info.surface_to_pupil, 162.5e-3),
        (info.pupil_to_image, 65e-3),
        (info.principal_distance, 81.25e-3),
        (info.magnification, 0.5),
        (info.pixel_pitch, 3.45e-6),
        (info.speckle_size, 4.225e-6),
        (info.speckle_size_in_pixels, 4.225 / 3.45),
        (info.object_speckle_size, 650e-9 * 13.0),
        (info.axial_decorrelation_length, 8.0 * 650e-9 * 169.0),
    ];
    for (i, (got, expected)) in expected.into_iter().enumerate() {
        // A few rounded operations each.
        assert!(
            (got / expected - 1.0).abs() < 8.0 * f64::EPSILON,
            "{i}: {got} and {expected}"
        );
    }
}

#[test]
fn thick_lenses_are_those_of_the_library_for_each_kind_of_focus() {
    use tem00_decorrelation::Focus as F;
    let kinds = [
        (Focus::SurfaceToPupil, F::SurfaceToPupil(0.3)),
        (
            Focus::SurfaceToPrincipalPlane,
            F::SurfaceToPrincipalPlane(0.3),
        ),
        (Focus::Magnification, F::Magnification(0.3)),
    ];
    for (kind, focus) in kinds {
        let info = Owned::new(&LensDescription {
            pupil_magnification: 0.8,
            focus_kind: kind as u32,
            ..LENS
        })
        .info();
        let geometry = ImagingGeometry::from_thick_lens(ThickLensData {
            wavelength: 650e-9,
            focal_length: 25e-3,
            f_number: 8.0,
            pupil_magnification: 0.8,
            focus,
            pixel_pitch: 3.45e-6,
        });
        assert_eq!(info, ImagingInfo::new(&geometry.unwrap()), "{kind:?}");
    }
}

#[test]
fn cameras_from_distances_are_those_of_the_library() {
    let mut imaging = ptr::null_mut();
    // SAFETY: the pointers are valid.
    let status = unsafe { tem00_imaging_create_distances(&DISTANCES, &raw mut imaging) };
    assert_eq!(status, Status::Ok, "{}", last_parameter());
    let geometry = ImagingGeometry::from_distances(tem00_decorrelation::PupilDistances {
        wavelength: 650e-9,
        surface_to_pupil: 0.3,
        pupil_to_image: 75e-3,
        pupil_diameter: 10e-3,
        pixel_pitch: 3.45e-6,
    });
    let expected = ImagingInfo::new(&geometry.unwrap());
    assert_eq!(Owned(imaging).info(), expected, "{DISTANCES:?}");
}

#[test]
fn cameras_are_refused_by_the_name_of_what_is_wrong() {
    let create = |lens: LensDescription| {
        let mut imaging = ptr::dangling_mut();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_imaging_create_lens(&raw const lens, &raw mut imaging) };
        assert!(imaging.is_null(), "{lens:?} made a camera");
        refusal(status)
    };
    let nan = f64::NAN;
    assert_eq!(
        create(LensDescription {
            wavelength: nan,
            ..LENS
        }),
        argument("wavelength"),
        "NaN"
    );
    assert_eq!(
        create(LensDescription {
            f_number: 0.1,
            ..LENS
        }),
        argument("f_number"),
        "0.1"
    );
    assert_eq!(
        create(LensDescription { focus: nan, ..LENS }),
        argument("surface_to_pupil"),
        "NaN"
    );
    assert_eq!(
        create(LensDescription {
            focus_kind: 3,
            ..LENS
        }),
        argument("focus_kind"),
        "3"
    );
    let magnification = LensDescription {
        pupil_magnification: nan,
        ..LENS
    };
    assert_eq!(
        create(magnification),
        argument("pupil_magnification"),
        "NaN"
    );
}

#[test]
fn axes_are_those_of_the_library_and_bad_ones_are_refused() {
    let (axes, frame) = (axes(), frame());
    assert_eq!(axes.right, frame.right().to_array(), "right");
    assert_eq!(axes.up, frame.up().to_array(), "up");
    assert_eq!(
        axes.towards_camera,
        frame.towards_camera().to_array(),
        "towards the camera"
    );
    let mut out = axes;
    let (eye, nan) = (EYE.as_ptr(), [f64::NAN; 3]);
    // SAFETY: the pointers are valid or null, which is refused.
    unsafe {
        let status = tem00_camera_axes_look_at(eye, [0.0; 3].as_ptr(), nan.as_ptr(), &raw mut out);
        assert_eq!(refusal(status), argument("up"), "NaN");
        let status = tem00_camera_axes_look_at(eye, eye, eye, &raw mut out);
        assert_eq!(refusal(status).0, Status::InvalidArgument, "no view");
        let status = tem00_camera_axes_look_at(ptr::null(), eye, eye, &raw mut out);
        assert_eq!(
            refusal(status),
            (Status::InvalidPointer, "position".to_owned()),
            "null"
        );
    }
}

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

#[test]
fn laws_are_those_of_the_library() {
    for (s, x) in [(0.0, 0.0), (0.2, 0.3), (-0.5, 1.2), (2.0, 0.1)] {
        // SAFETY: the pointer is valid.
        let got: f64 = answer(|out| unsafe { tem00_correlation(s, x, out) });
        assert_eq!(got, tem00_decorrelation::correlation(s, x), "{s}, {x}");
        // SAFETY: the pointer is valid.
        let u: f64 = answer(|out| unsafe { tem00_slice_coordinate(got, 8, out) });
        assert_eq!(u, tem00_decorrelation::slice_coordinate(got, 8), "{got}");
    }
    let nan = f64::NAN;
    let mut out = 0.0;
    // SAFETY: the pointer is valid.
    let refusals = unsafe {
        [
            (
                "pupil_shift",
                refusal(tem00_correlation(nan, 0.0, &raw mut out)),
            ),
            (
                "axial_shift",
                refusal(tem00_correlation(0.0, nan, &raw mut out)),
            ),
            (
                "correlation",
                refusal(tem00_slice_coordinate(nan, 8, &raw mut out)),
            ),
        ]
    };
    for (name, refused) in refusals {
        assert_eq!(refused, argument(name), "NaN for {name}");
    }
}

#[test]
fn threads_may_share_a_camera() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Imaging>();
}

mod field;
