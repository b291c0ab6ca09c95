use super::*;

const NAN: [f64; 3] = [0.0, f64::NAN, 0.0];
const POINT: [f64; 3] = [0.2, -0.3, 0.5];
const ZERO: [f64; 3] = [0.0; 3];
const UNIT: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn senseless_numbers_are_refused_by_name_and_nothing_is_written() {
    let [pair, ..] = &pairs();
    let light = pair.handle.cast_const();
    let nan = NAN.as_ptr();
    let (point, unit, zero) = (POINT.as_ptr(), UNIT.as_ptr(), ZERO.as_ptr());
    let one = [0.5, 1.0, 0.5, 0.5];
    let half = [0.5; 4];
    let mut number = 7.0;
    let out = &raw mut number;
    let mut drawn = SampledEvent::default();
    let mut ray = RaySample::default();
    let mut pdf = RayPdf::default();
    let mut event = NextEvent::default();
    let mut bounds = Bounds::default();
    let mut hit = ApertureHit::default();
    // SAFETY: the handle and the pointers are valid.
    unsafe {
        let cases = [
            ("point", refusal(tem00_light_irradiance(light, nan, out))),
            (
                "point",
                refusal(tem00_light_flux(light, nan, [7.0; 3].as_mut_ptr())),
            ),
            (
                "point",
                refusal(tem00_light_next_event(light, nan, &raw mut event)),
            ),
            (
                "point",
                refusal(tem00_light_next_event_sampled(
                    light,
                    nan,
                    half.as_ptr(),
                    &raw mut drawn,
                )),
            ),
            (
                "u",
                refusal(tem00_light_next_event_sampled(
                    light,
                    point,
                    one.as_ptr(),
                    &raw mut drawn,
                )),
            ),
            (
                "point",
                refusal(tem00_light_next_event_pdf(light, nan, unit, out)),
            ),
            (
                "wi",
                refusal(tem00_light_next_event_pdf(light, point, zero, out)),
            ),
            (
                "u",
                refusal(tem00_light_sample_ray(light, one.as_ptr(), &raw mut ray)),
            ),
            (
                "origin",
                refusal(tem00_light_ray_pdf(light, nan, unit, &raw mut pdf)),
            ),
            (
                "direction",
                refusal(tem00_light_ray_pdf(light, point, zero, &raw mut pdf)),
            ),
            (
                "origin",
                refusal(tem00_light_radiance(light, nan, unit, out)),
            ),
            (
                "direction",
                refusal(tem00_light_radiance(light, point, nan, out)),
            ),
            (
                "distance",
                refusal(tem00_light_bounds(light, -1.0, &raw mut bounds)),
            ),
            (
                "point",
                refusal(tem00_light_hit(light, nan, unit, &raw mut hit)),
            ),
            (
                "wi",
                refusal(tem00_light_hit(light, point, zero, &raw mut hit)),
            ),
            (
                "min",
                refusal(tem00_light_power_bound(light, nan, point, out)),
            ),
            (
                "max",
                refusal(tem00_light_power_bound(light, point, nan, out)),
            ),
        ];
        for (i, (name, refused)) in cases.into_iter().enumerate() {
            assert_eq!(refused, argument(name), "case {i}");
        }
    }
    assert_eq!(number, 7.0, "the result");
    assert_eq!(event, NextEvent::default(), "the event");
}

#[test]
fn a_bad_point_of_a_batch_is_refused_before_anything_is_written() {
    let [pair, ..] = &pairs();
    let (good, bad) = ([0.1, 0.2], [0.1, f64::INFINITY]);
    let mut out = [7.0; 2];
    let (good, bad, irradiance) = (good.as_ptr(), bad.as_ptr(), out.as_mut_ptr());
    // SAFETY: the handle and the columns are valid.
    unsafe {
        let light = pair.handle.cast_const();
        let status = tem00_light_irradiance_batch(light, good, bad, good, 2, irradiance);
        assert_eq!(refusal(status), argument("y"), "infinite y");
        let status = tem00_light_irradiance_batch(light, good, good, bad, 2, irradiance);
        assert_eq!(refusal(status), argument("z"), "infinite z");
    }
    assert_eq!(out, [7.0; 2], "the results");
}

#[test]
fn batches_of_samples_are_refused_by_name_and_nothing_is_written() {
    let [pair, ..] = &pairs();
    let light = pair.handle.cast_const();
    let (good, mut bad) = ([0.5; 12], [0.5; 12]);
    bad[5] = f64::NAN;
    let (good, bad, null) = (good.as_ptr(), bad.as_ptr(), ptr::null());
    let mut events = [SampledEvent::default(); 2];
    let mut rays = [RaySample::default(); 2];
    let (event, ray) = (events.as_mut_ptr(), rays.as_mut_ptr());
    let drawn = |points, u, events| {
        // SAFETY: the handle is valid, and the pointers are valid or null.
        refusal(unsafe { tem00_light_next_event_sampled_batch(light, points, u, 2, events) })
    };
    let sampled = |u, rays| {
        // SAFETY: as above.
        refusal(unsafe { tem00_light_sample_ray_batch(light, u, 2, rays) })
    };
    let cases = [
        (argument("points"), drawn(bad, good, event)),
        (argument("u"), drawn(good, bad.wrapping_add(2), event)),
        (argument("u"), sampled(bad, ray)),
        (pointer("points"), drawn(null, good, event)),
        (pointer("u"), drawn(good, null, event)),
        (pointer("events"), drawn(good, good, ptr::null_mut())),
        (pointer("u"), sampled(null, ray)),
        (pointer("rays"), sampled(good, ptr::null_mut())),
        // What is written would be read.
        (
            pointer("events"),
            drawn(event.cast_const().cast(), good, event),
        ),
        (
            pointer("events"),
            drawn(good, event.cast_const().cast(), event),
        ),
        (pointer("rays"), sampled(ray.cast_const().cast(), ray)),
    ];
    for (i, (expected, refused)) in cases.into_iter().enumerate() {
        assert_eq!(refused, expected, "case {i}");
    }
    assert_eq!(events, [SampledEvent::default(); 2], "the events");
    assert_eq!(rays, [RaySample::default(); 2], "the rays");
    // SAFETY: no number is read or written.
    let none = unsafe {
        [
            tem00_light_next_event_sampled_batch(light, null, null, 0, ptr::null_mut()),
            tem00_light_sample_ray_batch(light, null, 0, ptr::null_mut()),
        ]
    };
    assert_eq!(none, [Status::Ok; 2], "of no numbers");
}

#[test]
fn null_is_refused_for_every_pointer() {
    let [pair, ..] = &pairs();
    let light = pair.handle.cast_const();
    let mut number = 0.0;
    let point = POINT.as_ptr();
    // SAFETY: null is refused, the other pointers are valid.
    let refusals = unsafe {
        [
            (
                "light",
                refusal(tem00_light_irradiance(ptr::null(), point, &raw mut number)),
            ),
            (
                "point",
                refusal(tem00_light_irradiance(light, ptr::null(), &raw mut number)),
            ),
            (
                "irradiance",
                refusal(tem00_light_irradiance(light, point, ptr::null_mut())),
            ),
            (
                "event",
                refusal(tem00_light_next_event(light, point, ptr::null_mut())),
            ),
            (
                "event",
                refusal(tem00_light_next_event_f32(
                    light,
                    [0.0; 3].as_ptr(),
                    ptr::null_mut(),
                )),
            ),
            (
                "u",
                refusal(tem00_light_sample_ray(light, ptr::null(), ptr::null_mut())),
            ),
            (
                "wi",
                refusal(tem00_light_next_event_pdf(
                    light,
                    point,
                    ptr::null(),
                    &raw mut number,
                )),
            ),
            (
                "events",
                refusal(tem00_light_next_event_batch(
                    light,
                    point,
                    point,
                    point,
                    3,
                    ptr::null(),
                )),
            ),
            (
                "x",
                refusal(tem00_light_irradiance_batch(
                    light,
                    ptr::null(),
                    point,
                    point,
                    3,
                    &raw mut number,
                )),
            ),
            (
                "bounds",
                refusal(tem00_light_bounds(light, 1.0, ptr::null_mut())),
            ),
            (
                "info",
                refusal(tem00_light_describe(light, ptr::null_mut())),
            ),
            (
                "max",
                refusal(tem00_light_power_bound(
                    light,
                    point,
                    ptr::null(),
                    &raw mut number,
                )),
            ),
            (
                "data",
                refusal(tem00_light_plain_data(light, ptr::null_mut())),
            ),
            (
                "light",
                refusal(tem00_light_create_spot(&SPOT, ptr::null_mut())),
            ),
            (
                "description",
                refusal(tem00_light_create_spot(ptr::null(), &mut ptr::null_mut())),
            ),
        ]
    };
    for (name, refused) in refusals {
        assert_eq!(refused, pointer(name), "null for {name}");
    }
}

#[test]
fn a_light_that_single_precision_cannot_carry_is_refused_there_alone() {
    let tiny = SpotDescription {
        wavelength: 1e-27,
        waist_radius: 1e-26,
        ..SPOT
    };
    let mut light = ptr::null_mut();
    let (mut event, mut single) = (NextEvent::default(), NextEventF32::default());
    // SAFETY: the pointers are valid, and the light is destroyed once.
    let statuses = unsafe {
        [
            tem00_light_create_spot(&raw const tiny, &raw mut light),
            tem00_light_next_event(light, POINT.as_ptr(), &raw mut event),
            tem00_light_next_event_f32(light, [0.0; 3].as_ptr(), &raw mut single),
        ]
    };
    // SAFETY: as above.
    unsafe { tem00_light_destroy(light) };
    assert_eq!(
        statuses,
        [Status::Ok, Status::Ok, Status::InvalidArgument],
        "in turn"
    );
}

#[test]
fn threads_may_share_a_light() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Light>();
}
