//! A refusal names the parameter, its value and what is allowed.

use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, DMat3, DVec3, Focus, Illumination,
    ImagingGeometry, LensData, LineOfSight, PupilDistances, RigidMotion, ThickLensData, Wavefront,
};

const LENS: LensData = LensData {
    wavelength: 650e-9,
    focal_length: 25e-3,
    f_number: 8.0,
    surface_to_pupil: 0.3,
    pixel_pitch: 3.45e-6,
};

const DISTANCES: PupilDistances = PupilDistances {
    wavelength: 650e-9,
    surface_to_pupil: 0.3,
    pupil_to_image: 30e-3,
    pupil_diameter: 3e-3,
    pixel_pitch: 3.45e-6,
};

/// Holds each refusal to its parameter and its text.
macro_rules! refusals {
    ($($result:expr => $parameter:literal: $text:literal,)*) => {$({
        let error = $result.expect_err($parameter);
        assert_eq!(error.parameter(), $parameter, "{error}");
        assert_eq!(error.to_string(), concat!($parameter, " must be ", $text));
    })*};
}

#[test]
fn refused_lenses_name_the_parameter_the_value_and_what_is_allowed() {
    let lens = ImagingGeometry::from_lens;
    let distances = ImagingGeometry::from_distances;
    let thick = |pupil_magnification, focus| {
        ImagingGeometry::from_thick_lens(ThickLensData {
            wavelength: 650e-9,
            focal_length: 25e-3,
            f_number: 8.0,
            pupil_magnification,
            focus,
            pixel_pitch: 3.45e-6,
        })
    };
    refusals! {
        lens(LensData { wavelength: -1.25, ..LENS }) =>
            "wavelength": "positive and finite, in metres, got -1.25",
        lens(LensData { focal_length: 0.0, ..LENS }) =>
            "focal_length": "positive and finite, in metres, got 0",
        lens(LensData { f_number: 0.25, ..LENS }) =>
            "f_number": "finite and at least 0.5, the limit of any lens in air, got 0.25",
        lens(LensData { pixel_pitch: f64::NAN, ..LENS }) =>
            "pixel_pitch": "positive and finite, in metres, got NaN",
        lens(LensData { surface_to_pupil: 0.02, ..LENS }) =>
            "surface_to_pupil": "finite and exceed the focal length of 0.025 m, got 0.02 m",
        lens(LensData { focal_length: 0.25, f_number: 524_288.0, ..LENS }) =>
            "pupil_diameter": "finite and exceed the wavelength of 6.5e-7 m, got 4.76837158203125e-7 m",
        distances(PupilDistances { pupil_to_image: -1.0, ..DISTANCES }) =>
            "pupil_to_image": "positive and finite, in metres, got -1",
        distances(PupilDistances { pupil_diameter: 61e-3, ..DISTANCES }) =>
            "pupil_diameter":
            "at most twice the distance of 0.03 m to surface or sensor, got 0.061 m",
        thick(-1.0, Focus::Magnification(1.0)) =>
            "pupil_magnification": "positive and finite, got -1",
        thick(1.0, Focus::Magnification(-1.0)) =>
            "magnification":
            "positive and finite, with the distances that follow from it, got -1",
        thick(1.0, Focus::SurfaceToPrincipalPlane(0.02)) =>
            "surface_to_principal_plane":
            "finite and exceed the focal length of 0.025 m, got 0.02 m",
        thick(0.5, Focus::SurfaceToPupil(0.04)) =>
            "surface_to_pupil":
            "finite and exceed the focal length over the pupil magnification of 0.05 m, got 0.04 m",
    }
}

#[test]
fn refused_vectors_name_the_parameter_the_value_and_what_is_allowed() {
    let (x, y, zero) = (DVec3::X, DVec3::Y, DVec3::ZERO);
    let skew = DMat3::from_cols(x, x, x);
    let camera = CameraFrame::look_at(DVec3::Z, zero, y).expect("a view");
    let columns = "[[1, 0, 0], [1, 0, 0], [1, 0, 0]]";
    let axes = CameraFrame::from_axes(skew).expect_err("skew").to_string();
    assert_eq!(
        axes,
        format!("axes must be right-handed and orthonormal within 1e-6, got columns {columns}")
    );
    refusals! {
        CameraFrame::look_at(x, x, y) =>
            "target": "at a finite vector from the camera that is not zero, in metres, got [0, 0, 0]",
        CameraFrame::look_at(x, zero, x) =>
            "up": "finite, not zero and not along the view, got [1, 0, 0]",
        LineOfSight::new(&camera, -DVec3::Z) =>
            "to_pupil":
            "finite, in metres, and lead from a point in front of the camera, got [-0, -0, -1]",
        Configuration::new(ConfigurationData {
            wavelength: 650e-9,
            point: zero,
            normal: zero,
            illumination: Illumination::collimated(DVec3::Z).expect("light"),
            camera,
            pupil: DVec3::Z,
        }) =>
            "normal": "finite and not zero, got [0, 0, 0]",
        Wavefront::plane(zero) =>
            "direction_to_source": "finite and not zero, got [0, 0, 0]",
        Wavefront::spherical(x, f64::INFINITY) =>
            "curvature": "finite, in 1/m (1/R), got inf",
        Wavefront::from_tensor(x, skew) =>
            "curvature":
            "finite and symmetric within 1e-6, in 1/m, got columns [[1, 0, 0], [1, 0, 0], [1, 0, 0]]",
        Wavefront::astigmatic(x, x, 1.0, 1.0) =>
            "axis": "finite, not zero and not along the direction to the source, got [1, 0, 0]",
        Illumination::point_source(DVec3::NAN) =>
            "position": "finite, in metres, got [NaN, NaN, NaN]",
        RigidMotion::about(zero, zero, 1.0) =>
            "axis": "finite and not zero, got [0, 0, 0]",
        RigidMotion::about(zero, x, f64::NAN) =>
            "angle": "finite, in radians, got NaN",
        RigidMotion::about(DVec3::INFINITY, x, 1.0) =>
            "pivot": "finite, in metres, got [inf, inf, inf]",
        RigidMotion::along(DVec3::NAN) =>
            "translation": "finite, in metres, got [NaN, NaN, NaN]",
    }
}
