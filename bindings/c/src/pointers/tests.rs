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
fn pointers_that_cannot_be_used_are_refused() {
    let values = [1.0, 2.0];
    let start = values.as_ptr();
    let too_many = isize::MAX.unsigned_abs() / size_of::<f64>() + 1;
    for (pointer, count) in [
        (ptr::null(), 1),
        (start.wrapping_byte_add(4), 1),
        (start, too_many),
    ] {
        let room = pointer.cast_mut();
        // SAFETY: what is wrong with the pointers is refused before they are used.
        unsafe {
            if count == 1 {
                assert_eq!(
                    refusal(borrow("p", pointer)),
                    pointer_refused("p"),
                    "borrow"
                );
                assert_eq!(
                    refusal(read::<_, 2>("p", pointer)),
                    pointer_refused("p"),
                    "read"
                );
                assert_eq!(
                    refusal(write("p", room, 3.0)),
                    pointer_refused("p"),
                    "write"
                );
            }
            let read = columns::<f64, 1, 0>(count, [("p", pointer)], []);
            assert_eq!(refusal(read), pointer_refused("p"), "input");
            let written = columns::<f64, 0, 1>(count, [], [("p", room)]);
            assert_eq!(refusal(written), pointer_refused("p"), "output");
            assert_eq!(
                refusal(rows::<1>(count, ("p", pointer))),
                pointer_refused("p"),
                "rows"
            );
            let records = records::<f64, f64, 0>(count, ("p", room), []);
            assert_eq!(refusal(records), pointer_refused("p"), "records");
        }
    }
}

#[test]
fn what_is_read_and_written_is_what_lies_there() {
    let mut values = [1.0, 2.0, 3.0];
    let (pointer, null) = (values.as_mut_ptr(), ptr::null_mut());
    // SAFETY: the pointer is to three numbers, and of none no number is used.
    unsafe {
        assert_eq!(read("p", pointer), Ok([1.0, 2.0, 3.0]), "read");
        write("p", pointer.add(1), 5.0).unwrap();
        assert_eq!(borrow("p", pointer.add(1)), Ok(&5.0), "borrowed");
        let (read, write) = columns::<f64, 1, 1>(0, [("x", null)], [("y", null)]).unwrap();
        assert!(
            read[0].is_empty() && write[0].is_empty(),
            "columns of no numbers"
        );
    }
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
fn a_handle_that_cannot_be_made_is_null_and_without_a_place_none_is_made() {
    let (mut here, made) = (7, Cell::new(false));
    let mut handle = &raw mut here;
    let fail = || Err(Failure::argument("size", "no"));
    let make = || {
        made.set(true);
        Ok(1)
    };
    // SAFETY: the pointer is to a pointer, or null, which is refused.
    let results = unsafe {
        [
            create("handle", &raw mut handle, fail),
            create("handle", ptr::null_mut(), make),
        ]
    };
    let size = Some((Status::InvalidArgument, "size".to_owned()));
    assert_eq!(results.map(refusal), [size, pointer_refused("handle")]);
    assert!(handle.is_null(), "and not what was there: {handle:?}");
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
