use glam::DVec3;
use tem00_decorrelation::RigidMotion;

use super::checks::{check_point, unit_vector};
use crate::Refusal;

/// A flat rectangle.
///
/// It is given by its centre and the two vectors from there to the middles of two neighbouring
/// edges. Its normal is `half_u × half_v`, normalised.
///
/// # Examples
///
/// A sheet of A4 paper that faces up:
///
/// ```
/// use glam::DVec3;
/// use tem00_geometry::Rectangle;
///
/// let sheet = Rectangle::new(DVec3::ZERO, 0.105 * DVec3::X, 0.1485 * DVec3::Y)?;
/// assert_eq!(sheet.normal(), DVec3::Z);
/// assert!((sheet.area() - 0.0624).abs() < 0.0001); // m²
/// # Ok::<(), tem00_geometry::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    centre: DVec3,
    half_u: DVec3,
    half_v: DVec3,
    normal: DVec3,
    /// The half edges divided by the squares of their lengths, in 1/m.
    inverse_u: DVec3,
    inverse_v: DVec3,
    area: f64,
}

impl Rectangle {
    /// Creates a rectangle from its centre and its half edges, in metres.
    ///
    /// Half edges within 1e−6 of a right angle pass, so that their components may be written with
    /// seven digits; `half_v` is then made perpendicular to `half_u`.
    ///
    /// # Errors
    ///
    /// Returns an error if the centre is not finite, or the half edges are not finite, not longer
    /// than zero or not perpendicular.
    pub fn new(centre: DVec3, half_u: DVec3, half_v: DVec3) -> Result<Self, Refusal> {
        const RIGHT_ANGLE_TOLERANCE: f64 = 1e-6;
        check_point("centre", centre)?;
        let u = unit_vector("half_u", half_u)?;
        let v = unit_vector("half_v", half_v)?;
        if u.dot(v).abs() > RIGHT_ANGLE_TOLERANCE {
            let allowed = "perpendicular to half_u";
            return Err(Refusal::new("half_v", half_v.to_array(), allowed));
        }
        let half_v = half_v - half_v.dot(u) * u;
        Ok(Self {
            centre,
            half_u,
            half_v,
            normal: u.cross(v).normalize(),
            inverse_u: half_u / half_u.length_squared(),
            inverse_v: half_v / half_v.length_squared(),
            area: 4.0 * half_u.length() * half_v.length(),
        })
    }

    /// Returns the centre, in metres.
    pub const fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Returns the vector from the centre to the middle of one edge, in metres.
    pub const fn half_u(&self) -> DVec3 {
        self.half_u
    }

    /// Returns the vector from the centre to the middle of the next edge, in metres.
    pub const fn half_v(&self) -> DVec3 {
        self.half_v
    }

    /// Returns the unit normal, along `half_u × half_v`.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Returns the area, in m².
    pub const fn area(&self) -> f64 {
        self.area
    }

    /// Returns the point at the fractions `u` and `v`, in [0, 1), of the two edges.
    ///
    /// Uniform fractions give points that are uniform over the area.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        self.centre + (2.0 * u - 1.0) * self.half_u + (2.0 * v - 1.0) * self.half_v
    }

    /// Returns how far an offset from the centre reaches along the half edges, as fractions of
    /// them.
    #[inline(always)]
    pub fn fractions(&self, offset: DVec3) -> [f64; 2] {
        [offset.dot(self.inverse_u), offset.dot(self.inverse_v)]
    }

    /// Returns the point at `u` and `v` half edges from the centre.
    #[inline(always)]
    pub(crate) fn at(&self, u: f64, v: f64) -> DVec3 {
        self.centre + u * self.half_u + v * self.half_v
    }

    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let reach = self.half_u.abs() + self.half_v.abs();
        (self.centre - reach, self.centre + reach)
    }

    /// Returns the rectangle after a rigid motion.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        Self {
            centre: motion.point(self.centre),
            half_u: motion.direction(self.half_u),
            half_v: motion.direction(self.half_v),
            normal: motion.direction(self.normal).normalize(),
            inverse_u: motion.direction(self.inverse_u),
            inverse_v: motion.direction(self.inverse_v),
            area: self.area,
        }
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::refuses;

    use super::*;
    use crate::Shape;

    fn tilted() -> Rectangle {
        let half_u = DVec3::new(0.03, 0.04, 0.0);
        Rectangle::new(DVec3::new(0.1, 0.2, 0.3), half_u, 0.2 * DVec3::Z).unwrap()
    }

    #[test]
    fn rectangle_knows_its_area_normal_and_bounds() {
        let rectangle = tilted();
        // Half edges of 0.05 m and 0.2 m.
        assert!((rectangle.area() - 0.04).abs() < 1e-16, "0.1 m × 0.4 m");
        let normal = DVec3::new(0.8, -0.6, 0.0);
        assert!(
            rectangle.normal().abs_diff_eq(normal, 1e-15),
            "{rectangle:?}"
        );
        let (low, high) = Shape::Rectangle(rectangle).bounds();
        assert!(low.abs_diff_eq(DVec3::new(0.07, 0.16, 0.1), 1e-15), "{low}");
        let top = DVec3::new(0.13, 0.24, 0.5);
        assert!(high.abs_diff_eq(top, 1e-15), "{high}");
    }

    #[test]
    fn points_of_a_rectangle_run_from_corner_to_corner() {
        let r = tilted();
        for (u, v, half_edges) in [
            (0.0, 0.0, -r.half_u() - r.half_v()),
            (0.5, 0.5, DVec3::ZERO),
            (0.75, 0.5, 0.5 * r.half_u()),
        ] {
            let point = r.point(u, v);
            assert!(
                point.abs_diff_eq(r.centre() + half_edges, 1e-15),
                "{u}, {v}: {point}"
            );
        }
    }

    #[test]
    fn seven_digits_are_enough_for_a_right_angle() {
        let half_u = DVec3::new(0.939_692_6, 0.342_020_1, 0.0);
        let half_v = DVec3::new(-0.342_020_2, 0.939_692_6, 0.0);
        assert!(half_u.dot(half_v).abs() > 1e-8, "the last digits spoil it");
        let r = Rectangle::new(DVec3::ZERO, half_u, half_v).unwrap();
        let cosine = r.half_u().dot(r.half_v());
        assert!(cosine.abs() < 2e-16, "made perpendicular: {cosine:e}");
    }

    #[test]
    fn impossible_rectangles_are_refused() {
        refuses!(centre = DVec3::ZERO, half_u = DVec3::X, half_v = DVec3::Y
            => Rectangle::new(centre, half_u, half_v);
            centre: [DVec3::NAN],
            half_u: [DVec3::ZERO],
            half_v: [DVec3::INFINITY, DVec3::new(1e-5, 1.0, 0.0), DVec3::X],
        );
    }
}
