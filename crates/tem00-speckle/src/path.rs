use core::f64::consts::PI;

use tem00_numerics::{circular_path_overlap, circular_path_overlap_inverse, disc_overlap_inverse};

use crate::{
    Pupil, PupilField, SpeckleError,
    lattice::{Lattice, to_i64},
    mask::{from_i64, to_f64},
};

/// The way the pupil takes over the lattice from slice to slice of a stack.
///
/// `half_period` is the number M of slices to the first uncorrelated one; the stack is cyclic with
/// 2M slices. More slices cost memory and buy a smaller error of the blend between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlicePath {
    /// One slice: the pattern moves, but does not change.
    Still,
    /// A circle of diameter C about the lattice's origin, as in the paper. Slices i and i + M stand
    /// on opposite sides and just cease to overlap.
    ///
    /// The correlation depends on the distance of two slices alone for pupils of rotational
    /// symmetry; behind a rectangle it also depends on the direction.
    Circle {
        /// Half the number of slices, M.
        half_period: usize,
    },
    /// A straight line along x over a lattice that closes after `length` pupil diameters. Slices
    /// are uncorrelated from `2M / length` slices on, which is M for a length of 2, until `length` − 1
    /// diameters: a motion over so many diameters never returns to speckle it has left.
    Straight {
        /// Half the number of slices, M.
        half_period: usize,
        /// The length of the path in pupil diameters, at least 2.
        length: usize,
    },
}

impl SlicePath {
    /// The largest half period M.
    pub const MAX_HALF_PERIOD: usize = 1 << 15;
    /// The greatest length of a straight path, in pupil diameters.
    pub const MAX_LENGTH: usize = 1 << 15;

    /// Returns the number of slices: 1, or 2M.
    pub const fn slice_count(self) -> usize {
        match self {
            Self::Still => 1,
            Self::Circle { half_period } | Self::Straight { half_period, .. } => {
                half_period.saturating_mul(2)
            }
        }
    }

    /// Returns the bytes of a stack of W × H samples along this path: 8 per sample.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::SlicePath;
    ///
    /// let bytes = SlicePath::Circle { half_period: 16 }.memory_bytes([1024, 1024]);
    /// assert_eq!(bytes, 32 * 1024 * 1024 * 8); // 256 MiB
    /// ```
    pub const fn memory_bytes(self, size: [usize; 2]) -> u64 {
        let samples = (size[0] as u64).saturating_mul(size[1] as u64);
        samples
            .saturating_mul(8)
            .saturating_mul(self.slice_count() as u64)
    }

    /// Tells whether a stack can follow this path.
    ///
    /// # Errors
    ///
    /// Returns an error if the half period is zero or above [`MAX_HALF_PERIOD`](Self::MAX_HALF_PERIOD),
    /// or the length below 2 or above [`MAX_LENGTH`](Self::MAX_LENGTH).
    pub const fn check(self) -> Result<(), SpeckleError> {
        match self {
            Self::Circle { half_period } | Self::Straight { half_period, .. }
                if half_period == 0 || half_period > Self::MAX_HALF_PERIOD =>
            {
                Err(SpeckleError::HalfPeriod(half_period))
            }
            Self::Straight { length, .. } if length < 2 || length > Self::MAX_LENGTH => {
                Err(SpeckleError::PathLength(length))
            }
            _ => Ok(()),
        }
    }

    /// The pupil's centre for slice `index`, in its diameters.
    pub(crate) fn offset(self, index: usize, field: &PupilField) -> [f64; 2] {
        let centre = self.centre(index, field);
        [0, 1].map(|axis| from_i64(centre[axis]) / field.diameter()[axis])
    }

    /// The field on the lattice that the path closes on.
    pub(crate) fn close(self, field: &PupilField) -> PupilField {
        match self {
            Self::Still | Self::Circle { .. } => field.clone(),
            Self::Straight { length, .. } => {
                let period = [points_along(length, field), Lattice::SIDE];
                field.clone().closed(period)
            }
        }
    }

    /// The pupil's centre for slice `index`, rounded to the lattice so that all pupils hold the
    /// same points.
    pub(crate) fn centre(self, index: usize, field: &PupilField) -> [i64; 2] {
        match self {
            Self::Still => [0, 0],
            Self::Circle { half_period } => {
                let angle = PI * to_f64(index) / to_f64(half_period);
                let [x, y] = field.diameter().map(|diameter| 0.5 * diameter);
                [round(x * angle.cos()), round(y * angle.sin())]
            }
            Self::Straight {
                half_period,
                length,
            } => {
                // i P / (2M), rounded to the nearest integer, on a lattice that closes after P.
                let (period, slices) = (points_along(length, field), to_i64(2 * half_period));
                [(2 * to_i64(index) * period + slices) / (2 * slices), 0]
            }
        }
    }
}

/// The lattice points along a path of `length` diameters.
fn points_along(length: usize, field: &PupilField) -> i64 {
    round(to_f64(length) * field.diameter()[0])
}

#[expect(clippy::cast_possible_truncation, reason = "lattice points are small")]
fn round(x: f64) -> i64 {
    x.round() as i64
}

/// The correlation along a path in closed form, for the continuous pupil.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PathLaw {
    pub(crate) path: SlicePath,
    pub(crate) pupil: Pupil,
}

impl PathLaw {
    /// The amplitude correlation of the coordinates 0 and `u`.
    pub(crate) fn overlap_at(&self, u: f64) -> f64 {
        match self.path {
            SlicePath::Still => 1.0,
            SlicePath::Circle { half_period } => {
                let half_turns = u / to_f64(half_period);
                if self.pupil == Pupil::Circle {
                    return circular_path_overlap(half_turns);
                }
                let (sin, cos) = (PI * half_turns.rem_euclid(2.0)).sin_cos();
                self.pupil.overlap([0.5 * (1.0 - cos), 0.5 * sin])
            }
            SlicePath::Straight {
                half_period,
                length,
            } => {
                let period = to_f64(2 * half_period);
                let steps = u.rem_euclid(period);
                let steps = steps.min(period - steps);
                self.pupil.overlap([steps * to_f64(length) / period, 0.0])
            }
        }
    }

    /// The smallest u ≥ 0 at which the overlap has fallen to `overlap`.
    pub(crate) fn coordinate_of(&self, overlap: f64) -> f64 {
        match (self.path, &self.pupil) {
            (SlicePath::Still, _) => 0.0,
            (SlicePath::Circle { half_period }, Pupil::Circle) => {
                to_f64(half_period) * circular_path_overlap_inverse(overlap)
            }
            (
                SlicePath::Straight {
                    half_period,
                    length,
                },
                Pupil::Circle,
            ) => to_f64(2 * half_period) / to_f64(length) * disc_overlap_inverse(overlap),
            (SlicePath::Circle { half_period } | SlicePath::Straight { half_period, .. }, _) => {
                self.first_crossing(overlap, to_f64(half_period))
            }
        }
    }

    /// Scan and bisection, for pupils whose overlap has no closed inverse or is not monotonic.
    fn first_crossing(&self, overlap: f64, half_period: f64) -> f64 {
        const STEPS: u32 = 256;
        if overlap >= 1.0 {
            return 0.0;
        }
        let overlap = overlap.max(0.0); // NaN counts as no correlation, too
        let step = half_period / f64::from(STEPS);
        let fallen = |u: f64| self.overlap_at(u) <= overlap;
        let Some(end) = (1..STEPS).map(|i| f64::from(i) * step).find(|&u| fallen(u)) else {
            return half_period;
        };
        let (mut low, mut high) = (end - step, end);
        for _ in 0..52 {
            let middle = 0.5 * (low + high);
            if fallen(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }
}
