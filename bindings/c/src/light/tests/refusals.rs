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
    let (half, one) = ([0.5; 4], [0.5, 1.0, 0.5, 0.5]);
    let (half, one) = (half.as_ptr(), one.as_ptr());
    let mut number = 7.0;
    let out = &raw mut number;
    let mut drawn = SampledEvent::default();
    let drawn = &raw mut drawn;
    let mut ray = RaySample::default();
    let mut pdf = RayPdf::default();
    let mut event = NextEvent::default();
    let mut bounds = Bounds::default();
    let mut hit = ApertureHit::default();
    // SAFETY: the handle and the pointers are valid.
    unsafe {
        number_is_refused("point", tem00_light_irradiance(light, nan, out));
        number_is_refused("point", tem00_light_flux(light, nan, [7.0; 3].as_mut_ptr()));
        number_is_refused("point", tem00_light_next_event(light, nan, &raw mut event));
        number_is_refused(
            "point",
            tem00_light_next_event_sampled(light, nan, half, drawn),
        );
        number_is_refused(
            "u",
            tem00_light_next_event_sampled(light, point, one, drawn),
        );
        number_is_refused("point", tem00_light_next_event_pdf(light, nan, unit, out));
        number_is_refused("wi", tem00_light_next_event_pdf(light, point, zero, out));
        number_is_refused("u", tem00_light_sample_ray(light, one, &raw mut ray));
        number_is_refused(
            "origin",
            tem00_light_ray_pdf(light, nan, unit, &raw mut pdf),
        );
        number_is_refused(
            "direction",
            tem00_light_ray_pdf(light, point, zero, &raw mut pdf),
        );
        number_is_refused("origin", tem00_light_radiance(light, nan, unit, out));
        number_is_refused("direction", tem00_light_radiance(light, point, nan, out));
        number_is_refused("distance", tem00_light_bounds(light, -1.0, &raw mut bounds));
        number_is_refused("point", tem00_light_hit(light, nan, unit, &raw mut hit));
        number_is_refused("wi", tem00_light_hit(light, point, zero, &raw mut hit));
        number_is_refused("min", tem00_light_power_bound(light, nan, point, out));
        number_is_refused("max", tem00_light_power_bound(light, point, nan, out));
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
    let ask = |[x, y, z]: [_; 3]| {
        // SAFETY: the handle and the columns are valid.
        unsafe { tem00_light_irradiance_batch(pair.handle, x, y, z, 2, irradiance) }
    };
    number_is_refused("y", ask([good, bad, good]));
    number_is_refused("z", ask([good, good, bad]));
    assert_eq!(out, [7.0; 2], "the results");
}

#[test]
fn batches_of_samples_are_refused_by_name_and_nothing_is_written() {
    let [pair, ..] = &pairs();
    let (good, mut bad) = ([0.5; 12], [0.5; 12]);
    bad[5] = f64::NAN;
    let (good, bad, null) = (good.as_ptr(), bad.as_ptr(), ptr::null());
    let mut events = [SampledEvent::default(); 2];
    let mut rays = [RaySample::default(); 2];
    let (event, ray) = (events.as_mut_ptr(), rays.as_mut_ptr());
    let draw = |points, u, events| {
        // SAFETY: the handle is valid, and the pointers are valid or null.
        unsafe { tem00_light_next_event_sampled_batch(pair.handle, points, u, 2, events) }
    };
    let sample = |u, rays| {
        // SAFETY: as above.
        unsafe { tem00_light_sample_ray_batch(pair.handle, u, 2, rays) }
    };
    number_is_refused("points", draw(bad, good, event));
    number_is_refused("u", draw(good, bad.wrapping_add(2), event));
    number_is_refused("u", sample(bad, ray));
    pointer_is_refused("points", draw(null, good, event));
    pointer_is_refused("u", draw(good, null, event));
    pointer_is_refused("events", draw(good, good, ptr::null_mut()));
    pointer_is_refused("u", sample(null, ray));
    pointer_is_refused("rays", sample(good, ptr::null_mut()));
    // What is written would be read.
    pointer_is_refused("events", draw(event.cast(), good, event));
    pointer_is_refused("events", draw(good, event.cast(), event));
    pointer_is_refused("rays", sample(ray.cast(), ray));
    assert_eq!(events, [SampledEvent::default(); 2], "the events");
    assert_eq!(rays, [RaySample::default(); 2], "the rays");
    // SAFETY: no number is read or written.
    let none = unsafe {
        [
            tem00_light_next_event_sampled_batch(pair.handle, null, null, 0, ptr::null_mut()),
            tem00_light_sample_ray_batch(pair.handle, null, 0, ptr::null_mut()),
        ]
    };
    assert_eq!(none, [Status::Ok; 2], "of no numbers");
}

#[test]
fn null_is_refused_for_every_pointer() {
    let [pair, ..] = &pairs();
    let light = pair.handle.cast_const();
    let (point, null) = (POINT.as_ptr(), ptr::null());
    let mut number = 0.0;
    let out = &raw mut number;
    // SAFETY: null is refused, the other pointers are valid.
    unsafe {
        pointer_is_refused("light", tem00_light_irradiance(ptr::null(), point, out));
        pointer_is_refused("point", tem00_light_irradiance(light, null, out));
        pointer_is_refused(
            "irradiance",
            tem00_light_irradiance(light, point, ptr::null_mut()),
        );
        pointer_is_refused(
            "event",
            tem00_light_next_event(light, point, ptr::null_mut()),
        );
        let event = tem00_light_next_event_f32(light, [0.0; 3].as_ptr(), ptr::null_mut());
        pointer_is_refused("event", event);
        pointer_is_refused("u", tem00_light_sample_ray(light, null, ptr::null_mut()));
        pointer_is_refused("wi", tem00_light_next_event_pdf(light, point, null, out));
        let events = tem00_light_next_event_batch(light, point, point, point, 3, ptr::null());
        pointer_is_refused("events", events);
        let x = tem00_light_irradiance_batch(light, null, point, point, 3, out);
        pointer_is_refused("x", x);
        pointer_is_refused("bounds", tem00_light_bounds(light, 1.0, ptr::null_mut()));
        pointer_is_refused("info", tem00_light_describe(light, ptr::null_mut()));
        pointer_is_refused("max", tem00_light_power_bound(light, point, null, out));
        pointer_is_refused("data", tem00_light_plain_data(light, ptr::null_mut()));
        pointer_is_refused("light", tem00_light_create_spot(&SPOT, ptr::null_mut()));
        let description = tem00_light_create_spot(ptr::null(), &mut ptr::null_mut());
        pointer_is_refused("description", description);
    }
}

#[test]
fn threads_may_share_a_light() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Light>();
}
