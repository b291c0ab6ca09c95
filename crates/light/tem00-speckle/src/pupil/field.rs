use core::f64::consts::PI;
use std::sync::Arc;

use num_complex::Complex;
use tem00_numerics::{Fft2, Grid, Shown};

use crate::{
    Phasors, Pupil, SpeckleError,
    pupil::{
        lattice::{Lattice, Seeded, Source},
        mask::Mask,
    },
};

/// A field on the lattice of pupil points, random or measured, seen through the pupil.
///
/// The lattice is unbounded: a pupil may move over it any distance and never meets the same phasors
/// again. The phasor `P(k)` at a point depends on the seed and on k alone. A pupil of C lattice
/// points in diameter, displaced by `offset` diameters, selects the points about `c = offset · C`,
/// and their Fourier transform is the speckle field on Q × Q samples:
///
/// ```text
/// U(r) = Σ t(p) P(k + c₀) exp(2πi a |2p|²) exp(−2πi k·r / Q) / √(Σ |t|²)     p = (k + c₀ − c) / C
/// I(r) = |U(r)|²
/// ```
///
/// with the transmission t of the [`Pupil`], the defocus a, and the lattice point c₀ nearest to c.
/// The sum runs over points about k = 0 for any position of the pupil on the lattice, so that U is
/// band-limited about zero frequency and can be interpolated.
///
/// Patterns need not be square: on W × H samples with speckles h wide the pupil has the diameters
/// W/h and H/h in lattice points, and each component of p is in units of the diameter along its
/// axis.
///
/// # Defocus
///
/// The defocus a is counted in axial decorrelation lengths: it adds a turn of phase per unit from
/// the centre of the pupil to its rim. Speckle in focus and out of focus has the correlation
/// `γ = sinc²(π a)`, whose first zero is at a = 1. A surface that moves by `d` along the line of
/// sight, at the distance L from a pupil of diameter D, is out of focus by `a = d D² / (8 λ L²)`.
///
/// Displacement and defocus together also move the pattern: against the pattern in focus of the
/// pupil at rest, in the frame of the lattice, by `−4 a · offset` speckle sizes.
///
/// # Validity
///
/// The intensity holds spatial frequencies up to C/Q, twice those of the amplitude: C ≤ Q/2 keeps
/// it free of aliasing. C ≥ 8 gives 49 phasors or more, so that the contrast is within 1 % of one.
/// Random phasors repeat after 2³² lattice points along each axis, which is a million diameters for
/// a pupil of 4096 points.
///
/// Any size works; sizes without prime factors above 5 are transformed fastest.
///
/// # Examples
///
/// ```
/// use tem00_speckle::PupilField;
///
/// let field = PupilField::new(256, 64, 1)?;
/// assert_eq!(field.speckle_size(), 4.0);
///
/// let pattern = field.pattern();
/// let values = pattern.values().values();
/// let mean = values.iter().map(|&i| f64::from(i)).sum::<f64>() / values.len() as f64;
/// assert!((mean - 1.0).abs() < 1e-6);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
///
/// # References
///
/// - D. D. Duncan and S. J. Kirkpatrick, *Algorithms for simulation of speckle*, 2008.
/// - D. W. Li and F. P. Chiang, *Decorrelation functions in laser speckle photography*, 1986.
/// - S. Bergmann et al., *A Phenomenological Approach to Integrating Gaussian Beam Properties and
///   Speckle into a Physically-Based Renderer*, 2016, §5.
#[derive(Clone, Debug)]
pub struct PupilField {
    pub(crate) lattice: Lattice,
    size: [usize; 2],
    diameter: [f64; 2],
    speckle_size: f64,
    pupil: Pupil,
    pub(crate) mask: Mask,
    pub(crate) transform: Fft2,
}

/// Sizes of a pattern: its samples, and the lattice points across the pupil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layout {
    pub(crate) size: [usize; 2],
    pub(crate) diameter: [f64; 2],
    pub(crate) speckle_size: f64,
}

impl PupilField {
    /// The largest side of a pattern, in samples: 8 GiB for one square complex field.
    pub const MAX_SIZE: usize = 1 << 15;
    /// The smallest pupil diameter C, in lattice points.
    pub const MIN_DIAMETER: usize = 8;
    /// The smallest number of phasors N: the number in a circle of the smallest diameter.
    pub const MIN_PHASORS: usize = 49;

    /// Creates a square field of unit phasors behind a circular pupil.
    ///
    /// `size` is the pattern size Q in samples, `diameter` the pupil diameter C in lattice points.
    /// A speckle is Q/C samples wide, and the pattern repeats after Q samples or C speckles.
    ///
    /// # Errors
    ///
    /// Returns an error unless `8 ≤ diameter ≤ size / 2` and `16 ≤ size ≤ MAX_SIZE`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::PupilField;
    ///
    /// let aliased = PupilField::new(256, 129, 0);
    /// assert_eq!(aliased.unwrap_err().parameter(), "diameter");
    /// ```
    pub fn new(size: usize, diameter: usize, seed: u64) -> Result<Self, SpeckleError> {
        check_side(size)?;
        if diameter < Self::MIN_DIAMETER || diameter > size / 2 {
            let limits = [Self::MIN_DIAMETER as f64, (size / 2) as f64];
            let allowed = within(limits, "lattice points, half the size at most");
            return Err(SpeckleError::refused("diameter", diameter, allowed));
        }
        let layout = Layout {
            size: [size; 2],
            diameter: [diameter as f64; 2],
            speckle_size: size as f64 / diameter as f64,
        };
        Self::build(seeded(seed), layout, Pupil::Circle)
    }

    /// Creates a field of unit phasors behind a circular pupil, for patterns of `size` = [W, H]
    /// samples whose speckles are `speckle_size` samples wide, in both directions.
    ///
    /// The speckle size h is the period of the intensity's cut-off frequency. The pupil is an
    /// ellipse of W/h by H/h lattice points.
    ///
    /// # Speckle without a lens
    ///
    /// On a screen at the distance z, parallel to a rough surface and near the axis, the lit area
    /// takes the place of the pupil: with the width w it produces speckles of the size `λz / w`,
    /// and [`with_pupil`](Self::with_pupil) sets its shape. A Gaussian spot is cut off: the width w
    /// holds five radii for a pupil of the radius 0.2. A surface that has moved by d through the
    /// light displaces the pupil by `−d / w`: its speckle boils and does not move.
    /// `tem00_statistics::laws::ObjectiveSpeckle` gives the law.
    ///
    /// # Errors
    ///
    /// Returns an error unless both sides are from 16 to `MAX_SIZE` and
    /// `2 ≤ speckle_size ≤ min(W, H) / 8`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::PupilField;
    ///
    /// let field = PupilField::from_speckle_size([640, 480], 3.2, 7)?;
    /// assert_eq!(field.diameter(), [200.0, 150.0]);
    /// assert_eq!(field.pattern().values().height(), 480);
    ///
    /// // A red laser spot of 1 mm on a wall, at 2 m on pixels of 0.5 mm, before and after the wall
    /// // moved by 0.1 mm.
    /// let speckle_size = 650e-9 * 2.0 / 1e-3;
    /// let wall = PupilField::from_speckle_size([256, 192], speckle_size / 0.5e-3, 1)?;
    /// let (before, after) = (wall.pattern(), wall.pattern_at([-0.1, 0.0], 0.0));
    /// assert_ne!(before, after);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn from_speckle_size(
        size: [usize; 2],
        speckle_size: f64,
        seed: u64,
    ) -> Result<Self, SpeckleError> {
        let layout = Layout::new(size, speckle_size)?;
        Self::build(seeded(seed), layout, Pupil::Circle)
    }

    /// Creates a field of external samples behind a circular pupil: a measured or computed complex
    /// amplitude in the pupil plane.
    ///
    /// One sample is one lattice point, and the sample (⌊width/2⌋, ⌊height/2⌋) is the origin, about
    /// which the undisplaced pupil is centred. The field is zero beyond the samples. `size` and
    /// `speckle_size` are as in [`from_speckle_size`](Self::from_speckle_size): for a pupil of C
    /// samples in diameter, request patterns of Q × Q samples and speckles of Q/C.
    ///
    /// Only the shape of the field matters: each pattern is divided by the power within its pupil,
    /// so that its mean is 1 at any position of the pupil. If the pupil contains no power, the
    /// pattern is 0.
    ///
    /// # Errors
    ///
    /// Returns an error unless all samples are finite, both sides are from 16 to `MAX_SIZE` and
    /// `2 ≤ speckle_size ≤ min(W, H) / 8`.
    pub fn from_samples(
        samples: Grid<Complex<f32>>,
        size: [usize; 2],
        speckle_size: f64,
    ) -> Result<Self, SpeckleError> {
        let layout = Layout::new(size, speckle_size)?;
        check_samples(&samples)?;
        let source = Source::Measured(Arc::new(samples));
        Self::build(Lattice::endless(source), layout, Pupil::Circle)
    }

    /// Returns the same field behind a pupil of another shape.
    ///
    /// # Errors
    ///
    /// Returns an error if a proportion of `pupil` is out of range or if the pupil holds fewer than
    /// [`MIN_PHASORS`](Self::MIN_PHASORS) lattice points.
    pub fn with_pupil(self, pupil: Pupil) -> Result<Self, SpeckleError> {
        pupil.check()?;
        let layout = self.layout();
        Self::build(self.lattice, layout, pupil)
    }

    /// Returns the same field behind a pupil of another diameter, for speckles `speckle_size`
    /// samples wide. External samples are shared, not copied.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`from_speckle_size`](Self::from_speckle_size) and
    /// [`with_pupil`](Self::with_pupil).
    pub fn with_speckle_size(self, speckle_size: f64) -> Result<Self, SpeckleError> {
        let layout = Layout::new(self.size, speckle_size)?;
        Self::build(self.lattice, layout, self.pupil)
    }

    /// Returns the same pupil with another law of phasors. External samples do not change.
    #[must_use]
    pub const fn with_phasors(mut self, phasors: Phasors) -> Self {
        if let Source::Seeded(seeded) = &mut self.lattice.source {
            seeded.phasors = phasors;
        }
        self
    }

    /// Returns the same pupil with another, independent set of phasors. External samples do not
    /// change.
    #[must_use]
    pub const fn with_seed(mut self, seed: u64) -> Self {
        if let Source::Seeded(seeded) = &mut self.lattice.source {
            seeded.seed = seed;
        }
        self
    }

    /// Returns the same field with the rest position of the pupil displaced by `points` lattice
    /// points along each axis.
    ///
    /// A stack of the displaced field holds another part of a path than a stack of the field
    /// itself. Slices that both stacks hold have the same speckle.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::PupilField;
    ///
    /// let field = PupilField::new(64, 16, 7)?;
    /// // Two diameters of the pupil.
    /// let farther = field.clone().displaced([32, 0]);
    /// assert_eq!(farther.pattern(), field.pattern_at([2.0, 0.0], 0.0));
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    #[must_use]
    pub fn displaced(mut self, points: [i64; 2]) -> Self {
        self.lattice = self.lattice.displaced(points);
        self
    }

    /// Returns the lattice point of the phasors or samples at which the pupil rests: the origin
    /// unless the field has been [displaced](Self::displaced).
    pub const fn origin(&self) -> [i64; 2] {
        self.lattice.origin
    }

    /// Returns the same field on a lattice that closes after `period` points along each axis.
    pub(crate) const fn closed(mut self, period: [i64; 2]) -> Self {
        self.lattice.period = period;
        self
    }

    /// Returns the displacement between two lattice points, along the shorter way round the
    /// lattice.
    pub(crate) fn shift(&self, from: [i64; 2], to: [i64; 2]) -> [i64; 2] {
        self.lattice.nearest([to[0] - from[0], to[1] - from[1]])
    }

    fn build(lattice: Lattice, layout: Layout, pupil: Pupil) -> Result<Self, SpeckleError> {
        let Layout { size, diameter, .. } = layout;
        let mask = Mask::new(&pupil, diameter, [0.0; 2]);
        // For equal phasors (Σ|t|²)² / Σ|t|⁴ is an integer up to rounding.
        let effective = mask.effective_count() * (1.0 + 1e-12);
        if effective < Self::MIN_PHASORS as f64 {
            let allowed =
                "open for at least 49 equal phasors (enlarge the diameter or open the pupil)";
            return Err(SpeckleError::refused("pupil", effective.floor(), allowed));
        }
        let [columns, rows] = mask.extent();
        let transform = Fft2::with_aperture(size[0], size[1], columns, rows)
            .map_err(|_| not_a_side(size[0].max(size[1])))?;
        Ok(Self {
            lattice,
            size,
            diameter,
            speckle_size: layout.speckle_size,
            pupil,
            mask,
            transform,
        })
    }

    pub(crate) const fn layout(&self) -> Layout {
        Layout {
            size: self.size,
            diameter: self.diameter,
            speckle_size: self.speckle_size,
        }
    }

    /// Returns the width and the height of the pattern, in samples.
    pub const fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the nominal pupil diameter along each axis, in lattice points.
    pub const fn diameter(&self) -> [f64; 2] {
        self.diameter
    }

    /// Returns the speckle size `Q / C`, in samples.
    ///
    /// This is the period of the intensity's cut-off frequency, `λ d / D` on the sensor. The first
    /// zero of a circular pupil's autocovariance lies at 1.22 speckle sizes, its full width at half
    /// maximum is 1.03.
    pub const fn speckle_size(&self) -> f64 {
        self.speckle_size
    }

    /// Returns the shape of the pupil.
    pub const fn pupil(&self) -> &Pupil {
        &self.pupil
    }

    /// Returns the seed, or `None` for external samples.
    pub const fn seed(&self) -> Option<u64> {
        match &self.lattice.source {
            Source::Seeded(seeded) => Some(seeded.seed),
            Source::Measured(_) => None,
        }
    }

    /// Returns the law of the phasors, or `None` for external samples.
    pub const fn phasors(&self) -> Option<Phasors> {
        match &self.lattice.source {
            Source::Seeded(seeded) => Some(seeded.phasors),
            Source::Measured(_) => None,
        }
    }

    /// Returns the external samples, or `None` for random phasors.
    pub fn samples(&self) -> Option<&Grid<Complex<f32>>> {
        match &self.lattice.source {
            Source::Seeded(_) => None,
            Source::Measured(samples) => Some(samples),
        }
    }

    /// Returns the number N of lattice points inside the undisplaced pupil.
    pub const fn phasor_count(&self) -> usize {
        self.mask.count()
    }

    /// Returns the number of phasors of equal weight with the same fluctuations as the pupil.
    ///
    /// ```text
    /// N = (Σ |t|²)² / Σ |t|⁴
    /// ```
    ///
    /// It equals the count unless the pupil is apodised. The squared contrast of unit phasors is
    /// `1 − 1/N`.
    pub fn effective_phasor_count(&self) -> f64 {
        self.mask.effective_count()
    }

    /// Returns the diameter `2√(N/π)` of the disc whose area is the pupil's N lattice cells.
    ///
    /// With this diameter the Airy autocovariance of a circular pupil holds within 1.3e−3 in every
    /// direction at C = 32, and within 3e−4 at C = 128. With the nominal C the deviations are
    /// 4.1e−3 and 6e−4. For a pattern that is not square it is the geometric mean over both axes.
    pub fn effective_diameter(&self) -> f64 {
        2.0 * (self.phasor_count() as f64 / PI).sqrt()
    }

    /// Returns the exact amplitude correlation μ of two samples that are `lag` samples apart.
    ///
    /// ```text
    /// μ(lag) = Σ |t|² exp(−2πi k·lag / Q) / Σ |t|²
    /// ```
    ///
    /// It is 1 at zero lag, has the period of the pattern, and is real for pupils with a centre of
    /// symmetry. The autocovariance of the intensity is `|μ|²` for Gaussian phasors and
    /// `|μ|² − 1/N` for unit phasors, with the [effective](Self::effective_phasor_count) number N.
    ///
    /// # Panics
    ///
    /// Panics unless both lags are finite.
    pub fn amplitude_correlation(&self, lag: [f64; 2]) -> Complex<f64> {
        assert!(
            lag.iter().all(|l| l.is_finite()),
            "the lag {lag:?} is not finite"
        );
        self.mask.correlation(lag, self.size)
    }

    /// Returns the amplitude correlation between the field of the pupil and the field of the same
    /// pupil displaced by `shift` lattice points.
    ///
    /// ```text
    /// Σ t(k) t*(k − shift) / Σ |t|²
    /// ```
    ///
    /// Without apodisation it is the fraction of the lattice points that both share, counted
    /// exactly. [`Pupil::overlap`] is its limit for a fine lattice.
    pub fn overlap(&self, shift: [i64; 2]) -> Complex<f64> {
        let [x, y] = self.lattice.nearest(shift);
        // On a lattice that closes early a displaced pupil may overlap from both sides.
        self.sides()
            .map(|side| self.overlap_on_one_side([x + side[0], y + side[1]]))
            .sum()
    }

    /// Returns the overlap of two pupils `shift` apart, on this side of the periodic lattice only.
    pub(crate) fn overlap_on_one_side(&self, shift: [i64; 2]) -> Complex<f64> {
        self.mask.overlap(shift) / self.mask.power()
    }

    /// The displacements by up to one period of the lattice.
    pub(crate) fn sides(&self) -> impl Iterator<Item = [i64; 2]> {
        let [x, y] = self.lattice.period;
        [-x, 0, x]
            .into_iter()
            .flat_map(move |x| [-y, 0, y].map(|y| [x, y]))
    }
}

impl PartialEq for PupilField {
    fn eq(&self, other: &Self) -> bool {
        // The mask and the plan follow from these fields.
        self.lattice == other.lattice
            && self.size == other.size
            && self.diameter == other.diameter
            && self.pupil == other.pupil
    }
}

impl Layout {
    fn new(size: [usize; 2], speckle_size: f64) -> Result<Self, SpeckleError> {
        size.into_iter().try_for_each(check_side)?;
        let largest = size[0].min(size[1]) as f64 / PupilField::MIN_DIAMETER as f64;
        if !(speckle_size >= 2.0 && speckle_size <= largest) {
            return Err(not_a_speckle_size(speckle_size, largest));
        }
        Ok(Self {
            size,
            diameter: size.map(|side| side as f64 / speckle_size),
            speckle_size,
        })
    }
}

const fn seeded(seed: u64) -> Lattice {
    Lattice::endless(Source::Seeded(Seeded {
        seed,
        phasors: Phasors::Unit,
    }))
}

/// Refuses a side that is too short for the smallest pupil, or longer than
/// [`PupilField::MAX_SIZE`].
fn check_side(side: usize) -> Result<(), SpeckleError> {
    if (2 * PupilField::MIN_DIAMETER..=PupilField::MAX_SIZE).contains(&side) {
        Ok(())
    } else {
        Err(not_a_side(side))
    }
}

/// The refusal of a side of a pattern.
pub(crate) fn not_a_side(side: usize) -> SpeckleError {
    SpeckleError::refused("size", side as f64, "16 to 32768 samples")
}

fn within([min, max]: [f64; 2], unit: &str) -> String {
    format!("{} to {} {unit}", Shown(min), Shown(max))
}

fn not_a_speckle_size(speckle_size: f64, largest: f64) -> SpeckleError {
    let allowed = within([2.0, largest], "samples in a pattern of that size");
    SpeckleError::refused("speckle_size", speckle_size, allowed)
}

fn check_samples(samples: &Grid<Complex<f32>>) -> Result<(), SpeckleError> {
    let finite = |z: &Complex<f32>| z.re.is_finite() && z.im.is_finite();
    match samples.values().iter().position(|z| !finite(z)) {
        None => Ok(()),
        Some(bad) => {
            let z = samples.values()[bad];
            let (x, y) = (bad % samples.width(), bad / samples.width());
            let allowed = format!("finite at column {x} of row {y}");
            Err(SpeckleError::refused(
                "samples",
                [z.re.into(), z.im.into()],
                allowed,
            ))
        }
    }
}

#[cfg(test)]
mod tests;
