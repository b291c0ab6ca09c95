use super::*;
use crate::optics::AbcdMatrix;
use crate::{
    AngularProfile, AstigmaticBeam, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile,
    LocatedBeam, Placement, SpotLight,
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
fn messages_name_the_parameter_its_value_and_what_is_allowed() {
    let placement = |origin, direction, fan_axis| {
        let placement = Placement {
            origin,
            direction,
            fan_axis,
        };
        let beam = GaussianBeam::from_waist(650e-9, 1e-4).unwrap();
        SpotLight::place(&beam, 0.0, &placement, 1.0).unwrap_err()
    };
    let located = |wavelength| {
        let beam = GaussianBeam::from_waist(wavelength, 1e-4).unwrap();
        LocatedBeam::new(beam, 0.0).unwrap()
    };
    let glass = AbcdMatrix::flat_interface(1.0, 1.25).unwrap();
    let cases = [
        (
            GaussianBeam::from_waist(-1.5, 1e-4).unwrap_err(),
            "wavelength must be between 1e-30 m and 1e30 m, got -1.5e0 m",
        ),
        (
            GaussianBeam::from_divergence(650e-9, 2.5).unwrap_err(),
            "divergence must be in (0, 0.5] rad, got 2.5e0 rad",
        ),
        (
            located(650e-9).beam().with_m_squared(0.5).unwrap_err(),
            "m_squared must be finite and at least 1, got 5e-1",
        ),
        (
            AngularProfile::new(&[0.0; 3], &[1.0; 4]).unwrap_err(),
            "as many powers as angles, and at least 2, got 3 angles and 4 powers",
        ),
        (
            AngularProfile::new(&[0.0, 0.5, 1.75], &[1.0; 3]).unwrap_err(),
            "angles must be ascending within (-π/2, π/2) rad, got 1.75e0 rad at index 2",
        ),
        (
            AngularProfile::new(&[0.0, 0.1], &[1.0, -1.5]).unwrap_err(),
            "powers must be finite and not negative, got -1.5e0 at index 1",
        ),
        (
            AngularProfile::new(&[0.0, 0.1], &[0.0; 2]).unwrap_err(),
            "powers must be greater than 0 at some angle, got 0e0",
        ),
        (
            placement(DVec3::X * 7e30, DVec3::Z, DVec3::X),
            "origin must be finite and within ±1e30 m, got [7",
        ),
        (
            placement(DVec3::ZERO, DVec3::ZERO, DVec3::X),
            "direction must be finite and of some length, got [0, 0, 0]",
        ),
        (
            placement(DVec3::ZERO, DVec3::Z, DVec3::Z),
            "fan_axis must be finite, of some length and not parallel to the direction, \
             got [0, 0, 1]",
        ),
        (
            AstigmaticBeam::new(located(6.5e-7), located(5e-7)).unwrap_err(),
            "wavelength must be equal in both axes, got 6.5e-7 and 5e-7",
        ),
        (
            AstigmaticBeam::stigmatic(located(6.5e-7))
                .through_axes([AbcdMatrix::identity(), glass])
                .unwrap_err(),
            "determinant must be equal in both axes, got 1e0 and 8e-1",
        ),
        (
            AbcdMatrix::new(1.0, 0.0, 0.0, f64::INFINITY).unwrap_err(),
            "matrix must be finite in all entries, got inf",
        ),
        (
            AbcdMatrix::free_space(1.0)
                .unwrap()
                .eigenmode()
                .unwrap_err(),
            "half_trace must be in (-1, 1) for a beam to reproduce itself, got 1e0",
        ),
        (
            BeamError::single_precision(1e60),
            "single_precision must be able to hold all fields of the light in f32, got 1e60",
        ),
        (
            BeamError::TabulatedProfile,
            "placed as a TabulatedLineLight",
        ),
        (BeamError::NotTabulated, "placed as a LineLight"),
        (
            BeamError::NotParaxial {
                waist_radius: 1e-9,
                minimum: 1e-7,
            },
            "waist radius must be at least 2 M² λ / π = 1e-7 m to be paraxial, got 1e-9 m",
        ),
        (
            BeamError::ApexOffset {
                apex_offset: 1e-8,
                minimum: 1e-6,
            },
            "apex offset must be at least 1e-6 m and at most 1e30 m, got 1e-8 m",
        ),
    ];
    for (error, expected) in cases {
        let text = error.to_string();
        assert!(text.contains(expected), "{text:?} is not {expected:?}");
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
