use super::*;
use crate::{
    AngularProfile, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile, Placement,
    SpotLight,
};

#[test]
fn a_tight_waist_shows_the_limit_that_the_wavelength_sets() {
    // A wavelength in nanometres: it, and not the radius, is what looks wrong.
    let text = GaussianBeam::from_waist(650.0, 1e-3)
        .unwrap_err()
        .to_string();
    assert!(text.contains("2 M² λ / π = 4.138"), "{text:?}");
    assert!(text.contains("got 1e-3 m"), "{text:?}");
}

#[test]
fn messages_name_the_parameter_and_its_value() {
    let cases = [
        (BeamError::Wavelength(-1.5), "wavelength", "-1.5e0"),
        (BeamError::WaistRadius(-1.5), "waist radius", "-1.5e0"),
        (BeamError::Divergence(2.5), "divergence", "2.5e0"),
        (BeamError::MSquared(0.5), "M²", "5e-1"),
        (BeamError::Growth(0.5), "growth", "5e-1"),
        (BeamError::PowerFraction(1.5), "power fraction", "1.5e0"),
        (BeamError::FanAngle(4.0), "fan angle", "4e0"),
        (BeamError::FocusDistance(1e31), "focus distance", "1e31"),
        (BeamError::Edge(3.0), "edge", "3e0"),
        (
            BeamError::ProfileLength {
                angles: 3,
                powers: 4,
            },
            "profile",
            "3 angles and 4 powers",
        ),
        (
            BeamError::ProfileAngle {
                index: 2,
                angle: 1.75,
            },
            "angles",
            "1.75e0 rad at index 2",
        ),
        (
            BeamError::ProfilePower {
                index: 5,
                power: -1.5,
            },
            "powers",
            "-1.5e0 at index 5",
        ),
        (BeamError::ProfileTotal(0.0), "power", "0e0"),
        (
            BeamError::TabulatedProfile,
            "tabulated",
            "TabulatedLineLight",
        ),
        (
            BeamError::NotTabulated,
            "not tabulated",
            "TabulatedLineLight",
        ),
        (BeamError::WaistDistance(1e31), "waist distance", "1e31"),
        (BeamError::Rotation(f64::INFINITY), "rotation", "inf"),
        (BeamError::RayleighRange(-1.5), "Rayleigh", "-1.5e0"),
        (BeamError::Radius(-1.5), "beam radius", "-1.5e0"),
        (BeamError::Curvature(1e31), "curvature", "1e31"),
        (BeamError::MatrixEntry(f64::INFINITY), "matrix", "inf"),
        (BeamError::Determinant(-1.0), "determinant", "-1e0"),
        (BeamError::NotSymplectic(0.5), "symplectic", "5e-1"),
        (
            BeamError::Determinants { x: 1.0, y: 0.75 },
            "determinants",
            "7.5e-1",
        ),
        (BeamError::HalfTrace(-1.25), "half the trace", "-1.25e0"),
        (BeamError::Length(1e31), "length", "1e31"),
        (BeamError::FocalLength(0.0), "focal length", "0e0"),
        (BeamError::Thickness(-1.0), "thickness", "-1e0"),
        (BeamError::Index(-1.5), "index", "-1.5e0"),
        (BeamError::AngleOfIncidence(1.75), "incidence", "1.75e0"),
        (BeamError::Gradient(-3.0), "gradient", "-3e0"),
        (
            BeamError::PositionMoments(DMat2::ZERO),
            "position moments",
            "[[0, 0], [0, 0]]",
        ),
        (
            BeamError::MixedMoments(DMat2::IDENTITY),
            "mixed moments",
            "[[1, 0], [0, 1]]",
        ),
        (
            BeamError::SlopeMoments(DMat2::ZERO),
            "slope moments",
            "[[0, 0], [0, 0]]",
        ),
        (
            BeamError::ComplexCurvature([[Complex64::I; 2]; 2]),
            "complex curvature",
            "[[0+1i, 0+1i], [0+1i, 0+1i]]",
        ),
        (BeamError::Power(-2.0), "power", "-2e0"),
        (BeamError::Origin(DVec3::X * 7.0), "origin", "[7, 0, 0]"),
        (BeamError::Direction(DVec3::ZERO), "direction", "[0, 0, 0]"),
        (BeamError::FanAxis(DVec3::Z), "fan axis", "[0, 0, 1]"),
        (BeamError::SinglePrecision(1e60), "f32", "1e60"),
        (
            BeamError::Wavelengths { x: 6.5e-7, y: 5e-7 },
            "wavelengths",
            "6.5e-7",
        ),
        (
            BeamError::NotParaxial {
                waist_radius: 1e-9,
                minimum: 1e-7,
            },
            "waist radius",
            "1e-9",
        ),
        (
            BeamError::ApexOffset {
                apex_offset: 1e-8,
                minimum: 1e-6,
            },
            "apex offset",
            "1e-8",
        ),
    ];
    for (error, name, value) in cases {
        let text = error.to_string();
        assert!(text.contains(name), "{text:?} does not name {name:?}");
        assert!(text.contains(value), "{text:?} does not show {value:?}");
    }
}

#[test]
fn the_refused_argument_is_named_as_its_caller_wrote_it() {
    let beam = || GaussianBeam::from_waist(650e-9, 1e-4).unwrap();
    let fan = FanGeometry {
        fan_angle: 4.0,
        apex_offset: 2e-3,
        focus_distance: 0.2,
        focus_curve: FocusCurve::EqualPlane,
    };
    let placement = Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::Z,
    };
    let errors = [
        GaussianBeam::from_waist(650e-9, 1e-8).unwrap_err(),
        GaussianBeam::from_divergence(650e-9, 0.6).unwrap_err(),
        beam().with_m_squared(0.5).unwrap_err(),
        beam().depth_of_focus(1.0).unwrap_err(),
        beam().cross_section_at(0.0).circle_radius(1.0).unwrap_err(),
        LaserLine::new(beam(), fan, LineProfile::GaussianTan).unwrap_err(),
        AngularProfile::new(&[0.1, 0.0], &[1.0, 1.0]).unwrap_err(),
        AngularProfile::new(&[0.0, 0.1], &[0.0, 0.0]).unwrap_err(),
        SpotLight::place(&beam(), 0.1, &placement, 1.0).unwrap_err(),
    ];
    let names = errors.map(|error| error.parameter());
    let expected = [
        "waist_radius",
        "divergence",
        "m_squared",
        "growth",
        "fraction",
        "fan_angle",
        "angles",
        "powers",
        "fan_axis",
    ];
    assert_eq!(names, expected, "the names of arguments");
}
