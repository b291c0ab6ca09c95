use super::*;
use crate::status::Status;

/// The record of what is found; zeros where it is dark.
fn found<A, B: From<A> + Default>(answer: Option<A>) -> B {
    answer.map(B::from).unwrap_or_default()
}

/// Checks that some of the points are lit and some are dark.
fn both_lit_and_dark(values: impl Iterator<Item = f64>) {
    let (lit, dark): (Vec<_>, Vec<_>) = values.partition(|value| *value > 0.0);
    let counts = (lit.len(), dark.len());
    assert!(counts.0 > 10 && counts.1 > 1, "{counts:?}");
}

#[test]
fn answers_are_those_of_the_library_to_the_last_bit() {
    for Pair {
        light, peer, kind, ..
    } in &pairs()
    {
        let light = light.handle.cast_const();
        let mut variates = Numbers::new(2);
        for p in points(&**peer) {
            let (u, v) = (variates.units(), variates.units());
            let point = p.as_ptr();
            let drawn = peer.next_event_sampled(p, u);
            let wi = drawn.map_or([0.0, 0.6, 0.8], |event| event.wi);
            let ray = peer.sample_ray(v);
            let (origin, direction) = (ray.origin, ray.direction);
            let (o, d) = (origin.as_ptr(), direction.as_ptr());
            let corner = p.map(|x| x + 0.01);
            agree! {
                (kind, p);
                tem00_light_irradiance(light, point) = peer.irradiance(p);
                tem00_light_flux(light, point) = peer.flux(p);
                tem00_light_next_event(light, point) = found::<_, NextEvent>(peer.next_event(p));
                tem00_light_next_event_sampled(light, point, u.as_ptr()) =
                    found::<_, SampledEvent>(drawn);
                tem00_light_next_event_pdf(light, point, wi.as_ptr()) = peer.next_event_pdf(p, wi);
                tem00_light_hit(light, point, wi.as_ptr()) =
                    found::<_, ApertureHit>(peer.hit(p, wi));
                tem00_light_power_bound(light, point, corner.as_ptr()) =
                    peer.power_bound(p, corner);
                tem00_light_sample_ray(light, v.as_ptr()) = RaySample::from(ray);
                tem00_light_ray_pdf(light, o, d) = RayPdf::from(peer.ray_pdf(origin, direction));
                tem00_light_radiance(light, o, d) = peer.radiance(origin, direction);
            }
            assert!(
                peer.ray_pdf(origin, direction).position > 0.0,
                "of a drawn ray"
            );
        }
        both_lit_and_dark(points(&**peer).into_iter().map(|p| peer.irradiance(p)));
        let info = LightInfo {
            origin: peer.origin(),
            power: peer.power(),
            axis: peer.axis(),
            wavelength: peer.wavelength(),
        };
        agree! { kind; tem00_light_describe(light) = info; }
        for distance in [0.0, 0.5, 1e30] {
            agree! {
                (kind, distance);
                tem00_light_bounds(light, distance) = Bounds::from(peer.bounds(distance));
            }
        }
    }
}

/// The coordinates of points, each in a column.
fn columns<T>(points: &[[f64; 3]], narrowed: impl Fn(f64) -> T) -> [Vec<T>; 3] {
    [0, 1, 2].map(|axis| points.iter().map(|p| narrowed(p[axis])).collect())
}

/// Columns of the next events and the irradiances of lights.
type Columns<T> = [Vec<T>; 6];

/// Asks both batches of one precision: about these coordinates, into six columns.
macro_rules! batches {
    ($light:expr, $places:ident, $irradiance:ident, $next_event:ident, $columns:ident) => {{
        let count = $places[0].len();
        let mut out: Columns<_> = Default::default();
        let [x, y, z] = $places.each_ref().map(|column| column.as_ptr());
        let room = out.each_mut().map(|column| {
            column.resize(count, 7.0);
            column.as_mut_ptr()
        });
        let [wi_x, wi_y, wi_z, distance, e_perp, irradiance] = room;
        let events = $columns {
            wi_x,
            wi_y,
            wi_z,
            distance,
            e_perp,
        };
        // SAFETY: the handle and the columns are valid.
        let statuses = unsafe {
            [
                $irradiance($light, x, y, z, count, irradiance),
                $next_event($light, x, y, z, count, &raw const events),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 2]);
        out
    }};
}

#[test]
fn batches_are_single_answers_to_the_last_bit() {
    for Pair {
        light, peer, kind, ..
    } in &pairs()
    {
        let points = points(&**peer).repeat(7);
        let places = columns(&points, |x| x);
        let out = batches!(
            light.handle,
            places,
            tem00_light_irradiance_batch,
            tem00_light_next_event_batch,
            NextEventColumns
        );
        for (i, &p) in points.iter().enumerate() {
            let event: NextEvent = found(peer.next_event(p));
            let [x, y, z] = event.wi;
            let expected = [x, y, z, event.distance, event.e_perp, peer.irradiance(p)];
            assert_eq!(
                out.each_ref().map(|column| column[i]),
                expected,
                "{kind:?} at {p:?}"
            );
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounded on purpose")]
const fn single(x: f64) -> f32 {
    x as f32
}

#[test]
fn single_precision_is_that_of_the_library_rounded() {
    for Pair {
        light, peer, kind, ..
    } in &pairs()
    {
        let places = columns(&points(&**peer), single);
        let out = batches!(
            light.handle,
            places,
            tem00_light_irradiance_batch_f32,
            tem00_light_next_event_batch_f32,
            NextEventColumnsF32
        );
        for i in 0..places[0].len() {
            let p = places.each_ref().map(|column| column[i]);
            let wide = p.map(f64::from);
            let event: NextEvent = found(peer.next_event(wide));
            let event = NextEventF32 {
                point: event.point.map(single),
                distance: single(event.distance),
                wi: event.wi.map(single),
                e_perp: single(event.e_perp),
            };
            let [x, y, z] = event.wi;
            let irradiance = single(peer.irradiance(wide));
            let expected = [x, y, z, event.distance, event.e_perp, irradiance];
            assert_eq!(
                out.each_ref().map(|column| column[i]),
                expected,
                "{kind:?} at {p:?}"
            );
            agree! { (kind, p); tem00_light_next_event_f32(light.handle, p.as_ptr()) = event; }
        }
    }
}

#[test]
fn batches_of_samples_are_single_answers_to_the_last_bit() {
    for Pair { light, peer, .. } in &pairs() {
        let points = points(&**peer);
        let count = points.len();
        let mut variates = Numbers::new(4);
        let pairs: Vec<[f64; 2]> = points.iter().map(|_| variates.units()).collect();
        let fours: Vec<[f64; 4]> = points.iter().map(|_| variates.units()).collect();
        let mut events = vec![SampledEvent::default(); count];
        let mut rays = vec![RaySample::default(); count];
        let (p, two, four) = (points.as_ptr(), pairs.as_ptr(), fours.as_ptr());
        // SAFETY: the handle and the pointers are valid.
        let statuses = unsafe {
            let (events, rays) = (events.as_mut_ptr(), rays.as_mut_ptr());
            [
                tem00_light_next_event_sampled_batch(
                    light.handle,
                    p.cast(),
                    two.cast(),
                    count,
                    events,
                ),
                tem00_light_sample_ray_batch(light.handle, four.cast(), count, rays),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 2]);
        for i in 0..count {
            let event = found(peer.next_event_sampled(points[i], pairs[i]));
            assert_eq!(events[i], event, "at {:?}", points[i]);
            assert_eq!(
                rays[i],
                peer.sample_ray(fours[i]).into(),
                "of {:?}",
                fours[i]
            );
        }
        both_lit_and_dark(events.into_iter().map(|event| event.value));
    }
}

#[test]
fn plain_data_are_the_rows_of_the_light_in_single_precision() {
    for Pair {
        light, kind, rows, ..
    } in pairs()
    {
        let mut fields = [0.0; 28];
        fields[..rows.len()].copy_from_slice(&rows);
        let count = u32::try_from(rows.len()).unwrap();
        let data = LightData {
            kind,
            count,
            fields,
        };
        agree! { kind; tem00_light_plain_data(light.handle) = data; }
    }
}
