//! The functions of a stack against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

use core::{
    ffi::{CStr, c_char},
    ptr,
};
use std::{ffi::CString, fs, path::PathBuf};

use tem00_speckle::{PupilField, StackOptions, StackPlan};

use super::*;
use crate::status::{Status, tem00_last_error_parameter};

const DESCRIPTION: StackDescription = StackDescription {
    width: 64,
    height: 48,
    diameter: 0,
    speckle_size: 3.0,
    seed: 11,
    path: SlicePath::Straight as u32,
    half_period: 6,
    length: 3,
    interpolation: Interpolation::CubicSpline as u32,
    memory_limit: 1 << 20,
};

const NEEDS: StackNeeds = StackNeeds {
    image: [60.0, 40.0],
    region: [80.0, 40.0],
    speckle_size: 1.5,
    changes: 1,
    motion: 0.7,
    frames: 5,
    memory_limit: 4 << 20,
};

/// A stack that frees itself.
struct Owned(*mut Stack);

impl Drop for Owned {
    fn drop(&mut self) {
        // SAFETY: it was created by the interface and is not used again.
        unsafe { tem00_stack_destroy(self.0) };
    }
}

impl Owned {
    fn new(description: &StackDescription) -> Self {
        let mut stack = ptr::null_mut();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_stack_create(description, &raw mut stack) };
        assert_eq!(status, Status::Ok, "{}", last_parameter());
        Self(stack)
    }

    fn library(&self) -> &SpeckleStack {
        // SAFETY: the stack lives as long as this.
        unsafe { &(*self.0).0 }
    }
}

fn last_parameter() -> String {
    // SAFETY: the text is that of this thread, and no call fails meanwhile.
    let text = unsafe { CStr::from_ptr(tem00_last_error_parameter()) };
    text.to_str().unwrap().to_owned()
}

fn refusal(status: Status) -> (Status, String) {
    (status, last_parameter())
}

fn argument(name: &str) -> (Status, String) {
    (Status::InvalidArgument, name.to_owned())
}

/// Asks the interface, which must succeed.
fn answer<R>(mut result: R, question: impl FnOnce(*mut R) -> Status) -> R {
    assert_eq!(
        question(&raw mut result),
        Status::Ok,
        "{}",
        last_parameter()
    );
    result
}

fn peer(
    path: tem00_speckle::SlicePath,
    interpolation: tem00_speckle::Interpolation,
) -> SpeckleStack {
    let field = PupilField::from_speckle_size([64, 48], 3.0, 11).unwrap();
    let options = StackOptions {
        interpolation,
        memory_limit: 1 << 20,
    };
    SpeckleStack::generate_with(&field, path, options).unwrap()
}

#[test]
fn every_path_and_interpolation_makes_the_stack_of_the_library() {
    use tem00_speckle::{Interpolation as I, SlicePath as P};
    let (half_period, length) = (6, 3);
    let straight = P::Straight {
        half_period,
        length,
    };
    let paths = [
        (SlicePath::Still, P::Still),
        (SlicePath::Circle, P::Circle { half_period }),
        (SlicePath::Straight, straight),
    ];
    let interpolations = [
        (Interpolation::CubicSpline, I::CubicSpline),
        (Interpolation::Bilinear, I::Bilinear),
        (Interpolation::Nearest, I::Nearest),
    ];
    for (path, of_library) in paths {
        for (interpolation, interpolation_of_library) in interpolations {
            let stack = Owned::new(&StackDescription {
                path: path as u32,
                interpolation: interpolation as u32,
                ..DESCRIPTION
            });
            let same = *stack.library() == peer(of_library, interpolation_of_library);
            assert!(same, "{path:?} with {interpolation:?}");
        }
    }
}

#[test]
fn a_diameter_makes_the_field_of_that_diameter() {
    let whole = |height, diameter| {
        Owned::new(&StackDescription {
            width: 98,
            height,
            diameter,
            speckle_size: f64::NAN,
            path: SlicePath::Still as u32,
            ..DESCRIPTION
        })
    };
    let square = whole(98, 23);
    let expected = PupilField::new(98, 23, 11).unwrap();
    assert!(
        *square.library().field() == expected,
        "a square of 98 samples"
    );
    let oblong = whole(112, 23);
    let expected = PupilField::from_speckle_size([98, 112], 98.0 / 23.0, 11).unwrap();
    assert!(*oblong.library().field() == expected, "98 × 112 samples");
}

#[test]
fn a_description_from_a_plan_makes_the_stack_of_the_plan() {
    for (memory_limit, changes, side) in [(4 << 20, 1, 60.0), (1 << 30, 0, 80.0)] {
        let needs = StackNeeds {
            image: [side, 40.0],
            memory_limit,
            changes,
            ..NEEDS
        };
        // SAFETY: the pointers are valid.
        let description = answer(DESCRIPTION, |out| unsafe {
            tem00_stack_plan(&raw const needs, out)
        });
        let plan = StackPlan::new(&tem00_speckle::StackNeeds {
            image: [side, 40.0],
            region: [80.0, 40.0],
            speckle_size: 1.5,
            motion: (changes == 1).then_some(0.7),
            frames: 5,
            memory_limit,
        })
        .unwrap();
        let stack = Owned::new(&StackDescription {
            seed: 5,
            ..description
        });
        let expected = plan.stack(
            5,
            StackOptions {
                memory_limit,
                ..StackOptions::default()
            },
        );
        assert!(*stack.library() == expected.unwrap(), "{plan:?}");
    }
}

#[test]
fn a_stack_tells_what_it_is() {
    let stack = Owned::new(&DESCRIPTION);
    let info = StackInfo {
        width: 64,
        height: 48,
        slice_count: 12,
        speckle_size: 3.0,
        path: SlicePath::Straight,
        half_period: 6,
        length: 3,
        interpolation: Interpolation::CubicSpline,
        memory_bytes: 64 * 48 * 12 * 8,
    };
    let blank = StackInfo {
        width: 0,
        height: 0,
        slice_count: 0,
        ..info
    };
    // SAFETY: the pointers are valid.
    let got = answer(blank, |out| unsafe { tem00_stack_describe(stack.0, out) });
    assert_eq!(got, info, "{DESCRIPTION:?}");
}

/// Places in and out of the period.
fn places() -> [Vec<f64>; 3] {
    let count = 50_u32;
    let column = |step: f64, start: f64| {
        let place = |i| start + step * f64::from(i);
        (0..count).map(place).collect()
    };
    [column(3.37, -40.0), column(-1.71, 30.0), column(0.29, -3.0)]
}

#[test]
fn look_ups_are_those_of_the_library_to_the_last_bit() {
    let stack = Owned::new(&DESCRIPTION);
    let library = stack.library();
    let [x, y, u] = places();
    let mut batch = vec![0.0; x.len()];
    // SAFETY: the handle and the columns are valid.
    let status = unsafe {
        let out = batch.as_mut_ptr();
        tem00_stack_intensity_batch(stack.0, x.as_ptr(), y.as_ptr(), u.as_ptr(), x.len(), out)
    };
    assert_eq!(status, Status::Ok, "{}", last_parameter());
    for i in 0..x.len() {
        let (x, y, u) = (x[i], y[i], u[i]);
        let expected = library.intensity_at(x, y, u);
        let (centre, size) = ([x, y], [3.0, 0.5]);
        // SAFETY: the handle and the pointers are valid.
        unsafe {
            let one = answer(0.0, |out| tem00_stack_intensity(stack.0, x, y, u, out));
            let mean = answer(0.0, |out| {
                tem00_stack_average(stack.0, centre.as_ptr(), size.as_ptr(), u, out)
            });
            assert_eq!([one, batch[i]], [expected; 2], "at ({x}, {y}, {u})");
            assert_eq!(
                mean,
                library.average_over(centre, size, u),
                "about ({x}, {y}, {u})"
            );
        }
    }
}

#[test]
fn correlations_offsets_and_coefficients_are_those_of_the_library() {
    let stack = Owned::new(&DESCRIPTION);
    let (handle, library) = (stack.0.cast_const(), stack.library());
    // SAFETY: the handle and the pointers are valid.
    unsafe {
        for correlation in [-0.5, 0.0, 0.3, 1.0, 2.0] {
            let u = answer(-1.0, |out| {
                tem00_stack_coordinate_of(handle, correlation, out)
            });
            assert_eq!(u, library.coordinate_of(correlation), "of {correlation}");
            let back = answer(-1.0, |out| tem00_stack_correlation_at(handle, u, out));
            assert_eq!(back, library.correlation_at(u), "at {u}");
        }
        for slice in 0..12 {
            let between = answer(-1.0, |out| {
                tem00_stack_correlation_between(handle, 2, slice, out)
            });
            assert_eq!(
                between,
                library.correlation_between(2, slice),
                "2 and {slice}"
            );
            let offset = answer([9.0; 2], |out| {
                tem00_stack_offset(handle, slice, out.cast())
            });
            assert_eq!(offset, library.offset(slice), "of slice {slice}");
            let values = answer(ptr::null(), |out| {
                tem00_stack_coefficients(handle, slice, out)
            });
            let values = core::slice::from_raw_parts(values, 2 * 64 * 48);
            let expected = library.coefficients(slice).values();
            let parts: Vec<f32> = expected.iter().flat_map(|z| [z.re, z.im]).collect();
            assert_eq!(values, parts, "of slice {slice}");
        }
    }
}

/// A file for one test, with its name for C.
fn file(name: &str) -> (PathBuf, CString) {
    let path = std::env::temp_dir().join(format!("tem00_{}_{name}", std::process::id()));
    let text = CString::new(path.to_str().unwrap()).unwrap();
    (path, text)
}

fn read_file(path: *const c_char, memory_limit: u64) -> (Owned, Status) {
    let mut stack = ptr::dangling_mut();
    // SAFETY: the pointers are valid.
    let status = unsafe { tem00_stack_read(path, memory_limit, &raw mut stack) };
    (Owned(stack), status)
}

#[test]
fn a_file_gives_back_the_stack() {
    let stack = Owned::new(&DESCRIPTION);
    let (path, name) = file("same");
    // SAFETY: the pointers are valid.
    let written = unsafe { tem00_stack_write(stack.0, name.as_ptr()) };
    let (same, read) = read_file(name.as_ptr(), 1 << 20);
    let (_, limited) = read_file(name.as_ptr(), 1000);
    fs::write(&path, &fs::read(&path).unwrap()[..1000]).unwrap();
    let (_, short) = read_file(name.as_ptr(), 1 << 20);
    fs::remove_file(path).unwrap();
    assert_eq!([written, read], [Status::Ok; 2], "{}", last_parameter());
    assert!(same.library() == stack.library(), "the bits");
    assert_eq!(
        [limited, short],
        [Status::Memory, Status::File],
        "limited and cut short"
    );
}

#[test]
fn files_that_cannot_be_used_are_refused() {
    let stack = Owned::new(&DESCRIPTION);
    let missing = c"/nowhere/at/all".as_ptr();
    let not_utf8 = c"\xff".as_ptr();
    let expected = |status| (status, "path".to_owned());
    // SAFETY: the pointers are valid or null, which is refused.
    let write = |path| refusal(unsafe { tem00_stack_write(stack.0, path) });
    assert_eq!(write(missing), expected(Status::Io), "write");
    assert_eq!(write(not_utf8), expected(Status::InvalidArgument), "write");
    assert_eq!(
        write(ptr::null()),
        expected(Status::InvalidPointer),
        "write"
    );
    for (path, status) in [
        (missing, Status::Io),
        (not_utf8, Status::InvalidArgument),
        (ptr::null(), Status::InvalidPointer),
    ] {
        let (stack, got) = read_file(path, 0);
        assert_eq!(refusal(got), expected(status), "read");
        assert!(stack.0.is_null(), "{status:?} left a stack");
    }
}

#[test]
fn descriptions_are_refused_by_the_name_of_what_is_wrong() {
    let create = |description: StackDescription| {
        let mut stack = ptr::dangling_mut();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_stack_create(&raw const description, &raw mut stack) };
        assert!(stack.is_null(), "{description:?} made a stack");
        refusal(status)
    };
    let memory = (Status::Memory, "memory_limit".to_owned());
    let d = DESCRIPTION;
    assert_eq!(
        create(StackDescription {
            width: 1 << 20,
            ..d
        }),
        argument("size"),
        "width"
    );
    assert_eq!(
        create(StackDescription {
            speckle_size: 1.0,
            ..d
        }),
        argument("speckle_size"),
        "1"
    );
    let nan = StackDescription {
        speckle_size: f64::NAN,
        ..d
    };
    assert_eq!(create(nan), argument("speckle_size"), "NaN");
    let wide = StackDescription {
        height: 64,
        diameter: 33,
        ..d
    };
    assert_eq!(create(wide), argument("diameter"), "above half the width");
    assert_eq!(
        create(StackDescription {
            half_period: 0,
            ..d
        }),
        argument("half_period"),
        "0"
    );
    assert_eq!(
        create(StackDescription { path: 3, ..d }),
        argument("path"),
        "3"
    );
    assert_eq!(
        create(StackDescription {
            interpolation: 3,
            ..d
        }),
        argument("interpolation"),
        "3"
    );
    assert_eq!(
        create(StackDescription {
            memory_limit: 1000,
            ..d
        }),
        memory,
        "1000 bytes"
    );
    let short = create(StackDescription { length: 1, ..d });
    assert_eq!(short.0, Status::InvalidArgument, "a path of length 1");
}

#[test]
fn needs_are_refused_by_the_name_of_what_is_wrong() {
    let plan = |needs: StackNeeds| {
        let mut description = DESCRIPTION;
        // SAFETY: the pointers are valid.
        refusal(unsafe { tem00_stack_plan(&raw const needs, &raw mut description) })
    };
    assert_eq!(
        plan(StackNeeds {
            image: [f64::NAN, 1.0],
            ..NEEDS
        }),
        argument("image"),
        "NaN"
    );
    assert_eq!(
        plan(StackNeeds {
            region: [1.0, 0.0],
            ..NEEDS
        }),
        argument("region"),
        "0"
    );
    assert_eq!(
        plan(StackNeeds {
            changes: 2,
            ..NEEDS
        }),
        argument("changes"),
        "2"
    );
    assert_eq!(
        plan(StackNeeds {
            motion: f64::NAN,
            ..NEEDS
        }),
        argument("motion"),
        "NaN"
    );
    let memory = (Status::Memory, "memory_limit".to_owned());
    assert_eq!(
        plan(StackNeeds {
            memory_limit: 10,
            ..NEEDS
        }),
        memory,
        "10 bytes"
    );
}

#[test]
fn look_ups_are_refused_by_the_name_of_what_is_wrong() {
    let stack = Owned::new(&DESCRIPTION);
    let handle = stack.0.cast_const();
    let nan = f64::NAN;
    let mut result = [7.0; 2];
    let out = result.as_mut_ptr();
    let (good, bad, negative) = ([1.0, 2.0], [1.0, nan], [1.0, -2.0]);
    let (good, bad, negative) = (good.as_ptr(), bad.as_ptr(), negative.as_ptr());
    // SAFETY: the handle and the pointers are valid.
    let refusals = unsafe {
        [
            (
                "x",
                refusal(tem00_stack_intensity(handle, nan, 0.0, 0.0, out)),
            ),
            (
                "y",
                refusal(tem00_stack_intensity(handle, 0.0, nan, 0.0, out)),
            ),
            (
                "u",
                refusal(tem00_stack_intensity(handle, 0.0, 0.0, nan, out)),
            ),
            (
                "u",
                refusal(tem00_stack_intensity_batch(handle, good, good, bad, 2, out)),
            ),
            (
                "centre",
                refusal(tem00_stack_average(handle, bad, good, 0.0, out)),
            ),
            (
                "size",
                refusal(tem00_stack_average(handle, good, negative, 0.0, out)),
            ),
            (
                "u",
                refusal(tem00_stack_average(handle, good, good, nan, out)),
            ),
            (
                "correlation",
                refusal(tem00_stack_coordinate_of(handle, nan, out)),
            ),
            (
                "distance",
                refusal(tem00_stack_correlation_at(handle, nan, out)),
            ),
            (
                "first",
                refusal(tem00_stack_correlation_between(handle, 12, 0, out)),
            ),
            (
                "second",
                refusal(tem00_stack_correlation_between(handle, 0, 12, out)),
            ),
            (
                "slice",
                refusal(tem00_stack_coefficients(handle, 12, &mut ptr::null())),
            ),
            (
                "slice",
                refusal(tem00_stack_offset(handle, 12, [0.0; 2].as_mut_ptr())),
            ),
        ]
    };
    for (name, refused) in refusals {
        assert_eq!(refused, argument(name), "for {name}");
    }
    assert_eq!(result, [7.0; 2], "nothing is written");
}

#[test]
fn the_farthest_look_ups_are_finite() {
    let stack = Owned::new(&DESCRIPTION);
    for far in [1e9, 1e30, -1e30] {
        // SAFETY: the handle and the pointer are valid.
        let intensity = answer(f64::NAN, |out| unsafe {
            tem00_stack_intensity(stack.0, far, -far, far, out)
        });
        assert!(intensity.is_finite(), "{intensity} at {far:e}");
    }
}

#[test]
fn null_is_refused_for_every_pointer() {
    let stack = Owned::new(&DESCRIPTION);
    let handle = stack.0.cast_const();
    let mut result = 0.0;
    let out = &raw mut result;
    let pair = [1.0; 2];
    let (pair, null) = (pair.as_ptr(), ptr::null());
    // SAFETY: null is refused, the other pointers are valid.
    let refusals = unsafe {
        [
            (
                "stack",
                refusal(tem00_stack_intensity(ptr::null(), 0.0, 0.0, 0.0, out)),
            ),
            (
                "intensity",
                refusal(tem00_stack_intensity(
                    handle,
                    0.0,
                    0.0,
                    0.0,
                    ptr::null_mut(),
                )),
            ),
            (
                "x",
                refusal(tem00_stack_intensity_batch(
                    handle, null, pair, pair, 2, out,
                )),
            ),
            (
                "centre",
                refusal(tem00_stack_average(handle, null, pair, 0.0, out)),
            ),
            (
                "size",
                refusal(tem00_stack_average(handle, pair, null, 0.0, out)),
            ),
            (
                "info",
                refusal(tem00_stack_describe(handle, ptr::null_mut())),
            ),
            (
                "offset",
                refusal(tem00_stack_offset(handle, 0, ptr::null_mut())),
            ),
            (
                "description",
                refusal(tem00_stack_create(ptr::null(), &mut ptr::null_mut())),
            ),
            (
                "stack",
                refusal(tem00_stack_create(&DESCRIPTION, ptr::null_mut())),
            ),
            (
                "needs",
                refusal(tem00_stack_plan(ptr::null(), ptr::null_mut())),
            ),
        ]
    };
    for (name, refused) in refusals {
        assert_eq!(
            refused,
            (Status::InvalidPointer, name.to_owned()),
            "null for {name}"
        );
    }
}

#[test]
fn threads_may_share_a_stack() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Stack>();
}
