use tem00_beam::NextEventSlices;

use super::{Light, RaySample, SampledEvent};
use crate::{
    numbers::{check_coordinates, check_variates},
    pointers::{Borrowed, borrow, columns, records, rows},
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

/// As `tem00_next_event_columns`, in single precision.
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

/// Asks for `M` numbers at each point, in `f64`.
fn in_blocks<T: Precision, const M: usize>(
    points: [&[T]; 3],
    mut answers: [&mut [T]; M],
    ask: impl Fn([&[f64]; 3], [&mut [f64]; M]),
) {
    let mut wide = [[0.0; BLOCK]; 3];
    let mut out = [[0.0; BLOCK]; M];
    let count = points[0].len();
    for start in (0..count).step_by(BLOCK) {
        let length = BLOCK.min(count - start);
        for (wide, points) in wide.iter_mut().zip(points) {
            for (wide, &x) in wide.iter_mut().zip(&points[start..]) {
                *wide = x.into();
            }
        }
        let block = wide.each_ref().map(|column| &column[..length]);
        ask(block, out.each_mut().map(|column| &mut column[..length]));
        for (answers, out) in answers.iter_mut().zip(&out) {
            for (answer, &x) in answers[start..].iter_mut().zip(&out[..length]) {
                *answer = T::rounded(x);
            }
        }
    }
}

const POINT: [&str; 3] = ["x", "y", "z"];

/// Borrows the coordinates of `count` points and `M` columns for the answers.
///
/// # Safety
///
/// Each pointer is null, or points to `count` numbers that nobody else touches during `'a`.
unsafe fn points_and_answers<'a, T: Precision, const M: usize>(
    points: [*const T; 3],
    count: usize,
    answers: [(&'static str, *mut T); M],
) -> Result<Borrowed<'a, T, 3, M>, Failure> {
    let points = core::array::from_fn(|i| (POINT[i], points[i]));
    // SAFETY: by the contract of this function.
    let (points, answers) = unsafe { columns(count, points, answers) }?;
    for (name, coordinates) in POINT.iter().zip(points) {
        check_coordinates(name, coordinates)?;
    }
    Ok((points, answers))
}

/// # Safety
///
/// As [`points_and_answers`]; the light is null or valid.
unsafe fn irradiance<T: Precision>(
    light: *const Light,
    points: [*const T; 3],
    count: usize,
    irradiance: *mut T,
) -> Status {
    call(|| {
        let answers = [("irradiance", irradiance)];
        // SAFETY: by the contract of this function.
        let light = unsafe { borrow("light", light) }?;
        // SAFETY: by the contract of this function.
        let (points, answers) = unsafe { points_and_answers(points, count, answers) }?;
        light.ask(|light| {
            in_blocks(points, answers, |[x, y, z], [out]| {
                light.irradiance_batch(x, y, z, out);
            });
        });
        Ok(())
    })
}

/// # Safety
///
/// As [`points_and_answers`]; the light is null or valid.
unsafe fn next_event<T: Precision>(
    light: *const Light,
    points: [*const T; 3],
    count: usize,
    [wi_x, wi_y, wi_z, distance, e_perp]: [*mut T; 5],
) -> Result<(), Failure> {
    let answers = [
        ("wi_x", wi_x),
        ("wi_y", wi_y),
        ("wi_z", wi_z),
        ("distance", distance),
        ("e_perp", e_perp),
    ];
    // SAFETY: by the contract of this function.
    let light = unsafe { borrow("light", light) }?;
    // SAFETY: by the contract of this function.
    let (points, answers) = unsafe { points_and_answers(points, count, answers) }?;
    light.ask(|light| {
        in_blocks(points, answers, |[x, y, z], answers| {
            let [wi_x, wi_y, wi_z, distance, e_perp] = answers;
            let wi = [wi_x, wi_y, wi_z];
            let out = NextEventSlices {
                wi,
                distance,
                e_perp,
            };
            light.next_event_batch(x, y, z, out);
        });
    });
    Ok(())
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
    unsafe { self::irradiance(light, [x, y, z], count, irradiance) }
}

/// As `tem00_light_irradiance_batch`, in single precision.
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
    unsafe { self::irradiance(light, [x, y, z], count, irradiance) }
}

/// Computes the next events at `count` points: the bits of `tem00_light_next_event`.
///
/// `x`, `y`, `z` hold the coordinates, in metres. The columns of `events` are written; they must not
/// overlap with each other nor with the coordinates.
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
    call(|| {
        // SAFETY: by the contract of this function.
        let out = unsafe { borrow("events", events) }?;
        let out = [out.wi_x, out.wi_y, out.wi_z, out.distance, out.e_perp];
        // SAFETY: by the contract of this function.
        unsafe { next_event(light, [x, y, z], count, out) }
    })
}

/// As `tem00_light_next_event_batch`, in single precision.
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
    call(|| {
        // SAFETY: by the contract of this function.
        let out = unsafe { borrow("events", events) }?;
        let out = [out.wi_x, out.wi_y, out.wi_z, out.distance, out.e_perp];
        // SAFETY: by the contract of this function.
        unsafe { next_event(light, [x, y, z], count, out) }
    })
}

/// Draws a direction from the light that arrives at each of `count` points: the bits of
/// `tem00_light_next_event_sampled`.
///
/// `points` holds x, y, z in metres of one point after the other, `u` two random numbers in [0, 1) for
/// each; `events` must not overlap with them. Where it is dark, all of an event is 0.
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
    call(|| {
        // SAFETY: by the contract of this function.
        let light = unsafe { borrow("light", light) }?;
        // SAFETY: by the contract of this function.
        let points = unsafe { rows::<3>(count, ("points", points)) }?;
        // SAFETY: by the contract of this function.
        let u = unsafe { rows::<2>(count, ("u", u)) }?;
        let read = [("points", points.as_flattened()), ("u", u.as_flattened())];
        // SAFETY: by the contract of this function.
        let events = unsafe { records(count, ("events", events), read) }?;
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
    call(|| {
        // SAFETY: by the contract of this function.
        let light = unsafe { borrow("light", light) }?;
        // SAFETY: by the contract of this function.
        let u = unsafe { rows::<4>(count, ("u", u)) }?;
        // SAFETY: by the contract of this function.
        let rays = unsafe { records(count, ("rays", rays), [("u", u.as_flattened())]) }?;
        check_variates("u", u.as_flattened())?;
        light.ask(|light| {
            for (&u, ray) in u.iter().zip(rays) {
                *ray = light.sample_ray(u).into();
            }
        });
        Ok(())
    })
}
