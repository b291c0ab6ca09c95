use num_complex::Complex;
use tem00_numerics::Grid;

use crate::{Boundary, StatisticsError, laws::VORTEX_DENSITY};

/// A phase singularity, or vortex, of a complex field: a point of intensity zero around which the
/// phase turns once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Singularity {
    /// The column of the cell: the singularity lies between this sample and the next.
    pub x: usize,
    /// The row of the cell.
    pub y: usize,
    /// +1 if the phase grows by 2π in the sense from the x to the y axis, −1 if it falls.
    pub charge: i8,
}

/// Finds the phase singularities of a sampled field, cell by cell, in the order of its rows.
///
/// The charge of a cell is the number of turns of the phase along its four corners. It is counted
/// in integers, so that the charge inside any closed path is exactly the number of turns along the
/// path; over a [`Periodic`](Boundary::Periodic) field the charges add up to exactly 0. Cells of a
/// [`Finite`](Boundary::Finite) field have all corners inside.
///
/// # Bias
///
/// Where the field is nearly zero between two samples its phase seems to jump, and a spurious pair
/// of opposite charges appears in neighbouring cells: for speckles of h ≥ 3 samples the count is
/// too large by the fraction 1.5/h², by simulation. Two singularities of opposite charge in one
/// cell cancel.
///
/// # Independence
///
/// No independence is assumed. Singularities of opposite charge are neighbours: charges screen each
/// other.
///
/// # Errors
///
/// Returns an error if a component of the field is not finite. Its index counts the samples.
///
/// # Examples
///
/// ```
/// use num_complex::Complex;
/// use tem00_numerics::Grid;
/// use tem00_statistics::{Boundary, estimate::{Singularity, phase_singularities}};
///
/// let vortex = Grid::from_fn(4, 4, |x, y| Complex::new(x as f32 - 1.3, y as f32 - 2.6));
/// let found = phase_singularities(&vortex, Boundary::Finite)?;
/// assert_eq!(found, [Singularity { x: 1, y: 2, charge: 1 }]);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
pub fn phase_singularities(
    field: &Grid<Complex<f32>>,
    boundary: Boundary,
) -> Result<Vec<Singularity>, StatisticsError> {
    check_field(field)?;
    let (columns, rows) = cells(field, boundary);
    let mut found = Vec::new();
    for y in 0..rows {
        let (upper, lower) = (field.row(y), field.row((y + 1) % field.height()));
        for x in 0..columns {
            let next = (x + 1) % field.width();
            let corners = [upper[x], upper[next], lower[next], lower[x]];
            let charge = turns(corners);
            if charge != 0 {
                found.push(Singularity { x, y, charge });
            }
        }
    }
    Ok(found)
}

/// Returns the numbers of columns and rows of cells.
fn cells(field: &Grid<Complex<f32>>, boundary: Boundary) -> (usize, usize) {
    match boundary {
        Boundary::Periodic => (field.width(), field.height()),
        Boundary::Finite => (field.width() - 1, field.height() - 1),
    }
}

fn check_field(field: &Grid<Complex<f32>>) -> Result<(), StatisticsError> {
    let bad = |value: &Complex<f32>| !value.is_finite();
    match field.values().iter().position(bad) {
        Some(index) => {
            let Complex { re, im } = field.values()[index];
            let value = if re.is_finite() { im } else { re };
            Err(StatisticsError::refused_at(
                index, "samples", value, "finite",
            ))
        }
        None => Ok(()),
    }
}

/// Returns the number of turns of the phase around four corners and back.
fn turns([a, b, c, d]: [Complex<f32>; 4]) -> i8 {
    crossing(a, b) + crossing(b, c) + crossing(c, d) + crossing(d, a)
}

/// Returns +1 where the straight line from `a` to `b` crosses the negative real axis
/// counterclockwise, −1 where clockwise, and 0 where it does not.
///
/// The line from `b` to `a` gives exactly the opposite: products of two `f32` are exact in `f64`,
/// so that the sign of their difference is exact, and a line through zero itself counts as no
/// crossing in either direction.
fn crossing(a: Complex<f32>, b: Complex<f32>) -> i8 {
    let (from_above, to_above) = (a.im >= 0.0, b.im >= 0.0);
    let turn = f64::from(a.re) * f64::from(b.im) - f64::from(a.im) * f64::from(b.re);
    if from_above && !to_above && turn > 0.0 {
        1
    } else if !from_above && to_above && turn < 0.0 {
        -1
    } else {
        0
    }
}

/// An estimate of the number of phase singularities per area.
///
/// ```text
/// density = count / cells          per squared sample, π / 8h² for speckles of the size h
/// ```
///
/// # Bias
///
/// The bias is the same as for [`phase_singularities`].
///
/// # Independence
///
/// Singularities repel like charges and attract opposite ones, and their number fluctuates less
/// than the number of independent points. The standard error, `√(0.56 count) / cells`, is valid for
/// fully developed speckle behind a circular pupil in a field many speckles across; the factor was
/// found by simulation.
///
/// # Examples
///
/// ```
/// use num_complex::Complex;
/// use tem00_numerics::Grid;
/// use tem00_statistics::{Boundary, estimate::VortexDensity};
///
/// let vortex = Grid::from_fn(11, 11, |x, y| Complex::new(x as f32 - 4.5, y as f32 - 3.5));
/// let density = VortexDensity::from_field(&vortex, Boundary::Finite)?;
/// assert_eq!((density.count(), density.value()), (1, 0.01));
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VortexDensity {
    count: usize,
    cells: usize,
}

/// The variance of the number of singularities divided by its mean, 1 for independent points.
const NUMBER_VARIANCE: f64 = 0.56;

impl VortexDensity {
    /// Counts the singularities of `field`.
    ///
    /// # Errors
    ///
    /// Returns an error if a component of the field is not finite or a finite field is less than
    /// two samples wide or high.
    pub fn from_field(
        field: &Grid<Complex<f32>>,
        boundary: Boundary,
    ) -> Result<Self, StatisticsError> {
        let (columns, rows) = cells(field, boundary);
        if columns * rows == 0 {
            return Err(StatisticsError::too_few_samples(field.values().len(), 4));
        }
        Ok(Self {
            count: phase_singularities(field, boundary)?.len(),
            cells: columns * rows,
        })
    }

    /// Returns the number of singularities.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Returns the number of singularities per squared sample.
    pub fn value(&self) -> f64 {
        self.count as f64 / self.cells as f64
    }

    /// Returns the standard error of the density, per squared sample.
    pub fn standard_error(&self) -> f64 {
        (NUMBER_VARIANCE * self.count as f64).sqrt() / self.cells as f64
    }

    /// Returns the speckle size h with this density, in samples: `√(π / 8 density)`; `None` if
    /// there is no singularity.
    pub fn speckle_size(&self) -> Option<f64> {
        (self.count > 0).then(|| (VORTEX_DENSITY / self.value()).sqrt())
    }
}

#[cfg(test)]
mod tests;
