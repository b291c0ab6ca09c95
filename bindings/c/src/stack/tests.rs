//! The functions of a stack against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

use core::ptr::{dangling_mut, null, null_mut};

use tem00_speckle::{PupilField, SpeckleStack, StackOptions, StackPlan};

use super::*;
use crate::{
    status::Status,
    testing::{Owned, each_is_refused, refuses},
};

const DESCRIPTION: StackDescription = StackDescription {
    width: 64,
    height: 48,
    diameter: 0,
    speckle_size: 3.0,
    seed: 11,
    path: SlicePath::Straight as u32,
    half_period: 6,
    length: 3,
    memory_limit: 1 << 20,
    threads: 1,
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

fn stack(description: &StackDescription) -> Owned<Stack> {
    Owned::new(tem00_stack_create, description, tem00_stack_destroy)
}

#[test]
fn every_path_makes_the_stack_of_the_library_on_any_number_of_threads() {
    use tem00_speckle::SlicePath as P;
    let (half_period, length) = (6, 3);
    let straight = P::Straight {
        half_period,
        length,
    };
    let field = PupilField::from_speckle_size([64, 48], 3.0, 11).unwrap();
    let memory_limit = 1 << 20;
    for (path, of_library, threads) in [
        (SlicePath::Still, P::Still, 0),
        (SlicePath::Circle, P::Circle { half_period }, 2),
        (SlicePath::Straight, straight, 5),
    ] {
        let stack = stack(&StackDescription {
            path: path as u32,
            threads,
            ..DESCRIPTION
        });
        let options = StackOptions { memory_limit };
        let expected = SpeckleStack::generate_with(&field, of_library, options);
        assert!(stack.0 == expected.unwrap(), "{path:?}");
    }
}

#[test]
fn a_diameter_makes_the_field_of_that_diameter() {
    // 256 / (256 / 49) is not 49 in double precision.
    let oblong = PupilField::from_speckle_size([256, 112], 256.0 / 49.0, 11);
    for (height, expected) in [(256, PupilField::new(256, 49, 11)), (112, oblong)] {
        let stack = stack(&StackDescription {
            width: 256,
            height,
            diameter: 49,
            speckle_size: f64::NAN,
            path: SlicePath::Still as u32,
            ..DESCRIPTION
        });
        assert!(
            *stack.0.field() == expected.unwrap(),
            "256 × {height} samples"
        );
    }
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
        let description: StackDescription = ask!(tem00_stack_plan(&raw const needs));
        let plan = StackPlan::new(&tem00_speckle::StackNeeds {
            image: [side, 40.0],
            region: [80.0, 40.0],
            speckle_size: 1.5,
            motion: (changes == 1).then_some(0.7),
            frames: 5,
            memory_limit,
        })
        .unwrap();
        let stack = stack(&StackDescription {
            seed: 5,
            ..description
        });
        let expected = plan.stack(5, StackOptions { memory_limit });
        assert!(stack.0 == expected.unwrap(), "{plan:?}");
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
const fn single(x: f64) -> f32 {
    x as f32
}

#[test]
fn look_ups_are_those_of_the_library_to_the_last_bit() {
    let stack = stack(&DESCRIPTION);
    let (handle, library) = (stack.handle.cast_const(), &stack.0);
    // Places in and out of the period.
    let column = |step: f64, start: f64| (0..50).map(move |i| start + step * f64::from(i));
    let columns = [column(3.37, -40.0), column(-1.71, 30.0), column(0.29, -3.0)];
    let [x, y, u] = columns.map(Iterator::collect::<Vec<_>>);
    let narrow = |column: &Vec<f64>| column.iter().map(|&x| single(x)).collect::<Vec<_>>();
    let [x_f32, y_f32, u_f32] = [&x, &y, &u].map(narrow);
    let size = [3.0, 0.5];
    let mut batch = vec![0.0; 50];
    let mut narrow = [0.0_f32; 4].map(|zero| vec![zero; 50]);
    let [intensity, average, expected_intensity, expected_average] = &mut narrow;
    // SAFETY: the handle and the columns are valid.
    let statuses = unsafe {
        let ([a, b, c], out) = (
            [&x, &y, &u].map(|column| column.as_ptr()),
            batch.as_mut_ptr(),
        );
        let [d, e, f] = [&x_f32, &y_f32, &u_f32].map(|column| column.as_ptr());
        let [intensity, average] = [intensity, average].map(|column| column.as_mut_ptr());
        [
            tem00_stack_intensity_batch(handle, a, b, c, 50, out),
            tem00_stack_intensity_batch_f32(handle, d, e, f, 50, intensity),
            tem00_stack_average_batch_f32(handle, d, e, size.as_ptr(), f, 50, average),
        ]
    };
    assert_eq!(statuses, [Status::Ok; 3]);
    library.intensity_batch_f32(&x_f32, &y_f32, &u_f32, expected_intensity);
    library.average_batch_f32([&x_f32, &y_f32], size, &u_f32, expected_average);
    assert_eq!(narrow[..2], narrow[2..], "in single precision");
    for i in 0..50 {
        let (x, y, u) = (x[i], y[i], u[i]);
        let (field, centre) = (library.amplitude_at(x, y, u), [x, y]);
        agree! {
            (x, y, u);
            tem00_stack_intensity(handle, x, y, u) = library.intensity_at(x, y, u);
            tem00_stack_amplitude(handle, x, y, u) = [field.re, field.im];
            tem00_stack_average(handle, centre.as_ptr(), size.as_ptr(), u) =
                library.average_over(centre, size, u);
        }
        assert_eq!(
            batch[i],
            library.intensity_at(x, y, u),
            "at ({x}, {y}, {u})"
        );
    }
}

#[test]
fn what_a_stack_tells_of_itself_is_that_of_the_library() {
    let stack = stack(&DESCRIPTION);
    let (handle, library) = (stack.handle.cast_const(), &stack.0);
    let info = StackInfo {
        width: 64,
        height: 48,
        slice_count: 12,
        speckle_size: 3.0,
        path: SlicePath::Straight,
        half_period: 6,
        length: 3,
        memory_bytes: 64 * 48 * 12 * 8,
    };
    agree! { DESCRIPTION; tem00_stack_describe(handle) = info; }
    for correlation in [-0.5, 0.0, 0.3, 1.0, 2.0] {
        let u = library.coordinate_of(correlation);
        agree! {
            correlation;
            tem00_stack_coordinate_of(handle, correlation) = u;
            tem00_stack_correlation_at(handle, u) = library.correlation_at(u);
        }
    }
    for slice in 0..12 {
        let v = 0.75 * f64::from(u8::try_from(slice).unwrap());
        agree! {
            slice;
            tem00_stack_correlation_between(handle, 2.0, v) = library.correlation_between(2.0, v);
            tem00_stack_offset(handle, slice) = library.offset(slice);
        }
        let values: *const f32 = ask!(tem00_stack_coefficients(handle, slice));
        // SAFETY: they belong to the stack.
        let values = unsafe { core::slice::from_raw_parts(values, 2 * 64 * 48) };
        let expected = library.coefficients(slice).values();
        let parts: Vec<f32> = expected.iter().flat_map(|z| [z.re, z.im]).collect();
        assert_eq!(values, parts, "of slice {slice}");
    }
}

#[test]
fn descriptions_and_needs_are_refused_by_the_name_of_what_is_wrong() {
    // SAFETY: the pointers are valid.
    let create = |description, stack: *mut _| unsafe { tem00_stack_create(description, stack) };
    each_is_refused(
        DESCRIPTION,
        [
            ("width", |d| d.width = 1 << 20),
            ("speckle_size", |d| d.speckle_size = 1.0),
            ("speckle_size", |d| d.speckle_size = f64::NAN),
            ("height", |d| d.height = 1 << 20),
            // Of an oblong, and above half the width.
            ("diameter", |d| d.diameter = 33),
            ("diameter", |d| (d.height, d.diameter) = (64, 33)),
            ("half_period", |d| d.half_period = 0),
            ("path", |d| d.path = 3),
        ],
        create,
    );
    each_is_refused(
        NEEDS,
        [
            ("image", |needs| needs.image = [f64::NAN, 1.0]),
            ("region", |needs| needs.region = [1.0, 0.0]),
            ("changes", |needs| needs.changes = 2),
            ("motion", |needs| needs.motion = f64::NAN),
        ],
        |needs, handle: *mut *mut ()| {
            let mut description = DESCRIPTION;
            // SAFETY: the pointers are valid.
            unsafe {
                (
                    tem00_stack_plan(needs, &raw mut description),
                    handle.write(null_mut()),
                )
                    .0
            }
        },
    );
    let (mut large, mut short, mut needs) = (DESCRIPTION, DESCRIPTION, NEEDS);
    (large.memory_limit, short.length, needs.memory_limit) = (1000, 1, 10);
    let mut handle = dangling_mut();
    refuses(
        "memory_limit",
        Status::Memory,
        create(&raw const large, &raw mut handle),
    );
    assert_eq!(
        create(&raw const short, &raw mut handle),
        Status::InvalidArgument,
        "of length 1"
    );
    assert!(handle.is_null(), "a stack was made");
    refused! { Memory { "memory_limit" tem00_stack_plan(&raw const needs, &raw mut large); } }
}

#[test]
fn look_ups_are_refused_by_the_name_of_what_is_wrong() {
    let stack = stack(&DESCRIPTION);
    let handle = stack.handle.cast_const();
    let nan = f64::NAN;
    let (mut room, mut made) = ([7.0; 2], null_mut());
    let out = room.as_mut_ptr();
    let (good, bad, negative) = ([1.0, 2.0], [1.0, nan], [1.0, -2.0]);
    let (good, bad, negative) = (good.as_ptr(), bad.as_ptr(), negative.as_ptr());
    let (zero, nan_f32) = ([0.0], [f32::NAN]);
    let (zero, nan_f32) = (zero.as_ptr(), nan_f32.as_ptr());
    refused! {
        InvalidArgument {
            "x" tem00_stack_intensity(handle, nan, 0.0, 0.0, out);
            "y" tem00_stack_intensity(handle, 0.0, nan, 0.0, out);
            "u" tem00_stack_intensity(handle, 0.0, 0.0, nan, out);
            "u" tem00_stack_amplitude(handle, 0.0, 0.0, nan, out);
            "u" tem00_stack_intensity_batch(handle, good, good, bad, 2, out);
            "y" tem00_stack_intensity_batch_f32(handle, zero, nan_f32, zero, 1, out.cast());
            "size" tem00_stack_average_batch_f32(handle, zero, zero, negative, zero, 1, out.cast());
            "centre" tem00_stack_average(handle, bad, good, 0.0, out);
            "size" tem00_stack_average(handle, good, negative, 0.0, out);
            "u" tem00_stack_average(handle, good, good, nan, out);
            "correlation" tem00_stack_coordinate_of(handle, nan, out);
            "distance" tem00_stack_correlation_at(handle, nan, out);
            "u" tem00_stack_correlation_between(handle, nan, 0.0, out);
            "v" tem00_stack_correlation_between(handle, 0.0, nan, out);
            "slice" tem00_stack_coefficients(handle, 12, out.cast());
            "slice" tem00_stack_offset(handle, 12, out);
        }
        InvalidPointer {
            "stack" tem00_stack_intensity(null(), 0.0, 0.0, 0.0, out);
            "intensity" tem00_stack_intensity(handle, 0.0, 0.0, 0.0, null_mut());
            "x" tem00_stack_intensity_batch(handle, null(), good, good, 2, out);
            "centre" tem00_stack_average(handle, null(), good, 0.0, out);
            "size" tem00_stack_average(handle, good, null(), 0.0, out);
            "info" tem00_stack_describe(handle, null_mut());
            "offset" tem00_stack_offset(handle, 0, null_mut());
            "description" tem00_stack_create(null(), &raw mut made);
            "stack" tem00_stack_create(&DESCRIPTION, null_mut());
            "needs" tem00_stack_plan(null(), out.cast());
        }
    }
    assert_eq!(room, [7.0; 2], "nothing is written");
}
