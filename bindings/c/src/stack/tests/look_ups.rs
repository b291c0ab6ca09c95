use super::*;

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
            let amplitude = answer([0.0; 2], |out| {
                tem00_stack_amplitude(stack.0, x, y, u, out.cast())
            });
            let field = library.amplitude_at(x, y, u);
            assert_eq!(amplitude, [field.re, field.im], "at ({x}, {y}, {u})");
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

#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
fn single(x: f64) -> f32 {
    x as f32
}

#[test]
fn look_ups_in_single_precision_are_those_of_the_library() {
    let stack = Owned::new(&DESCRIPTION);
    let library = stack.library();
    let [x, y, u] = places().map(|column| column.into_iter().map(single).collect::<Vec<_>>());
    let size = [3.0, 0.5];
    let mut out = [(); 2].map(|()| vec![0.0_f32; x.len()]);
    let mut expected = out.clone();
    library.intensity_batch_f32(&x, &y, &u, &mut expected[0]);
    library.average_batch_f32([&x, &y], size, &u, &mut expected[1]);
    let [intensity, average] = out.each_mut().map(|out| out.as_mut_ptr());
    let ([px, py, pu], count) = ([&x, &y, &u].map(|column| column.as_ptr()), x.len());
    // SAFETY: the handle and the columns are valid.
    let statuses = unsafe {
        [
            tem00_stack_intensity_batch_f32(stack.0, px, py, pu, count, intensity),
            tem00_stack_average_batch_f32(stack.0, px, py, size.as_ptr(), pu, count, average),
        ]
    };
    assert_eq!(statuses, [Status::Ok; 2], "{}", last_parameter());
    assert_eq!(out, expected);
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
            let v = 0.75 * f64::from(u8::try_from(slice).unwrap());
            let between = answer(-1.0, |out| {
                tem00_stack_correlation_between(handle, 2.0, v, out)
            });
            assert_eq!(between, library.correlation_between(2.0, v), "2 and {v}");
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
