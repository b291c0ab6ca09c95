//! The functions of a camera against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

mod cameras;
mod field;
mod motion;

use core::ptr;

use tem00_decorrelation::{CameraFrame, DVec3, LensData};

use super::*;
use crate::{
    status::Status,
    testing::{each_is_refused, last_parameter, number_is_refused, pointer_is_refused},
};

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
        number_is_refused("up", status);
        let status = tem00_camera_axes_look_at(eye, eye, eye, &raw mut out);
        assert_eq!(status, Status::InvalidArgument, "no view");
        let status = tem00_camera_axes_look_at(ptr::null(), eye, eye, &raw mut out);
        pointer_is_refused("position", status);
    }
}

#[test]
fn laws_are_those_of_the_library() {
    for (s, x) in [(0.0, 0.0), (0.2, 0.3), (-0.5, 1.2), (2.0, 0.1)] {
        // SAFETY: the pointer is valid.
        let got: f64 = answer(|out| unsafe { tem00_correlation(s, x, out) });
        assert_eq!(got, tem00_decorrelation::correlation(s, x), "{s}, {x}");
    }
    let nan = f64::NAN;
    let mut out = 0.0;
    // SAFETY: the pointer is valid.
    unsafe {
        number_is_refused("pupil_shift", tem00_correlation(nan, 0.0, &raw mut out));
        number_is_refused("axial_shift", tem00_correlation(0.0, nan, &raw mut out));
    }
}

#[test]
fn threads_may_share_a_camera() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Imaging>();
}
