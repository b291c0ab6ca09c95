use core::fmt;

use num_complex::Complex;
use tem00_numerics::{Grid, disc_overlap, parallel};

use crate::{
    PupilField, SpeckleError,
    interpolation::{spline::Variance, taps::Period},
};

mod blend;
mod join;
mod look_up;
mod memory;
mod path;
mod plan;
mod quadrature;
mod slice_law;
mod source;

pub(crate) use join::Slice;
use join::join_all;
pub use memory::StackOptions;
pub(crate) use memory::{check_limit, dark, reserve};
use path::PathLaw;
pub use path::SlicePath;
pub use plan::{StackNeeds, StackPlan};
pub use slice_law::SliceLaw;
pub use source::StackSource;

/// Speckle that moves and decorrelates: slices of one random field behind a moving pupil.
///
/// A look-up takes a position (x, y) in samples and a coordinate u in slices. Along x and y the
/// pattern repeats after Q samples, along u after 2M slices. The correlation of two slices follows
/// from the overlap ρ of their pupils, γ = ρ². For slices Δu apart it is
///
/// ```text
/// circle:    ρ(Δu) = 1 − s − sin(π s)/π    s = Δu / M
/// straight:  ρ(Δu) = chat(Δu length / (2 M))
/// ```
///
/// # Interpolation
///
/// Slices hold complex amplitudes, not intensities: interpolated amplitudes of a Gaussian random
/// process are Gaussian again, so that the intensity keeps its exponential law at every coordinate
/// once it is divided by the variance after interpolation. In the plane the interpolation is a
/// cubic B-spline over 4 × 4 coefficients, prefiltered in the pupil, with the variance in closed
/// form. Between slices it is a linear blend in the common frame of the lattice:
///
/// ```text
/// U = (1 − f) U_i + f U_{i+1} exp(−2πi (c_{i+1} − c_i)·r / Q)
/// I = |U|² / ((1 − f)² v_i + f² v_{i+1} + 2 f (1 − f) w_i)
/// ```
///
/// with the pupil centres c, the variance v of the interpolated amplitude and its covariance w
/// between the two slices, both as functions of the fractions of x and y. At the samples w is the
/// overlap of the two pupils, counted on the lattice; between samples it is the covariance after
/// interpolation of the light in both pupils. For an external field, v and w are computed from the
/// light in the pupils, slice by slice.
///
/// # Validity
///
/// - Pupil centres are rounded to the lattice, which changes the overlap of two slices by up to
///   about 1/C relative to the closed form. [`correlation_between`](Self::correlation_between) is
///   exact.
/// - The spline's rms error of the field is 4.3e−3 at a speckle size of 2 samples and 2e−4 at 4
///   samples, and twice as large behind a square pupil. It changes the autocovariance by up to
///   3.8e−3 and 1.3e−4, but neither mean nor contrast.
/// - The mean is 1 at every coordinate up to 3e−6, the rounding of `f32`, and between slices of a
///   pupil without symmetry up to 2e−5, the error of the polynomials for their covariance. The one
///   exception is M = 1, where both pupils may contain the same points of the rim on opposite
///   sides: the overlap is 1/N for a disc and up to 1/C for a rectangle.
/// - Between slices the correlation is the correlation of the blend, which the methods below
///   include:
///
///   ```text
///   γ(0, i + f) = [(1 − f) ρ(i) + f ρ(i + 1)]² / [1 − 2 f (1 − f) (1 − ρ(1))]
///   ```
///
///   It depends on both coordinates, and not on their distance alone: on a circle it exceeds ρ² at
///   the same distance by up to 0.2 for 2M = 16 slices and 0.06 for 64 slices; relative to slice 0,
///   by up to 0.11 and 0.03.
///
/// # Examples
///
/// ```
/// use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
///
/// let field = PupilField::new(64, 16, 7)?;
/// let stack = SpeckleStack::generate(&field, SlicePath::Circle { half_period: 4 })?;
///
/// // The coordinate at which the speckle has kept half its correlation.
/// let u = stack.coordinate_of(0.5);
/// assert!((stack.correlation_at(u) - 0.5).abs() < 1e-9);
///
/// // Look-ups repeat with the periods Q and 2M.
/// let here = stack.intensity_at(3.5, 60.25, u);
/// assert!((stack.intensity_at(3.5 - 64.0, 60.25 + 64.0, u + 8.0) - here).abs() < 1e-4);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct SpeckleStack {
    pub(crate) field: PupilField,
    pub(crate) law: PathLaw,
    /// The periods along x, y and u.
    pub(crate) periods: [Period; 3],
    pub(crate) slices: Vec<Slice>,
    /// Variances: one for all slices, or one for each slice.
    pub(crate) variances: Vec<Variance>,
}

/// Without the samples, which fill a screen a million times.
impl fmt::Debug for SpeckleStack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SpeckleStack")
            .field("size", &self.field.size())
            .field("path", &self.path())
            .finish_non_exhaustive()
    }
}

impl SpeckleStack {
    /// Generates the slices of `field` along `path`.
    ///
    /// # Errors
    ///
    /// Returns an error if the half period or the length of `path` is out of range, or if the
    /// memory for [`SlicePath::memory_bytes`] cannot be allocated.
    pub fn generate(field: &PupilField, path: SlicePath) -> Result<Self, SpeckleError> {
        Self::generate_with(field, path, StackOptions::default())
    }

    /// Generates the slices of `field` along `path` within a limit of memory.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`generate`](Self::generate), and an error if the slices take more
    /// than the memory limit.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{PupilField, SlicePath, SpeckleError, SpeckleStack, StackOptions};
    ///
    /// let field = PupilField::new(64, 16, 7)?;
    /// let path = SlicePath::Circle { half_period: 4 };
    /// let frugal = StackOptions { memory_limit: 200_000 };
    ///
    /// let refused = SpeckleStack::generate_with(&field, path, frugal);
    /// let needed = 8 * 64 * 64 * 8; // slices of 64 × 64 samples of 8 bytes
    /// assert_eq!(refused, Err(SpeckleError::MemoryLimit { needed, limit: 200_000 }));
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn generate_with(
        field: &PupilField,
        path: SlicePath,
        options: StackOptions,
    ) -> Result<Self, SpeckleError> {
        let source = StackSource::new(field, path, options)?;
        let field = source.field();
        let reserved = reserve(path, field.size())?;
        let slices = parallel::map_items_with(reserved, |scratch, index, room| {
            let mut slice = dark(room, field.size())?;
            field.amplitude_into(&source.slice(index), &mut slice, scratch);
            Ok(slice)
        });
        let slices = slices.into_iter().collect::<Result<_, SpeckleError>>()?;
        Ok(Self::assemble(source.into_field(), path, slices))
    }

    /// Assembles a stack from the coefficients of the slices of `field`, on the closed lattice of
    /// the path.
    pub(crate) fn assemble(
        field: PupilField,
        path: SlicePath,
        coefficients: Vec<Grid<Complex<f32>>>,
    ) -> Self {
        let periods = [field.size()[0], field.size()[1], coefficients.len()].map(Period::new);
        let (slices, variances) = join_all(&field, path, coefficients);
        Self {
            law: PathLaw::new(path, field.pupil()),
            periods,
            slices,
            variances,
            field,
        }
    }

    /// Returns the field from which the slices were cut. For a straight path the field closes on
    /// itself after the length of the path.
    pub const fn field(&self) -> &PupilField {
        &self.field
    }

    /// Returns the path of the pupil.
    pub const fn path(&self) -> SlicePath {
        self.law.path
    }

    /// Returns the coefficients of slice `index` that the look-up interpolates, the coefficients of
    /// the prefiltered spline.
    ///
    /// # Panics
    ///
    /// Panics unless `index < slice_count`.
    pub fn coefficients(&self, index: usize) -> &Grid<Complex<f32>> {
        &self.slices[index].coefficients
    }

    /// Returns the closed forms of slice `index` and of its join to the next slice.
    ///
    /// # Panics
    ///
    /// Panics unless `index < slice_count`.
    pub fn slice_law(&self, index: usize) -> SliceLaw {
        SliceLaw::of(&self.slices[index])
    }

    /// Returns the periods in the plane, in samples: the width and the height.
    pub const fn size(&self) -> [usize; 2] {
        self.field.size()
    }

    /// Returns the speckle size `Q / C`, in samples.
    pub const fn speckle_size(&self) -> f64 {
        self.field.speckle_size()
    }

    /// Returns the number of slices: the period in u, 2M, or 1 for a still stack.
    pub const fn slice_count(&self) -> usize {
        self.slices.len()
    }

    /// Returns the memory of the slices, in bytes.
    pub const fn memory_bytes(&self) -> u64 {
        self.law.path.memory_bytes(self.field.size())
    }

    /// Returns the position of the pupil of slice `index`, in pupil diameters.
    ///
    /// At integer u the stack is the field's [`PupilField::pattern_at`] this offset.
    ///
    /// # Panics
    ///
    /// Panics unless `index < slice_count`.
    pub fn offset(&self, index: usize) -> [f64; 2] {
        assert!(
            index < self.slices.len(),
            "slice {index} of a stack of {}",
            self.slices.len()
        );
        self.law.path.offset(index, &self.field)
    }

    /// Returns the correlation γ of the intensities looked up at u = 0 and u = `distance`, in
    /// closed form.
    ///
    /// It is the correlation of look-ups with the pattern of slice 0, on slices and between them.
    /// For any two coordinates use [`correlation_between`](Self::correlation_between); the two
    /// methods differ by the rounding of pupil centres. The function is even and has the period of
    /// the stack; for a still stack it is 1. For a `distance` that is not finite it is 0.
    ///
    /// # Validity
    ///
    /// For pupils with aberrations it uses the magnitudes of the overlaps, as if the light of all
    /// slices were in phase.
    pub fn correlation_at(&self, distance: f64) -> f64 {
        if !distance.is_finite() {
            return 0.0;
        }
        self.law.overlap_at(distance.abs()).powi(2)
    }

    /// Returns the coordinate u, in slices, at which a look-up has a given `correlation` with the
    /// reference pattern at u = 0: the inverse of [`correlation_at`](Self::correlation_at).
    ///
    /// A correlation of 1 or more gives the distance 0. A correlation of 0 or less, and NaN, gives
    /// the first uncorrelated slice: M on the circle, the first slice from `2 M / length` on along
    /// the straight path. For a still stack the distance is always 0. If the law is not monotonic
    /// (an annulus), the result is the smallest distance.
    pub fn coordinate_of(&self, correlation: f64) -> f64 {
        let mut coordinate = [correlation];
        self.coordinates_of(&mut coordinate);
        coordinate[0]
    }

    /// Replaces each correlation by its coordinate, as [`coordinate_of`](Self::coordinate_of)
    /// returns it.
    ///
    /// Neighbours between the same two slices are found fastest.
    pub fn coordinates_of(&self, correlations: &mut [f64]) {
        for value in &mut *correlations {
            *value = value.sqrt();
        }
        self.law.coordinates_of(correlations);
    }

    /// Returns the coordinate u, in slices, for a `shift` of the pupil over the speckle, in pupil
    /// diameters, to one side or the other.
    ///
    /// The look-up at this coordinate has the correlation chat²(s) with the reference pattern at u
    /// = 0, as the shift leaves it, and its speckle differs from the speckle of every smaller
    /// shift. Shifts beyond the [reach](SlicePath::reach) of the path, and NaN, count as the reach:
    /// the speckle is new. For a pupil that is not circular, a shift is converted by the
    /// correlation that it would leave behind a circular pupil.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
    ///
    /// let path = SlicePath::Straight { half_period: 32, length: 4 };
    /// let stack = SpeckleStack::generate(&PupilField::new(64, 16, 7)?, path)?;
    ///
    /// let u = stack.coordinate_at(0.25);
    /// assert!((stack.correlation_at(u) - 0.469_276_571_606_7).abs() < 1e-9);
    /// assert_eq!(stack.coordinate_at(-0.25), -u);
    /// assert_eq!(stack.coordinate_at(f64::INFINITY), 3.0 * path.slices_per_diameter());
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn coordinate_at(&self, shift: f64) -> f64 {
        let mut coordinate = [shift.abs()];
        self.coordinates_within(self.path().reach(), &mut coordinate);
        coordinate[0].copysign(shift)
    }

    /// Replaces each shift, to one side, by its coordinate, as
    /// [`coordinate_at`](Self::coordinate_at) returns it, for a `reach` other than the reach of the
    /// path: if one side of the reference gets only a part of the path, or if the slices are a part
    /// of a longer path.
    ///
    /// Neighbours between the same two slices are found fastest.
    pub fn coordinates_within(&self, reach: f64, shifts: &mut [f64]) {
        const BLOCK: usize = 64;
        let per_diameter = self.path().slices_per_diameter();
        for shifts in shifts.chunks_mut(BLOCK) {
            let mut overlaps = [0.0; BLOCK];
            let overlaps = &mut overlaps[..shifts.len()];
            for (overlap, shift) in overlaps.iter_mut().zip(&mut *shifts) {
                *shift = shift.min(reach);
                *overlap = disc_overlap(*shift);
            }
            // The coordinate where the blend of two slices has the same correlation with the
            // reference pattern as the shift; beyond zero correlation, the position farther along
            // the path.
            self.law.coordinates_of(overlaps);
            for (shift, u) in shifts.iter_mut().zip(&*overlaps) {
                *shift = u.max(*shift * per_diameter);
            }
        }
    }
}

#[cfg(test)]
mod tests;
