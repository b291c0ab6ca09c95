//! Where the field goes in the pupil, and what heights leave of it.

use core::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use tem00_testkit::assert_absolute;

use super::{Pose, Source, State, set_ups, unit_motions};

/// A reference state and states after changes of all kinds, some of them large.
fn changes() -> Vec<(String, State, State)> {
    let plain = State {
        surface: Pose::new([0.0; 3], DVec3::ZERO),
        pupil: Pose::new([0.0; 3], DVec3::new(0.0, 0.0, 0.3)),
        source: Source::Sun(DVec3::new(-0.4, 0.1, 1.0)),
        wavelength: 650e-9,
    };
    let oblique = State {
        surface: Pose::new([-15.0, 20.0, 5.0], DVec3::new(0.01, 0.02, -0.01)),
        pupil: Pose::new([10.0, 35.0, 60.0], DVec3::new(0.2, -0.05, 0.28)),
        source: Source::Point(DVec3::new(-0.1, 0.05, 0.25)),
        wavelength: 650e-9,
    };
    let mut changes = Vec::new();
    for (place, state) in [("plain", plain), ("oblique", oblique)] {
        let Pose { turn, place: at } = state.surface;
        let slid = Pose {
            place: at + DVec3::new(5e-3, -3e-3, 2e-3),
            turn,
        };
        let turned = |turn| Pose { turn, place: at };
        let tilted = DQuat::from_rotation_x(0.02) * DQuat::from_rotation_y(-0.03) * turn;
        let walked = Pose {
            place: state.pupil.place + DVec3::new(-8e-3, 6e-3, 20e-3),
            turn: DQuat::from_rotation_y(0.05) * state.pupil.turn,
        };
        let nearer = Source::Point(DVec3::new(-0.12, 0.03, 0.2));
        let tumbled = Pose {
            turn: DQuat::from_rotation_z(0.3) * tilted,
            ..slid
        };
        let surface = |surface| State { surface, ..state };
        let source = |source| State { source, ..state };
        let camera = State {
            pupil: walked,
            ..state
        };
        let redder = State {
            wavelength: 700e-9,
            ..state
        };
        let all = State {
            surface: tumbled,
            pupil: walked,
            source: nearer,
            wavelength: 633e-9,
        };
        let after = [
            ("slid", surface(slid)),
            ("tilted", surface(turned(tilted))),
            ("spun", surface(turned(turn * DQuat::from_rotation_z(0.4)))),
            ("camera", camera),
            ("redder", redder),
            ("relit", source(Source::Sun(DVec3::new(-0.45, 0.14, 1.0)))),
            ("point source", source(nearer)),
            ("all", all),
        ];
        changes.extend(after.map(|(name, after)| (format!("{place}, {name}"), state, after)));
    }
    changes
}

#[test]
fn the_field_goes_where_the_paths_of_scatterers_keep_their_differences() {
    for (name, before, after) in changes() {
        let [one, two] = [before.configuration(), before.configuration_after(&after)];
        for q in [
            DVec2::ZERO,
            DVec2::new(4e-3, -2e-3),
            DVec2::new(-1e-3, 9e-3),
        ] {
            let exact = after.matching_point(&before, q);
            let law = one.pupil_point_after(&two, q).unwrap();
            // Rounding of directions, amplified by the slopes of surface and pupil.
            let distance = (law - exact).length();
            assert!(distance < 1e-12, "{name}, {q}: {law} instead of {exact}");
            assert!((law - q).length() > 1e-4, "{name}: nothing moved");
        }
    }
}

/// Waves of every kind near the origin: the shortest radius of all of them is 0.18 m.
fn sources() -> [(&'static str, Source); 6] {
    let fan = |centre: [f64; 3], axis, radius| {
        let centre = DVec3::from(centre);
        Source::Fan {
            centre,
            axis,
            radius,
        }
    };
    [
        ("plane", Source::Sun(DVec3::new(0.5, 0.1, 1.0))),
        ("point", Source::Point(DVec3::new(-0.15, 0.1, 0.25))),
        ("grazing point", Source::Point(DVec3::new(0.3, 0.0, 0.05))),
        ("focus", Source::Focus(DVec3::new(0.1, 0.05, -0.2))),
        (
            "fan",
            fan([0.05, -0.1, 0.2], DVec3::new(1.0, 0.5, 0.0), -0.3),
        ),
        ("short fan", fan([0.0, 0.1, 0.3], DVec3::X, 0.12)),
    ]
}

/// A curved wave is described to second order in the distance, so that displacements are compared
/// by central differences. The remainder of third order is about (δ/ℓ)² of the result, with ℓ the
/// shortest length of the set-up: 1e−10, about the rounding of the gradient, ε/1e−5 = 2e−11.
/// Oblique views amplify both by a few powers of the inverse cosines (at most 5 here).
#[test]
fn small_motions_in_curved_light_displace_the_field_as_exact_paths_do() {
    let delta = 1e-5 * 0.18;
    for (name, source) in sources() {
        for state in set_ups(source) {
            for motion in unit_motions() {
                let displaced = [delta, -delta].map(|delta| {
                    let (after, law) = state.shifted(motion.map(|v| v * delta));
                    let before = state.configuration();
                    let law = before.pupil_point_after(&law, DVec2::ZERO).unwrap();
                    [after.matching_point(&state, DVec2::ZERO), law]
                });
                let [exact, theory] =
                    [0, 1].map(|i: usize| (displaced[0][i] - displaced[1][i]) / (2.0 * delta));
                let miss = (theory - exact).length() / (1.0 + exact.length());
                assert!(miss < 1e-7, "{name}, {motion:?}: {theory}, not {exact}");
            }
        }
    }
}

#[test]
fn waves_are_followed_sideways_to_second_order() {
    let steps = [
        DVec3::X,
        DVec3::new(-0.4, 0.7, 0.3),
        DVec3::new(0.2, -0.1, -0.9),
    ];
    for (name, source) in sources() {
        let wave = source.wavefront();
        for step in steps {
            let error = |size: f64| {
                let seen = wave.direction_from(step * size).unwrap();
                (seen - source.direction_from(step * size)).length()
            };
            let (coarse, fine) = (error(2e-3), error(1e-3));
            // Rays of a torus go astray, those of a sphere and a plane do not: (2 mm/0.18 m)² with
            // a factor for radii of either sign, and at most a quarter of it up to the third order,
            // plus what the directions round.
            let allowed = if name.contains("fan") { 5e-4 } else { 1e-15 };
            assert!(coarse < allowed, "{name}, {step}: {coarse:e}");
            assert!(fine < 0.26 * coarse + 1e-15, "{name}, {step}: {fine:e}");
        }
    }
}

/// The magnitude of the sum over pairs of scatterers of the light at `q` before, conjugate, times
/// that at `p` after, as a fraction of the largest: the correlation of the fields.
fn coherence(before: &State, q: DVec2, after: &State, p: DVec2) -> f64 {
    const SIDE: i32 = 12;
    const HALF_WIDTH: f64 = 0.2e-3;
    let (mut re, mut im, mut count) = (0.0, 0.0, 0.0);
    for i in -SIDE..=SIDE {
        for j in -SIDE..=SIDE {
            let x = DVec3::new(f64::from(i), f64::from(j), 0.0) * (HALF_WIDTH / f64::from(SIDE));
            let turns = after.waves(x, p.extend(0.0)) - before.waves(x, q.extend(0.0));
            // Whole turns go first: a path is half a million of them.
            let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
            (re, im, count) = (re + cos, im + sin, count + 1.0);
        }
    }
    f64::hypot(re, im) / count
}

#[test]
fn the_field_of_a_lit_patch_correlates_where_the_law_says() {
    for (name, before, after) in changes() {
        let [one, two] = [before.configuration(), before.configuration_after(&after)];
        let p = one.pupil_point_after(&two, DVec2::ZERO).unwrap();
        let at = |offset| coherence(&before, DVec2::ZERO, &after, p + offset);
        // The field of a patch 0.4 mm wide at 0.3 m has speckles of 0.5 mm.
        let step = 0.05e-3;
        let vertex = |e: DVec2| {
            let (left, middle, right) = (at(e * -step), at(DVec2::ZERO), at(e * step));
            0.5 * step * (right - left) / (2.0 * middle - left - right)
        };
        let miss = DVec2::new(vertex(DVec2::X), vertex(DVec2::Y));
        // What changes the curvature of the paths across the patch changes their odd orders, which
        // move the peak by (0.2 mm)²/0.2 m at most.
        assert!(miss.length() < 2e-7, "{name}: {miss} off");
        // Over 0.2 mm the curvature comes to 0.6 rad.
        assert!(at(DVec2::ZERO) > 0.9, "{name}: {}", at(DVec2::ZERO));
    }
}

#[test]
fn heights_lose_the_phase_that_the_law_leaves() {
    for (name, before, after) in changes() {
        let [one, two] = [before.configuration(), before.configuration_after(&after)];
        let p = one.pupil_point_after(&two, DVec2::ZERO).unwrap();
        let change = one.height_phase_change(&two).unwrap();
        let turns = |h: f64| {
            let x = DVec3::new(0.0, 0.0, h);
            after.waves(x, p.extend(0.0)) - before.waves(x, DVec3::ZERO)
        };
        let slope = TAU * (turns(1e-6) - turns(-1e-6)) / 2e-6;
        // Paths of a million waves round at 2e−10 of a wave, over 2 µm; height is taken off a path.
        assert!((slope + change).abs() < 0.01, "{name}: {slope}, {change}");
        // Heights with a normal distribution, wide enough to leave exp(−1) of the intensity if that
        // takes no more than 50 µm. The trapezoidal rule is exact to rounding for it.
        let sigma = change.abs().recip().min(50e-6);
        let (mut re, mut im) = (0.0, 0.0);
        for k in -60..=60 {
            let z = 0.1 * f64::from(k);
            let weight = 0.1 * (-0.5 * z * z).exp() / TAU.sqrt();
            let (sin, cos) = (TAU * (turns(z * sigma) - turns(0.0))).sin_cos();
            (re, im) = (re + weight * cos, im + weight * sin);
        }
        let left = re * re + im * im;
        let law = (-(sigma * change).powi(2)).exp();
        // The sum ends at 6 σ, which leaves out 2e−9. The second order of the path is k σ²/0.2 m or
        // 0.1 rad at 50 µm, and its change a few per cent of that, squared.
        assert_absolute(left, law, 1e-5);
    }
}
