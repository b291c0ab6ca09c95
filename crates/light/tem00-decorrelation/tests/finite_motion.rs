//! The law of motion against exact optical paths, without any of its formulas.
//!
//! A scene here is a list of positions: scatterers fixed to a body, a source, a pupil. Paths are
//! distances, the phase is 2π/λ times the path, and the law is found by looking where phases agree.

use core::f64::consts::TAU;

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3};
use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, Illumination, ImagingGeometry, LensData,
    PupilDistances, RigidMotion, RigidMotions, SpeckleMotion, axial_correlation,
    pupil_overlap_correlation,
};
use tem00_testkit::assert_absolute;

/// A rotation about the origin of the body and where the origin then lies.
#[derive(Clone, Copy)]
struct Pose {
    turn: DQuat,
    place: DVec3,
}

impl Pose {
    fn new(degrees: [f64; 3], place: DVec3) -> Self {
        let [x, y, z] = degrees.map(f64::to_radians);
        let turn =
            DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
        Self { turn, place }
    }

    fn at(&self, body: DVec3) -> DVec3 {
        self.turn * body + self.place
    }

    /// The motion from this pose to another.
    fn motion_to(&self, other: &Self) -> RigidMotion {
        let rotation = other.turn * self.turn.inverse();
        let translation = other.place - rotation * self.place;
        RigidMotion::new(DMat3::from_quat(rotation), translation).unwrap()
    }
}

#[derive(Clone, Copy)]
enum Source {
    /// Far away, in this direction.
    Sun(DVec3),
    Point(DVec3),
}

/// One state of a scene. The surface is the plane z = 0 of its body, the pupil that of its own.
#[derive(Clone, Copy)]
struct State {
    surface: Pose,
    pupil: Pose,
    source: Source,
    wavelength: f64,
}

impl State {
    /// The optical path, in wavelengths, by way of a scatterer of the body to a point of the pupil.
    fn waves(&self, scatterer: DVec3, pupil_point: DVec3) -> f64 {
        let x = self.surface.at(scatterer);
        let to_source = match self.source {
            Source::Sun(direction) => -direction.normalize().dot(x),
            Source::Point(position) => position.distance(x),
        };
        (to_source + self.pupil.at(pupil_point).distance(x)) / self.wavelength
    }

    /// How the path differs between scatterers on either side of the middle, in waves per metre.
    fn slope(&self, pupil_point: DVec2) -> DVec2 {
        const APART: f64 = 1e-5;
        let between = |along: DVec3| {
            let p = pupil_point.extend(0.0);
            (self.waves(along * APART, p) - self.waves(-along * APART, p)) / (2.0 * APART)
        };
        DVec2::new(between(DVec3::X), between(DVec3::Y))
    }

    /// The pupil point of `self` that sees the slope that `q` sees in `before`, by Newton's method.
    fn matching_point(&self, before: &Self, q: DVec2) -> DVec2 {
        const STEP: f64 = 1e-4;
        let wanted = before.slope(q);
        let mut p = q;
        for _ in 0..20 {
            let difference = |e: DVec2| self.slope(p + e * STEP) - self.slope(p - e * STEP);
            let jacobian = DMat2::from_cols(difference(DVec2::X), difference(DVec2::Y));
            p += (jacobian * (0.5 / STEP)).inverse() * (wanted - self.slope(p));
        }
        p
    }

    fn illumination(&self) -> Illumination {
        match self.source {
            Source::Sun(direction) => Illumination::collimated(direction).unwrap(),
            Source::Point(position) => Illumination::point_source(position).unwrap(),
        }
    }

    fn configuration(&self) -> Configuration {
        Configuration::new(ConfigurationData {
            wavelength: self.wavelength,
            point: self.surface.place,
            normal: self.surface.turn * DVec3::Z,
            illumination: self.illumination(),
            camera: CameraFrame::from_axes(DMat3::from_quat(self.pupil.turn)).unwrap(),
            pupil: self.pupil.place,
        })
        .unwrap()
    }

    /// The configuration of another state, reached from that of this one.
    fn configuration_after(&self, after: &Self) -> Configuration {
        let moved = self.configuration().moved(&RigidMotions {
            surface: self.surface.motion_to(&after.surface),
            camera: self.pupil.motion_to(&after.pupil),
            ..RigidMotions::default()
        });
        let lit = moved.and_then(|state| state.with_illumination(after.illumination()));
        lit.and_then(|state| state.with_wavelength(after.wavelength))
            .unwrap()
    }
}

/// A reference state and states after changes of all kinds, some of them large.
fn changes() -> Vec<(String, State, State)> {
    let level = Pose::new([0.0; 3], DVec3::ZERO);
    let above = Pose::new([0.0; 3], DVec3::new(0.0, 0.0, 0.3));
    let side = Pose::new([10.0, 35.0, 60.0], DVec3::new(0.2, -0.05, 0.28));
    let sun = Source::Sun(DVec3::new(-0.4, 0.1, 1.0));
    let point = Source::Point(DVec3::new(-0.1, 0.05, 0.25));
    let plain = State {
        surface: level,
        pupil: above,
        source: sun,
        wavelength: 650e-9,
    };
    let oblique = State {
        surface: Pose::new([-15.0, 20.0, 5.0], DVec3::new(0.01, 0.02, -0.01)),
        pupil: side,
        source: point,
        wavelength: 650e-9,
    };
    let mut changes = Vec::new();
    for (place, state) in [("plain", plain), ("oblique", oblique)] {
        let mut add = |name, after| changes.push((format!("{place}, {name}"), state, after));
        let slid = Pose {
            place: state.surface.place + DVec3::new(5e-3, -3e-3, 2e-3),
            ..state.surface
        };
        add(
            "slid",
            State {
                surface: slid,
                ..state
            },
        );
        let tilted = Pose {
            turn: DQuat::from_rotation_x(0.02) * DQuat::from_rotation_y(-0.03) * state.surface.turn,
            ..state.surface
        };
        add(
            "tilted",
            State {
                surface: tilted,
                ..state
            },
        );
        let spun = Pose {
            turn: state.surface.turn * DQuat::from_rotation_z(0.4),
            ..state.surface
        };
        add(
            "spun",
            State {
                surface: spun,
                ..state
            },
        );
        let walked = Pose {
            place: state.pupil.place + DVec3::new(-8e-3, 6e-3, 20e-3),
            turn: DQuat::from_rotation_y(0.05) * state.pupil.turn,
        };
        add(
            "camera",
            State {
                pupil: walked,
                ..state
            },
        );
        add(
            "redder",
            State {
                wavelength: 700e-9,
                ..state
            },
        );
        let swung = Source::Sun(DVec3::new(-0.45, 0.14, 1.0));
        add(
            "relit",
            State {
                source: swung,
                ..state
            },
        );
        let nearer = Source::Point(DVec3::new(-0.12, 0.03, 0.2));
        add(
            "point source",
            State {
                source: nearer,
                ..state
            },
        );
        let tumbled = Pose {
            turn: DQuat::from_rotation_z(0.3) * tilted.turn,
            ..slid
        };
        let all = State {
            surface: tumbled,
            pupil: walked,
            source: nearer,
            wavelength: 633e-9,
        };
        add("all", all);
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
            // Scatterers 10 µm from the middle see the third order of the path, (10 µm/0.2 m)²/6 of
            // the slope, and paths of 0.5 m round at ε over 20 µm: 4e−10 and 6e−12 of a direction,
            // times up to 0.4 m and the slopes of surface and pupil.
            let distance = (law - exact).length();
            assert!(distance < 1e-9, "{name}, {q}: {law} instead of {exact}");
            assert!((law - q).length() > 1e-4, "{name}: nothing moved");
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

fn geometry() -> ImagingGeometry {
    ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    })
    .unwrap()
}

/// The light at upright image point `r` from one scatterer, through a slit pupil along b1.
///
/// An ideal lens makes all paths to the image of a point in the focal plane equal.
fn through_lens(state: &State, scatterer: DVec3, r: f64) -> (f64, f64) {
    const SAMPLES: i32 = 60;
    let geometry = geometry();
    let focus = DVec3::new(
        r * geometry.surface_to_pupil() / geometry.principal_distance(),
        0.0,
        -geometry.surface_to_pupil(),
    );
    let (mut re, mut im) = (0.0, 0.0);
    for i in -SAMPLES..=SAMPLES {
        let p = DVec3::X * (0.5 * geometry.pupil_diameter() * f64::from(i) / f64::from(SAMPLES));
        let turns = state.waves(scatterer, p) - p.distance(focus) / state.wavelength;
        let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
        (re, im) = (re + cos, im + sin);
    }
    (re, im)
}

/// The correlation of the image field at `r1` after with that at `r0` before, averaged over all
/// rough surfaces: scatterers with phases of their own, along a line of the surface.
fn image_coherence(before: &State, r0: f64, after: &State, r1: f64) -> f64 {
    const SCATTERERS: i32 = 40;
    const SPACING: f64 = 15e-6;
    let (mut re, mut im) = (0.0, 0.0);
    for j in -SCATTERERS..=SCATTERERS {
        let x = DVec3::X * (SPACING * f64::from(j));
        let (a, b) = through_lens(before, x, r0);
        let (c, d) = through_lens(after, x, r1);
        (re, im) = (re + a * c + b * d, im + a * d - b * c);
    }
    f64::hypot(re, im)
}

/// The place of the highest value of `f` within `reach` of `start`, for a peak about `width` wide.
fn peak(f: impl Fn(f64) -> f64, start: f64, reach: f64, width: f64) -> f64 {
    let steps = (reach / (0.2 * width)).ceil();
    let mut best = (f(start), start);
    let mut k = -steps;
    while k <= steps {
        let r = start + reach * k / steps;
        let value = f(r);
        best = if value > best.0 { (value, r) } else { best };
        k += 1.0;
    }
    let mut r = best.1;
    for step in [0.1 * width, 0.02 * width] {
        let (left, middle, right) = (f(r - step), f(r), f(r + step));
        r += 0.5 * step * (right - left) / (2.0 * middle - left - right);
    }
    r
}

#[test]
fn speckle_out_of_focus_moves_as_the_wave_field_does() {
    let tilt = |radians: f64| DQuat::from_rotation_y(radians);
    let pupil = |x: f64, z: f64, turn: f64| Pose {
        turn: tilt(turn),
        place: DVec3::new(x, 0.0, z),
    };
    let surface = |x: f64, z: f64, turn: f64| Pose {
        turn: tilt(turn),
        place: DVec3::new(x, 0.0, z),
    };
    let state = |surface, pupil| State {
        surface,
        pupil,
        source: Source::Point(DVec3::new(-0.1, 0.0, 0.3)),
        wavelength: 650e-9,
    };
    let (rest, flat) = (pupil(0.0, 0.3, 0.0), surface(0.0, 0.0, 0.0));
    let (near, far) = (pupil(0.0, 0.285, 0.0), pupil(0.02, 0.32, 0.06));
    let leaning = surface(0.0, 0.0, 0.5);
    let cases = [
        (
            "in focus",
            state(flat, rest),
            state(surface(0.3e-3, 0.0, 0.0), rest),
        ),
        (
            "too near",
            state(flat, near),
            state(surface(0.3e-3, 0.0, 0.0), near),
        ),
        (
            "too near, tilted",
            state(flat, near),
            state(surface(0.0, 0.0, 2e-3), near),
        ),
        (
            "too far, tilted",
            state(leaning, far),
            state(surface(0.0, 0.0, 0.498), far),
        ),
        (
            "into focus",
            state(flat, near),
            state(surface(0.1e-3, -8e-3, 1e-3), near),
        ),
        (
            "out of focus",
            state(flat, rest),
            state(surface(0.4e-3, 4e-3, -1e-3), rest),
        ),
        (
            "through focus",
            state(surface(0.0, 4e-3, 0.0), rest),
            state(surface(0.2e-3, -4e-3, 1e-3), rest),
        ),
        (
            "camera",
            state(leaning, near),
            state(leaning, pupil(0.5e-3, 0.286, 1e-3)),
        ),
    ];
    let geometry = geometry();
    let mut largest_defocus = 0.0_f64;
    for (name, before, after) in cases {
        let [one, two] = [before.configuration(), before.configuration_after(&after)];
        let speckle = SpeckleMotion::between(&geometry, &one, &two);
        // Where the image of the point lies: along b1 over minus b3, in the frame of the pupil.
        let seen = before.pupil.turn.inverse() * (before.surface.place - before.pupil.place);
        let r0 = geometry.principal_distance() * seen.x / -seen.z;
        let law = speckle.speckle_displacement().x;
        let coherence = |r: f64| image_coherence(&before, r0, &after, r0 + r);
        let h = geometry.speckle_size();
        assert!(
            speckle.correlation > 0.05,
            "{name} has no peak: {speckle:?}"
        );
        let wave = peak(coherence, law, 3.0 * h, h);

        // Where the distance changes by 3 %, the field stretches by as much across the pupil, and
        // its centre is not all of it.
        let tolerance = 0.01 * h + 0.04 * speckle.defocus_displacement.length();
        assert_absolute(wave, law, tolerance);
        largest_defocus = largest_defocus.max(speckle.defocus_displacement.length() / h);
    }
    assert!(
        largest_defocus > 0.4,
        "the defocus does not show: {largest_defocus} h"
    );
}

const PUPIL_TO_IMAGE: f64 = 0.06;

/// A camera in focus at 0.3 m and two states of a scene, in which the speckle moves across its pupil
/// and along its axis at once: a surface that slides and turns, seen and lit obliquely, by a camera
/// that moves itself.
fn random_change(index: u32) -> (ImagingGeometry, State, State) {
    let mut k = 100.0 * f64::from(index);
    // Squares times the golden ratio: even, and independent of each other.
    let mut draw = |limit: f64| {
        k += 1.0;
        limit * (2.0 * (k * k * 0.618_033_988_749_894_9).fract() - 1.0)
    };
    let diameter = 16e-3 + draw(4e-3);
    let geometry = ImagingGeometry::from_distances(PupilDistances {
        wavelength: 650e-9,
        surface_to_pupil: 0.3,
        pupil_to_image: PUPIL_TO_IMAGE,
        pupil_diameter: diameter,
        pixel_pitch: 3.45e-6,
    })
    .unwrap();
    let length = geometry.axial_decorrelation_length();
    let turn = Pose::new([draw(60.0), draw(60.0), draw(180.0)], DVec3::ZERO).turn;
    let tilt = Pose::new([draw(35.0), draw(35.0), draw(180.0)], DVec3::ZERO).turn;
    let surface = Pose {
        turn: turn * tilt,
        place: DVec3::new(draw(0.1), draw(0.1), draw(0.1)),
    };
    let depth = 0.3 + draw(length);
    let pupil = Pose {
        turn,
        place: surface.at(DVec3::ZERO) + turn * DVec3::new(draw(0.04), draw(0.04), 1.0) * depth,
    };
    let to_source = surface.turn * DVec3::new(draw(0.5), draw(0.5), 1.0);
    let distance = 0.6 + draw(0.3);
    let source = match index % 3 {
        0 => Source::Sun(to_source),
        _ => Source::Point(surface.place + to_source * distance),
    };
    let before = State {
        surface,
        pupil,
        source,
        wavelength: 650e-9,
    };
    let slide = DVec3::new(
        draw(0.3 * diameter),
        draw(0.3 * diameter),
        draw(0.8 * length),
    );
    let mut small =
        |angle: f64| DQuat::from_rotation_x(draw(angle)) * DQuat::from_rotation_y(draw(angle));
    let (spun, looked) = (small(2e-3), small(1e-3));
    let after = State {
        surface: Pose {
            turn: spun * surface.turn,
            place: surface.place + turn * slide,
        },
        pupil: Pose {
            turn: looked * turn,
            place: pupil.place + DVec3::new(draw(2e-4), draw(2e-4), draw(2e-4)),
        },
        ..before
    };
    (geometry, before, after)
}

/// The light of a change on its way through the lens: the phases, in turns, that the correlation of the
/// fields in two image points sums up over the pupil, and the pupil points after the change.
///
/// Of all pairs of pupil points before and after, the average over rough surfaces leaves those whose
/// paths differ alike for neighbouring scatterers.
struct Pairs {
    geometry: ImagingGeometry,
    after: Vec<(DVec2, f64)>,
    points: f64,
    image: DVec2,
}

impl Pairs {
    const SIDE: i32 = 40;

    fn new(geometry: ImagingGeometry, before: &State, after: &State) -> Self {
        let radius = 0.5 * geometry.pupil_diameter();
        let lattice = || (-Self::SIDE..=Self::SIDE).map(|i| f64::from(i) / f64::from(Self::SIDE));
        let disc = lattice().flat_map(|x| lattice().map(move |y| DVec2::new(x, y)));
        // Points on the rim count half.
        let mut pairs = Self {
            geometry,
            after: Vec::new(),
            points: 0.0,
            image: image_of(before),
        };
        for p in disc.filter(|p| p.length() < 1.0).map(|p| p * radius) {
            pairs.points += 1.0;
            let q = before.matching_point(after, p);
            if q.length() < radius {
                let turns = after.waves(DVec3::ZERO, p.extend(0.0))
                    - before.waves(DVec3::ZERO, q.extend(0.0))
                    + pairs.lens(q, pairs.image);
                pairs.after.push((p, turns));
            }
        }
        pairs
    }

    /// The path from a pupil point to the point in focus whose image lies at `r`, in wavelengths: an ideal
    /// lens makes all paths to that image equal.
    fn lens(&self, p: DVec2, r: DVec2) -> f64 {
        let focus = (r / self.geometry.principal_distance()).extend(-1.0);
        p.extend(0.0)
            .distance(focus * self.geometry.surface_to_pupil())
            / self.geometry.wavelength()
    }

    /// The correlation of the intensity where the point was seen before with that at `displacement` from
    /// there.
    fn correlation(&self, displacement: DVec2) -> f64 {
        let sum = |sum: DVec2, &(p, turns): &(DVec2, f64)| {
            let turns: f64 = turns - self.lens(p, self.image + displacement);
            sum + DVec2::from_angle(TAU * (turns - turns.round()))
        };
        (self.after.iter().fold(DVec2::ZERO, sum) / self.points).length_squared()
    }
}

/// Where the image of the point lies, upright, in metres from the axis.
fn image_of(state: &State) -> DVec2 {
    let seen = state.pupil.turn.inverse() * (state.surface.place - state.pupil.place);
    seen.truncate() * (PUPIL_TO_IMAGE / -seen.z)
}

#[test]
fn images_correlate_most_where_the_law_says_and_by_as_much() {
    let mut seen_by_the_product = 0;
    for index in 0..24 {
        let (geometry, before, after) = random_change(index);
        let [one, two] = [before.configuration(), before.configuration_after(&after)];
        let law = SpeckleMotion::between(&geometry, &one, &two);
        let pairs = Pairs::new(geometry, &before, &after);
        let peak = law.speckle_displacement();
        let left = pairs.correlation(peak);
        let h = geometry.speckle_size();
        let vertex = |e: DVec2| {
            let [low, high] = [-0.1 * h, 0.1 * h].map(|step| pairs.correlation(peak + e * step));
            0.05 * (high - low) / (2.0 * left - low - high)
        };
        let miss = DVec2::new(vertex(DVec2::X), vertex(DVec2::Y)).length();
        // The field stretches with the distance, by up to 1 % across the pupil, and its distance is
        // not its depth, 3° off the axis; 81 points across count the area of a lens to 0.5 %.
        assert!(miss < 0.025, "{index}: {miss} speckles off, {law:?}");
        assert_absolute(law.correlation, left, 8e-3);

        let s = law.pupil_displacement.unwrap().length() / geometry.pupil_diameter();
        let x = law.axial_displacement / geometry.axial_decorrelation_length();
        let product = pupil_overlap_correlation(s) * axial_correlation(x);
        seen_by_the_product += i32::from((product - left).abs() < 0.03);
    }
    // Most of them move both ways at once.
    assert!(
        seen_by_the_product < 12,
        "{seen_by_the_product} tell nothing"
    );
}
