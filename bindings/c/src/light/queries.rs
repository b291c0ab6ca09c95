use tem00_beam::Emitter;

use super::{Light, batch::Precision};
use crate::{
    numbers::{check_coordinates, check_length, check_variates, unit_vector},
    pointers::{borrow, read, write},
    status::{Failure, Status, call},
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

/// As `tem00_next_event`, in single precision.
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

/// Asks a light a question about a place, and writes the answer.
///
/// # Safety
///
/// The pointers are null or valid, `point` for three numbers.
pub(super) unsafe fn ask_at<R>(
    light: *const Light,
    point: (&'static str, *const f64),
    answer: (&'static str, *mut R),
    question: impl FnOnce(&dyn Emitter, [f64; 3]) -> Result<R, Failure>,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let (light, place) = unsafe { (borrow("light", light)?, read(point.0, point.1)?) };
        check_coordinates(point.0, &place)?;
        let result = light.ask(|light| question(light, place))?;
        // SAFETY: by the contract of this function.
        unsafe { write(answer.0, answer.1, result) }
    })
}

/// Reads a direction of any length as a unit vector.
///
/// # Safety
///
/// The pointer is null or valid for three numbers.
pub(super) unsafe fn read_direction(name: &str, pointer: *const f64) -> Result<[f64; 3], Failure> {
    // SAFETY: by the contract of this function.
    unit_vector(name, unsafe { read(name, pointer) }?)
}

/// Reads random numbers.
///
/// # Safety
///
/// The pointer is null or valid for `N` numbers.
unsafe fn variates<const N: usize>(pointer: *const f64) -> Result<[f64; N], Failure> {
    // SAFETY: by the contract of this function.
    let u = unsafe { read("u", pointer) }?;
    check_variates("u", &u)?;
    Ok(u)
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
    let answer = ("irradiance", irradiance);
    // SAFETY: by the contract of this function.
    unsafe {
        ask_at(light, ("point", point), answer, |light, p| {
            Ok(light.irradiance(p))
        })
    }
}

/// Computes the energy-flow vector at `point`, in W/m²: a surface whose normal n lies on the lit side
/// receives the irradiance max(0, -flux . n).
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
    let answer = ("flux", flux.cast::<[f64; 3]>());
    // SAFETY: by the contract of this function.
    unsafe {
        ask_at(
            light,
            ("point", point),
            answer,
            |light, p| Ok(light.flux(p)),
        )
    }
}

/// Computes the light at `point` as one direction, that of the mean energy flow: a delta light.
///
/// A surface of normal n reflects f |n . wi| V times `e_perp`. Where it is dark, beyond the cut-off and behind
/// the aperture, all of `event` is 0 and no shadow ray is needed. `point` holds x, y, z in metres.
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
    // SAFETY: by the contract of this function.
    unsafe {
        ask_at(light, ("point", point), ("event", event), |light, p| {
            Ok(light.next_event(p).map(NextEvent::from).unwrap_or_default())
        })
    }
}

/// As `tem00_light_next_event`, in single precision.
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
    call(|| {
        // SAFETY: by the contract of this function.
        let (light, place) = unsafe { (borrow("light", light)?, read("point", point)?) };
        let place: [f32; 3] = place;
        check_coordinates("point", &place)?;
        let result = light.ask(|light| light.next_event(place.map(f64::from)));
        let result = result.map(NextEventF32::from).unwrap_or_default();
        // SAFETY: by the contract of this function.
        unsafe { write("event", event, result) }
    })
}

/// Draws a direction from the light that arrives at `point`, with two random numbers `u` in [0, 1).
///
/// The estimate of the reflected radiance is f |n . wi| V times `value`, which has been divided by the
/// density. Where it is dark, all of `event` is 0. `point` holds x, y, z in metres.
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
    // SAFETY: by the contract of this function.
    unsafe {
        ask_at(light, ("point", point), ("event", event), |light, p| {
            let event = light.next_event_sampled(p, variates(u)?);
            Ok(event.map(SampledEvent::from).unwrap_or_default())
        })
    }
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
    // SAFETY: by the contract of this function.
    unsafe {
        ask_at(light, ("point", point), ("pdf", pdf), |light, p| {
            Ok(light.next_event_pdf(p, read_direction("wi", wi)?))
        })
    }
}

/// Draws a ray that leaves the aperture, with four random numbers `u` in [0, 1).
///
/// Every ray stands for the same power, so straight rays reproduce the irradiance at every distance.
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
    call(|| {
        // SAFETY: by the contract of this function.
        let (light, u) = unsafe { (borrow("light", light)?, variates(u)?) };
        let drawn = light.ask(|light| light.sample_ray(u));
        // SAFETY: by the contract of this function.
        unsafe { write("ray", ray, drawn.into()) }
    })
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
    // SAFETY: by the contract of this function.
    unsafe {
        ask_at(light, ("origin", origin), ("pdf", pdf), |light, o| {
            Ok(light
                .ray_pdf(o, read_direction("direction", direction)?)
                .into())
        })
    }
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
    // SAFETY: by the contract of this function.
    unsafe {
        ask_at(
            light,
            ("origin", origin),
            ("radiance", radiance),
            |light, o| Ok(light.radiance(o, read_direction("direction", direction)?)),
        )
    }
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
    call(|| {
        check_length("distance", distance)?;
        // SAFETY: by the contract of this function.
        let light = unsafe { borrow("light", light) }?;
        let result = light.ask(|light| light.bounds(distance));
        // SAFETY: by the contract of this function.
        unsafe { write("bounds", bounds, result.into()) }
    })
}

impl From<tem00_beam::NextEvent> for NextEvent {
    fn from(event: tem00_beam::NextEvent) -> Self {
        Self {
            point: event.point,
            distance: event.distance,
            wi: event.wi,
            e_perp: event.e_perp,
        }
    }
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

impl From<tem00_beam::SampledEvent> for SampledEvent {
    fn from(event: tem00_beam::SampledEvent) -> Self {
        Self {
            point: event.point,
            distance: event.distance,
            wi: event.wi,
            value: event.value,
            pdf: event.pdf,
        }
    }
}

impl From<tem00_beam::RaySample> for RaySample {
    fn from(ray: tem00_beam::RaySample) -> Self {
        Self {
            origin: ray.origin,
            flux: ray.flux,
            direction: ray.direction,
            cos: ray.cos,
            pdf: ray.pdf.into(),
        }
    }
}

impl From<tem00_beam::RayPdf> for RayPdf {
    fn from(pdf: tem00_beam::RayPdf) -> Self {
        Self {
            position: pdf.position,
            direction_given_position: pdf.direction_given_position,
            direction: pdf.direction,
            position_given_direction: pdf.position_given_direction,
        }
    }
}

impl From<tem00_beam::Bounds> for Bounds {
    fn from(bounds: tem00_beam::Bounds) -> Self {
        Self {
            min: bounds.min,
            max: bounds.max,
            axis: bounds.axis,
            half_angle: bounds.half_angle,
        }
    }
}
