//! A refusal names the parameter, its value and what is allowed.

use tem00_wave::{
    Amplitudes, Arrangement, BeamDescription, Camera, DMat3, DVec3, FanDescription, Illumination,
    Lens, PatchDescription, RigidMotion, RoughSurface, Roughness, SamplePlane, Scatterer,
};

const BEAM: BeamDescription = BeamDescription {
    wavelength: 650e-9,
    waist: DVec3::ZERO,
    direction: DVec3::Z,
    waist_radius: 1e-3,
};

const FAN: FanDescription = FanDescription {
    wavelength: 650e-9,
    apex: DVec3::ZERO,
    direction: DVec3::Z,
    opening: DVec3::X,
    half_angle: 0.3,
    waist_radius: 1e-4,
    waist_distance: 0.3,
};

const PATCH: PatchDescription = PatchDescription {
    centre: DVec3::ZERO,
    normal: DVec3::Z,
    along: DVec3::X,
    size: [1e-3; 2],
    scatterers: [8; 2],
    arrangement: Arrangement::Lattice,
    roughness: Roughness::FullyDeveloped(Amplitudes::Unit),
    seed: 1,
};

const LENS: Lens = Lens {
    pupil_diameter: 3e-3,
    focus_distance: 0.3,
    pupil_to_image: 0.03,
};

/// Holds each refusal to its text.
macro_rules! refusals {
    ($($result:expr => $text:literal,)*) => {$(
        assert_eq!($result.expect_err($text).to_string(), $text);
    )*};
}

#[test]
fn refused_light_names_the_parameter_the_value_and_what_is_allowed() {
    let beam = |beam| Illumination::gaussian_beam(&beam);
    let fan = |fan| Illumination::fan(&fan);
    refusals! {
        Illumination::plane(-1.25, DVec3::Z) =>
            "wavelength must be from 1e-10 to 1, in metres, got -1.25",
        Illumination::plane(650e-9, DVec3::ZERO) =>
            "direction must be finite and not zero, got [0, 0, 0]",
        Illumination::point(650e-9, DVec3::NAN) =>
            "position must be finite and at most 1e4 in each component, in metres, got [NaN, NaN, NaN]",
        beam(BeamDescription { waist_radius: -1.0, ..BEAM }) =>
            "waist_radius must be from 1e-12 to 1e4, in metres, got -1",
        beam(BeamDescription { wavelength: 0.5, waist_radius: 0.125, ..BEAM }) =>
            "waist_radius must be at least the paraxial limit of 0.3183098861837907 m, got 0.125 m",
        fan(FanDescription { half_angle: 1.75, ..FAN }) =>
            "half_angle must be between 0 and π/2, in radians, got 1.75",
        fan(FanDescription { waist_distance: 1e30, ..FAN }) =>
            "waist_distance must be finite and at most 1e4 in magnitude, in metres, got 1e30",
        fan(FanDescription { opening: DVec3::Z, ..FAN }) =>
            "opening must be finite, not zero and not along the direction of the fan, got [0, 0, 1]",
    }
}

#[test]
fn refused_surfaces_name_the_parameter_the_value_and_what_is_allowed() {
    let patch = |patch| RoughSurface::patch(&patch);
    let heights = |rms, correlation_length| Roughness::Heights {
        rms,
        correlation_length,
    };
    let bright = Scatterer {
        position: DVec3::ZERO,
        amplitude: tem00_wave::Complex::new(0.5, 1e30),
    };
    refusals! {
        patch(PatchDescription { size: [1.0, -1.25], ..PATCH }) =>
            "size must be from 1e-12 to 1e4, in metres, got -1.25",
        patch(PatchDescription { scatterers: [0, 7], ..PATCH }) =>
            "scatterers must be from 1 to 2²⁸ in all, got 0",
        patch(PatchDescription { along: DVec3::Z, ..PATCH }) =>
            "along must be finite, not zero and not along the normal, got [0, 0, 1]",
        patch(PatchDescription { roughness: heights(-1.0, 0.0), ..PATCH }) =>
            "rms must be 0 or from 1e-12 to 1e4, in metres, got -1",
        patch(PatchDescription { roughness: heights(0.0, 1e5), ..PATCH }) =>
            "correlation_length must be 0 or from 1e-12 to 1e4, in metres, got 100000",
        RoughSurface::from_scatterers(vec![bright]) =>
            "amplitude must be finite and at most 1e4 in each component, in metres, got [0.5, \
             1000000000000000000000000000000, 0]",
        RigidMotion::translation(DVec3::X * 1e5) =>
            "translation must be finite and at most 1e4 in each component, in metres, got [100000, 0, 0]",
        SamplePlane::new(DVec3::ZERO, [DVec3::X, DVec3::Y], [0, 7]) =>
            "samples must be from 1 to 2²⁸ in all, got 0",
    }
}

#[test]
fn refused_cameras_name_the_parameter_the_value_and_what_is_allowed() {
    let (x, y, zero) = (DVec3::X, DVec3::Y, DVec3::ZERO);
    refusals! {
        Camera::new(zero, DMat3::ZERO, LENS) =>
            "axes must be right-handed and orthonormal within 1e-6, got columns \
             [[0, 0, 0], [0, 0, 0], [0, 0, 0]]",
        Camera::look_at([x, x], y, LENS) =>
            "target must be at a finite vector from the camera that is not zero, in metres, got \
             [0, 0, 0]",
        Camera::look_at([x, zero], x, LENS) =>
            "up must be finite, not zero and not along the view, got [1, 0, 0]",
        Camera::look_at([x, zero], y, Lens { pupil_diameter: 0.0, ..LENS }) =>
            "pupil_diameter must be from 1e-12 to 1e4, in metres, got 0",
    }
}
