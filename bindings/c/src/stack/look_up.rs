use super::{
    Stack,
    description::{SlicePath, path_numbers},
};
use crate::{
    numbers::{check_coordinate, check_coordinates, check_length, check_number, read_point},
    pointers::{Named, borrow, columns, read},
    status::{Failure, Status, call},
};

/// Properties of a stack.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StackInfo {
    /// Width of the pattern, in samples, after which it repeats.
    pub width: usize,
    /// Height of the pattern, in samples.
    pub height: usize,
    /// Number of slices, after which the coordinate u repeats: 1, or twice `half_period`.
    pub slice_count: usize,
    /// Speckle size in samples.
    pub speckle_size: f64,
    /// The way the pupil takes.
    pub path: SlicePath,
    /// Half the number of slices, 0 for a still path.
    pub half_period: usize,
    /// Length of a straight path in pupil diameters, 0 for others.
    pub length: usize,
    /// Bytes that the slices take.
    pub memory_bytes: u64,
}

impl StackInfo {
    fn new(Stack(stack): &Stack) -> Self {
        let [width, height] = stack.size();
        let (path, half_period, length) = path_numbers(stack.path());
        Self {
            width,
            height,
            slice_count: stack.slice_count(),
            speckle_size: stack.speckle_size(),
            path,
            half_period,
            length,
            memory_bytes: stack.memory_bytes(),
        }
    }
}

impl Stack {
    /// The index of a slice, checked.
    fn slice(&self, slice: usize) -> Result<usize, Failure> {
        let last = self.0.slice_count() - 1;
        if slice <= last {
            return Ok(slice);
        }
        let message = format!("slice must be 0 to {last}, got {slice}");
        Err(Failure::argument("slice", message))
    }
}

/// Tells what a stack is.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_describe(stack: *const Stack, info: *mut StackInfo) -> Status {
    answer!(stack: borrow => info: StackInfo::new(stack))
}

/// Looks up the intensity, with mean 1, at (`x`, `y`) in samples and `u` in slices.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_intensity(
    stack: *const Stack,
    x: f64,
    y: f64,
    u: f64,
    intensity: *mut f64,
) -> Status {
    answer!(stack: borrow, x: check_coordinate, y: check_coordinate, u: check_coordinate =>
        intensity: stack.0.intensity_at(x, y, u))
}

/// Looks up the amplitude whose squared magnitude is the intensity, for light whose fields add:
/// `amplitude` holds its real and imaginary part.
///
/// It is the field in the frame of the pupil of the slice at u or before it: stacks along one path
/// have one frame.
///
/// # Safety
///
/// The pointers are null or valid, `amplitude` for two numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_amplitude(
    stack: *const Stack,
    x: f64,
    y: f64,
    u: f64,
    amplitude: *mut f64,
) -> Status {
    let amplitude = amplitude.cast::<[f64; 2]>();
    answer!(
        stack: borrow, x: check_coordinate, y: check_coordinate, u: check_coordinate => amplitude: {
            let found = stack.0.amplitude_at(x, y, u);
            [found.re, found.im]
        }
    )
}

/// Looks up the intensities at `count` points: the bits of `tem00_stack_intensity`. Points close to
/// each other between the same two slices are fastest.
///
/// `x` and `y` are in samples and `u` in slices; `intensity` must not overlap with them.
///
/// # Safety
///
/// The pointers are null or valid for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_intensity_batch(
    stack: *const Stack,
    x: *const f64,
    y: *const f64,
    u: *const f64,
    count: usize,
    intensity: *mut f64,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        unsafe {
            let stack = &borrow("stack", stack)?.0;
            let ([x, y, u], out) = places([x, y, u], count, ("intensity", intensity))?;
            stack.intensity_batch(x, y, u, out);
        }
        Ok(())
    })
}

/// Single-precision form of `tem00_stack_intensity_batch`: the same intensities, rounded.
///
/// A place that is rounded to single precision moves by up to 3e-8 of its distance from 0: take off
/// whole periods before.
///
/// # Safety
///
/// The pointers are null or valid for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_intensity_batch_f32(
    stack: *const Stack,
    x: *const f32,
    y: *const f32,
    u: *const f32,
    count: usize,
    intensity: *mut f32,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        unsafe {
            let stack = &borrow("stack", stack)?.0;
            let ([x, y, u], out) = places([x, y, u], count, ("intensity", intensity))?;
            stack.intensity_batch_f32(x, y, u, out);
        }
        Ok(())
    })
}

/// Computes the means of the intensity over boxes about `count` points, in single precision: those
/// of `tem00_stack_average` at these coordinates, rounded.
///
/// `size` holds the width and the height of the boxes, in samples.
///
/// # Safety
///
/// The pointers are null or valid for `count` numbers, `size` for two.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_average_batch_f32(
    stack: *const Stack,
    x: *const f32,
    y: *const f32,
    size: *const f64,
    u: *const f32,
    count: usize,
    average: *mut f32,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        unsafe {
            let stack = &borrow("stack", stack)?.0;
            let ([x, y, u], out) = places([x, y, u], count, ("average", average))?;
            stack.average_batch_f32([x, y], read_size("size", size)?, u, out);
        }
        Ok(())
    })
}

/// Reads the sides of a box.
///
/// # Safety
///
/// The pointer is null or valid for two numbers.
unsafe fn read_size(name: &str, size: *const f64) -> Result<[f64; 2], Failure> {
    // SAFETY: by the contract of this function.
    let [width, height] = unsafe { read(name, size) }?;
    Ok([check_length(name, width)?, check_length(name, height)?])
}

/// Borrows `count` places and room for as many answers.
///
/// # Safety
///
/// The pointers are null or valid for `count` numbers that nobody else touches during `'a`.
unsafe fn places<'a, T: Copy + Into<f64>>(
    places: [*const T; 3],
    count: usize,
    answer: Named<*mut T>,
) -> Result<([&'a [T]; 3], &'a mut [T]), Failure> {
    let [x, y, u] = places;
    // SAFETY: by the contract of this function.
    let (read, [answers]) = unsafe { columns(count, [("x", x), ("y", y), ("u", u)], [answer]) }?;
    for (name, values) in ["x", "y", "u"].iter().zip(read) {
        check_coordinates(name, values)?;
    }
    Ok((read, answers))
}

/// Computes the mean of the intensity over a box about `centre`, at `u`: what a pixel sees whose
/// whole area takes part.
///
/// `centre` holds x, y and `size` the width and the height of the box, all in samples; `u` is in
/// slices.
///
/// # Safety
///
/// The pointers are null or valid, `centre` and `size` for two numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_average(
    stack: *const Stack,
    centre: *const f64,
    size: *const f64,
    u: f64,
    average: *mut f64,
) -> Status {
    answer!(stack: borrow, centre: read_point, size: read_size, u: check_coordinate =>
        average: stack.0.average_over(centre, size, u))
}

/// Computes the coordinate u, in slices, at which the intensity has a given `correlation` to that
/// at u = 0: 0 for 1 or more, and the first slice of no correlation for 0 or less.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_coordinate_of(
    stack: *const Stack,
    correlation: f64,
    u: *mut f64,
) -> Status {
    answer!(stack: borrow, correlation: check_number => u: stack.0.coordinate_of(correlation))
}

/// Computes the correlation of the intensities at u = 0 and u = `distance`, in slices: the inverse
/// of `tem00_stack_coordinate_of`.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_correlation_at(
    stack: *const Stack,
    distance: f64,
    correlation: *mut f64,
) -> Status {
    answer!(stack: borrow, distance: check_coordinate =>
        correlation: stack.0.correlation_at(distance))
}

/// Computes the correlation of the intensities at two coordinates u and v, on slices or between,
/// exactly.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_correlation_between(
    stack: *const Stack,
    u: f64,
    v: f64,
    correlation: *mut f64,
) -> Status {
    answer!(stack: borrow, u: check_coordinate, v: check_coordinate =>
        correlation: stack.0.correlation_between(u, v))
}

/// Gives the coefficients of a slice, for upload to a GPU: width * height complex numbers row by
/// row, each a real and an imaginary part.
///
/// They are the samples of the amplitude, or for the cubic spline its prefiltered coefficients, and
/// belong to the stack.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_coefficients(
    stack: *const Stack,
    slice: usize,
    coefficients: *mut *const f32,
) -> Status {
    // A complex number is its two parts, one after the other.
    answer!(stack: borrow =>
        coefficients: stack.0.coefficients(stack.slice(slice)?).values().as_ptr().cast())
}

/// Gives the place of the pupil of a slice, in its diameters: `offset` holds x, y.
///
/// # Safety
///
/// The pointers are null or valid, `offset` for two numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_offset(
    stack: *const Stack,
    slice: usize,
    offset: *mut f64,
) -> Status {
    let offset = offset.cast::<[f64; 2]>();
    answer!(stack: borrow => offset: stack.0.offset(stack.slice(slice)?))
}
