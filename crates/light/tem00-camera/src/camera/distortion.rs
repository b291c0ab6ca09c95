use glam::{DMat2, DVec2};

use crate::RadialDistortion;

/// Radial distortion with the range in which it can be undone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distortion {
    k: RadialDistortion,
    /// The radius, before distortion, beyond which the image would fold back; may be infinite.
    limit: f64,
    /// The distorted radius at `limit`.
    reach: f64,
}

impl Distortion {
    pub(super) fn new(k: RadialDistortion) -> Self {
        let limit = turning_point(k);
        let reach = if limit.is_finite() {
            limit * factor(k, limit * limit)
        } else {
            f64::INFINITY
        };
        Self { k, limit, reach }
    }

    /// Returns the distorted radius that no image point reaches; may be infinite.
    pub(super) const fn reach(&self) -> f64 {
        self.reach
    }

    pub(super) fn is_none(&self) -> bool {
        self.k == RadialDistortion::default()
    }

    /// Returns the image of a tangent, or `None` for one that would fold back into the image.
    pub(super) fn distorted(&self, tangent: DVec2) -> Option<DVec2> {
        if self.is_none() {
            return Some(tangent);
        }
        let squared = tangent.length_squared();
        (squared < self.limit * self.limit).then(|| tangent * factor(self.k, squared))
    }

    /// Returns the tangent that has the given image; for an image beyond reach, the outermost
    /// tangent.
    pub(super) fn undistorted(&self, image: DVec2) -> DVec2 {
        let radius = image.length();
        if self.is_none() || radius == 0.0 {
            return image;
        }
        image * (self.undistorted_radius(radius) / radius)
    }

    /// Returns the derivative of the distorted by the undistorted tangent.
    ///
    /// ```text
    /// J = F(r²) 1 + 2 F′(r²) t tᵀ
    /// ```
    pub(super) fn jacobian(&self, tangent: DVec2) -> DMat2 {
        let RadialDistortion { k1, k2, k3 } = self.k;
        let s = tangent.length_squared();
        let slope = k1 + s * (2.0 * k2 + s * (3.0 * k3));
        let outer = DMat2::from_cols(tangent * tangent.x, tangent * tangent.y);
        DMat2::from_diagonal(DVec2::splat(factor(self.k, s))) + 2.0 * slope * outer
    }

    /// Newton's iteration, kept inside a bracket that is halved whenever a step leaves it.
    fn undistorted_radius(&self, image: f64) -> f64 {
        if image >= self.reach {
            return self.limit;
        }
        let excess = |r: f64| r * factor(self.k, r * r) - image;
        let (mut low, mut high) = (0.0, self.limit.min(image));
        while high < self.limit && excess(high) < 0.0 {
            (low, high) = (high, (2.0 * high).min(self.limit));
        }
        let mut radius = 0.5 * (low + high);
        for _ in 0..64 {
            let error = excess(radius);
            if error < 0.0 {
                low = radius;
            } else {
                high = radius;
            }
            let newton = radius - error / derivative(self.k, radius * radius);
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - radius).abs() <= f64::EPSILON * radius {
                return next;
            }
            radius = next;
        }
        radius
    }
}

/// F(s), s = r²: the distorted by the undistorted radius.
fn factor(k: RadialDistortion, s: f64) -> f64 {
    1.0 + s * (k.k1 + s * (k.k2 + s * k.k3))
}

/// d(r F)/dr as a polynomial of s = r².
fn derivative(k: RadialDistortion, s: f64) -> f64 {
    1.0 + s * (3.0 * k.k1 + s * (5.0 * k.k2 + s * (7.0 * k.k3)))
}

/// Returns the smallest radius at which the distorted radius stops growing, or infinity.
fn turning_point(k: RadialDistortion) -> f64 {
    if [k.k1, k.k2, k.k3].iter().all(|&k| k >= 0.0) {
        return f64::INFINITY;
    }
    // Between the extrema of its derivative the derivative is monotone.
    let mut start = 0.0;
    for end in extrema(k) {
        if derivative(k, end) <= 0.0 {
            return bisected(k, start, end).sqrt();
        }
        start = end;
    }
    let mut end = f64::max(1.0, 2.0 * start);
    while end < f64::MAX.sqrt().sqrt() {
        if derivative(k, end) <= 0.0 {
            return bisected(k, start, end).sqrt();
        }
        end *= 2.0;
    }
    f64::INFINITY
}

/// Returns the positive zeros of 3 k₁ + 10 k₂ s + 21 k₃ s², in order.
fn extrema(k: RadialDistortion) -> impl Iterator<Item = f64> {
    let (a, half_b, c) = (21.0 * k.k3, 5.0 * k.k2, 3.0 * k.k1);
    let root = (half_b * half_b - a * c).max(0.0).sqrt();
    // The sum has no cancellation; the other zero follows from their product.
    let sum = -(half_b + root.copysign(half_b));
    let (one, two) = (sum / a, c / sum);
    [one.min(two), one.max(two)]
        .into_iter()
        .filter(|s| *s > 0.0 && s.is_finite())
}

/// Returns where the derivative, positive at `low` and not at `high`, changes its sign.
fn bisected(k: RadialDistortion, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if derivative(k, middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_relative;

    use super::*;

    #[test]
    fn images_grow_up_to_the_turning_point_and_shrink_behind_it() {
        for (k1, k2, k3) in [
            (-10.0, 0.0, 0.0),
            (0.0, -30.0, 0.0),
            (0.0, 0.0, -80.0),
            (2.0, -30.0, 5.0),
            (-1.0, 3.0, -40.0),
            // Grows again farther out.
            (-1000.0, 4e5, 1.0),
        ] {
            let distortion = Distortion::new(RadialDistortion { k1, k2, k3 });
            let image = |r: f64| r * (1.0 + k1 * r.powi(2) + k2 * r.powi(4) + k3 * r.powi(6));
            let limit = distortion.limit;
            for step in 0..1000 {
                let (r, next) = (f64::from(step) * 1e-3, f64::from(step + 1) * 1e-3);
                // Near the turning point the last steps change the radius by a fraction of 1e−6,
                // more than rounding.
                assert!(
                    image(limit * r) < image(limit * next),
                    "{k1}, {k2}, {k3}: {r}"
                );
            }
            assert!(image(1.001 * limit) < image(limit), "{k1}, {k2}, {k3}");
            assert_relative(distortion.reach(), image(limit), 1e-14);
        }
        for (k1, k2, k3) in [(1.0, 0.0, 0.0), (-1.0, 1.0, 0.0), (0.0, -1.0, 10.0)] {
            let distortion = Distortion::new(RadialDistortion { k1, k2, k3 });
            assert!(distortion.limit.is_infinite(), "{k1}, {k2}, {k3}");
        }
    }
}
