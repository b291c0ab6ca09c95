use core::{cell::Cell, ptr};

use super::*;

/// The status and the parameter of a refusal.
fn refusal<T>(result: Result<T, Failure>) -> Option<(Status, String)> {
    result
        .err()
        .map(|failure| (failure.status, failure.parameter))
}

fn pointer_refused(name: &str) -> Option<(Status, String)> {
    Some((Status::InvalidPointer, name.to_owned()))
}

#[test]
fn null_and_misaligned_pointers_are_refused() {
    let values = [1.0, 2.0];
    let misaligned = values.as_ptr().wrapping_byte_add(4);
    for pointer in [ptr::null(), misaligned] {
        // SAFETY: what is wrong with the pointers is refused before they are used.
        unsafe {
            assert_eq!(
                refusal(borrow("p", pointer)),
                pointer_refused("p"),
                "borrow"
            );
            assert_eq!(
                refusal(read::<f64, 2>("p", pointer)),
                pointer_refused("p"),
                "read"
            );
            let mutable = pointer.cast_mut();
            assert_eq!(
                refusal(write("p", mutable, 3.0)),
                pointer_refused("p"),
                "write"
            );
            let inputs = columns(1, [("p", pointer)], []);
            assert_eq!(
                refusal::<Borrowed<'_, f64, 1, 0>>(inputs),
                pointer_refused("p"),
                "input"
            );
            let outputs = columns(1, [], [("p", mutable)]);
            assert_eq!(
                refusal::<Borrowed<'_, f64, 0, 1>>(outputs),
                pointer_refused("p"),
                "output"
            );
        }
    }
}

#[test]
fn what_is_read_and_written_is_what_lies_there() {
    let mut values = [1.0, 2.0, 3.0];
    let pointer = values.as_mut_ptr();
    // SAFETY: the pointer is to three numbers.
    unsafe {
        assert_eq!(read("p", pointer), Ok([1.0, 2.0, 3.0]), "read");
        write("p", pointer.add(1), 5.0).unwrap();
        assert_eq!(borrow("p", pointer.add(1)), Ok(&5.0), "borrowed");
    }
}

#[test]
fn columns_of_no_numbers_may_be_null() {
    let null = ptr::null_mut();
    // SAFETY: no number is read or written.
    let (read, write) = unsafe { columns::<f64, 1, 1>(0, [("x", null)], [("y", null)]) }.unwrap();
    assert!(read[0].is_empty() && write[0].is_empty(), "of no numbers");
}

#[test]
fn more_numbers_than_fit_into_memory_are_refused() {
    let value = 1.0;
    let count = isize::MAX.unsigned_abs() / size_of::<f64>() + 1;
    // SAFETY: the count is refused before the pointer is used.
    let result = unsafe { columns::<f64, 1, 0>(count, [("x", &raw const value)], []) };
    assert_eq!(refusal(result), pointer_refused("x"), "{count} numbers");
}

#[test]
fn columns_that_overlap_are_refused_and_neighbours_are_not() {
    let mut values = [0.0; 8];
    let start = values.as_mut_ptr();
    for (distance, overlap) in [(0, true), (1, true), (3, true), (4, false)] {
        // SAFETY: both columns are inside the array, and used only if they do not overlap.
        unsafe {
            for (a, b) in [(0, distance), (distance, 0)] {
                let (a, b) = (start.add(a), start.add(b));
                let result = columns::<f64, 1, 1>(4, [("x", a)], [("out", b)]);
                assert_eq!(result.is_err(), overlap, "input at {a:?}, output at {b:?}");
                let result = columns::<f64, 0, 2>(4, [], [("out", a), ("other", b)]);
                assert_eq!(result.is_err(), overlap, "outputs at {a:?} and {b:?}");
                let result = columns::<f64, 2, 0>(4, [("x", a), ("y", b)], []);
                assert!(result.is_ok(), "inputs at {a:?} and {b:?}");
            }
        }
    }
}

#[test]
fn records_that_overlap_with_what_is_read_are_refused_and_neighbours_are_not() {
    let mut values = [0.0; 10];
    let start = values.as_mut_ptr();
    // Two rows of two numbers are read, two records of three written.
    for (read, written, overlap) in [(0, 3, true), (0, 4, false), (5, 0, true), (6, 0, false)] {
        // SAFETY: both are inside the array, and used only if they do not overlap.
        let result = unsafe {
            let read = rows::<2>(2, ("x", start.add(read).cast_const())).unwrap();
            let room = start.add(written).cast::<[f64; 3]>();
            records(2, ("out", room), [("x", read.as_flattened())])
        };
        let expected = overlap.then(|| pointer_refused("out")).flatten();
        assert_eq!(
            refusal(result),
            expected,
            "rows at {read}, records at {written}"
        );
    }
}

#[test]
fn a_handle_that_cannot_be_made_is_null() {
    let mut here = 7;
    let mut handle = &raw mut here;
    // SAFETY: the pointer is to a pointer.
    let result = unsafe {
        create("handle", &raw mut handle, || {
            Err(Failure::argument("size", "no"))
        })
    };
    assert_eq!(
        refusal(result),
        Some((Status::InvalidArgument, "size".to_owned())),
        "the reason"
    );
    assert!(handle.is_null(), "and not what was there: {handle:?}");
}

#[test]
fn nothing_is_made_where_the_handle_has_no_place() {
    let made = Cell::new(false);
    let make = || {
        made.set(true);
        Ok(1)
    };
    // SAFETY: null is refused.
    let result = unsafe { create("handle", ptr::null_mut(), make) };
    assert_eq!(refusal(result), pointer_refused("handle"), "null");
    assert!(!made.get(), "it would have no owner");
}

#[test]
fn destroying_a_handle_frees_it_once_and_null_never() {
    struct Counted<'a>(&'a Cell<i32>);
    impl Drop for Counted<'_> {
        fn drop(&mut self) {
            self.0.set(self.0.get() + 1);
        }
    }
    let freed = Cell::new(0);
    let mut handle = ptr::null_mut();
    // SAFETY: the handle is made, then freed.
    unsafe {
        create("handle", &raw mut handle, || Ok(Counted(&freed))).unwrap();
        assert_eq!(freed.get(), 0, "made");
        destroy(handle);
        assert_eq!(freed.get(), 1, "destroyed");
        destroy(ptr::null_mut::<Counted<'_>>());
    }
    assert_eq!(freed.get(), 1, "null destroyed");
}
