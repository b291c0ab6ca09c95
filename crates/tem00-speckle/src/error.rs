use core::{error, fmt};

use crate::PupilField;

/// Why a pupil field or a stack could not be constructed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpeckleError {
    /// The pattern size, in samples, is above [`PupilField::MAX_SIZE`].
    Size(usize),
    /// The pupil diameter, in lattice points, is below [`PupilField::MIN_DIAMETER`] or above half
    /// the pattern size.
    Diameter {
        /// The rejected diameter, in lattice points.
        diameter: usize,
        /// The pattern size, in samples.
        size: usize,
    },
    /// The inner diameter of an annulus, in units of the outer one, is not inside (0, 1).
    InnerDiameter(f64),
    /// The height of a rectangle, in units of its width, is not inside (0, 1].
    Height(f64),
    /// The pupil holds fewer phasors than [`PupilField::MIN_PHASORS`].
    PhasorCount(usize),
    /// Half the number of slices is zero or above [`SlicePath::MAX_HALF_PERIOD`].
    ///
    /// [`SlicePath::MAX_HALF_PERIOD`]: crate::SlicePath::MAX_HALF_PERIOD
    HalfPeriod(usize),
    /// The machine refused the memory of a stack.
    Memory {
        /// The bytes that were asked for.
        bytes: u64,
    },
}

impl fmt::Display for SpeckleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size(got) => write!(
                f,
                "size must be at most {} samples, got {got}",
                PupilField::MAX_SIZE
            ),
            Self::Diameter { diameter, size } => write!(
                f,
                "diameter must be at least {} and at most half the size, {} of {size} samples, \
                 got {diameter}",
                PupilField::MIN_DIAMETER,
                size / 2
            ),
            Self::InnerDiameter(got) => write!(
                f,
                "inner diameter must lie between 0 and 1 of the outer diameter, got {got}"
            ),
            Self::Height(got) => write!(
                f,
                "height must be positive and at most 1 of the width, got {got}"
            ),
            Self::PhasorCount(got) => write!(
                f,
                "phasor count must be at least {}, got {got}: enlarge the diameter or open the \
                 pupil",
                PupilField::MIN_PHASORS
            ),
            Self::HalfPeriod(got) => write!(
                f,
                "half period must be 1 to {} slices, got {got}",
                crate::SlicePath::MAX_HALF_PERIOD
            ),
            Self::Memory { bytes } => write!(f, "memory for the stack refused: {bytes} bytes"),
        }
    }
}

impl error::Error for SpeckleError {}
