use super::*;

/// Tries to create a light, and returns the status: no light is made.
fn refused(create: impl FnOnce(*mut *mut Light) -> Status) -> Status {
    let mut handle = ptr::dangling_mut();
    let status = create(&raw mut handle);
    assert!(handle.is_null(), "a light was made");
    status
}

#[test]
fn a_spot_refuses_each_number_that_is_wrong() {
    each_is_refused(
        SPOT,
        [
            ("wavelength", |spot| spot.wavelength = f64::NAN),
            ("waist_radius", |spot| spot.waist_radius = -1e-3),
            ("m_squared", |spot| spot.m_squared = 0.9),
            ("power", |spot| spot.power = -1.0),
            ("waist_distance", |spot| spot.waist_distance = f64::INFINITY),
            ("origin", |spot| spot.placement.origin = [f64::NAN; 3]),
            ("direction", |spot| spot.placement.direction = [0.0; 3]),
            ("fan_axis", |spot| {
                spot.placement.fan_axis = PLACEMENT.direction;
            }),
        ],
        // SAFETY: the description is valid.
        |spot| refused(|handle| unsafe { tem00_light_create_spot(spot, handle) }),
    );
}

#[test]
fn an_elliptic_beam_refuses_the_numbers_of_either_axis_and_says_which() {
    each_is_refused(
        ELLIPTIC,
        [
            ("waist_radius[0]", |beam| beam.waist_radius[0] = 0.0),
            ("waist_radius[1]", |beam| beam.waist_radius[1] = 0.0),
            ("m_squared[0]", |beam| beam.m_squared[0] = 0.5),
            ("m_squared[1]", |beam| beam.m_squared[1] = 0.5),
            ("waist_distance[0]", |beam| beam.waist_distance[0] = 2e30),
            ("waist_distance[1]", |beam| beam.waist_distance[1] = 2e30),
            ("wavelength", |beam| beam.wavelength = 0.0),
            ("rotation", |beam| beam.rotation = f64::NAN),
        ],
        // SAFETY: the description is valid.
        |beam| refused(|handle| unsafe { tem00_light_create_elliptic(beam, handle) }),
    );
}

#[test]
fn a_line_refuses_each_number_that_is_wrong() {
    // SAFETY: the description is valid, or its table is refused.
    let create =
        |line: &LineDescription| refused(|handle| unsafe { tem00_light_create_line(line, handle) });
    each_is_refused(
        LINE,
        [
            ("fan_angle", |line| line.fan_angle = 4.0),
            ("apex_offset", |line| line.apex_offset = 0.0),
            ("focus_distance", |line| line.focus_distance = f64::NAN),
            ("focus_curve", |line| line.focus_curve = 2),
            ("profile", |line| line.profile = 7),
            ("edge", |line| line.edge = f64::NAN),
        ],
        create,
    );
    let without_table = LineDescription {
        angles: ptr::null(),
        ..tabulated()
    };
    pointer_is_refused("angles", create(&without_table));
    let short = LineDescription {
        knot_count: 1,
        ..tabulated()
    };
    assert_eq!(create(&short), Status::InvalidArgument, "one knot");
}

const ALONG_Z: Placement = Placement {
    origin: [0.0; 3],
    direction: [0.0, 0.0, 1.0],
    fan_axis: [1.0, 0.0, 0.0],
};

/// The irradiance of a line at the fan angle `theta`, 0.3 m from its apex.
fn irradiance_at(description: &LineDescription, theta: f64) -> f64 {
    let mut handle = ptr::null_mut();
    let mut irradiance = 0.0;
    let point = [0.3 * theta.sin(), 0.0, 0.3 * theta.cos() - LINE.apex_offset];
    // SAFETY: the description is valid, and the light destroyed once.
    unsafe {
        let status = tem00_light_create_line(&raw const *description, &raw mut handle);
        assert_eq!(status, Status::Ok, "{description:?}");
        let status = tem00_light_irradiance(handle, point.as_ptr(), &raw mut irradiance);
        assert_eq!(status, Status::Ok, "{description:?}");
        tem00_light_destroy(handle);
    }
    irradiance
}

#[test]
fn each_profile_and_each_focus_curve_is_the_one_of_its_name() {
    use tem00_beam::{FocusCurve as F, LineProfile as P};
    let profiles = [
        (LineProfile::GaussianTan, P::GaussianTan),
        (LineProfile::GaussianAngle, P::GaussianAngle),
        (LineProfile::GaussianSin, P::GaussianSin),
        (LineProfile::UniformTan, P::UniformTan),
        (LineProfile::UniformAngle, P::UniformAngle),
        (LineProfile::Powell, P::Powell { edge: 0.1 }),
    ];
    let curves = [
        (FocusCurve::EqualDistance, F::EqualDistance),
        (FocusCurve::EqualPlane, F::EqualPlane),
    ];
    let placed = tem00_beam::Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::X,
    };
    for (profile, of_library) in &profiles {
        for (curve, curve_of_library) in curves {
            let description = LineDescription {
                placement: ALONG_Z,
                profile: *profile as u32,
                focus_curve: curve as u32,
                ..LINE
            };
            let fan = FanGeometry {
                fan_angle: 0.5,
                apex_offset: 2e-3,
                focus_distance: 0.25,
                focus_curve: curve_of_library,
            };
            let line = LaserLine::new(beam(80e-6, 1.2), fan, of_library.clone()).unwrap();
            let light = LineLight::place(&line, &placed, 2e-3).unwrap();
            for theta in [-0.2_f64, 0.0, 0.11] {
                let point = [0.3 * theta.sin(), 0.0, 0.3 * theta.cos() - 2e-3];
                let got = irradiance_at(&description, theta);
                assert_eq!(
                    got,
                    light.irradiance(point),
                    "{profile:?} {curve:?} at {theta}"
                );
            }
        }
    }
}

#[test]
fn a_light_keeps_a_copy_of_its_table() {
    let mut angles = ANGLES.to_vec();
    let mut handle = ptr::null_mut();
    let description = LineDescription {
        placement: ALONG_Z,
        angles: angles.as_ptr(),
        ..tabulated()
    };
    let point = [0.0, 0.0, 0.2];
    let mut irradiance = [0.0; 2];
    // SAFETY: the description is valid, and the light destroyed once.
    unsafe {
        tem00_light_create_line(&raw const description, &raw mut handle);
        tem00_light_irradiance(handle, point.as_ptr(), &raw mut irradiance[0]);
        angles.fill(0.0);
        tem00_light_irradiance(handle, point.as_ptr(), &raw mut irradiance[1]);
        tem00_light_destroy(handle);
    }
    assert!(irradiance[0] > 0.0, "on the axis");
    assert_eq!(
        irradiance[0], irradiance[1],
        "before and after the table has changed"
    );
}
