use tem00_beam::{Emitter, NextEventSlices};

use super::{Light, RaySample, SampledEvent};
use crate::{
    numbers::{check_coordinates, check_variates},
    pointers::{Named, borrow, columns, records, rows},
    status::{Failure, Status, call},
};

/// Destination of the next events at many points: pointers to as many numbers as there are points.
///
/// The point of the aperture plane is p + distance * wi.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct NextEventColumns {
    /// Components x of the unit vectors towards the light.
    pub wi_x: *mut f64,
    /// Components y.
    pub wi_y: *mut f64,
    /// Components z.
    pub wi_z: *mut f64,
    /// Distances to the aperture plane along `wi`, in metres.
    pub distance: *mut f64,
    /// Irradiances of a surface square to `wi`, in W/m²; 0 where no light arrives.
    pub e_perp: *mut f64,
}

/// Columns of next events in single precision, otherwise as `tem00_next_event_columns`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct NextEventColumnsF32 {
    /// Components x of the unit vectors towards the light.
    pub wi_x: *mut f32,
    /// Components y.
    pub wi_y: *mut f32,
    /// Components z.
    pub wi_z: *mut f32,
    /// Distances to the aperture plane along `wi`, in metres.
    pub distance: *mut f32,
    /// Irradiances of a surface square to `wi`, in W/m²; 0 where no light arrives.
    pub e_perp: *mut f32,
}

/// The two precisions of points and answers; lights answer in `f64`.
pub(super) trait Precision: Copy + Into<f64> {
    fn rounded(x: f64) -> Self;
}

impl Precision for f64 {
    fn rounded(x: f64) -> Self {
        x
    }
}

impl Precision for f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounded on purpose")]
    fn rounded(x: f64) -> Self {
        x as Self
    }
}

/// Points that are converted at a time.
const BLOCK: usize = 256;

/// Asks a light for `M` numbers at each of `count` points, in `f64` whatever the columns are in.
///
/// # Safety
///
/// The light is null or valid; each column is null, or points to `count` numbers that nobody else
/// touches meanwhile.
unsafe fn ask_columns<T: Precision, const M: usize>(
    light: *const Light,
    [x, y, z]: [*const T; 3],
    count: usize,
    answers: [Named<*mut T>; M],
    ask: impl Fn(&dyn Emitter, [&[f64]; 3], [&mut [f64]; M]),
) -> Result<(), Failure> {
    let points = [("x", x), ("y", y), ("z", z)];
    // SAFETY: by the contract of this function.
    let (light, (read, mut write)) =
        unsafe { (borrow("light", light)?, columns(count, points, answers)?) };
    for ((name, _), coordinates) in points.iter().zip(read) {
        check_coordinates(name, coordinates)?;
    }
    let (mut wide, mut out) = ([[0.0; BLOCK]; 3], [[0.0; BLOCK]; M]);
    for start in (0..count).step_by(BLOCK) {
        let length = BLOCK.min(count - start);
        for (wide, points) in wide.iter_mut().zip(read) {
            for (wide, &x) in wide.iter_mut().zip(&points[start..]) {
                *wide = x.into();
            }
        }
        let block = wide.each_ref().map(|column| &column[..length]);
        let room = out.each_mut().map(|column| &mut column[..length]);
        light.ask(|light| ask(light, block, room));
        for (answers, out) in write.iter_mut().zip(&out) {
            for (answer, &x) in answers[start..].iter_mut().zip(&out[..length]) {
                *answer = T::rounded(x);
            }
        }
    }
    Ok(())
}

fn irradiances(light: &dyn Emitter, [x, y, z]: [&[f64]; 3], [out]: [&mut [f64]; 1]) {
    light.irradiance_batch(x, y, z, out);
}

fn next_events(light: &dyn Emitter, [x, y, z]: [&[f64]; 3], answers: [&mut [f64]; 5]) {
    let [wi_x, wi_y, wi_z, distance, e_perp] = answers;
    let wi = [wi_x, wi_y, wi_z];
    let out = NextEventSlices {
        wi,
        distance,
        e_perp,
    };
    light.next_event_batch(x, y, z, out);
}

/// Body of a function that computes next events into columns.
macro_rules! next_events {
    ($light:ident, $points:expr, $count:ident, $events:ident) => {
        // SAFETY: by the contract of the function whose body this is.
        call(|| unsafe {
            let to = borrow(stringify!($events), $events)?;
            let wi = [("wi_x", to.wi_x), ("wi_y", to.wi_y), ("wi_z", to.wi_z)];
            let answers = [
                wi[0],
                wi[1],
                wi[2],
                ("distance", to.distance),
                ("e_perp", to.e_perp),
            ];
            ask_columns($light, $points, $count, answers, next_events)
        })
    };
}

/// Computes the irradiances, in W/m², of planes through `count` points at right angles to the axis:
/// the bits of `tem00_light_irradiance`.
///
/// `x`, `y`, `z` hold the coordinates, in metres; `irradiance` must not overlap with them.
///
/// # Safety
///
/// The pointers are null or valid for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_irradiance_batch(
    light: *const Light,
    x: *const f64,
    y: *const f64,
    z: *const f64,
    count: usize,
    irradiance: *mut f64,
) -> Status {
    // SAFETY: by the contract of this function.
    call(|| unsafe {
        ask_columns(
            light,
            [x, y, z],
            count,
            [("irradiance", irradiance)],
            irradiances,
        )
    })
}

/// Single-precision form of `tem00_light_irradiance_batch`.
///
/// # Safety
///
/// The pointers are null or valid for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_irradiance_batch_f32(
    light: *const Light,
    x: *const f32,
    y: *const f32,
    z: *const f32,
    count: usize,
    irradiance: *mut f32,
) -> Status {
    // SAFETY: by the contract of this function.
    call(|| unsafe {
        ask_columns(
            light,
            [x, y, z],
            count,
            [("irradiance", irradiance)],
            irradiances,
        )
    })
}

/// Computes the next events at `count` points: the bits of `tem00_light_next_event`.
///
/// `x`, `y`, `z` hold the coordinates, in metres. The columns of `events` are written; they must
/// not overlap with each other nor with the coordinates.
///
/// # Safety
///
/// The pointers are null or valid for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_next_event_batch(
    light: *const Light,
    x: *const f64,
    y: *const f64,
    z: *const f64,
    count: usize,
    events: *const NextEventColumns,
) -> Status {
    next_events!(light, [x, y, z], count, events)
}

/// Single-precision form of `tem00_light_next_event_batch`.
///
/// # Safety
///
/// The pointers are null or valid for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_next_event_batch_f32(
    light: *const Light,
    x: *const f32,
    y: *const f32,
    z: *const f32,
    count: usize,
    events: *const NextEventColumnsF32,
) -> Status {
    next_events!(light, [x, y, z], count, events)
}

/// Draws a direction from the light that arrives at each of `count` points: the bits of
/// `tem00_light_next_event_sampled`.
///
/// `points` holds x, y, z in metres of one point after the other, `u` two random numbers in [0, 1)
/// for each; `events` must not overlap with them. Where it is dark, all of an event is 0.
///
/// # Safety
///
/// The pointers are null or valid, for `3 * count` and `2 * count` numbers and for `count` events.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_next_event_sampled_batch(
    light: *const Light,
    points: *const f64,
    u: *const f64,
    count: usize,
    events: *mut SampledEvent,
) -> Status {
    // SAFETY: by the contract of this function.
    call(|| unsafe {
        let light = borrow("light", light)?;
        let points = rows::<3>(count, ("points", points))?;
        let u = rows::<2>(count, ("u", u))?;
        let read = [("points", points.as_flattened()), ("u", u.as_flattened())];
        let events = records(count, ("events", events), read)?;
        check_coordinates("points", points.as_flattened())?;
        check_variates("u", u.as_flattened())?;
        light.ask(|light| {
            for ((&p, &u), event) in points.iter().zip(u).zip(events) {
                let drawn = light.next_event_sampled(p, u);
                *event = drawn.map(SampledEvent::from).unwrap_or_default();
            }
        });
        Ok(())
    })
}

/// Draws `count` rays that leave the aperture: the bits of `tem00_light_sample_ray`.
///
/// `u` holds four random numbers in [0, 1) for each ray; `rays` must not overlap with it.
///
/// # Safety
///
/// The pointers are null or valid, for `4 * count` numbers and for `count` rays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_sample_ray_batch(
    light: *const Light,
    u: *const f64,
    count: usize,
    rays: *mut RaySample,
) -> Status {
    // SAFETY: by the contract of this function.
    call(|| unsafe {
        let light = borrow("light", light)?;
        let u = rows::<4>(count, ("u", u))?;
        let rays = records(count, ("rays", rays), [("u", u.as_flattened())])?;
        check_variates("u", u.as_flattened())?;
        light.ask(|light| {
            for (&u, ray) in u.iter().zip(rays) {
                *ray = light.sample_ray(u).into();
            }
        });
        Ok(())
    })
}
