use super::*;

#[test]
fn descriptions_are_refused_by_the_name_of_what_is_wrong() {
    let create = |description: &StackDescription| {
        let mut stack = ptr::dangling_mut();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_stack_create(description, &raw mut stack) };
        assert!(stack.is_null(), "{description:?} made a stack");
        status
    };
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
            ("interpolation", |d| d.interpolation = 3),
        ],
        create,
    );
    let large = StackDescription {
        memory_limit: 1000,
        ..DESCRIPTION
    };
    assert_eq!(refusal(create(&large)), memory(), "1000 bytes");
    let short = StackDescription {
        length: 1,
        ..DESCRIPTION
    };
    assert_eq!(create(&short), Status::InvalidArgument, "of length 1");
}

fn memory() -> (Status, String) {
    (Status::Memory, "memory_limit".to_owned())
}

#[test]
fn needs_are_refused_by_the_name_of_what_is_wrong() {
    let plan = |needs: &StackNeeds| {
        let mut description = DESCRIPTION;
        // SAFETY: the pointers are valid.
        unsafe { tem00_stack_plan(needs, &raw mut description) }
    };
    each_is_refused(
        NEEDS,
        [
            ("image", |needs| needs.image = [f64::NAN, 1.0]),
            ("region", |needs| needs.region = [1.0, 0.0]),
            ("changes", |needs| needs.changes = 2),
            ("motion", |needs| needs.motion = f64::NAN),
        ],
        plan,
    );
    let large = StackNeeds {
        memory_limit: 10,
        ..NEEDS
    };
    assert_eq!(refusal(plan(&large)), memory(), "10 bytes");
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
                "y",
                refusal(tem00_stack_intensity_batch_f32(
                    handle,
                    [0.0].as_ptr(),
                    [f32::NAN].as_ptr(),
                    [0.0].as_ptr(),
                    1,
                    [0.0].as_mut_ptr(),
                )),
            ),
            (
                "size",
                refusal(tem00_stack_average_batch_f32(
                    handle,
                    [0.0].as_ptr(),
                    [0.0].as_ptr(),
                    negative,
                    [0.0].as_ptr(),
                    1,
                    [0.0].as_mut_ptr(),
                )),
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
                "u",
                refusal(tem00_stack_correlation_between(handle, nan, 0.0, out)),
            ),
            (
                "v",
                refusal(tem00_stack_correlation_between(handle, 0.0, nan, out)),
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
        assert_eq!(refused, pointer(name), "null for {name}");
    }
}
