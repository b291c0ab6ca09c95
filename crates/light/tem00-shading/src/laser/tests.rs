use tem00_beam::{AngularProfile, FocusCurve};
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

/// A line of 60° in focus at 0.3 m, from the origin along z.
fn line(profile: LineProfile, focus_curve: FocusCurve) -> Laser {
    let shape = BeamShape::Line {
        waist_radius: 0.1e-3,
        m_squared: 1.0,
        fan: FanGeometry {
            fan_angle: 60_f64.to_radians(),
            apex_offset: 2e-3,
            focus_distance: 0.3,
            focus_curve,
        },
        profile,
    };
    Laser::new(LaserDescription {
        spectrum: Spectrum::monochromatic(650e-9).unwrap(),
        power: 5e-3,
        position: DVec3::ZERO,
        look_at: DVec3::Z,
        line_direction: DVec3::X,
        shape,
    })
    .unwrap()
}

#[test]
fn refused_vectors_have_the_names_of_the_caller() {
    let spot = || Laser::spot(650e-9, 1e-3);
    let error = |laser: Result<Laser, ShadingError>| laser.unwrap_err().to_string();
    let along = error(spot().placed(DVec3::ZERO, DVec3::Z, DVec3::Z));
    assert!(along.starts_with("line_direction must be"), "{along}");
    let nowhere = error(spot().placed(DVec3::X, DVec3::X, DVec3::Z));
    assert!(nowhere.starts_with("target must be another"), "{nowhere}");
    let description = line(LineProfile::GaussianTan, FocusCurve::EqualPlane).description;
    let far = error(Laser::new(LaserDescription {
        position: DVec3::NAN,
        ..description.clone()
    }));
    assert!(far.starts_with("position must be"), "{far}");
    let there = error(Laser::new(LaserDescription {
        look_at: description.position,
        ..description
    }));
    assert!(there.starts_with("look_at must be"), "{there}");
}

/// The change of direction of a laser's light along one of two directions per length along the
/// other, in 1/m: a component of the curvature of its wavefront.
fn curvature(laser: &Laser, point: DVec3, [along, turned]: [DVec3; 2]) -> f64 {
    const STEP: f64 = 1e-7;
    let wave = |part: f64| laser.wave_direction_at(point + part * along);
    (wave(-STEP) - wave(STEP)).dot(turned) / (2.0 * STEP)
}

#[test]
fn the_wavefront_across_a_line_is_flat_where_its_focus_curve_says() {
    let slope = 0.4_f64;
    let on_plane = DVec3::new(0.302 * slope, 0.0, 0.3);
    let cos = slope.atan().cos();
    let on_circle = DVec3::new(0.302 * slope * cos, 0.0, 0.302 * cos - 2e-3);
    let cases = [
        (FocusCurve::EqualPlane, on_plane, on_circle),
        (FocusCurve::EqualDistance, on_circle, on_plane),
    ];
    for (focus_curve, flat, curved) in cases {
        let laser = line(LineProfile::GaussianTan, focus_curve);
        let across = [flat, curved].map(|point| curvature(&laser, point, [DVec3::Y, DVec3::Y]));
        assert!(across[0].abs() < 1e-9, "{focus_curve:?}: {across:?}");
        assert!(across[1].abs() > 1.0, "{focus_curve:?}: {across:?}");
    }
}

/// An elliptic spot with its waists apart, from an oblique position, whose line direction is not
/// across the axis; its beam; and the three axes.
fn elliptic_spot() -> (Laser, AstigmaticBeam, [DVec3; 3]) {
    let position = DVec3::new(0.03, -0.02, 0.05);
    let axis = DVec3::new(2.0, 1.0, -2.0) / 3.0;
    let line_direction = DVec3::new(0.3, 0.8, 0.1);
    let laser = Laser::new(LaserDescription {
        spectrum: Spectrum::monochromatic(650e-9).unwrap(),
        power: 5e-3,
        position,
        look_at: position + 0.2 * axis,
        line_direction,
        shape: BeamShape::Spot {
            waist_radius: [20e-6, 60e-6],
            waist_distance: [0.1, 0.14],
            m_squared: [1.0, 1.4],
        },
    })
    .unwrap();
    let [first, second] = [(20e-6, 0.1, 1.0), (60e-6, 0.14, 1.4)].map(|(radius, distance, m2)| {
        let beam = GaussianBeam::from_waist(650e-9, radius).unwrap();
        LocatedBeam::new(beam.with_m_squared(m2).unwrap(), distance).unwrap()
    });
    let across = axis.cross(line_direction).normalize();
    let axes = [across.cross(axis), across, axis];
    (laser, AstigmaticBeam::new(first, second).unwrap(), axes)
}

#[test]
fn the_first_values_of_a_spot_hold_along_the_line_direction() {
    let (laser, beam, [along, across, axis]) = elliptic_spot();
    let centre = laser.description().position + 0.2 * axis;
    let peak = laser.next_event(centre).unwrap().e_perp;
    for (direction, radius) in [along, across].into_iter().zip(beam.radii_at(0.2)) {
        let light = laser.next_event(centre + radius * direction).unwrap();
        // On a plane across the axis, the irradiance is down to e⁻² of the peak at the beam radius.
        let across_axis = light.e_perp * -light.wi.dot(axis);
        // The radius is a difference of points 0.2 m from the origin: 4 ε 0.2 m / 0.2 mm = 1e-12.
        assert_absolute(across_axis / peak * 2_f64.exp(), 1.0, 1e-12);
    }
}

#[test]
fn a_tilted_plane_receives_the_power_of_an_elliptic_spot() {
    let (laser, _, [along, across, axis]) = elliptic_spot();
    let centre = laser.description().position + 0.2 * axis;
    for (towards_along, towards_across) in [(0.0, 0.0), (1.5, 0.5), (-0.3, 1.7)] {
        let normal = (towards_along * along + towards_across * across - axis).normalize();
        let (u, v) = normal.any_orthonormal_pair();
        // The radii are 1.0 mm and 0.3 mm across the axis and at most twice that on the plane,
        // where they grow by a tenth. A sum in steps of h is off by exp(−π² w²/2 h²) < 1e-25, and
        // 10 mm hold all but exp(−2 · 4²) = 1e-14, where the light is cut off.
        let step = 0.08e-3;
        let place = |i: i32| f64::from(i) * step;
        let power: f64 = (-125..=125)
            .flat_map(|i| (-125..=125).map(move |j| (i, j)))
            .filter_map(|(i, j)| laser.next_event(centre + place(i) * u + place(j) * v))
            .map(|light| light.e_perp * light.wi.dot(normal) * step * step)
            .sum();
        assert_relative(power, 5e-3, 1e-12);
    }
}

#[test]
fn the_wavefront_of_an_elliptic_spot_is_curved_as_its_beam_along_each_axis() {
    let (laser, beam, [along, across, axis]) = elliptic_spot();
    for z in [0.05, 0.1, 0.12, 0.14, 0.3] {
        let point = laser.description().position + z * axis;
        let [first, second] = beam.curvatures_at(z);
        // Rounding of 1e−16 over the step, and c³ times its square.
        let tolerance = 1e-8;
        for (one, other, expected) in [
            (along, along, first),
            (across, across, second),
            (along, across, 0.0),
            (across, along, 0.0),
        ] {
            let error = (curvature(&laser, point, [one, other]) - expected).abs();
            assert!(error < tolerance, "z = {z}, {one} and {other}: {error:e}");
        }
    }
}

/// Lines of three profiles, one of them a table, and the elliptic spot.
fn lasers() -> Vec<Laser> {
    let table = AngularProfile::from_pairs(&[(-0.2, 1.0), (0.0, 2.0), (0.4, 0.5)]).unwrap();
    let profiles = [
        LineProfile::GaussianTan,
        LineProfile::Powell { edge: 0.1 },
        LineProfile::Tabulated(table),
    ];
    let lines = profiles.map(|profile| line(profile, FocusCurve::EqualPlane));
    lines.into_iter().chain([elliptic_spot().0]).collect()
}

/// A point in the beam of a laser, 0.2 m along the axis from the aperture.
fn lit_point(laser: &Laser) -> DVec3 {
    let LaserDescription {
        position, look_at, ..
    } = *laser.description();
    let axis = (look_at - position).normalize();
    position + 0.2 * axis + 20e-6 * axis.any_orthonormal_vector()
}

#[test]
fn the_laser_is_dark_from_behind() {
    for laser in lasers() {
        let LaserDescription {
            position, look_at, ..
        } = *laser.description();
        let axis = (look_at - position).normalize();
        assert!(laser.radiance(position + 0.1 * axis, -axis) > 0.0, "front");
        assert!(laser.radiance(position - 0.1 * axis, -axis) <= 0.0, "back");
        assert!(laser.radiance(position + 0.1 * axis, axis) <= 0.0, "away");
        assert_eq!(laser.aperture_distance(look_at, axis), None, "away");
    }
}

#[test]
fn a_moved_laser_lights_moved_points_as_before() {
    let turn = RigidMotion::about(DVec3::new(0.1, 0.2, -0.1), DVec3::new(1.0, -2.0, 0.5), 1.1);
    let shift = RigidMotion::along(DVec3::new(0.05, -0.02, 0.3));
    let motion = turn.unwrap().then(&shift.unwrap());
    for laser in lasers() {
        let moved = laser.moved(&motion);
        let point = lit_point(&laser);
        let (before, after) = (
            laser.next_event(point).unwrap(),
            moved.next_event(motion.point(point)).unwrap(),
        );
        // Points round by 1e−16 m, beside beam radii of at least 0.1 mm and slopes below 1.
        let ratio = after.e_perp / before.e_perp;
        assert!((ratio - 1.0).abs() < 1e-10, "{laser:?}: {ratio}");
        let turned = after.wi.distance(motion.direction(before.wi));
        assert!(turned < 1e-12, "{laser:?}: {turned:e}");
        let carried = after.point.distance(motion.point(before.point));
        assert!(carried < 1e-12, "{laser:?}: {carried:e}");
        // The description says the same: a laser created from it is the moved one.
        let created = Laser::new(moved.description().clone()).unwrap();
        let created = created.next_event(motion.point(point)).unwrap();
        assert_absolute(created.e_perp / after.e_perp, 1.0, 1e-10);
    }
}

#[test]
fn a_laser_stands_where_its_trajectory_says() {
    let step = DVec3::new(1e-3, 2e-3, -3e-3);
    let laser = elliptic_spot().0;
    let moving = laser
        .clone()
        .with_trajectory(Trajectory::steady(step).unwrap());
    let there = moving.in_frame(3).description().position;
    let expected = laser.description().position + 3.0 * step;
    assert!(there.distance(expected) < 1e-16, "{there} | {expected}");
    assert!(
        moving.in_frame(3).trajectory().is_still(),
        "it has been moved"
    );
}

#[test]
fn points_together_are_lit_as_each_alone() {
    for laser in lasers() {
        let description = laser.description();
        let (axis, across) = (description.look_at - description.position, DVec3::Y);
        let point = |index: u32| {
            let (along, aside) = (f64::from(index % 10) - 1.0, f64::from(index / 10) - 5.0);
            description.position + 0.2 * along * axis + 0.2e-4 * aside * across
        };
        let mut lit = LaserEventBatch::default();
        lit.place((0..100).map(point));
        laser.next_events(&mut lit);
        let mut bright = 0;
        for index in 0..100 {
            let alone = laser.next_event(point(index));
            let together = lit.at(index as usize);
            assert_eq!(alone.is_some(), together.is_some(), "{index}");
            let Some((alone, together)) = alone.zip(together) else {
                continue;
            };
            bright += 1;
            assert_eq!(alone.wi, together.wi, "{index}");
            let [one, other] = [alone, together].map(|light| light.e_perp.to_bits());
            assert_eq!(one, other, "{index}");
            // Roundings of coordinates up to 2.
            assert!(alone.point.distance(together.point) < 2e-15, "{index}");
        }
        assert!(bright > 20 && bright < 100, "{bright} are lit");
    }
}
