use tem00_decorrelation::ThickLensData;

use super::*;

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
    let create = |lens: &LensDescription| {
        let mut imaging = ptr::dangling_mut();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_imaging_create_lens(lens, &raw mut imaging) };
        assert!(imaging.is_null(), "{lens:?} made a camera");
        status
    };
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
        create,
    );
}
