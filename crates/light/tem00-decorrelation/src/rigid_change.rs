use glam::{DVec2, DVec3};

use crate::{CameraFrame, GRAZING_COSINE, Refusal, RigidMotion, RigidMotions, vector::finite};

/// A rigid motion of surface and camera, prepared for many points of the surface.
///
/// It evaluates the law of [`SpeckleMotion::between`](crate::SpeckleMotion::between) in light of
/// one wavelength, without the part that depends on the lens. Quantities that all points share are
/// computed once, and [`at`](Self::at) needs only arithmetic, square roots and selections, so that
/// a loop over points fills the vector units ([`tem00_numerics::vectorised`]).
///
/// # Examples
///
/// A surface seen and lit along its normal slides by 0.1 mm. Its speckle moves across the pupil by
/// the same distance:
///
/// ```
/// use tem00_decorrelation::{
///     CameraFrame, ChangedPoint, DVec3, RigidChange, RigidMotion, RigidMotions,
/// };
///
/// let eye = DVec3::new(0.0, 0.0, 0.3);
/// let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y)?;
/// let motions = RigidMotions {
///     surface: RigidMotion::along(DVec3::new(1e-4, 0.0, 0.0))?,
///     ..RigidMotions::default()
/// };
/// let change = RigidChange::new(camera, eye, &motions)?;
/// let point = change.at(&ChangedPoint {
///     position: DVec3::new(1e-4, 0.0, 0.0),
///     normal: DVec3::Z,
///     to_source: [DVec3::Z; 2],
/// });
/// assert!((point.tangent_displacement.x - 1e-4 / 0.3).abs() < 1e-15);
/// assert!((point.pupil_displacement.x - 1e-4).abs() < 1e-15);
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidChange {
    surface: RigidMotion,
    back: RigidMotion,
    /// The camera before and after.
    eyes: [Eye; 2],
}

/// A camera: its axes and the centre of its pupil.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Eye {
    camera: CameraFrame,
    pupil: DVec3,
}

/// A surface point after a change, with the light on it before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangedPoint {
    /// Position of the point after the change, in metres.
    pub position: DVec3,
    /// Unit normal of the surface at the point, to either side.
    pub normal: DVec3,
    /// Unit vectors from the point to the source, from the position of the point before and after
    /// the change.
    pub to_source: [DVec3; 2],
}

/// Change of the speckle at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointChange {
    /// Displacement t' − t of the image of the point along b1 and b2 of the camera, upright, in
    /// units of the principal distance; infinite if the point is invisible in one of the states.
    pub tangent_displacement: DVec2,
    /// The displacement of the speckle field over the pupil, in metres along b1 and b2; infinite
    /// where the pattern is decorrelated for
    /// [`pupil_point_after`](crate::Configuration::pupil_point_after).
    pub pupil_displacement: DVec2,
    /// 1/Z before and after, with the depth Z before the pupil plane, in 1/m.
    pub per_depth: [f64; 2],
}

impl RigidChange {
    /// Creates a change from the axes of the camera and the centre of its pupil before the change,
    /// in metres, and the motions of surface and camera. The motion of the source is ignored: the
    /// light is given with each point.
    ///
    /// # Errors
    ///
    /// Returns an error if the centre of the pupil is not finite.
    pub fn new(camera: CameraFrame, pupil: DVec3, motions: &RigidMotions) -> Result<Self, Refusal> {
        finite("pupil", pupil)?;
        let after = Eye {
            camera: camera.turned(motions.camera.rotation()),
            pupil: motions.camera.point(pupil),
        };
        Ok(Self {
            surface: motions.surface,
            back: motions.surface.inverse(),
            eyes: [Eye { camera, pupil }, after],
        })
    }

    /// Returns the position of a surface point before the change, in metres.
    #[inline(always)]
    pub fn origin(&self, position: DVec3) -> DVec3 {
        self.back.point(position)
    }

    /// Returns a direction rotated by the motion of the surface.
    #[inline(always)]
    pub fn turned(&self, direction: DVec3) -> DVec3 {
        self.surface.direction(direction)
    }

    /// Returns the change of the speckle at a point. Coordinates that are not finite give infinite
    /// displacements.
    #[inline(always)]
    pub fn at(&self, point: &ChangedPoint) -> PointChange {
        let [before, after] = &self.eyes;
        let from = Sight::new(before, self.origin(point.position));
        let sight = Sight::new(after, point.position);
        let [source_before, source] = point.to_source;
        let turned_source = self.turned(source_before);
        let turned_sight = self.turned(from.direction);

        let side = point.normal.dot(turned_sight);
        let (direction, rest) = leaving(point.normal, turned_sight + turned_source - source, side);
        let lit_side = point.normal.dot(turned_source) * point.normal.dot(source);
        let cosine = direction.dot(after.camera.towards_camera());
        let pupil = after.across(direction * (1.0 / (cosine * sight.per_depth)) - sight.to_pupil);
        let tangents = from.tangents - sight.tangents;

        let seen = from.seen & sight.seen & is_finite(tangents);
        // NaN fails every comparison.
        let known = (rest > 0.0)
            & (side.abs() > GRAZING_COSINE)
            & (lit_side >= 0.0)
            & (cosine > GRAZING_COSINE)
            & is_finite(pupil);
        PointChange {
            tangent_displacement: finite_if(seen, tangents),
            pupil_displacement: finite_if(seen & known, pupil),
            per_depth: [from.per_depth, sight.per_depth],
        }
    }
}

/// Returns the direction in which a field leaves, and the square of its component along the normal;
/// no field leaves if the square is not positive. The tangential component is the one of `sum`, and
/// the normal component has the sign of `side`.
#[inline(always)]
pub(crate) fn leaving(normal: DVec3, sum: DVec3, side: f64) -> (DVec3, f64) {
    let tangential = sum - normal * normal.dot(sum);
    let rest = 1.0 - tangential.length_squared();
    (tangential + normal * rest.sqrt().copysign(side), rest)
}

impl Eye {
    /// The components of a vector along b1 and b2.
    #[inline(always)]
    fn across(&self, vector: DVec3) -> DVec2 {
        DVec2::new(
            vector.dot(self.camera.right()),
            vector.dot(self.camera.up()),
        )
    }
}

/// A line of sight from a surface point to the centre of the pupil.
struct Sight {
    to_pupil: DVec3,
    direction: DVec3,
    per_depth: f64,
    /// Offset across the axis divided by depth: opposite to the image, which is upright.
    tangents: DVec2,
    seen: bool,
}

impl Sight {
    #[inline(always)]
    fn new(eye: &Eye, point: DVec3) -> Self {
        let to_pupil = eye.pupil - point;
        let distance = to_pupil.length_squared().sqrt();
        let depth = to_pupil.dot(eye.camera.towards_camera());
        let per_depth = 1.0 / depth;
        Self {
            to_pupil,
            direction: to_pupil * (1.0 / distance),
            per_depth,
            tangents: eye.across(to_pupil) * per_depth,
            seen: depth > GRAZING_COSINE * distance,
        }
    }
}

#[inline(always)]
fn is_finite(vector: DVec2) -> bool {
    (vector.x.abs() <= f64::MAX) & (vector.y.abs() <= f64::MAX)
}

#[inline(always)]
fn finite_if(condition: bool, vector: DVec2) -> DVec2 {
    let or_infinite = |x| if condition { x } else { f64::INFINITY };
    DVec2::new(or_infinite(vector.x), or_infinite(vector.y))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        Configuration, ConfigurationData, Illumination, ImagingGeometry, LensData, SpeckleMotion,
    };

    fn unit_vectors() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0, -1.0..1.0, -1.0..1.0]
            .prop_map(DVec3::from_array)
            .prop_filter("a direction", |v| v.length() > 0.1)
            .prop_map(DVec3::normalize)
    }

    fn motions() -> impl Strategy<Value = RigidMotion> {
        let along = [-0.05..0.05, -0.05..0.05, -0.05..0.05].prop_map(DVec3::from_array);
        (unit_vectors(), -1.0_f64..1.0, along).prop_map(|(axis, angle, along)| {
            let turn = RigidMotion::about(DVec3::ZERO, axis, angle * angle * angle).unwrap();
            turn.then(&RigidMotion::along(along).unwrap())
        })
    }

    fn close(a: DVec2, b: DVec2, scale: f64) -> bool {
        (a - b).length() <= 1e-12 * (scale + b.length())
    }

    proptest! {
        /// The oracle is the law of two states, which is itself tested against waves and closed
        /// forms.
        #[test]
        fn points_change_as_their_states_do(
            position in [-0.1..0.1, -0.1..0.1, -0.1..0.1].prop_map(DVec3::from_array),
            normal in unit_vectors(),
            to_source in [unit_vectors(), unit_vectors()],
            surface in motions(),
            camera in motions(),
        ) {
            let eye = DVec3::new(0.02, -0.01, 0.4);
            let frame = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y).unwrap();
            let motions = RigidMotions { surface, camera, ..RigidMotions::default() };
            let light = to_source.map(|to| Illumination::collimated(to).unwrap());
            let before = Configuration::new(ConfigurationData {
                wavelength: 650e-9,
                point: position,
                normal,
                illumination: light[0],
                camera: frame,
                pupil: eye,
            }).unwrap();
            let found = RigidChange::new(frame, eye, &motions).unwrap().at(&ChangedPoint {
                position: surface.point(position),
                normal: surface.direction(normal),
                to_source,
            });
            let moved = before.moved(&motions);
            let Ok(after) = moved.and_then(|state| state.with_illumination(light[1])) else {
                prop_assert_eq!(found.tangent_displacement, DVec2::INFINITY);
                return Ok(());
            };
            let geometry = ImagingGeometry::from_lens(LensData {
                wavelength: 650e-9,
                focal_length: 25e-3,
                f_number: 8.0,
                surface_to_pupil: 0.3,
                pixel_pitch: 3.45e-6,
            }).unwrap();
            let law = SpeckleMotion::between(&geometry, &before, &after);
            let tangents = law.image_displacement / geometry.principal_distance();
            prop_assert!(
                close(found.tangent_displacement, tangents, 1.0),
                "{found:?}, not {tangents}"
            );
            let [from, to] = found.per_depth.map(f64::recip);
            prop_assert!((from - to - law.axial_displacement).abs() < 1e-13);
            match law.pupil_displacement {
                // Near grazing incidence the square root of a small remainder amplifies its
                // rounding to 1e-8.
                Some(pupil) => prop_assert!(
                    close(found.pupil_displacement, pupil, 1.0) || pupil.length() > 10.0,
                    "{found:?}, not {pupil}"
                ),
                None => prop_assert_eq!(found.pupil_displacement, DVec2::INFINITY),
            }
        }
    }

    #[test]
    fn what_is_not_finite_gives_infinite_displacements() {
        let frame = CameraFrame::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y).unwrap();
        let change = RigidChange::new(frame, DVec3::Z, &RigidMotions::default()).unwrap();
        let point = ChangedPoint {
            position: DVec3::ZERO,
            normal: DVec3::Z,
            to_source: [DVec3::Z; 2],
        };
        assert_eq!(change.at(&point).pupil_displacement, DVec2::ZERO);
        for bad in [DVec3::NAN, DVec3::INFINITY, DVec3::Z] {
            let found = change.at(&ChangedPoint {
                position: bad,
                ..point
            });
            assert_eq!(found.tangent_displacement, DVec2::INFINITY, "{bad}");
        }
        let dark = ChangedPoint {
            to_source: [DVec3::Z, DVec3::NAN],
            ..point
        };
        let found = change.at(&dark);
        assert_eq!(found.pupil_displacement, DVec2::INFINITY, "{found:?}");
        assert!(RigidChange::new(frame, DVec3::NAN, &RigidMotions::default()).is_err());
    }
}
