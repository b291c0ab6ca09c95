//! The power of an elliptical Gaussian distribution within a circle anywhere.
//!
//! The circle is cut into chords along the axis on which its centre lies farther out; each chord
//! holds a difference of error functions, and one integral over the chords remains.

use core::f64::consts::PI;

use tem00_numerics::quadrature::integrate_adaptively;

use super::marginal::{Interval, power_beyond};

/// Distance from the axis, in radii, at which the density underflows: exp(−2 · 19.4²) = 1e−327.
const REACH: f64 = 19.4;

/// Distances, in radii from the axis, at which an integrand that follows the density changes: the
/// core, the tails that matter to the sum, the tails that matter to themselves.
const LEVELS: [f64; 7] = [-REACH, -5.0, -2.0, 0.0, 2.0, 5.0, REACH];

/// A circle and the distribution, with the axes so exchanged and mirrored that `y ≥ x ≥ 0`.
#[derive(Clone, Copy, Debug)]
struct Decentred {
    /// The coordinates of the centre.
    x: f64,
    y: f64,
    /// The 1/e² radii of the distribution on the same axes.
    w_x: f64,
    w_y: f64,
    /// The radius of the circle.
    r: f64,
}

/// The fraction of the power within the circle of radius `r` about `centre`.
pub(super) fn power_in_circle([w_x, w_y]: [f64; 2], centre: [f64; 2], r: f64) -> f64 {
    let [x, y] = centre.map(f64::abs);
    // The comparisons below would take it for a circle that holds all, or nothing.
    if x.is_nan() || y.is_nan() || r.is_nan() {
        return f64::NAN;
    }
    let circle = if y >= x {
        Decentred { x, y, w_x, w_y, r }
    } else {
        Decentred {
            x: y,
            y: x,
            w_x: w_y,
            w_y: w_x,
            r,
        }
    };
    circle.power()
}

impl Decentred {
    fn power(self) -> f64 {
        let (wide, slim) = (self.w_x.max(self.w_y), self.w_x.min(self.w_y));
        // No circle, or one that begins where the density has underflowed.
        if self.r <= 0.0 || self.y - self.r > REACH * self.w_y {
            return 0.0;
        }
        // Over the wide radius the edge bends by wide² / 2r, here less than 1e−16 of the slim one.
        // Beyond a ratio of 1e60 one axis is as good as empty, and squares might overflow.
        if self.r / wide > 1e16 * (wide / slim).min(1e60) {
            return self.power_within_straight_edge();
        }
        // A power of two scales without rounding.
        self.scaled(-libm::ilogb(wide)).power_over_chords().min(1.0)
    }

    fn scaled(self, exponent: i32) -> Self {
        let scale = |length| libm::ldexp(length, exponent);
        Self {
            x: scale(self.x),
            y: scale(self.y),
            w_x: scale(self.w_x).max(f64::MIN_POSITIVE),
            w_y: scale(self.w_y).max(f64::MIN_POSITIVE),
            r: scale(self.r),
        }
    }

    /// `x² + y² − r²`, which is negative where the circle holds the axis of the beam.
    ///
    /// The three squares may cancel to their last digit, so each carries its rounding error along.
    fn excess(self) -> f64 {
        let (sum, sum_error) = two_sum(self.y, self.r);
        let (difference, difference_error) = two_sum(self.y, -self.r);
        let (product, product_error) = two_product(sum, difference);
        let (square, square_error) = two_product(self.x, self.x);
        let (total, total_error) = two_sum(product, square);
        let cross = sum * difference_error + sum_error * difference;
        total + (total_error + product_error + square_error + cross)
    }

    /// The power on the inner side of a circle so large that the beam sees a straight edge.
    fn power_within_straight_edge(self) -> f64 {
        let exponent = libm::ilogb(self.r);
        let circle = self.scaled(-exponent);
        let reach = circle.x.hypot(circle.y);
        if reach < 0.5 {
            return 1.0;
        }
        let gap = circle.excess() / (reach + circle.r);
        let (cos, sin) = (circle.x / reach, circle.y / reach);
        let w = (cos * self.w_x).hypot(sin * self.w_y);
        power_beyond(libm::ldexp(gap, exponent), w)
    }

    fn power_over_chords(self) -> f64 {
        let excess = self.excess();
        [1.0, -1.0]
            .into_iter()
            .map(|inward| Half::new(self, excess, inward).power())
            .sum()
    }
}

/// The chords from one end of the circle to its middle, in one of two variables.
///
/// `p` counts towards the middle. If the end of the circle is out of the beam's reach, `p` is the
/// coordinate itself, with its sign chosen. If it is within, the chords grow from it like the
/// square root of the depth, and `p` is that root: the integrand is smooth in it.
#[derive(Clone, Copy, Debug)]
struct Half {
    circle: Decentred,
    excess: f64,
    /// The sign of the direction from the end to the middle.
    inward: f64,
    /// The coordinate of the end, counted inward.
    end: f64,
    rooted: bool,
}

/// One chord of the circle.
struct Chord {
    x: f64,
    half: f64,
    /// dx / dp
    stretch: f64,
}

impl Half {
    fn new(circle: Decentred, excess: f64, inward: f64) -> Self {
        let end = inward * circle.x - circle.r;
        Self {
            circle,
            excess,
            inward,
            end,
            rooted: end.abs() <= 2.0 * REACH * circle.w_x,
        }
    }

    fn power(self) -> f64 {
        let breaks = self.breaks();
        let density = |x: f64| {
            let t = x / self.circle.w_x;
            (2.0 / PI).sqrt() / self.circle.w_x * (-2.0 * t * t).exp()
        };
        integrate_adaptively(
            |p| {
                let chord = self.chord(p);
                density(chord.x) * self.interval(&chord).power(self.circle.w_y) * chord.stretch
            },
            &breaks,
        )
    }

    fn chord(self, p: f64) -> Chord {
        let Decentred { r, .. } = self.circle;
        let (depth, inward_x, stretch) = if self.rooted {
            (p * p, self.end + p * p, 2.0 * p)
        } else {
            (p - self.end, p, 1.0)
        };
        Chord {
            x: self.inward * inward_x,
            half: (depth * (2.0 * r - depth)).max(0.0).sqrt(),
            stretch,
        }
    }

    /// The chord as an interval of y. Where its lower end is a small difference, it follows from
    /// the product of both ends, `excess + x (x − 2 x_c)`.
    fn interval(self, chord: &Chord) -> Interval {
        let Decentred { x, y, .. } = self.circle;
        let interval = Interval::new(y, chord.half);
        if y > 0.5 * chord.half && chord.half > 0.5 * y {
            let ends = self.excess + chord.x * (chord.x - 2.0 * x);
            interval.with_low(ends / (y + chord.half))
        } else {
            interval
        }
    }

    /// The ascending values of `p` between which the integrand is smooth on the scale of a panel:
    /// where the chord reaches a level of the density across it, or lies on one itself.
    fn breaks(self) -> Vec<f64> {
        let Decentred { x, w_x, w_y, .. } = self.circle;
        let last = self.of_coordinate((self.inward * x).min(REACH * w_x));
        let first = if self.rooted && self.end > -REACH * w_x {
            0.0
        } else {
            self.of_coordinate(self.end.max(-REACH * w_x))
        };
        let levels = LEVELS.into_iter();
        let mut breaks: Vec<_> = levels
            .clone()
            .filter_map(|level| self.where_chord_ends_at(level * w_y))
            .chain(levels.map(|level| self.of_coordinate(level * w_x)))
            .filter(|&p| first < p && p < last)
            .chain([first, last.max(first)])
            .collect();
        breaks.sort_by(f64::total_cmp);
        breaks
    }

    /// The variable at the coordinate that is `inward_x` when counted inward.
    fn of_coordinate(self, inward_x: f64) -> f64 {
        if self.rooted {
            // The depth, from the middle of the circle: from its end a small circle loses digits.
            let depth = inward_x - self.inward * self.circle.x + self.circle.r;
            depth.max(0.0).sqrt()
        } else {
            inward_x
        }
    }

    /// The variable where one end of the chord lies at `y`.
    ///
    /// In the rooted variable that is a matter of the depth of a chord. Else it is a root of
    /// `x² − 2 x_c x + excess − y (2 y_c − y)`, taken without cancellation.
    fn where_chord_ends_at(self, y: f64) -> Option<f64> {
        let Decentred { r, .. } = self.circle;
        let half = (self.circle.y - y).abs();
        if half > r {
            return None;
        }
        let root = ((r - half) * (r + half)).sqrt();
        if self.rooted {
            return Some(half / (r + root).sqrt());
        }
        let far = self.circle.x + root;
        if self.inward < 0.0 {
            return Some(-far);
        }
        let product = self.excess - y * (2.0 * self.circle.y - y);
        (far > 0.0).then(|| product / far)
    }
}

/// The rounded sum and its error (D. E. Knuth, *The Art of Computer Programming*, vol. 2, 4.2.2).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// The rounded product and its error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}
