use super::*;

/// Asks the interface, which must succeed.
fn answer<R: Default>(question: impl FnOnce(*mut R) -> Status) -> R {
    let mut result = R::default();
    assert_eq!(
        question(&raw mut result),
        Status::Ok,
        "{}",
        last_parameter()
    );
    result
}

/// Checks that some of the points are lit and some are dark.
fn both_lit_and_dark(name: &str, irradiance: impl Iterator<Item = f64>) {
    let (lit, dark): (Vec<_>, Vec<_>) = irradiance.partition(|e| *e > 0.0);
    assert!(
        lit.len() > 10 && dark.len() > 1,
        "{name}: {} and {}",
        lit.len(),
        dark.len()
    );
}

#[test]
fn answers_about_points_are_those_of_the_library_to_the_last_bit() {
    for Pair { name, handle, peer } in &pairs() {
        let light = handle.cast_const();
        let mut irradiance = Vec::new();
        for p in peer.points() {
            let point = p.as_ptr();
            // SAFETY: the handle and the pointers are valid.
            unsafe {
                let e = answer(|out| tem00_light_irradiance(light, point, out));
                assert_eq!(e, peer.ask(|light| light.irradiance(p)), "{name} at {p:?}");
                irradiance.push(e);

                let f: [f64; 3] =
                    answer(|out: *mut [f64; 3]| tem00_light_flux(light, point, out.cast()));
                assert_eq!(f, peer.ask(|light| light.flux(p)), "{name} at {p:?}");

                let event: NextEvent = answer(|out| tem00_light_next_event(light, point, out));
                let expected = peer.ask(|light| light.next_event(p)).map(NextEvent::from);
                assert_eq!(event, expected.unwrap_or_default(), "{name} at {p:?}");
            }
        }
        both_lit_and_dark(name, irradiance.into_iter());
    }
}

#[test]
fn sampled_events_and_their_densities_are_those_of_the_library() {
    for Pair { name, handle, peer } in &pairs() {
        let light = handle.cast_const();
        let mut variates = Variates(2);
        for p in peer.points() {
            let (point, u) = (p.as_ptr(), [variates.next(), variates.next()]);
            // SAFETY: the handle and the pointers are valid.
            unsafe {
                let event: SampledEvent =
                    answer(|out| tem00_light_next_event_sampled(light, point, u.as_ptr(), out));
                let expected = peer.ask(|light| light.next_event_sampled(p, u));
                let expected = expected.map(SampledEvent::from).unwrap_or_default();
                assert_eq!(event, expected, "{name} at {p:?}");

                if event.pdf > 0.0 {
                    let wi = event.wi;
                    let pdf: f64 =
                        answer(|out| tem00_light_next_event_pdf(light, point, wi.as_ptr(), out));
                    assert_eq!(pdf, peer.ask(|light| light.next_event_pdf(p, wi)), "{name}");
                    assert!(
                        pdf > 0.0,
                        "{name} at {p:?}: a drawn direction has a density"
                    );
                }
            }
        }
    }
}

#[test]
fn rays_their_densities_and_radiances_are_those_of_the_library() {
    for Pair { name, handle, peer } in &pairs() {
        let light = handle.cast_const();
        let mut variates = Variates(3);
        for _ in 0..40 {
            let u = [(); 4].map(|()| variates.next());
            // SAFETY: the handle and the pointers are valid.
            unsafe {
                let ray: RaySample = answer(|out| tem00_light_sample_ray(light, u.as_ptr(), out));
                assert_eq!(ray, peer.ask(|light| light.sample_ray(u)).into(), "{name}");

                let (o, d) = (ray.origin, ray.direction);
                let pdf: RayPdf =
                    answer(|out| tem00_light_ray_pdf(light, o.as_ptr(), d.as_ptr(), out));
                assert_eq!(pdf, peer.ask(|light| light.ray_pdf(o, d)).into(), "{name}");
                assert!(pdf.position > 0.0, "{name}: a drawn ray has a density");

                let radiance: f64 =
                    answer(|out| tem00_light_radiance(light, o.as_ptr(), d.as_ptr(), out));
                assert_eq!(radiance, peer.ask(|light| light.radiance(o, d)), "{name}");
            }
        }
    }
}

#[test]
fn bounds_are_those_of_the_library() {
    for Pair { name, handle, peer } in &pairs() {
        for distance in [0.0, 0.5, 1e30] {
            // SAFETY: the handle and the pointer are valid.
            let bounds: Bounds =
                answer(|out| unsafe { tem00_light_bounds(*handle, distance, out) });
            let expected = peer.ask(|light| light.bounds(distance));
            assert_eq!(bounds, expected.into(), "{name} to {distance:e} m");
        }
    }
}

#[test]
fn a_light_tells_what_it_was_made_with() {
    for Pair { name, handle, peer } in &pairs() {
        // SAFETY: the handle and the pointer are valid.
        let info: LightInfo = answer(|out| unsafe { tem00_light_describe(*handle, out) });
        let expected = peer.ask(|light| LightInfo {
            origin: light.origin(),
            power: light.power(),
            axis: light.axis(),
            wavelength: light.wavelength(),
        });
        assert_eq!(info, expected, "{name}");
        assert!((400e-9..700e-9).contains(&info.wavelength), "{info:?}");
    }
}

#[test]
fn hits_and_bounds_of_power_are_those_of_the_library() {
    for Pair { name, handle, peer } in &pairs() {
        let light = handle.cast_const();
        let mut hits = Vec::new();
        for p in peer.points() {
            let towards = peer.ask(|light| light.next_event_sampled(p, [0.3, 0.8]));
            let wi = towards.map_or([0.1, 0.2, 0.3], |event| event.wi.map(|x| 2.0 * x));
            // SAFETY: the handle and the pointers are valid.
            let hit: ApertureHit =
                answer(|out| unsafe { tem00_light_hit(light, p.as_ptr(), wi.as_ptr(), out) });
            hits.push(hit.radiance);
            let expected = towards.map_or_else(ApertureHit::default, |event| {
                peer.ask(|light| light.hit(p, event.wi))
                    .map(ApertureHit::from)
                    .unwrap_or_default()
            });
            let ratio = (hit.radiance + 1e-300) / (expected.radiance + 1e-300);
            // The unit vector has been made again.
            assert!(
                (ratio - 1.0).abs() < 1e-7,
                "{name} at {p:?}: {hit:?}, {expected:?}"
            );

            let end = p.map(|x| x + 0.01);
            // SAFETY: the handle and the pointers are valid.
            let bound: f64 = answer(|out| unsafe {
                tem00_light_power_bound(light, p.as_ptr(), end.as_ptr(), out)
            });
            assert_eq!(bound, peer.ask(|light| light.power_bound(p, end)), "{name}");
        }
        both_lit_and_dark(name, hits.into_iter());
    }
}

/// Five columns of answers.
fn room<T: Copy + Default>(count: usize) -> [Vec<T>; 5] {
    [(); 5].map(|()| vec![T::default(); count])
}

/// The coordinates of points, each in a column.
fn coordinates(points: &[[f64; 3]]) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect())
}

#[test]
fn batches_are_single_calls_to_the_last_bit() {
    for Pair { name, handle, peer } in &pairs() {
        let points = peer.points();
        let count = points.len();
        let [x, y, z] = coordinates(&points);
        let [mut wi_x, mut wi_y, mut wi_z, mut distance, mut e_perp] = room::<f64>(count);
        let mut irradiance = vec![0.0; count];
        let events = NextEventColumns {
            wi_x: wi_x.as_mut_ptr(),
            wi_y: wi_y.as_mut_ptr(),
            wi_z: wi_z.as_mut_ptr(),
            distance: distance.as_mut_ptr(),
            e_perp: e_perp.as_mut_ptr(),
        };
        let (x, y, z) = (x.as_ptr(), y.as_ptr(), z.as_ptr());
        // SAFETY: the handle and the columns are valid.
        let statuses = unsafe {
            let out = irradiance.as_mut_ptr();
            [
                tem00_light_irradiance_batch(*handle, x, y, z, count, out),
                tem00_light_next_event_batch(*handle, x, y, z, count, &raw const events),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 2], "{name}");
        for (i, p) in points.into_iter().enumerate() {
            assert_eq!(
                irradiance[i],
                peer.ask(|light| light.irradiance(p)),
                "{name} at {p:?}"
            );
            let event = peer.ask(|light| light.next_event(p)).map(NextEvent::from);
            let event = event.unwrap_or_default();
            let got = ([wi_x[i], wi_y[i], wi_z[i]], distance[i], e_perp[i]);
            assert_eq!(
                got,
                (event.wi, event.distance, event.e_perp),
                "{name} at {p:?}"
            );
        }
    }
}

#[test]
fn batches_of_samples_are_single_calls_to_the_last_bit() {
    for Pair { name, handle, peer } in &pairs() {
        let points = peer.points();
        let count = points.len();
        let mut variates = Variates(4);
        let pairs: Vec<_> = points
            .iter()
            .map(|_| [(); 2].map(|()| variates.next()))
            .collect();
        let fours: Vec<_> = points
            .iter()
            .map(|_| [(); 4].map(|()| variates.next()))
            .collect();
        let mut events = vec![SampledEvent::default(); count];
        let mut rays = vec![RaySample::default(); count];
        let (p, u) = (
            points.as_flattened().as_ptr(),
            pairs.as_flattened().as_ptr(),
        );
        let four = fours.as_flattened().as_ptr();
        // SAFETY: the handle and the pointers are valid.
        let statuses = unsafe {
            let (events, rays) = (events.as_mut_ptr(), rays.as_mut_ptr());
            [
                tem00_light_next_event_sampled_batch(*handle, p, u, count, events),
                tem00_light_sample_ray_batch(*handle, four, count, rays),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 2], "{name}");
        for i in 0..count {
            let event = peer.ask(|light| light.next_event_sampled(points[i], pairs[i]));
            let event = event.map(SampledEvent::from).unwrap_or_default();
            assert_eq!(events[i], event, "{name} at {:?}", points[i]);
            let ray = peer.ask(|light| light.sample_ray(fours[i]));
            assert_eq!(rays[i], ray.into(), "{name} of {:?}", fours[i]);
        }
        both_lit_and_dark(name, events.into_iter().map(|event| event.value));
    }
}

#[test]
fn single_precision_is_that_of_the_library() {
    for Pair { name, handle, peer } in &pairs() {
        let points: Vec<_> = peer.points();
        let count = points.len();
        let [x, y, z] = coordinates(&points).map(narrowed);
        let [mut wi_x, mut wi_y, mut wi_z, mut distance, mut e_perp] = room::<f32>(count);
        let mut irradiance = vec![0.0; count];
        let events = NextEventColumnsF32 {
            wi_x: wi_x.as_mut_ptr(),
            wi_y: wi_y.as_mut_ptr(),
            wi_z: wi_z.as_mut_ptr(),
            distance: distance.as_mut_ptr(),
            e_perp: e_perp.as_mut_ptr(),
        };
        // SAFETY: the handle and the columns are valid.
        let statuses = unsafe {
            let (x, y, z, out) = (x.as_ptr(), y.as_ptr(), z.as_ptr(), irradiance.as_mut_ptr());
            [
                tem00_light_irradiance_batch_f32(*handle, x, y, z, count, out),
                tem00_light_next_event_batch_f32(*handle, x, y, z, count, &raw const events),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 2], "{name}");
        for i in 0..count {
            let p = [x[i], y[i], z[i]];
            // SAFETY: the handle and the pointers are valid.
            let event: NextEventF32 =
                answer(|out| unsafe { tem00_light_next_event_f32(*handle, p.as_ptr(), out) });
            let expected = peer.ask(|light| light.next_event(p.map(f64::from)));
            assert_eq!(
                event,
                expected.map(NextEventF32::from).unwrap_or_default(),
                "{name}"
            );
            let expected = peer.ask(|light| light.irradiance(p.map(f64::from)));
            assert_eq!([irradiance[i]].to_vec(), narrowed(vec![expected]), "{name}");
            let got = ([wi_x[i], wi_y[i], wi_z[i]], distance[i], e_perp[i]);
            assert_eq!(
                got,
                (event.wi, event.distance, event.e_perp),
                "{name} at {p:?}"
            );
        }
        both_lit_and_dark(name, irradiance.into_iter().map(f64::from));
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounded on purpose")]
fn narrowed(values: Vec<f64>) -> Vec<f32> {
    values.into_iter().map(|x| x as f32).collect()
}

#[test]
fn plain_data_are_the_rows_of_the_light_in_single_precision() {
    let expected: [(LightKind, Vec<f32>); 4] = pairs().map(|pair| match &pair.peer {
        Peer::Spot(light) => (LightKind::Spot, light.to_rows_f32().concat()),
        Peer::Line(light) => (LightKind::Line, light.to_rows_f32().concat()),
        Peer::Tabulated(line) => {
            let light = TabulatedLineLight::place(line, &placement(), 2e-3).unwrap();
            (LightKind::TabulatedLine, light.line.to_rows_f32().concat())
        }
    });
    for (pair, (kind, fields)) in pairs().iter().zip(expected) {
        let mut data = LightData {
            kind: LightKind::Line,
            count: 99,
            fields: [9.0; 28],
        };
        // SAFETY: the handle and the pointer are valid.
        let status = unsafe { tem00_light_plain_data(pair.handle, &raw mut data) };
        assert_eq!(status, Status::Ok, "{}", pair.name);
        assert_eq!(data.kind, kind, "{}", pair.name);
        let count = usize::try_from(data.count).unwrap();
        assert_eq!(data.fields[..count], fields, "{}", pair.name);
        assert!(
            data.fields[count..].iter().all(|x| *x == 0.0),
            "{}",
            pair.name
        );
    }
}

#[test]
fn no_place_and_no_direction_however_far_gives_a_nan() {
    let extremes = [-1e30, -1e15, -1.0, -1e-300, 0.0, 1e-300, 1.0, 1e15, 1e30];
    for Pair { name, handle, .. } in &pairs() {
        let light = handle.cast_const();
        for (x, y, z) in extremes
            .iter()
            .flat_map(|x| extremes.map(|y| (*x, y)))
            .flat_map(|(x, y)| extremes.map(|z| (x, y, z)))
        {
            let (p, d) = (
                [x, y, z],
                DVec3::new(x, y, z).normalize_or(DVec3::Z).to_array(),
            );
            let single = p.map(|x| narrowed(vec![x])[0]);
            let (point, way, u) = (p.as_ptr(), d.as_ptr(), [0.0, 0.999]);
            // SAFETY: the handle and the pointers are valid.
            let numbers = unsafe {
                let event: NextEvent = answer(|out| tem00_light_next_event(light, point, out));
                let single: NextEventF32 =
                    answer(|out| tem00_light_next_event_f32(light, single.as_ptr(), out));
                let pdf: RayPdf = answer(|out| tem00_light_ray_pdf(light, point, way, out));
                let drawn: SampledEvent =
                    answer(|out| tem00_light_next_event_sampled(light, point, u.as_ptr(), out));
                [
                    event.e_perp,
                    event.distance,
                    event.wi.iter().chain(&event.point).sum(),
                    f64::from(single.e_perp + single.distance),
                    f64::from(single.wi.iter().chain(&single.point).sum::<f32>()),
                    pdf.position,
                    pdf.direction_given_position,
                    pdf.direction,
                    pdf.position_given_direction,
                    drawn.pdf,
                    drawn.value,
                    answer(|out| tem00_light_next_event_pdf(light, point, way, out)),
                    answer(|out| tem00_light_radiance(light, point, way, out)),
                    answer(|out| tem00_light_hit(light, point, way, out)).radiance,
                    answer(|out| tem00_light_power_bound(light, point, point, out)),
                ]
            };
            assert!(
                numbers.iter().all(|x| x.is_finite()),
                "{name} at {p:?}: {numbers:?}"
            );
        }
    }
}

#[test]
fn records_keep_each_number_under_its_name() {
    // Both print their fields by name.
    let fields = |record: &dyn core::fmt::Debug| {
        let text = format!("{record:?}");
        text.split_once('{').unwrap().1.to_owned()
    };
    let (a, b, c) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]);
    let event = tem00_beam::NextEvent {
        point: a,
        distance: 10.0,
        wi: b,
        e_perp: 11.0,
    };
    assert_eq!(
        fields(&NextEvent::from(event)),
        fields(&event),
        "next event"
    );
    assert_eq!(
        fields(&NextEventF32::from(event)),
        fields(&event),
        "in single precision"
    );
    let drawn = tem00_beam::SampledEvent {
        point: a,
        distance: 10.0,
        wi: b,
        value: 11.0,
        pdf: 12.0,
    };
    assert_eq!(
        fields(&SampledEvent::from(drawn)),
        fields(&drawn),
        "sampled event"
    );
    let pdf = tem00_beam::RayPdf {
        position: 10.0,
        direction_given_position: 11.0,
        direction: 12.0,
        position_given_direction: 13.0,
    };
    assert_eq!(
        fields(&RayPdf::from(pdf)),
        fields(&pdf),
        "densities of a ray"
    );
    let ray = tem00_beam::RaySample {
        origin: a,
        flux: 10.0,
        direction: b,
        cos: 11.0,
        pdf,
    };
    assert_eq!(fields(&RaySample::from(ray)), fields(&ray), "ray");
    let bounds = tem00_beam::Bounds {
        min: a,
        max: b,
        axis: c,
        half_angle: 10.0,
    };
    assert_eq!(fields(&Bounds::from(bounds)), fields(&bounds), "bounds");
}
