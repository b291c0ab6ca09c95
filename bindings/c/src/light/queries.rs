use super::{Light, batch::Precision};
use crate::{
    numbers::{check_length, read_direction, read_point, read_variates},
    pointers::borrow,
    status::Status,
};

/// The light at a point, as one direction and one irradiance; all 0 where it is dark.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NextEvent {
    /// Point of the aperture plane that the light seems to come from, in metres.
    pub point: [f64; 3],
    /// Distance to that point, in metres.
    pub distance: f64,
    /// Unit vector towards the light, against the mean energy flow.
    pub wi: [f64; 3],
    /// Irradiance of a surface square to `wi`, in W/m².
    pub e_perp: f64,
}

/// Next event in single precision, otherwise as `tem00_next_event`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NextEventF32 {
    /// Point of the aperture plane that the light seems to come from, in metres.
    pub point: [f32; 3],
    /// Distance to that point, in metres.
    pub distance: f32,
    /// Unit vector towards the light, against the mean energy flow.
    pub wi: [f32; 3],
    /// Irradiance of a surface square to `wi`, in W/m².
    pub e_perp: f32,
}

/// The light at a point, as a random direction and its density; all 0 where it is dark.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampledEvent {
    /// Point of the aperture plane that the ray comes from, in metres.
    pub point: [f64; 3],
    /// Distance to that point, in metres.
    pub distance: f64,
    /// Unit vector towards the light.
    pub wi: [f64; 3],
    /// Radiance divided by `pdf`, in W/m².
    pub value: f64,
    /// Probability density of `wi`, per steradian.
    pub pdf: f64,
}

/// A ray that leaves the aperture.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RaySample {
    /// Point of the aperture plane, in metres.
    pub origin: [f64; 3],
    /// Power of the light, in watts, to be divided by the number of rays.
    pub flux: f64,
    /// Unit vector along the ray.
    pub direction: [f64; 3],
    /// Cosine of the angle between the ray and the axis.
    pub cos: f64,
    /// Probability densities of the ray.
    pub pdf: RayPdf,
}

/// The probability densities of a ray, whose joint density factors in two ways: position times
/// direction given position, which bidirectional methods want, and direction times position given
/// direction, which a ray is drawn from. Positions are those on the aperture plane.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RayPdf {
    /// Density of the position, whatever the direction, per m² of the aperture plane.
    pub position: f64,
    /// Density of the direction at this position, per steradian.
    pub direction_given_position: f64,
    /// Density of the direction, wherever the ray starts, per steradian.
    pub direction: f64,
    /// Density of the position among the rays of this direction, per m² of the aperture plane.
    pub position_given_direction: f64,
}

/// Bounds of the light in space and direction, as a light hierarchy stores them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Smallest corner of a box around the lit volume, in metres.
    pub min: [f64; 3],
    /// Largest corner of the box, in metres.
    pub max: [f64; 3],
    /// Unit vector along the axis.
    pub axis: [f64; 3],
    /// Half-angle of the cone about `axis` that the light travels in, in radians.
    pub half_angle: f64,
}

/// Computes the irradiance, in W/m², of a plane through `point` at right angles to the axis.
///
/// `point` holds x, y, z in metres.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_irradiance(
    light: *const Light,
    point: *const f64,
    irradiance: *mut f64,
) -> Status {
    answer!(light: borrow, point: read_point =>
        irradiance: light.ask(|light| light.irradiance(point)))
}

/// Computes the energy-flow vector at `point`, in W/m²: a surface whose normal n lies on the lit
/// side receives the irradiance max(0, -flux . n).
///
/// `point` and `flux` hold x, y, z.
///
/// # Safety
///
/// The pointers are null or valid, `flux` for three numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_flux(
    light: *const Light,
    point: *const f64,
    flux: *mut f64,
) -> Status {
    let flux = flux.cast::<[f64; 3]>();
    answer!(light: borrow, point: read_point => flux: light.ask(|light| light.flux(point)))
}

/// Computes the light at `point` as one direction, that of the mean energy flow: a delta light.
///
/// A surface of normal n reflects f |n . wi| V times `e_perp`. Where it is dark, beyond the cut-off
/// and behind the aperture, all of `event` is 0 and no shadow ray is needed. `point` holds x, y, z
/// in metres.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_next_event(
    light: *const Light,
    point: *const f64,
    event: *mut NextEvent,
) -> Status {
    answer!(light: borrow, point: read_point => event: {
        let found = light.ask(|light| light.next_event(point));
        found.map(NextEvent::from).unwrap_or_default()
    })
}

/// Single-precision form of `tem00_light_next_event`.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_next_event_f32(
    light: *const Light,
    point: *const f32,
    event: *mut NextEventF32,
) -> Status {
    answer!(light: borrow, point: read_point => event: {
        let point: [f32; 3] = point;
        let found = light.ask(|light| light.next_event(point.map(f64::from)));
        found.map(NextEventF32::from).unwrap_or_default()
    })
}

/// Draws a direction from the light that arrives at `point`, with two random numbers `u` in [0, 1).
///
/// The estimate of the reflected radiance is f |n . wi| V times `value`, which has been divided by
/// the density. Where it is dark, all of `event` is 0. `point` holds x, y, z in metres.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_next_event_sampled(
    light: *const Light,
    point: *const f64,
    u: *const f64,
    event: *mut SampledEvent,
) -> Status {
    answer!(light: borrow, point: read_point, u: read_variates => event: {
        let drawn = light.ask(|light| light.next_event_sampled(point, u));
        drawn.map(SampledEvent::from).unwrap_or_default()
    })
}

/// Computes the density, per steradian, with which `tem00_light_next_event_sampled` draws the
/// direction `wi` towards the light at `point`; 0 where it is dark.
///
/// `point` and `wi`, of any length but 0, hold x, y, z.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_next_event_pdf(
    light: *const Light,
    point: *const f64,
    wi: *const f64,
    pdf: *mut f64,
) -> Status {
    answer!(light: borrow, point: read_point, wi: read_direction =>
        pdf: light.ask(|light| light.next_event_pdf(point, wi)))
}

/// Draws a ray that leaves the aperture, with four random numbers `u` in [0, 1).
///
/// Every ray stands for the same power, so straight rays reproduce the irradiance at every
/// distance.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_sample_ray(
    light: *const Light,
    u: *const f64,
    ray: *mut RaySample,
) -> Status {
    answer!(light: borrow, u: read_variates => ray: light.ask(|light| light.sample_ray(u)).into())
}

/// Computes the densities with which `tem00_light_sample_ray` draws the ray through `origin` along
/// `direction`; 0 for a ray against the axis.
///
/// `origin`, any point of the ray, and `direction`, of any length but 0, hold x, y, z.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_ray_pdf(
    light: *const Light,
    origin: *const f64,
    direction: *const f64,
    pdf: *mut RayPdf,
) -> Status {
    answer!(light: borrow, origin: read_point, direction: read_direction =>
        pdf: light.ask(|light| light.ray_pdf(origin, direction)).into())
}

/// Computes the radiance, in W/(m² sr), of the ray through `origin` along the direction of travel
/// `direction`; 0 for a ray against the axis.
///
/// `origin`, any point of the ray, and `direction`, of any length but 0, hold x, y, z.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_radiance(
    light: *const Light,
    origin: *const f64,
    direction: *const f64,
    radiance: *mut f64,
) -> Status {
    answer!(light: borrow, origin: read_point, direction: read_direction =>
        radiance: light.ask(|light| light.radiance(origin, direction)))
}

/// Computes bounds of the light from the aperture to `distance`, in metres, along its axis.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_bounds(
    light: *const Light,
    distance: f64,
    bounds: *mut Bounds,
) -> Status {
    answer!(light: borrow, distance: check_length =>
        bounds: light.ask(|light| light.bounds(distance)).into())
}

same_fields! {
    tem00_beam::NextEvent => NextEvent { point, distance, wi, e_perp }
    tem00_beam::SampledEvent => SampledEvent { point, distance, wi, value, pdf }
    tem00_beam::RaySample => RaySample { origin, flux, direction, cos, pdf }
    tem00_beam::RayPdf =>
        RayPdf { position, direction_given_position, direction, position_given_direction }
    tem00_beam::Bounds => Bounds { min, max, axis, half_angle }
}

impl From<tem00_beam::NextEvent> for NextEventF32 {
    fn from(event: tem00_beam::NextEvent) -> Self {
        Self {
            point: event.point.map(f32::rounded),
            distance: f32::rounded(event.distance),
            wi: event.wi.map(f32::rounded),
            e_perp: f32::rounded(event.e_perp),
        }
    }
}
