use glam::{DVec2, DVec3};
use tem00_geometry::Rectangle;

/// A rectangle as seen from a point before it: its image on the unit sphere.
///
/// In axes along the edges and towards the plane of the rectangle at the distance `d`, with
/// `X = x/√(x² + d²)` and `Y` likewise, the part of the image up to the edge x covers
///
/// ```text
/// Ω(x) = A(x, y₁) − A(x, y₀) − A(x₀, y₁) + A(x₀, y₀)      A(x, y) = asin(X Y)
/// ```
///
/// The first two terms, with sum τ, give X back by the addition theorem of the sine:
///
/// ```text
/// X = sin τ / √((Y₁ − Y₀)² + 4 Y₀ Y₁ sin²(τ/2))
/// ```
///
/// # References
///
/// - C. Ureña, M. Fajardo and A. King, *An Area-Preserving Parametrization for Spherical
///   Rectangles*, 2013.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalRectangle {
    axes: [DVec3; 3],
    /// The edges and the distance, in metres, in these axes.
    low: [f64; 2],
    high: [f64; 2],
    distance: f64,
    /// τ at the first edge, in steradian.
    first: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// Returns the image of a rectangle for a point before its front.
    pub(super) fn new(rectangle: &Rectangle, from: DVec3) -> Self {
        let offset = rectangle.centre() - from;
        let distance = -offset.dot(rectangle.normal());
        let (width, height) = (rectangle.half_u().length(), rectangle.half_v().length());
        let (x_axis, y_axis) = (rectangle.half_u() / width, rectangle.half_v() / height);
        let (x, y) = (offset.dot(x_axis), offset.dot(y_axis));
        let seen = Self {
            axes: [x_axis, y_axis, -rectangle.normal()],
            low: [x - width, y - height],
            high: [x + width, y + height],
            distance,
            first: 0.0,
            solid_angle: 0.0,
        };
        let first = seen.strip(seen.low[0]);
        Self {
            first,
            solid_angle: seen.strip(seen.high[0]) - first,
            ..seen
        }
    }

    /// Returns the solid angle, in steradian. It errs by some 1e−15.
    pub(super) const fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Returns the vector to a point of the rectangle, in metres; uniform numbers in [0, 1) give
    /// directions that are uniform over the solid angle.
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        let d = self.distance;
        let tau = self.first + u * self.solid_angle;
        let (low, high) = (part(self.low[1], d), part(self.high[1], d));
        let half = libm::sin(0.5 * tau);
        let squared = (high - low) * (high - low) + 4.0 * low * high * half * half;
        let x = length(libm::sin(tau) / squared.sqrt(), d).clamp(self.low[0], self.high[0]);
        // Along y, the density of directions is the density of y / √(x² + y² + d²).
        let d = DVec2::new(x, d).length();
        let (low, high) = (part(self.low[1], d), part(self.high[1], d));
        let y = length(low + v * (high - low), d).clamp(self.low[1], self.high[1]);
        let [x_axis, y_axis, z_axis] = self.axes;
        x * x_axis + y * y_axis + self.distance * z_axis
    }

    /// A(x, y₁) − A(x, y₀), by arctangents, which are exact where an arcsine ends.
    fn strip(&self, x: f64) -> f64 {
        let area = |y: f64| {
            let d = self.distance;
            libm::atan2(x * y, d * DVec3::new(x, y, d).length())
        };
        area(self.high[1]) - area(self.low[1])
    }
}

/// The sine of the angle whose tangent is `x / d`.
fn part(x: f64, d: f64) -> f64 {
    x / DVec2::new(x, d).length()
}

/// The inverse of [`part`]; infinite for 1 and beyond.
fn length(part: f64, d: f64) -> f64 {
    let squared = (1.0 - part) * (1.0 + part);
    if squared > 0.0 {
        d * part / squared.sqrt()
    } else {
        f64::INFINITY.copysign(part)
    }
}
