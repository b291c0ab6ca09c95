use super::*;

/// More points than a vector holds, and a remainder; lit ones and some of either unlit kind.
fn batch_points() -> [Vec<f64>; 3] {
    let points = (0..203).map(|i| {
        let [x, y, z] = fractions(i);
        world(DVec3::new(6e-3 * x, 1e-3 * y, 0.2 + 0.5 * z))
    });
    let points: Vec<[f64; 3]> = points.collect();
    [0, 1, 2].map(|k| points.iter().map(|p| p[k]).collect())
}

/// Compares both batch forms with single calls, bit for bit, and returns the number of lit points.
fn lit_in_batch(light: &dyn Emitter) -> usize {
    let [x, y, z] = batch_points();
    let mut out = vec![vec![1.0; x.len()]; 6];
    let [e, wi_x, wi_y, wi_z, distance, e_perp] = out.get_disjoint_mut([0, 1, 2, 3, 4, 5]).unwrap();
    light.irradiance_batch(&x, &y, &z, e);
    let slices = NextEventSlices {
        wi: [wi_x, wi_y, wi_z],
        distance,
        e_perp,
    };
    light.next_event_batch(&x, &y, &z, slices);
    let mut lit = 0;
    for i in 0..x.len() {
        let p = [x[i], y[i], z[i]];
        let event = light.next_event(p);
        lit += usize::from(event.is_some());
        let numbers = |event: NextEvent| {
            let [a, b, c] = event.wi;
            [a, b, c, event.distance, event.e_perp]
        };
        let [a, b, c, distance, e_perp] = event.map_or([0.0; 5], numbers);
        let expected = [light.irradiance(p), a, b, c, distance, e_perp];
        let got: [f64; 6] = core::array::from_fn(|k| out[k][i]);
        assert_eq!(got.map(f64::to_bits), expected.map(f64::to_bits), "{i}");
    }
    lit
}

#[test]
fn batches_equal_single_calls_to_the_last_bit() {
    let mut lit = vec![lit_in_batch(&spot())];
    for profile in smooth_profiles() {
        let line = laser(profile, FocusCurve::EqualDistance, 0.5);
        lit.push(lit_in_batch(&*place(&line)));
    }
    assert!(lit.iter().all(|lit| (20..180).contains(lit)), "{lit:?}");
}

#[test]
#[should_panic(expected = "must be of equal length, got 3, 3, 3 and [4]")]
fn batches_of_unequal_length_panic() {
    spot().irradiance_batch(&[0.0; 3], &[0.0; 3], &[0.0; 3], &mut [0.0; 4]);
}

#[test]
#[should_panic(expected = "must be of equal length, got 1, 1, 1 and [1, 1, 1, 2, 1]")]
fn batches_of_next_events_of_unequal_length_panic() {
    let out = NextEventSlices {
        wi: [&mut [0.0], &mut [0.0], &mut [0.0]],
        distance: &mut [0.0; 2],
        e_perp: &mut [0.0],
    };
    spot().next_event_batch(&[0.0], &[0.0], &[0.0], out);
}
