use pyo3::prelude::*;
use tem00_speckle as physics;

use super::arguments::counts;
use crate::{
    arrays::Whole,
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// The way the pupil takes over the lattice from slice to slice of a stack.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlicePath(pub(super) physics::SlicePath);

#[pymethods]
impl SlicePath {
    /// The largest half period.
    #[classattr]
    const MAX_HALF_PERIOD: usize = physics::SlicePath::MAX_HALF_PERIOD;
    /// The greatest length of a straight path, in pupil diameters.
    #[classattr]
    const MAX_LENGTH: usize = physics::SlicePath::MAX_LENGTH;

    /// Return the path of one slice: the pattern moves, but does not change.
    #[staticmethod]
    const fn still() -> Self {
        Self(physics::SlicePath::Still)
    }

    /// Return a circle about the lattice's origin, as wide as the pupil.
    ///
    /// Parameters
    /// ----------
    /// half_period : int
    ///     Half the number of slices, M. Slices i and i + M just cease to overlap.
    #[staticmethod]
    fn circle(half_period: Whole<'_>) -> PyResult<Self> {
        Self::checked(physics::SlicePath::Circle {
            half_period: half_period.unsigned("half_period")?,
        })
    }

    /// Return a straight line along x that closes after ``length`` pupil diameters.
    ///
    /// Parameters
    /// ----------
    /// half_period : int
    ///     Half the number of slices, M. Slices are uncorrelated from 2 M / length slices on.
    /// length : int
    ///     Length of the path in pupil diameters, at least 2.
    #[staticmethod]
    fn straight(half_period: Whole<'_>, length: Whole<'_>) -> PyResult<Self> {
        Self::checked(physics::SlicePath::Straight {
            half_period: half_period.unsigned("half_period")?,
            length: length.unsigned("length")?,
        })
    }

    /// Return the bytes of a stack of width x height samples along this path: 8 per sample.
    ///
    /// Parameters
    /// ----------
    /// size : (int, int)
    ///     Width and height in samples.
    fn memory_bytes(&self, size: [Whole<'_>; 2]) -> PyResult<u64> {
        Ok(self.0.memory_bytes(counts("size", &size)?))
    }

    pub(super) fn __repr__(&self) -> String {
        match self.0 {
            physics::SlicePath::Still => "SlicePath.still()".to_owned(),
            physics::SlicePath::Circle { half_period } => {
                format!("SlicePath.circle(half_period={half_period})")
            }
            physics::SlicePath::Straight {
                half_period,
                length,
            } => format!("SlicePath.straight(half_period={half_period}, length={length})"),
        }
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        match self.0 {
            physics::SlicePath::Still => by_constructor::<Self>(py, "still", ()),
            physics::SlicePath::Circle { half_period } => {
                by_constructor::<Self>(py, "circle", (half_period,))
            }
            physics::SlicePath::Straight {
                half_period,
                length,
            } => by_constructor::<Self>(py, "straight", (half_period, length)),
        }
    }
}

methods! {
    impl SlicePath as this: this.0;

    unmade "still, circle or straight";

    /// "still", "circle" or "straight".
    get kind -> &'static str = match this.0 {
        physics::SlicePath::Still => "still",
        physics::SlicePath::Circle { .. } => "circle",
        physics::SlicePath::Straight { .. } => "straight",
    };

    /// Half the number of slices, M, or None of a still path.
    get half_period -> Option<usize> = match this.0 {
        physics::SlicePath::Still => None,
        physics::SlicePath::Circle { half_period }
        | physics::SlicePath::Straight { half_period, .. } => Some(half_period),
    };

    /// Length of a straight path in pupil diameters, or None.
    get length -> Option<usize> = match this.0 {
        physics::SlicePath::Straight { length, .. } => Some(length),
        _ => None,
    };

    /// Number of slices: 1, or 2 M.
    get slice_count -> usize;
}

impl SlicePath {
    fn checked(path: physics::SlicePath) -> PyResult<Self> {
        path.check().or_raise()?;
        Ok(Self(path))
    }
}
