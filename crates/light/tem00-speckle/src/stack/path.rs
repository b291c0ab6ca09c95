use core::f64::consts::PI;

use tem00_numerics::{
    cast::{to_i64, to_signed, to_usize},
    circular_path_overlap,
};

use crate::{Pupil, PupilField, SpeckleError, pupil::lattice::Lattice};

/// Path of the pupil over the lattice from slice to slice of a stack.
///
/// `half_period` is the number M of slices to the first uncorrelated one; the stack is cyclic with
/// 2M slices. More slices need more memory and reduce the error of the blend between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlicePath {
    /// Single slice: the pattern moves, but does not change.
    Still,
    /// A circle of diameter C about the lattice's origin, as in the paper. The pupils of slices i
    /// and i + M lie on opposite sides and just cease to overlap.
    ///
    /// For pupils with rotational symmetry the correlation depends on the distance of two slices
    /// alone; behind a rectangle it also depends on the direction.
    Circle {
        /// Half the number of slices, M.
        half_period: usize,
    },
    /// A straight line along x over a lattice that closes after `length` pupil diameters. Slices
    /// are uncorrelated from `2M / length` slices on, which is M for a length of 2, until `length`
    /// − 1 diameters: a motion up to this length never returns to speckle that it has left.
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

    /// Returns the number of slices per motion of the pupil by its diameter.
    pub const fn slices_per_diameter(self) -> f64 {
        match self {
            Self::Still => 1.0,
            Self::Circle { half_period } => half_period as f64,
            Self::Straight {
                half_period,
                length,
            } => 2.0 * half_period as f64 / length as f64,
        }
    }

    /// Returns the largest motion of the pupil, in pupil diameters, that the slices distinguish
    /// from every smaller motion: the length of their path minus the diameter of the pupil.
    pub const fn reach(self) -> f64 {
        match self {
            Self::Still => 0.0,
            Self::Circle { .. } => 1.0,
            Self::Straight { length, .. } => length as f64 - 1.0,
        }
    }

    /// Returns the memory, in bytes, of a stack of W × H samples along this path: 8 bytes per
    /// sample.
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

    /// Returns the correlation γ of the intensities behind a circular pupil at two coordinates, on
    /// slices and between them, in closed form; 0 unless both are finite.
    ///
    /// It is the correlation of
    /// [`SpeckleStack::correlation_between`](crate::SpeckleStack::correlation_between) before
    /// pupils are rounded to the lattice.
    pub fn correlation_between(self, u: f64, v: f64) -> f64 {
        if !(u.is_finite() && v.is_finite()) {
            return 0.0;
        }
        let taps = |u: f64| {
            let slice = u.floor();
            [(slice, 1.0 - (u - slice)), (slice + 1.0, u - slice)]
        };
        let overlap = |a: f64, b: f64| -> f64 {
            let pairs = taps(a)
                .into_iter()
                .flat_map(|one| taps(b).map(|other| (one, other)));
            pairs
                .map(|((i, of_i), (j, of_j))| of_i * of_j * self.overlap(&Pupil::Circle, [i, j]))
                .sum()
        };
        overlap(u, v).powi(2) / (overlap(u, u) * overlap(v, v))
    }

    /// Checks the number of slices and the length.
    ///
    /// # Errors
    ///
    /// Returns an error if the half period is zero or above
    /// [`MAX_HALF_PERIOD`](Self::MAX_HALF_PERIOD), or if the length is below 2 or above
    /// [`MAX_LENGTH`](Self::MAX_LENGTH).
    pub fn check(self) -> Result<(), SpeckleError> {
        match self {
            Self::Circle { half_period } | Self::Straight { half_period, .. }
                if !(1..=Self::MAX_HALF_PERIOD).contains(&half_period) =>
            {
                let allowed = "1 to 32768 slices";
                Err(SpeckleError::refused("half_period", half_period, allowed))
            }
            Self::Straight { length, .. } if !(2..=Self::MAX_LENGTH).contains(&length) => {
                let allowed = "2 to 32768 pupil diameters";
                Err(SpeckleError::refused("length", length, allowed))
            }
            _ => Ok(()),
        }
    }

    /// The pupil's centre for slice `index`, in pupil diameters.
    pub(crate) fn offset(self, index: usize, field: &PupilField) -> [f64; 2] {
        let centre = self.centre(to_signed(index), field);
        [0, 1].map(|axis| centre[axis] as f64 / field.diameter()[axis])
    }

    /// The field on the lattice on which the path is closed.
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
    pub(crate) fn centre(self, index: i64, field: &PupilField) -> [i64; 2] {
        match self {
            Self::Still => [0, 0],
            Self::Circle { half_period } => {
                let angle = PI * index as f64 / half_period as f64;
                let [x, y] = field.diameter().map(|diameter| 0.5 * diameter);
                [
                    to_i64((x * angle.cos()).round()),
                    to_i64((y * angle.sin()).round()),
                ]
            }
            Self::Straight {
                half_period,
                length,
            } => {
                // i P / (2M), rounded to the nearest integer, on a lattice that closes after P.
                let (period, slices) = (points_along(length, field), to_signed(2 * half_period));
                [(2 * index * period + slices).div_euclid(2 * slices), 0]
            }
        }
    }

    /// The overlap of the pupils of two slices.
    fn overlap(self, pupil: &Pupil, [i, j]: [f64; 2]) -> f64 {
        match self {
            Self::Still => 1.0,
            Self::Circle { half_period } => {
                let half_period = half_period as f64;
                if *pupil == Pupil::Circle {
                    return circular_path_overlap((j - i) / half_period);
                }
                let [(y0, x0), (y1, x1)] = [i, j].map(|slice| (PI * slice / half_period).sin_cos());
                pupil.overlap([0.5 * (x1 - x0), 0.5 * (y1 - y0)])
            }
            Self::Straight {
                half_period,
                length,
            } => {
                let period = (2 * half_period) as f64;
                let steps = (j - i).rem_euclid(period);
                let steps = steps.min(period - steps);
                pupil.overlap([steps * length as f64 / period, 0.0])
            }
        }
    }
}

/// The lattice points along a path of `length` diameters.
fn points_along(length: usize, field: &PupilField) -> i64 {
    to_i64((length as f64 * field.diameter()[0]).round())
}

/// The correlation along a path in closed form, for the continuous pupil.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PathLaw {
    pub(crate) path: SlicePath,
    /// The overlaps of the pupils of each slice with slice 0 and with the next slice, over a
    /// period.
    pub(super) overlaps: Vec<[f64; 2]>,
    /// The smallest overlap with slice 0 up to each slice, to the half period.
    lowest: Vec<f64>,
}

/// Overlaps of a blend of two neighbouring slices with a slice before them: all as overlaps
/// of pupils.
///
/// ```text
/// overlap(f) = [(1 − f) a + f b] / √(1 − 2 f (1 − f) (1 − ρ))
/// ```
///
/// with the overlaps a and b of the earlier slice with the two slices, and the overlap ρ of the
/// two: the blend is divided by its root mean square.
struct Blend {
    overlaps: [f64; 2],
    /// 1 − ρ.
    apart: f64,
}

impl Blend {
    fn overlap(&self, fraction: f64) -> f64 {
        let [a, b] = self.overlaps;
        let power = 1.0 - 2.0 * fraction * (1.0 - fraction) * self.apart;
        (a + fraction * (b - a)) / power.sqrt()
    }

    /// The fraction at which the overlap has fallen to `overlap`, a value between the overlaps of
    /// both slices: the smaller root of A f² + 2 B f + C, whose discriminant has the factor
    /// `overlap`².
    fn fraction(&self, overlap: f64) -> f64 {
        let ([a, b], k, g) = (self.overlaps, self.apart, overlap);
        let step = b - a;
        let half_slope = a * step + k * g * g;
        let rest = ((a - g) * (a + g)).max(0.0);
        let inner = step * step + 2.0 * k * a * b - k * (2.0 - k) * g * g;
        let root = g * inner.max(0.0).sqrt();
        // Both are zero where the overlap has not fallen.
        (rest / (root - half_slope + f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }
}

impl PathLaw {
    pub(crate) fn new(path: SlicePath, pupil: &Pupil) -> Self {
        let overlaps = |slice: usize| {
            let here = slice as f64;
            [[0.0, here], [here, here + 1.0]].map(|slices| path.overlap(pupil, slices))
        };
        let overlaps: Vec<_> = (0..=path.slice_count()).map(overlaps).collect();
        let to_half_period = overlaps.iter().take(path.slice_count() / 2 + 1);
        let lowest = to_half_period.scan(f64::INFINITY, |lowest, [overlap, _]| {
            *lowest = lowest.min(*overlap);
            Some(*lowest)
        });
        Self {
            path,
            lowest: lowest.collect(),
            overlaps,
        }
    }

    /// The amplitude correlation of look-ups at the coordinates 0 and `u`.
    pub(crate) fn overlap_at(&self, u: f64) -> f64 {
        if self.path == SlicePath::Still {
            return 1.0;
        }
        let u = u.rem_euclid(self.path.slice_count() as f64);
        self.blend_after(to_usize(u)).overlap(u.fract())
    }

    /// Replaces each of `overlaps` by the smallest u ≥ 0 at which the overlap has fallen to its
    /// value; NaN counts as no overlap.
    pub(crate) fn coordinates_of(&self, overlaps: &mut [f64]) {
        // The blend in which the previous coordinate was found, and the overlaps to which it falls.
        let (mut before, mut blend) = (0, self.blend_after(0));
        let mut range = self.fall_after(0);
        for overlap in overlaps {
            let u = overlap;
            *u = u.max(0.0);
            if self.path == SlicePath::Still || *u >= 1.0 {
                *u = 0.0;
                continue;
            }
            if !(range[1] <= *u && *u < range[0]) {
                let slice = self.lowest.partition_point(|lowest| lowest > u);
                if slice == self.lowest.len() {
                    *u = (slice - 1) as f64;
                    continue;
                }
                before = slice - 1;
                (blend, range) = (self.blend_after(before), self.fall_after(before));
            }
            *u = before as f64 + blend.fraction(*u);
        }
    }

    /// The smallest overlap with slice 0 up to slice `index`, and up to the next.
    fn fall_after(&self, index: usize) -> [f64; 2] {
        let next = self.lowest.get(index + 1);
        [self.lowest[index], next.copied().unwrap_or(f64::INFINITY)]
    }

    /// The blend of slice `index` and the next, relative to slice 0.
    fn blend_after(&self, index: usize) -> Blend {
        let [here, to_next] = self.overlaps[index];
        let [next, _] = self.overlaps[index + 1];
        Blend {
            overlaps: [here, next],
            apart: 1.0 - to_next,
        }
    }
}
