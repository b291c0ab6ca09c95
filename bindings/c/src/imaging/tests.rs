//! The functions of a camera against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

mod cameras;

use core::ptr;

use tem00_decorrelation::{CorrelationLaw, DVec2, LensData};

use super::*;
use crate::{
    status::Status,
    testing::{each_is_refused, last_parameter, number_is_refused},
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

#[test]
fn laws_are_those_of_the_library() {
    for (s, x) in [(0.0, 0.0), (0.2, 0.3), (-0.5, 1.2), (2.0, 0.1)] {
        // SAFETY: the pointer is valid.
        let got: f64 = answer(|out| unsafe { tem00_correlation(s, x, out) });
        assert_eq!(got, CorrelationLaw::AtPeak.correlation(s, x), "{s}, {x}");
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
