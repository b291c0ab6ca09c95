//! Positions of a measurement, and estimates along them.

use tem00_numerics::check;

use super::error::FitError;

/// A fitted value and its standard error, in the same unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The best-fit value.
    pub value: f64,
    /// The standard deviation of the value over repeated measurements, to first order.
    pub standard_error: f64,
}

/// Checks that both lists have equal lengths and at least `needed` entries.
pub(super) fn check_count(
    positions: &[f64],
    values: &[f64],
    needed: usize,
) -> Result<(), FitError> {
    if positions.len() != values.len() {
        return Err(FitError::LengthsDiffer {
            positions: positions.len(),
            values: values.len(),
        });
    }
    if positions.len() < needed {
        return Err(FitError::TooFewPoints {
            got: positions.len(),
            needed,
        });
    }
    Ok(())
}

/// The positions of a measurement, mapped to the interval [−1, 1].
///
/// The fits work on such coordinates, so that the unit of the data makes no difference.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    pub(super) middle: f64,
    pub(super) half_range: f64,
    pub(super) coordinates: Vec<f64>,
}

impl Axis {
    pub(super) fn new(positions: &[f64]) -> Result<Self, FitError> {
        check::each(positions, |x| check::coordinate("positions", x))?;
        let first = positions.iter().copied().fold(f64::INFINITY, f64::min);
        let last = positions.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (middle, half_range) = (0.5 * first + 0.5 * last, 0.5 * last - 0.5 * first);
        if half_range < f64::MIN_POSITIVE {
            return Err(FitError::EqualPositions);
        }
        let coordinates = positions.iter().map(|x| (x - middle) / half_range);
        Ok(Self {
            middle,
            half_range,
            coordinates: coordinates.collect(),
        })
    }

    /// The position of an estimated coordinate.
    pub(super) fn position(&self, coordinate: f64, variance: f64) -> Estimate {
        Estimate {
            value: self.middle + self.half_range * coordinate,
            standard_error: self.half_range * variance.sqrt(),
        }
    }
}
