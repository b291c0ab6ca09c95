//! The functions of a camera against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

use core::ptr::{null, null_mut};

use tem00_decorrelation::{CorrelationLaw, LensData, ThickLensData};

use super::*;
use crate::testing::{Owned, each_is_refused};

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

fn imaging(lens: &LensDescription) -> Owned<Imaging> {
    Owned::new(tem00_imaging_create_lens, lens, tem00_imaging_destroy)
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
fn cameras_are_those_of_the_library() {
    use tem00_decorrelation::Focus as F;
    let thick = |focus_kind: Focus, focus| {
        let pupil_magnification = 0.8;
        let lens = imaging(&LensDescription {
            pupil_magnification,
            focus_kind: focus_kind as u32,
            ..LENS
        });
        let geometry = ImagingGeometry::from_thick_lens(ThickLensData {
            wavelength: 650e-9,
            focal_length: 25e-3,
            f_number: 8.0,
            pupil_magnification,
            focus,
            pixel_pitch: 3.45e-6,
        });
        (lens, geometry.unwrap())
    };
    let (create, destroy) = (tem00_imaging_create_distances, tem00_imaging_destroy);
    let distances = ImagingGeometry::from_distances(DISTANCES.into()).unwrap();
    for (imaging, geometry) in [
        (imaging(&LENS), geometry()),
        (Owned::new(create, &DISTANCES, destroy), distances),
        thick(Focus::SurfaceToPupil, F::SurfaceToPupil(0.3)),
        thick(
            Focus::SurfaceToPrincipalPlane,
            F::SurfaceToPrincipalPlane(0.3),
        ),
        thick(Focus::Magnification, F::Magnification(0.3)),
    ] {
        agree! { geometry; tem00_imaging_describe(imaging.handle) = ImagingInfo::new(&geometry); }
    }
}

#[test]
fn coordinates_and_laws_are_those_of_the_library() {
    let imaging = imaging(&LENS);
    let (pixel, moved) = ([320.5, 17.0], [3e-6, -8e-6]);
    let (p, m) = (pixel.as_ptr(), moved.as_ptr());
    let expected = geometry().pattern_coordinate(pixel.into(), moved.into(), 4.0);
    agree! { p; tem00_imaging_pattern_coordinate(imaging.handle, p, m, 4.0) = expected.to_array(); }
    for (s, x) in [(0.0, 0.0), (0.2, 0.3), (-0.5, 1.2), (2.0, 0.1)] {
        agree! { s; tem00_correlation(s, x) = CorrelationLaw::AtPeak.correlation(s, x); }
    }
    let mut room = [7.0; 2];
    let (out, mut made, nan) = (room.as_mut_ptr(), null_mut(), f64::NAN);
    refused! {
        InvalidArgument {
            "pupil_shift" tem00_correlation(nan, 0.0, out);
            "axial_shift" tem00_correlation(0.0, nan, out);
            "pattern_speckle_size" tem00_imaging_pattern_coordinate(imaging.handle, p, m, 0.0, out);
        }
        InvalidPointer {
            "correlation" tem00_correlation(0.0, 0.0, null_mut());
            "imaging" tem00_imaging_pattern_coordinate(null(), p, m, 4.0, out);
            "pixel" tem00_imaging_pattern_coordinate(imaging.handle, null(), m, 4.0, out);
            "displacement" tem00_imaging_pattern_coordinate(imaging.handle, p, null(), 4.0, out);
            "info" tem00_imaging_describe(imaging.handle, null_mut());
            "description" tem00_imaging_create_lens(null(), &raw mut made);
            "distances" tem00_imaging_create_distances(null(), &raw mut made);
        }
    }
    assert_eq!(room, [7.0; 2], "nothing is written");
}

#[test]
fn cameras_are_refused_by_the_name_of_what_is_wrong() {
    each_is_refused(
        LENS,
        [
            ("wavelength", |lens| lens.wavelength = f64::NAN),
            ("f_number", |lens| lens.f_number = 0.1),
            ("focus", |lens| lens.focus = f64::NAN),
            ("focus_kind", |lens| lens.focus_kind = 3),
            ("pupil_magnification", |lens| {
                lens.pupil_magnification = f64::NAN;
            }),
            ("focus", |lens| {
                (lens.focus_kind, lens.focus) = (Focus::SurfaceToPrincipalPlane as u32, -1.0);
            }),
            ("focus", |lens| {
                (lens.focus_kind, lens.focus) = (Focus::Magnification as u32, -1.0);
            }),
        ],
        // SAFETY: the pointers are valid.
        |lens, handle| unsafe { tem00_imaging_create_lens(lens, handle) },
    );
}
