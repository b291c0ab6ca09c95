use glam::DVec3;

/// The segment from a surface point to another point, which is tested for obstacles.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_geometry::{Intersector, Segment, Shape, Sphere};
///
/// let ball = Shape::Sphere(Sphere::new(DVec3::new(0.0, 0.0, 0.1), 0.01)?);
/// let intersector = Intersector::build(&[ball])?;
/// let up = |x: f64| Segment::to_infinity(x * DVec3::X, DVec3::Z, DVec3::Z);
///
/// let mut visible = [true; 2];
/// intersector.visible_batch(&[up(0.009), up(0.011)], &mut visible);
/// assert_eq!(visible, [false, true]);
/// # Ok::<(), tem00_geometry::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// A point on a surface, in metres.
    pub from: DVec3,
    /// The unit normal of that surface, of either sign.
    pub from_normal: DVec3,
    /// The other point, in metres; a surface on which it lies does not hide it.
    pub to: DVec3,
}

impl Segment {
    /// Creates the segment from a surface point out of the scene along `direction`, of unit length.
    ///
    /// It ends 10¹⁰ m away: no shape reaches farther than 10⁹ m from the origin.
    pub fn to_infinity(from: DVec3, from_normal: DVec3, direction: DVec3) -> Self {
        const BEYOND: f64 = 1e10;
        Self {
            from,
            from_normal,
            to: from + BEYOND * direction,
        }
    }
}
