use core::ptr::null_mut;

use super::*;
use crate::status::Status;

#[test]
fn what_is_wrong_is_refused_by_name_and_nothing_is_written() {
    let light = spot();
    let light = light.handle.cast_const();
    let (mut room, mut handle, single) = ([7.0; 24], null_mut(), [0.0_f32; 3]);
    let (out, single) = (room.as_mut_ptr(), single.as_ptr());
    let [nan, point, unit, zero, half, one, nan_later] = [
        [0.0, f64::NAN, 0.0, 0.0],
        [0.2, -0.3, 0.5, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0; 4],
        [0.5; 4],
        [0.5, 1.0, 0.5, 0.5],
        [0.5, 0.5, 0.5, f64::NAN],
    ]
    .map(|numbers| Box::leak(Box::new(numbers)).as_ptr());
    let (good, bad) = ([0.5; 12], [0.5, 0.5, 0.5, 0.5, 0.5, f64::NAN, 0.5, 0.5]);
    let (good, bad) = (good.as_ptr(), bad.as_ptr());
    refused! {
        InvalidArgument {
            "point" tem00_light_irradiance(light, nan, out);
            "point" tem00_light_flux(light, nan, out);
            "point" tem00_light_next_event(light, nan, out.cast());
            "point" tem00_light_next_event_sampled(light, nan, half, out.cast());
            "u" tem00_light_next_event_sampled(light, point, one, out.cast());
            "point" tem00_light_next_event_pdf(light, nan, unit, out);
            "wi" tem00_light_next_event_pdf(light, point, zero, out);
            "u" tem00_light_sample_ray(light, one, out.cast());
            "origin" tem00_light_ray_pdf(light, nan, unit, out.cast());
            "direction" tem00_light_ray_pdf(light, point, zero, out.cast());
            "origin" tem00_light_radiance(light, nan, unit, out);
            "direction" tem00_light_radiance(light, point, nan, out);
            "distance" tem00_light_bounds(light, -1.0, out.cast());
            "point" tem00_light_hit(light, nan, unit, out.cast());
            "wi" tem00_light_hit(light, point, zero, out.cast());
            "min" tem00_light_power_bound(light, nan, point, out);
            "max" tem00_light_power_bound(light, point, nan, out);
            "y" tem00_light_irradiance_batch(light, half, nan_later, half, 4, out);
            "z" tem00_light_irradiance_batch(light, half, half, nan_later, 4, out);
            "points" tem00_light_next_event_sampled_batch(light, bad, good, 2, out.cast());
            "u" tem00_light_next_event_sampled_batch(light, good, nan_later, 2, out.cast());
            "u" tem00_light_sample_ray_batch(light, bad, 2, out.cast());
        }
        InvalidPointer {
            "light" tem00_light_irradiance(null(), point, out);
            "point" tem00_light_irradiance(light, null(), out);
            "irradiance" tem00_light_irradiance(light, point, null_mut());
            "flux" tem00_light_flux(light, point, null_mut());
            "event" tem00_light_next_event(light, point, null_mut());
            "event" tem00_light_next_event_f32(light, single, null_mut());
            "u" tem00_light_sample_ray(light, null(), out.cast());
            "wi" tem00_light_next_event_pdf(light, point, null(), out);
            "events" tem00_light_next_event_batch(light, point, point, point, 3, null());
            "x" tem00_light_irradiance_batch(light, null(), point, point, 3, out);
            "bounds" tem00_light_bounds(light, 1.0, null_mut());
            "info" tem00_light_describe(light, null_mut());
            "max" tem00_light_power_bound(light, point, null(), out);
            "data" tem00_light_plain_data(light, null_mut());
            "light" tem00_light_create_spot(&SPOT, null_mut());
            "description" tem00_light_create_spot(null(), &raw mut handle);
            "points" tem00_light_next_event_sampled_batch(light, null(), good, 2, out.cast());
            "u" tem00_light_next_event_sampled_batch(light, good, null(), 2, out.cast());
            "events" tem00_light_next_event_sampled_batch(light, good, good, 2, null_mut());
            "u" tem00_light_sample_ray_batch(light, null(), 2, out.cast());
            "rays" tem00_light_sample_ray_batch(light, good, 2, null_mut());
            // What is written would be read.
            "events" tem00_light_next_event_sampled_batch(light, out, good, 2, out.cast());
            "events" tem00_light_next_event_sampled_batch(light, good, out, 2, out.cast());
            "rays" tem00_light_sample_ray_batch(light, out, 2, out.cast());
        }
    }
    assert_eq!(room, [7.0; 24], "the results");
    assert!(handle.is_null(), "a light was made");
    // SAFETY: no number is read or written.
    let none = unsafe {
        [
            tem00_light_next_event_sampled_batch(light, null(), null(), 0, null_mut()),
            tem00_light_sample_ray_batch(light, null(), 0, null_mut()),
        ]
    };
    assert_eq!(none, [Status::Ok; 2], "of no numbers");
}
