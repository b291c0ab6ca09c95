use super::*;
use crate::{
    status::Status,
    testing::{each_is_refused, refuses},
};

#[test]
fn each_number_of_a_light_that_is_wrong_is_refused_by_its_name() {
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
        // SAFETY: the pointers are valid.
        |spot, handle| unsafe { tem00_light_create_spot(spot, handle) },
    );
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
        // SAFETY: the pointers are valid.
        |beam, handle| unsafe { tem00_light_create_elliptic(beam, handle) },
    );
    // SAFETY: the pointers are valid, or those of the table null, which is refused.
    let create = |line, handle: *mut _| unsafe { tem00_light_create_line(line, handle) };
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
    let mut handle = core::ptr::dangling_mut();
    let (mut null_table, mut short) = (TABULATED, TABULATED);
    null_table.angles = null();
    short.knot_count = 1;
    refuses(
        "angles",
        Status::InvalidPointer,
        create(&raw const null_table, &raw mut handle),
    );
    let short = create(&raw const short, &raw mut handle);
    assert_eq!(short, Status::InvalidArgument, "one knot");
    assert!(handle.is_null(), "a light was made");
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
    for (profile, of_library) in &profiles {
        for (curve, curve_of_library) in curves {
            let light = line(&LineDescription {
                profile: *profile as u32,
                focus_curve: curve as u32,
                ..LINE
            });
            let peer = laser_line(of_library.clone(), curve_of_library);
            let peer = LineLight::place(&peer, &placement(), 2e-3).unwrap();
            for p in points(&peer) {
                let context = (profile, curve);
                agree! {
                    context;
                    tem00_light_irradiance(light.handle, p.as_ptr()) = peer.irradiance(p);
                }
            }
        }
    }
}

#[test]
fn a_light_keeps_a_copy_of_its_table() {
    let mut angles = ANGLES.to_vec();
    let light = line(&LineDescription {
        angles: angles.as_ptr(),
        ..TABULATED
    });
    let on_axis = core::array::from_fn(|i| PLACEMENT.origin[i] + 0.2 * PLACEMENT.direction[i]);
    let on_axis: [f64; 3] = on_axis;
    let before: f64 = ask!(tem00_light_irradiance(light.handle, on_axis.as_ptr()));
    angles.fill(0.0);
    agree! {
        "after it has changed";
        tem00_light_irradiance(light.handle, on_axis.as_ptr()) = before;
    }
    assert!(before > 0.0, "on the axis");
}
