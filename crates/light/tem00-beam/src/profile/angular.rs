use core::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use tem00_numerics::check;

use super::density::{SlopeProfile, Variable};
use crate::Refusal;
use crate::normal::{HALF_SPACING, interior, normal_between, normal_density};

/// The smallest accepted distance between two angles, in radians: finer than any measurement.
const MIN_SPACING: f64 = 1e-12;

/// The smallest fraction of an interval's power between a drawn angle and either knot.
const MIN_PART: f64 = 1e-12;

/// The number of standard deviations beyond which a normal distribution is negligible in `f64`.
const NORMAL_REACH: f64 = 9.0;

/// The power of a laser line per fan angle, from the table of a data sheet or of a measurement.
///
/// The power per angle is linear between the angles of the table and 0 outside them. Its integral
/// is normalised to 1, so that the table may be in any unit; the cumulative power and its inverse
/// have closed forms.
///
/// A clone shares the table.
///
/// # Examples
///
/// A line that is twice as bright at its centre as at its edges at ±30°:
///
/// ```
/// use tem00_beam::AngularProfile;
///
/// let angles = [-30_f64, 0.0, 30.0].map(f64::to_radians);
/// let profile = AngularProfile::new(&angles, &[0.5, 1.0, 0.5])?;
///
/// let knots = profile.knots();
/// assert!((knots[1].cumulative - 0.5).abs() < 1e-15);
/// // ∫ f dθ = 0.75 · 60° · f(0)
/// assert!((knots[1].density * 45_f64.to_radians() - 1.0).abs() < 1e-15);
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AngularProfile {
    knots: Arc<[AngularKnot]>,
}

/// Node of an [`AngularProfile`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngularKnot {
    /// Signed angle from the axis, in radians.
    pub angle: f64,
    /// Fraction of the power per angle, in rad⁻¹.
    pub density: f64,
    /// Fraction of the power below the angle, from 0 to 1.
    pub cumulative: f64,
}

impl AngularProfile {
    /// Creates a profile from angles, in radians, and the power per angle at each, in any unit.
    ///
    /// # Errors
    ///
    /// Returns an error if the two slices differ in length or are shorter than 2, if an angle is
    /// not in (−π/2, π/2) or less than 1e−12 rad above the previous angle, if a power is negative
    /// or not finite, or if all powers are 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::AngularProfile;
    ///
    /// let unsorted = AngularProfile::new(&[-0.3, 0.3, 0.0], &[0.0, 1.0, 0.0]);
    /// let refusal = unsorted.unwrap_err();
    /// assert_eq!((refusal.parameter, refusal.index), ("angles", Some(2)));
    /// ```
    pub fn new(angles: &[f64], powers: &[f64]) -> Result<Self, Refusal> {
        if angles.len() != powers.len() || angles.len() < 2 {
            let lengths = [angles.len() as f64, powers.len() as f64];
            let allowed = "as many as angles, and at least 2";
            return Err(Refusal::new("powers", lengths, allowed));
        }
        let mut minimum = f64::NEG_INFINITY;
        for (index, &angle) in angles.iter().enumerate() {
            let holds = angle >= minimum && angle.abs() < FRAC_PI_2;
            let allowed = "ascending within (-π/2, π/2) rad";
            check::that(holds, "angles", angle, "rad", allowed)
                .map_err(|refusal| refusal.at(index))?;
            minimum = angle + MIN_SPACING;
        }
        check::each(powers, |power| check::not_negative("powers", power, ""))?;
        let peak = powers.iter().copied().fold(0.0, f64::max);
        check::that(
            peak > 0.0,
            "powers",
            peak,
            "",
            "greater than 0 at some angle",
        )?;
        let table = angles.iter().zip(powers);
        let relative = table.map(|(&angle, power)| (angle, power / peak)).collect();
        Ok(Self {
            knots: normalised(relative).into(),
        })
    }

    /// Creates a profile from pairs of an angle, in radians, and the power per angle there.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new).
    pub fn from_pairs(pairs: &[(f64, f64)]) -> Result<Self, Refusal> {
        let (angles, powers): (Vec<_>, Vec<_>) = pairs.iter().copied().unzip();
        Self::new(&angles, &powers)
    }

    /// Returns the angles of the table, with the normalised density and its integral at each.
    pub fn knots(&self) -> &[AngularKnot] {
        &self.knots
    }

    /// Returns the table as a density along the fan.
    pub(crate) fn table(&self) -> AngularTable<'_> {
        AngularTable(&self.knots)
    }
}

/// Integrates and normalises a table whose largest power is 1.
fn normalised(table: Vec<(f64, f64)>) -> Vec<AngularKnot> {
    let mut sum = 0.0;
    let mut before = table[0];
    let mut knots = Vec::with_capacity(table.len());
    for (angle, density) in table {
        sum += 0.5 * (density + before.1) * (angle - before.0);
        before = (angle, density);
        knots.push(AngularKnot {
            angle,
            density,
            cumulative: sum,
        });
    }
    for knot in &mut knots {
        knot.density /= sum;
        knot.cumulative /= sum;
    }
    knots
}

/// The knots of a table as a density along the fan; dark if there are fewer than two.
#[derive(Clone, Copy, Debug)]
#[expect(unnameable_types, reason = "it belongs to a sealed trait")]
pub struct AngularTable<'a>(pub(crate) &'a [AngularKnot]);

impl<'a> AngularTable<'a> {
    /// Returns the knots about the first one for which `beyond` holds.
    fn interval(self, beyond: impl Fn(&AngularKnot) -> bool) -> Option<Interval> {
        let last = self.0.len().checked_sub(1)?;
        let end = self.0.partition_point(|knot| !beyond(knot)).min(last);
        let start = end.checked_sub(1)?;
        Some(Interval {
            start: self.0[start],
            end: self.0[end],
        })
    }

    fn interval_at(self, angle: f64) -> Option<Interval> {
        self.interval(|knot| knot.angle > angle)
    }

    /// Returns the density per radian at an angle.
    fn density_at(self, angle: f64) -> f64 {
        match self.interval_at(angle) {
            Some(interval) if interval.holds(angle) => interval.density_at(angle),
            _ => 0.0,
        }
    }

    /// Returns the density per radian after a normal deviate has been added to the angle.
    fn spread_at(self, angle: f64, sigma: f64) -> f64 {
        let reach = NORMAL_REACH * sigma;
        let near = self.0.partition_point(|knot| knot.angle < angle - reach);
        let knots = &self.0[near.saturating_sub(1)..];
        let intervals = knots.windows(2).map(|pair| Interval {
            start: pair[0],
            end: pair[1],
        });
        let met = intervals.take_while(|interval| interval.start.angle <= angle + reach);
        met.map(|interval| interval.spread_at(angle, sigma))
            .sum::<f64>()
            .max(0.0)
    }

    /// Returns the fraction of the power below an angle.
    fn cumulative_at(self, angle: f64) -> f64 {
        self.interval_at(angle)
            .map_or(0.0, |interval| interval.cumulative_at(angle))
    }

    /// Moves an angle away from the ends of the table by the rounding of its slope.
    fn off_the_ends(self, angle: f64) -> f64 {
        let [first, last] = self.ends();
        let margin = self.margin();
        angle.max(first + margin).min(last - margin)
    }

    /// Returns the first and the last angle.
    fn ends(self) -> [f64; 2] {
        [self.0.first(), self.0.last()].map(|knot| knot.map_or(0.0, |knot| knot.angle))
    }

    /// Returns the distance from the ends within which the rounding of a slope may leave the table.
    fn margin(self) -> f64 {
        let [first, last] = self.ends();
        // Four units in the last place: two for the slope, two for its arc tangent.
        16.0 * HALF_SPACING * first.abs().max(last.abs())
    }
}

/// Two neighbouring knots.
struct Interval {
    start: AngularKnot,
    end: AngularKnot,
}

impl Interval {
    fn holds(&self, angle: f64) -> bool {
        (self.start.angle..=self.end.angle).contains(&angle)
    }

    /// Returns the fraction of the interval that lies below an angle, from 0 to 1.
    fn part_below(&self, angle: f64) -> f64 {
        let part = (angle - self.start.angle) / (self.end.angle - self.start.angle);
        part.clamp(0.0, 1.0)
    }

    fn density_at(&self, angle: f64) -> f64 {
        let part = self.part_below(angle);
        self.start.density + part * (self.end.density - self.start.density)
    }

    /// Returns the contribution of the interval to the density after a normal deviate of density φ
    /// has been added to the angle. In units of `sigma` from the angle, the density is α + m t:
    ///
    /// ```text
    /// ∫ (α + m t) φ(t) dt = α (Φ(b) − Φ(a)) − m (φ(b) − φ(a))     from a to b
    /// ```
    fn spread_at(&self, angle: f64, sigma: f64) -> f64 {
        let [a, b] = [&self.start, &self.end].map(|knot| (knot.angle - angle) / sigma);
        let m = (self.end.density - self.start.density) / (b - a);
        let alpha = self.start.density - m * a;
        alpha * normal_between(a, b) - m * (normal_density(b, 1.0) - normal_density(a, 1.0))
    }

    /// The density is linear, so its mean up to an angle is the mean of its end values.
    fn cumulative_at(&self, angle: f64) -> f64 {
        let part = self.part_below(angle);
        let mean = 0.5 * (self.start.density + self.density_at(angle));
        self.start.cumulative + mean * part * (self.end.angle - self.start.angle)
    }

    /// Returns the angle below which the fraction `p` of all power lies.
    ///
    /// With the densities a and b at the ends, the fraction q of the power of the interval lies in
    /// its part t, where `2 a t + (b − a) t² = q (a + b)`. The root, in the form without
    /// cancellation, is `t = q (a + b) / (a + √((1 − q) a² + q b²))`.
    fn angle_at(&self, p: f64) -> f64 {
        let power = self.end.cumulative - self.start.cumulative;
        // Keep off the knots, where the density may be 0.
        let q = ((p - self.start.cumulative) / power).clamp(MIN_PART, 1.0 - MIN_PART);
        let scale = self.start.density.max(self.end.density);
        let [a, b] = [self.start.density, self.end.density].map(|density| density / scale);
        let t = q * (a + b) / (a + ((1.0 - q) * a * a + q * b * b).sqrt());
        // An interval without power gives 0 / 0, which is NaN.
        let t = if t <= 1.0 { t } else { 1.0 };
        self.start.angle + t * (self.end.angle - self.start.angle)
    }
}

impl SlopeProfile for AngularTable<'_> {
    fn per_slope(&self, u: f64) -> f64 {
        self.per_angle(u) / (1.0 + u * u)
    }

    fn per_angle(&self, u: f64) -> f64 {
        self.density_at(u.atan())
    }

    fn spread_per_angle(&self, u: f64, sigma: f64) -> f64 {
        self.spread_at(u.atan(), sigma)
    }

    /// The table itself ends the light.
    fn reaches(&self, _: f64, _: f64) -> bool {
        true
    }

    fn largest_slope(&self, _: f64) -> f64 {
        let ends = [self.0.first(), self.0.last()];
        let angles = ends.into_iter().flatten();
        let widest = angles.fold(0.0, |widest: f64, knot| widest.max(knot.angle.abs()));
        Variable::Angle.slope(widest)
    }

    fn quantile(&self, p: f64) -> f64 {
        let p = interior(p);
        let angle = self
            .interval(|knot| knot.cumulative > p)
            .map_or(0.0, |interval| self.off_the_ends(interval.angle_at(p)));
        Variable::Angle.slope(angle)
    }

    fn between(&self, a: f64, b: f64) -> f64 {
        let [below_a, below_b] = [a, b].map(|u| self.cumulative_at(u.atan()));
        below_b - below_a
    }
}

#[cfg(test)]
mod tests;
