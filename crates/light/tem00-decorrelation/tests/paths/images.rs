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

/// A camera in focus at 0.3 m and two states of a scene, in which the speckle moves across its
/// pupil and along its axis at once: a surface that slides and turns, seen and lit obliquely, by a
/// camera that moves itself.
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

/// The light of a change on its way through the lens: the phases, in turns, that the correlation of
/// the fields in two image points sums up over the pupil, and the pupil points after the change.
///
/// Of all pairs of pupil points before and after, the average over rough surfaces leaves those
/// whose paths differ alike for neighbouring scatterers.
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

    /// The path from a pupil point to the point in focus whose image lies at `r`, in wavelengths:
    /// an ideal lens makes all paths to that image equal.
    fn lens(&self, p: DVec2, r: DVec2) -> f64 {
        let focus = (r / self.geometry.principal_distance()).extend(-1.0);
        p.extend(0.0)
            .distance(focus * self.geometry.surface_to_pupil())
            / self.geometry.wavelength()
    }

    /// The correlation of the intensity where the point was seen before with that at `displacement`
    /// from there.
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
