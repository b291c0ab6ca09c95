use super::Light;
use crate::{
    numbers::{read_direction, read_point},
    pointers::borrow,
    status::Status,
};

/// Parameters of a light.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightInfo {
    /// Centre of the aperture, in metres.
    pub origin: [f64; 3],
    /// Power, in watts.
    pub power: f64,
    /// Unit vector along the direction of travel.
    pub axis: [f64; 3],
    /// Wavelength in the medium, in metres.
    pub wavelength: f64,
}

/// The light that a ray meets on its way to the aperture; all 0 if it meets none.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ApertureHit {
    /// Point of the aperture plane, in metres.
    pub point: [f64; 3],
    /// Distance to that point, in metres.
    pub distance: f64,
    /// Radiance that arrives along the ray, in W/(m² sr).
    pub radiance: f64,
    /// Probability density with which a sampled next event has this direction, per steradian.
    pub pdf: f64,
}

/// Tells what a light was made with.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_describe(light: *const Light, info: *mut LightInfo) -> Status {
    answer!(light: borrow => info: light.ask(|light| LightInfo {
        origin: light.origin(),
        power: light.power(),
        axis: light.axis(),
        wavelength: light.wavelength(),
    }))
}

/// Finds the light that a ray from `point` along `wi` meets, for a direction that a material has
/// drawn: the other technique beside `tem00_light_next_event_sampled`.
///
/// A direction of the density q, per steradian, has the weight q / (q + `pdf`) of the balance
/// heuristic. Only what is nearer than `distance` hides the light. Where the ray meets none, all of
/// `hit` is 0. `point` and `wi`, of any length but 0, hold x, y, z.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_hit(
    light: *const Light,
    point: *const f64,
    wi: *const f64,
    hit: *mut ApertureHit,
) -> Status {
    answer!(light: borrow, point: read_point, wi: read_direction => hit: {
        let found = light.ask(|light| light.hit(point, wi));
        found.map(ApertureHit::from).unwrap_or_default()
    })
}

/// Computes a bound of the power, in watts, that reaches the box from `min` to `max`, for a
/// hierarchy of lights: 0 if the box is behind the aperture, beyond the cut-off or empty.
///
/// `min` and `max` hold x, y, z in metres.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_power_bound(
    light: *const Light,
    min: *const f64,
    max: *const f64,
    bound: *mut f64,
) -> Status {
    answer!(light: borrow, min: read_point, max: read_point =>
        bound: light.ask(|light| light.power_bound(min, max)))
}

same_fields! {
    tem00_beam::ApertureHit => ApertureHit { point, distance, radiance, pdf }
}
