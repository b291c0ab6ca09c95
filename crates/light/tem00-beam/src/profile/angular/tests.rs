use proptest::prelude::*;
use tem00_testkit::assert_absolute;

use super::*;

/// A table with unequal steps, a gap without power, and ends that do not fall to 0.
const ANGLES: [f64; 7] = [-0.5, -0.3, -0.25, 0.0, 0.1, 0.4, 0.9];
const POWERS: [f64; 7] = [0.5, 2.0, 0.0, 0.0, 3.0, 1.0, 0.25];

fn profile() -> AngularProfile {
    AngularProfile::new(&ANGLES, &POWERS).unwrap()
}

/// ∫ f dθ from the first angle to `end`: the midpoint rule is exact on every straight piece.
fn integral_to(profile: &AngularProfile, end: f64) -> f64 {
    let pieces = ANGLES
        .windows(2)
        .map(|pair| (pair[0].min(end), pair[1].min(end)));
    pieces
        .map(|(a, b)| (b - a) * profile.table().per_angle((0.5 * (a + b)).tan()))
        .sum()
}

#[test]
fn the_density_is_the_table_normalised() {
    // ½ · (2.5 · 0.2 + 2 · 0.05 + 3 · 0.1 + 4 · 0.3 + 1.25 · 0.5)
    const TOTAL: f64 = 1.3625;
    let profile = profile();
    let table = profile.table();
    let cases = [
        (-0.5, 0.5),
        (-0.4, 1.25),
        (-0.1, 0.0),
        (0.05, 1.5),
        (0.9, 0.25),
    ];
    for (angle, power) in cases {
        // The slope and its arc tangent round the angle by 1e−16; the steepest piece is 40 rad⁻¹.
        let inside: f64 = angle * (1.0 - 1e-15);
        let f = table.per_angle(inside.tan());
        assert!((f - power / TOTAL).abs() < 1e-13, "{angle}: {f}");
        let g = table.per_slope(inside.tan());
        assert_absolute(g, f * inside.cos().powi(2), 1e-15);
    }
    for outside in [-0.501_f64, 0.901, 1.5] {
        assert!(table.per_angle(outside.tan()) <= 0.0, "outside: {outside}");
    }
}

#[test]
fn the_cumulative_power_is_the_integral_of_the_density() {
    let profile = profile();
    for knot in profile.knots() {
        let expected = integral_to(&profile, knot.angle);
        assert!((knot.cumulative - expected).abs() < 1e-15, "{knot:?}");
    }
    for angle in [-0.45, -0.28, -0.1, 0.07, 0.2, 0.8, 0.9] {
        let below = profile.table().cumulative_at(angle);
        let expected = integral_to(&profile, angle);
        assert!((below - expected).abs() < 1e-15, "{angle}: {below}");
    }
    let ends = [-0.6, 1.2].map(|angle| profile.table().cumulative_at(angle));
    assert!(
        ends[0].abs() < 1e-300 && (ends[1] - 1.0).abs() < 1e-15,
        "{ends:?}"
    );
}

#[test]
fn a_triangle_has_its_eighths_at_half_the_height() {
    let triangle = AngularProfile::from_pairs(&[(-0.6, 0.0), (0.0, 7.0), (0.6, 0.0)]).unwrap();
    for (p, angle) in [(0.125, -0.3), (0.5, 0.0), (0.875, 0.3)] {
        let u: f64 = triangle.table().quantile(p);
        // A drawn angle keeps 1e−12 of the power away from a knot.
        assert!((u.atan() - angle).abs() < 1e-12, "{p}: {u}");
    }
}

#[test]
fn no_angle_is_drawn_where_a_gap_begins_or_ends() {
    for i in 1..48 {
        // In binary fractions the gap begins at one half of the power to the last digit.
        let gap = f64::from(i) / 64.0;
        let table = [(-2.0 * gap, 1.0), (-gap, 0.0), (gap, 0.0), (2.0 * gap, 1.0)];
        let profile = AngularProfile::from_pairs(&table).unwrap();
        let u: f64 = profile.table().quantile(0.5);
        assert!(profile.table().per_angle(u) > 0.0, "{gap}: {u}");
        // The angle past which lie 1e−12 of the power: 1e−6 of the piece.
        assert!((u.atan() / gap - 1.0).abs() < 2e-6, "{gap}: {u}");
    }
}

#[test]
fn the_unit_of_the_powers_is_of_no_account() {
    for unit in [1e-300, 1e-3, 5e307] {
        let scaled = AngularProfile::new(&ANGLES, &POWERS.map(|power| power * unit)).unwrap();
        for (a, b) in scaled.knots().iter().zip(profile().knots()) {
            assert!((a.density - b.density).abs() < 1e-14, "{unit:e}: {a:?}");
            assert_absolute(a.cumulative, b.cumulative, 1e-15);
        }
    }
}

#[test]
fn fewer_than_two_knots_are_dark() {
    let profile = profile();
    for count in [0, 1] {
        let table = AngularTable(&profile.knots()[..count]);
        assert!(table.per_slope(0.1) <= 0.0, "{count} knots");
        assert!(table.quantile(0.3).is_finite(), "{count} knots");
        assert!(table.largest_slope(4.0).is_finite(), "{count} knots");
    }
}

#[test]
fn the_largest_slope_is_that_of_the_widest_angle() {
    let slope: f64 = profile().table().largest_slope(4.0);
    assert!((slope - 0.9_f64.tan()).abs() < 1e-15, "{slope}");
}

/// Ascending angles within ±1.5 rad and powers, some of them 0.
fn tables() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    let power = prop_oneof![Just(0.0), 1e-6..1.0_f64];
    let steps = proptest::collection::vec((1e-6..1.0_f64, power), 2..12);
    steps.prop_map(|steps| {
        let total: f64 = steps.iter().map(|(step, _)| step).sum();
        let mut angle = -1.5;
        let mut ascend = |step: f64| {
            angle += 3.0 * step / total;
            angle.min(1.5)
        };
        steps
            .into_iter()
            .map(|(step, power)| (ascend(step), power))
            .unzip()
    })
}

proptest! {
    /// Where there is power, p(angle(p)) = p except for the 1e−12 that a drawn angle keeps off a
    /// knot: the angle is rounded by 2e−16 times a density that a narrow piece may raise to 1e6.
    #[test]
    fn angles_drawn_from_a_table_invert_its_cumulative_power(
        (angles, powers) in tables(),
        p in 0.0..1.0_f64,
    ) {
        prop_assume!(powers.iter().any(|&power| power > 0.0));
        let profile = AngularProfile::new(&angles, &powers).unwrap();
        let table = profile.table();
        let u: f64 = table.quantile(p);
        let back = table.cumulative_at(u.atan());
        let peak = profile.knots().iter().map(|knot| knot.density).fold(0.0, f64::max);
        let tolerance = 1e-12 + 1e-15 * peak;
        prop_assert!((back - p).abs() < tolerance, "{} {}", back, p);
        prop_assert!(table.per_angle(u) > 0.0 || peak > 1e3, "{}", u);
        prop_assert!((table.between(-1e30, 1e30) - 1.0).abs() < 1e-14, "the whole");
    }
}
