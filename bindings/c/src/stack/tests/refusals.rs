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
    let (zero, nan_f32, mut single) = ([0.0], [f32::NAN], [7.0_f32]);
    let (zero, nan_f32, single) = (zero.as_ptr(), nan_f32.as_ptr(), single.as_mut_ptr());
    // SAFETY: the handle and the pointers are valid.
    unsafe {
        number_is_refused("x", tem00_stack_intensity(handle, nan, 0.0, 0.0, out));
        number_is_refused("y", tem00_stack_intensity(handle, 0.0, nan, 0.0, out));
        number_is_refused("u", tem00_stack_intensity(handle, 0.0, 0.0, nan, out));
        number_is_refused(
            "u",
            tem00_stack_intensity_batch(handle, good, good, bad, 2, out),
        );
        let y = tem00_stack_intensity_batch_f32(handle, zero, nan_f32, zero, 1, single);
        number_is_refused("y", y);
        let size = tem00_stack_average_batch_f32(handle, zero, zero, negative, zero, 1, single);
        number_is_refused("size", size);
        number_is_refused("centre", tem00_stack_average(handle, bad, good, 0.0, out));
        number_is_refused(
            "size",
            tem00_stack_average(handle, good, negative, 0.0, out),
        );
        number_is_refused("u", tem00_stack_average(handle, good, good, nan, out));
        number_is_refused("correlation", tem00_stack_coordinate_of(handle, nan, out));
        number_is_refused("distance", tem00_stack_correlation_at(handle, nan, out));
        number_is_refused("u", tem00_stack_correlation_between(handle, nan, 0.0, out));
        number_is_refused("v", tem00_stack_correlation_between(handle, 0.0, nan, out));
        number_is_refused(
            "slice",
            tem00_stack_coefficients(handle, 12, &mut ptr::null()),
        );
        number_is_refused(
            "slice",
            tem00_stack_offset(handle, 12, [0.0; 2].as_mut_ptr()),
        );
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
    unsafe {
        pointer_is_refused(
            "stack",
            tem00_stack_intensity(ptr::null(), 0.0, 0.0, 0.0, out),
        );
        pointer_is_refused(
            "intensity",
            tem00_stack_intensity(handle, 0.0, 0.0, 0.0, ptr::null_mut()),
        );
        pointer_is_refused(
            "x",
            tem00_stack_intensity_batch(handle, null, pair, pair, 2, out),
        );
        pointer_is_refused("centre", tem00_stack_average(handle, null, pair, 0.0, out));
        pointer_is_refused("size", tem00_stack_average(handle, pair, null, 0.0, out));
        pointer_is_refused("info", tem00_stack_describe(handle, ptr::null_mut()));
        pointer_is_refused("offset", tem00_stack_offset(handle, 0, ptr::null_mut()));
        pointer_is_refused(
            "description",
            tem00_stack_create(ptr::null(), &mut ptr::null_mut()),
        );
        pointer_is_refused("stack", tem00_stack_create(&DESCRIPTION, ptr::null_mut()));
        pointer_is_refused("needs", tem00_stack_plan(ptr::null(), ptr::null_mut()));
    }
}
