//! What a lens shows of the moved field: displacement and correlation of images.

use core::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use tem00_decorrelation::{
    ImagingGeometry, LensData, PupilDistances, SpeckleMotion, axial_correlation,
    pupil_overlap_correlation,
};
use tem00_testkit::assert_absolute;

use super::{Pose, Source, State, set_ups, unit_motions};

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

/// Where the image of the point lies, upright, in metres from the axis.
fn image_of(state: &State, geometry: &ImagingGeometry) -> DVec2 {
    let seen = state.pupil.turn.inverse() * (state.surface.place - state.pupil.place);
    seen.truncate() * (geometry.principal_distance() / -seen.z)
}

#[test]
fn image_displacement_is_that_of_the_exact_projection() {
    for state in set_ups(Source::Sun(DVec3::Z)) {
        for motion in unit_motions() {
            let (after, law) = state.shifted(motion.map(|v| v * 5e-3));
            let exact = image_of(&after, &geometry()) - image_of(&state, &geometry());
            let theory = SpeckleMotion::between(&geometry(), &state.configuration(), &law);
            // Rounding of images 20 mm from the axis.
            let miss = (theory.image_displacement - exact).length();
            assert!(miss < 2e-16, "{motion:?}: {miss:e}");
        }
    }
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
    // Places along x and z, and turns about y.
    let pose = |[x, z, turn]: [f64; 3]| Pose {
        turn: DQuat::from_rotation_y(turn),
        place: DVec3::new(x, 0.0, z),
    };
    let state = |surface, pupil| State {
        surface: pose(surface),
        pupil: pose(pupil),
        source: Source::Point(DVec3::new(-0.1, 0.0, 0.3)),
        wavelength: 650e-9,
    };
    let (rest, near, far) = ([0.0, 0.3, 0.0], [0.0, 0.285, 0.0], [0.02, 0.32, 0.06]);
    let (flat, leaning) = ([0.0; 3], [0.0, 0.0, 0.5]);
    let (slid, tilted) = ([0.3e-3, 0.0, 0.0], [0.0, 0.0, 2e-3]);
    let walked = [0.5e-3, 0.286, 1e-3];
    let cases = [
        ("in focus", [flat, slid], [rest, rest]),
        ("too near", [flat, slid], [near, near]),
        ("too near, tilted", [flat, tilted], [near, near]),
        ("too far, tilted", [leaning, [0.0, 0.0, 0.498]], [far, far]),
        ("into focus", [flat, [0.1e-3, -8e-3, 1e-3]], [near, near]),
        ("out of focus", [flat, [0.4e-3, 4e-3, -1e-3]], [rest, rest]),
        (
            "through focus",
            [[0.0, 4e-3, 0.0], [0.2e-3, -4e-3, 1e-3]],
            [rest, rest],
        ),
        ("camera", [leaning, leaning], [near, walked]),
    ];
    let geometry = geometry();
    let mut largest_defocus = 0.0_f64;
    for (name, surfaces, pupils) in cases {
        let [before, after] = [0, 1].map(|i: usize| state(surfaces[i], pupils[i]));
        let [one, two] = [before.configuration(), before.configuration_after(&after)];
        let speckle = SpeckleMotion::between(&geometry, &one, &two);
        let r0 = image_of(&before, &geometry).x;
        let law = speckle.speckle_displacement().x;
        let coherence = |r: f64| image_coherence(&before, r0, &after, r0 + r);
        let h = geometry.speckle_size();
        assert!(speckle.correlation > 0.05, "{name}: {speckle:?}");
        let wave = peak(coherence, law, 3.0 * h, h);

        // Where the distance changes by 3 %, the field stretches by as much across the pupil, and
        // its centre is not all of it.
        let tolerance = 0.01 * h + 0.04 * speckle.defocus_displacement.length();
        assert_absolute(wave, law, tolerance);
        largest_defocus = largest_defocus.max(speckle.defocus_displacement.length() / h);
    }
    assert!(largest_defocus > 0.4, "{largest_defocus} h show nothing");
}

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
        pupil_to_image: 0.06,
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
            image: image_of(before, &geometry),
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
    assert!(seen_by_the_product < 12, "{seen_by_the_product} of 24");
}
