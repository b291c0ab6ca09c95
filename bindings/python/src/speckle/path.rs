use pyo3::prelude::*;
use tem00_speckle::{SlicePath as Path, SpeckleError};

use crate::pickling::Value;

class! {
    /// The way the pupil takes over the lattice from slice to slice of a stack.
    "tem00.speckle" SlicePath(Path): Copy
}

methods! {
    impl SlicePath as this: this.0;

    unmade "still, circle or straight";

    /// Return the path of one slice: the pattern moves, but does not change.
    make still() = PyResult::Ok(Path::Still);

    /// Return a circle about the lattice's origin, as wide as the pupil.
    ///
    /// Parameters
    /// ----------
    /// half_period : int
    ///     Half the number of slices, M. Slices i and i + M just cease to overlap.
    make circle(half_period: usize) = checked(Path::Circle { half_period });

    /// Return a straight line along x that closes after ``length`` pupil diameters.
    ///
    /// Parameters
    /// ----------
    /// half_period : int
    ///     Half the number of slices, M. Slices are uncorrelated from 2 M / length slices on.
    /// length : int
    ///     Length of the path in pupil diameters, at least 2.
    make straight(half_period: usize, length: usize) =
        checked(Path::Straight { half_period, length });

    /// Return the bytes of a stack of width x height samples along this path: 8 per sample.
    ///
    /// Parameters
    /// ----------
    /// size : (int, int)
    ///     Width and height in samples.
    fn memory_bytes(size: [usize; 2]) -> u64 = this.0.memory_bytes(size);

    /// Number of slices: 1, or 2 M.
    get slice_count -> usize;

    made_as match this.0 {
        Path::Still => ("still", vec![]),
        Path::Circle { half_period } => ("circle", vec![Value::Count(half_period)]),
        Path::Straight { half_period, length } => {
            ("straight", vec![Value::Count(half_period), Value::Count(length)])
        }
    };
}

fn checked(path: Path) -> Result<Path, SpeckleError> {
    path.check().map(|()| path)
}
