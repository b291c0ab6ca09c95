//! Pointers from C, made into references at one place each.

use core::{ops::Range, slice};

use crate::status::{Failure, Status};

fn refused(name: &str, why: &str) -> Failure {
    Failure::new(Status::InvalidPointer, name, format!("{name} {why}"))
}

/// Checks what can be checked of a pointer to `count` values.
fn check<T>(name: &str, pointer: *const T, count: usize) -> Result<(), Failure> {
    const LARGEST: usize = isize::MAX.unsigned_abs();
    if pointer.is_null() {
        return Err(refused(name, "must not be null"));
    }
    if !pointer.is_aligned() {
        let why = format!("must be aligned to {} bytes", align_of::<T>());
        return Err(refused(name, &why));
    }
    if count > LARGEST / size_of::<T>().max(1) {
        let why = format!("must point to {count} values, more than there is memory for");
        return Err(refused(name, &why));
    }
    Ok(())
}

/// Body of a function that answers one question: reads each argument by the function after its
/// colon, and writes the answer. What is refused is named by its variable.
macro_rules! answer {
    ($($argument:ident: $read:ident),* => $out:ident: $answer:expr) => {
        // SAFETY: by the contract of the function whose body this is.
        $crate::status::call(|| unsafe {
            $(let $argument = $read(stringify!($argument), $argument)?;)*
            $crate::pointers::write(stringify!($out), $out, $answer)
        })
    };
}

/// Body of a function that makes a handle: as `answer`, but that the last expression is a `Result`,
/// and nothing is read or made where the handle has no place.
macro_rules! create {
    ($($argument:ident: $read:ident),* => $handle:ident: $made:expr) => {
        // SAFETY: by the contract of the function whose body this is.
        $crate::status::call(|| unsafe {
            $crate::pointers::create(stringify!($handle), $handle, || {
                $(let $argument = $read(stringify!($argument), $argument)?;)*
                $made
            })
        })
    };
}

/// Converts structs to others by the names of their fields.
macro_rules! same_fields {
    ($($from:ty => $to:ident { $($field:ident),* })*) => {$(
        impl From<$from> for $to {
            fn from(from: $from) -> Self {
                Self { $($field: from.$field.into()),* }
            }
        }
    )*};
}

/// Borrows what a pointer points to.
///
/// # Safety
///
/// The pointer is null, or points to a `T` that nobody writes to during `'a`.
pub(crate) unsafe fn borrow<'a, T>(name: &str, pointer: *const T) -> Result<&'a T, Failure> {
    check(name, pointer, 1)?;
    // SAFETY: not null, aligned, and valid by the contract of this function.
    Ok(unsafe { &*pointer })
}

/// Reads `N` numbers.
///
/// # Safety
///
/// The pointer is null, or points to `N` numbers.
pub(crate) unsafe fn read<T: Copy, const N: usize>(
    name: &str,
    pointer: *const T,
) -> Result<[T; N], Failure> {
    check(name, pointer, N)?;
    // SAFETY: not null, aligned, and valid for N reads by the contract of this function.
    Ok(unsafe { pointer.cast::<[T; N]>().read() })
}

/// Writes a result.
///
/// # Safety
///
/// The pointer is null, or points to room for a `T`.
pub(crate) unsafe fn write<T>(name: &str, pointer: *mut T, value: T) -> Result<(), Failure> {
    check(name, pointer, 1)?;
    // SAFETY: not null, aligned, and valid for writes by the contract of this function. What was
    // there is plain data or nothing, so nothing is to be dropped.
    unsafe { pointer.write(value) };
    Ok(())
}

/// Makes a handle, or writes null where there is none.
///
/// # Safety
///
/// The pointer is null, or points to room for a pointer.
pub(crate) unsafe fn create<T>(
    name: &str,
    handle: *mut *mut T,
    make: impl FnOnce() -> Result<T, Failure>,
) -> Result<(), Failure> {
    // SAFETY: by the contract of this function.
    unsafe { write(name, handle, core::ptr::null_mut()) }?;
    let made = Box::into_raw(Box::new(make()?));
    // SAFETY: by the contract of this function.
    unsafe { write(name, handle, made) }
}

/// Frees a handle; null is none.
///
/// # Safety
///
/// The pointer is null, or came from [`create`] and is not used again.
pub(crate) unsafe fn destroy<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: it came from `Box::into_raw`, and nobody uses it again.
        drop(unsafe { Box::from_raw(handle) });
    }
}

/// A column of numbers from C and its name.
pub(crate) type Named<P> = (&'static str, P);

/// `N` columns that are read and `M` that are written.
pub(crate) type Borrowed<'a, T, const N: usize, const M: usize> = ([&'a [T]; N], [&'a mut [T]; M]);

/// Borrows `N` columns of `count` numbers to read, and `M` to write, which overlap with no other.
///
/// # Safety
///
/// Each pointer is null, or points to `count` numbers that nobody else touches during `'a`.
pub(crate) unsafe fn columns<'a, T, const N: usize, const M: usize>(
    count: usize,
    read: [Named<*const T>; N],
    write: [Named<*mut T>; M],
) -> Result<Borrowed<'a, T, N, M>, Failure> {
    if count == 0 {
        return Ok((
            [const { &[] as &[T] }; N],
            core::array::from_fn(|_| <&mut [T]>::default()),
        ));
    }
    for (name, pointer) in read {
        check(name, pointer, count)?;
    }
    let mut others: Vec<_> = read.map(|(name, other)| (name, bytes(other, count))).into();
    for (name, pointer) in write {
        check(name, pointer, count)?;
        let room = bytes(pointer, count);
        check_apart(name, &room, &others)?;
        others.push((name, room));
    }
    // SAFETY: not null, aligned, valid for `count` reads by the contract of this function, and
    // disjoint from all that is written.
    let read = read.map(|(_, pointer)| unsafe { slice::from_raw_parts(pointer, count) });
    // SAFETY: not null, aligned, valid for `count` reads and writes by the contract of this
    // function, and disjoint from all the others.
    let write = write.map(|(_, pointer)| unsafe { slice::from_raw_parts_mut(pointer, count) });
    Ok((read, write))
}

/// Borrows `count` rows of `N` numbers to read.
///
/// # Safety
///
/// The pointer is null, or points to `N * count` numbers that nobody writes to during `'a`.
pub(crate) unsafe fn rows<'a, const N: usize>(
    count: usize,
    (name, pointer): Named<*const f64>,
) -> Result<&'a [[f64; N]], Failure> {
    let pointer = pointer.cast::<[f64; N]>();
    if count == 0 {
        return Ok(&[]);
    }
    check(name, pointer, count)?;
    // SAFETY: not null, aligned, and valid for `count` reads by the contract of this function.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// Borrows `count` records to write, which overlap with none of those that are `read`.
///
/// # Safety
///
/// The pointer is null, or points to `count` records that nobody else touches during `'a`.
pub(crate) unsafe fn records<'a, T, R, const N: usize>(
    count: usize,
    (name, pointer): Named<*mut T>,
    read: [Named<&[R]>; N],
) -> Result<&'a mut [T], Failure> {
    if count == 0 {
        return Ok(&mut []);
    }
    check(name, pointer, count)?;
    let read = read.map(|(name, column)| (name, bytes(column.as_ptr(), column.len())));
    check_apart(name, &bytes(pointer, count), &read)?;
    // SAFETY: not null, aligned, valid for `count` reads and writes by the contract of this
    // function, and disjoint from all that is read.
    Ok(unsafe { slice::from_raw_parts_mut(pointer, count) })
}

/// The addresses of `count` values.
fn bytes<T>(pointer: *const T, count: usize) -> Range<usize> {
    let start = pointer.addr();
    start..start.saturating_add(count * size_of::<T>())
}

/// Checks that what is written overlaps with no other column.
fn check_apart(
    name: &str,
    room: &Range<usize>,
    others: &[Named<Range<usize>>],
) -> Result<(), Failure> {
    let met = others
        .iter()
        .find(|(_, other)| room.start < other.end && other.start < room.end);
    met.map_or(Ok(()), |(other, _)| {
        Err(refused(name, &format!("must not overlap with {other}")))
    })
}

#[cfg(test)]
mod tests;
