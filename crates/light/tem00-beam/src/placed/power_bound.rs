//! Bounds of the fraction of the power that reaches a box.

use core::f64::consts::FRAC_2_PI;

use super::axis::Axis;
use super::frame::Frame;
use crate::normal::{normal_between, normal_density};

/// Largest error of a probability by rounding.
pub(super) const ROUNDING: f64 = 1e-15;

/// A box in the frame of a light, in front of its aperture.
#[derive(Clone, Copy, Debug)]
#[expect(unnameable_types, reason = "it belongs to a sealed trait")]
pub struct LocalBox {
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
    pub(super) z: [f64; 2],
}

impl LocalBox {
    /// Encloses the part of a world box that lies in front of the aperture; `None` if there is
    /// none.
    pub(super) fn around(frame: &Frame, min: [f64; 3], max: [f64; 3]) -> Option<Self> {
        let along = |axis: [f64; 3]| {
            let mut range = [0.0; 2];
            for i in 0..3 {
                let (e, origin) = (axis[i], frame.origin[i]);
                let [a, b] = [min[i], max[i]].map(|end| e * (end - origin));
                // A difference of coordinates is accurate to the rounding error of the larger one.
                let slack = 4.0 * f64::EPSILON * (a.abs() + b.abs() + (e * origin).abs());
                range[0] += a.min(b) - slack;
                range[1] += a.max(b) + slack;
            }
            range
        };
        let is_empty = (0..3).any(|i| min[i] > max[i]);
        let [x, y, z] = [frame.ex, frame.ey, frame.ez].map(along);
        let met = z[1] >= 0.0 && !is_empty;
        let z = [z[0].max(0.0), z[1]];
        met.then_some(Self { x, y, z })
    }
}

/// Returns a bound of the probability that a ray is in the range `x` somewhere at the distances
/// `dz` from its waist, along one axis; 0 if `x` is beyond the cut-off, in beam radii.
///
/// In units of its standard deviation `w/2` a ray is at `u cos δ + v sin δ`, with independent
/// standard normal u and v and the Gouy phase δ, taken from the middle of its range ±Δ. With `x` in
/// these units, widened to its largest extent over `dz`, the inequality
/// `x₀ ≤ u cos δ + v sin δ ≤ x₁` implies that
///
/// ```text
/// x₀' − |v| tan Δ ≤ u ≤ x₁' + |v| tan Δ     where x' = x / cos Δ if that widens the range, else x
/// u² + v² ≥ x²                              for the x that is nearest to 0
/// ```
///
/// and `⟨|v|⟩ = √(2/π)`, `P(u² + v² ≥ x²) = exp(−x²/2)`.
pub(super) fn chance(axis: &Axis, dz: [f64; 2], x: [f64; 2], cutoff: f64) -> f64 {
    let nearest = dz[0].max(-dz[1]).max(0.0);
    let deviation = |dz: f64| 0.5 * (axis.w0_sq + axis.theta_sq * dz * dz).sqrt();
    let smallest = deviation(nearest);
    let largest = deviation(dz[0]).max(deviation(dz[1]));
    let outwards = |x: f64| if x > 0.0 { x / smallest } else { x / largest };
    let (low, high) = (-outwards(-x[0]), outwards(x[1]));
    let nearest = low.max(-high).max(0.0);
    if nearest > 2.0 * cutoff {
        return 0.0;
    }
    let phase = |dz: f64| (dz * (axis.theta_sq / axis.w0_sq).sqrt()).atan();
    let (sin, cos) = (0.5 * (phase(dz[1]) - phase(dz[0]))).sin_cos();
    let widened = |x: f64| if x > 0.0 { x / cos } else { x };
    let (low, high) = (-widened(-low), widened(high));
    let crossing = |x: f64| sin / cos * FRAC_2_PI.sqrt() * normal_density(x.max(0.0), 1.0);
    let sides = crossing(high) + crossing(-low);
    let bound = normal_between(low, high) + sides + ROUNDING;
    bound.min((-0.5 * nearest * nearest).exp())
}
