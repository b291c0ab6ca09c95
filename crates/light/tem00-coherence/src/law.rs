use core::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;
use tem00_numerics::{
    Shown, cast::to_usize, check, disc_overlap, quadrature::integrate, sinc_pi_squared,
};

use crate::{
    Refusal, ResolutionCell, Spectrum,
    cell::{Correlation, Difference},
    chebyshev::Tabulated,
    kernel::LagKernel,
    lens,
    spectrum::{LADDER_END, breaks_about},
};

/// Speckle of one rough surface in light of a finite bandwidth.
///
/// The detector adds the intensities of all wave numbers, and the fields of a rough surface are
/// jointly circular Gaussian over position and wave number, so that
///
/// ```text
/// ⟨I(x) I(x')⟩ − ⟨I⟩⟨I'⟩ = ∬ S(k) S(k') |⟨U(x, k) U*(x', k')⟩|² dk dk'
/// ```
///
/// All results are cases of this one law: the contrast is its value at `x = x'`, the covariance of
/// two frames its value where the second is displaced across the pupil, the autocovariance its
/// value along the image, and the noise of a line's centroid its power at low frequencies. These
/// differ: *the noise of a line does not follow from the contrast*.
///
/// # Validity
///
/// The limits of [`ResolutionCell`] and [`Spectrum`] apply. The light is polarised, and the
/// detector integrates over many coherence times.
///
/// # Examples
///
/// A superluminescent diode of 20 nm, head-on, seen under 30°:
///
/// ```
/// use tem00_coherence::{
///     CellGeometry, DVec3, PeakShape, PolychromaticSpeckle, ResolutionCell, Rows, Spectrum,
/// };
///
/// let (sin, cos) = 30_f64.to_radians().sin_cos();
/// let cell = ResolutionCell::new(CellGeometry {
///     to_source: DVec3::Z,
///     to_pupil: DVec3::new(sin, 0.0, cos),
///     normal: DVec3::Z,
///     sin_aperture: 0.025,
///     wavelength: 450e-9,
/// })?;
/// let spectrum = Spectrum::new(450e-9, 20e-9, PeakShape::Gaussian)?;
/// let speckle = PolychromaticSpeckle::new(&spectrum, &cell)?;
/// assert!((speckle.contrast() - 0.731).abs() < 1e-3);
/// assert!((speckle.line_noise_ratio(Rows::Thin) - 0.809).abs() < 1e-3);
/// # Ok::<(), tem00_coherence::Refusal>(())
/// ```
///
/// # References
///
/// - G. Parry, *Speckle patterns in partially coherent light*, in *Laser Speckle and Related
///   Phenomena*, ed. J. C. Dainty, 1975.
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007.
#[derive(Clone, Copy, Debug)]
pub struct PolychromaticSpeckle<'a> {
    /// The spectrum of the light.
    pub spectrum: &'a Spectrum,
    /// The paths of a resolution cell, for the wavelength of the spectrum.
    pub cell: &'a ResolutionCell,
}

impl<'a> PolychromaticSpeckle<'a> {
    /// Creates the speckle of a cell in the light of a spectrum.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelengths of both differ by more than 1 %: the laws measure the
    /// tilt in wave numbers of the cell.
    pub fn new(spectrum: &'a Spectrum, cell: &'a ResolutionCell) -> Result<Self, Refusal> {
        let (wavelength, of_cell) = (spectrum.wavelength(), cell.wavelength());
        let is_same = (wavelength - of_cell).abs() <= 0.01 * of_cell;
        let allowed = format!(
            "at the wavelength of the cell, {} m, to 1 %",
            Shown(of_cell)
        );
        check::that(is_same, "spectrum", wavelength, "m", allowed)?;
        Ok(Self { spectrum, cell })
    }
}

/// Height of the sensor rows, or width of the columns, along which a line is detected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rows {
    /// Finer than a speckle.
    #[default]
    Thin,
    /// Rows of this height, in speckle sizes.
    Height(f64),
    /// Much taller than a speckle. Round spots behave alike.
    Tall,
}

impl Rows {
    /// Height in speckles above which rows count as tall, to 0.005 in f.
    const TALLEST: f64 = 40.0;

    /// Returns f of [`line_noise_ratio`](PolychromaticSpeckle::line_noise_ratio) from a table by
    /// distance and direction, for many displacements of an extended source.
    fn tabulated(self) -> impl Fn(DVec2) -> f64 {
        const DISTANCES: u32 = 96;
        const TURNS: u32 = 24;
        let shared = self.shared_by_all();
        let values: Vec<f64> = (0..=DISTANCES)
            .flat_map(|i| (0..=TURNS).map(move |j| [i, j].map(f64::from)))
            .map(|[i, j]| {
                let turn = FRAC_PI_2 * j / f64::from(TURNS);
                shared(i / f64::from(DISTANCES) * DVec2::from_angle(turn))
            })
            .collect();
        let row = to_usize(f64::from(TURNS)) + 1;
        move |shift| {
            let [x, y] = shift.abs().to_array();
            let i = x.hypot(y) * f64::from(DISTANCES);
            let j = (y.atan2(x) / FRAC_PI_2 * f64::from(TURNS)).min(f64::from(TURNS) - 1e-9);
            if i >= f64::from(DISTANCES) {
                return 0.0;
            }
            let (first, s, t) = (to_usize(i) * row + to_usize(j), i.fract(), j.fract());
            let between = |first: usize| (1.0 - t) * values[first] + t * values[first + 1];
            (1.0 - s) * between(first) + s * between(first + row)
        }
    }

    /// Returns f of [`line_noise_ratio`](PolychromaticSpeckle::line_noise_ratio) as a function of a
    /// displacement along the tilt and across it.
    fn shared_by_all(self) -> impl Fn(DVec2) -> f64 {
        let of_chord = self.power_of_chord();
        let power = move |shift| of_chord.as_ref().map(|of_chord| power_in(shift, of_chord));
        let whole = power(DVec2::ZERO);
        move |shift| match (power(shift), whole) {
            (Some(power), Some(whole)) => power / whole,
            _ => disc_overlap(shift.length()),
        }
    }

    /// Returns `K(L) ∝ ∫ (L − |g|)₊ sinc²(πag) dg` of chords L along the rows, in diameters of the
    /// pupil; `None` for tall rows, whose power is the area.
    fn power_of_chord(self) -> Option<impl Fn(f64) -> f64> {
        const STEPS: f64 = 4096.0;
        let height = match self {
            Self::Thin => 0.0,
            Self::Height(height) => height.max(0.0),
            Self::Tall => f64::INFINITY,
        };
        if height > Self::TALLEST {
            return None;
        }
        // K″ = 2 sinc².
        let (mut slope, mut power) = (0.0, 0.0);
        let table: Vec<f64> = (0..=to_usize(STEPS) + 1)
            .map(|i| {
                let before = power;
                let middle = sinc_pi_squared(height * (i as f64 + 0.5) / STEPS);
                power += slope + 0.5 * middle;
                slope += middle;
                before
            })
            .collect();
        Some(move |chord: f64| {
            let at = chord.clamp(0.0, 1.0) * STEPS;
            let (first, t) = (to_usize(at), at.fract());
            (1.0 - t) * table[first] + t * table[first + 1]
        })
    }

    /// Returns the weight of the contrast kernel, relative to the kernel of tall rows, in the
    /// effect of correlated heights: 0.6 for thin rows, and for others in proportion to the
    /// position of f between thin and tall rows.
    fn weight_of_contrast(self) -> f64 {
        const OF_THIN_ROWS: f64 = 0.6;
        let half = DVec2::new(0.5, 0.0);
        let [this, thin, tall] =
            [self, Self::Thin, Self::Tall].map(|rows| rows.shared_by_all()(half));
        OF_THIN_ROWS * (tall - this) / (tall - thin)
    }
}

/// Returns ∫ K(L) dx over the chords L that cut the lens of two pupils, `shift` diameters apart,
/// across the tilt.
fn power_in(shift: DVec2, of_chord: impl Fn(f64) -> f64) -> f64 {
    let [along, across] = (0.5 * shift.abs()).to_array();
    let half = |x: f64| (0.25 - x * x).max(0.0).sqrt();
    let chord = |x: f64| {
        let (this, other) = (half(x - along), half(x + along));
        (across + this).min(other - across) - (across - this).max(-across - other)
    };
    let end = 0.5 - along;
    if end <= 0.0 {
        return 0.0;
    }
    // Chords end like a square root, and the chords on the other side of the middle are equal.
    let by_root = |t: f64| 4.0 * end * t * of_chord(chord(end * (1.0 - t * t)));
    integrate(by_root, [0.0, 1.0], 0.125)
}

/// Lags in radians across the pupil beyond which less than 3e−9 remains.
const FARTHEST: f64 = 1e3;

impl PolychromaticSpeckle<'_> {
    /// Returns the contrast, standard deviation over mean, `C² = ∫ R(κ) |P̂(κ)|² dκ`.
    pub fn contrast(&self) -> f64 {
        self.covariance([0.0; 2]).sqrt()
    }

    /// Returns the covariance, divided by ⟨I⟩², of two frames in focus between which the field
    /// moved across the pupil by `displacement`, in pupil diameters along the tilt and across it.
    ///
    /// ```text
    /// cov(I₁, I₂) / ⟨I⟩² = ∫ R(κ) exp(−κ² σ_L²) chat²(|m + κ v̂ / κ_t|) dκ
    /// ```
    ///
    /// for a relief without correlation length; without a displacement it is the squared contrast.
    pub fn covariance(&self, displacement: [f64; 2]) -> f64 {
        let displacement = DVec2::from_array(displacement);
        let correlation = Correlation::new(self.cell, self.is_of_many_parts());
        self.mean(|difference| {
            let shift = displacement + difference.shift;
            let moved = Difference {
                shift,
                ..difference
            };
            correlation.squared(moved)
        })
    }

    /// Returns the autocovariance in focus, divided by ⟨I⟩², at a lag on the object, in speckle
    /// sizes along the tilt and across it. Speckles are elongated along the tilt.
    pub fn autocovariance(&self, lag: [f64; 2]) -> f64 {
        let lag = PI * DVec2::from_array(lag);
        self.mean(|difference| {
            // Along the shift and across it.
            let axis = difference.shift.try_normalize().unwrap_or(DVec2::X);
            let [first, second] = [axis.dot(lag), axis.perp_dot(lag)];
            let shift = difference.shift.length();
            let range = first.abs() + second.abs();
            if shift >= 1.0 || range > FARTHEST {
                return 0.0;
            }
            let across = |chord: f64| lens::linear_across(second, chord);
            let lens = lens::mean_over_lens(shift, range, |along| first * along, across);
            lens.norm_sqr() * self.cell.height_correlation(difference.of_heights).powi(2)
        })
    }

    /// Returns the standard deviation of the position of a line divided by its value in light of
    /// one wavelength, for a tilt across the line.
    ///
    /// ```text
    /// √∫ R(κ) exp(−κ² σ_L²) f(s) dκ,     s = |κ| / κ_t
    /// f = 1 − 3s/2 + s³/2               thin rows
    /// f = chat(s)                       tall rows
    /// f = ∫ K(L(x, s)) dx / ∫ K(L(x, 0)) dx,   K(L) = ∫ (L − |g|)₊ sinc²(πag) dg
    ///                                   rows of a speckle sizes
    /// ```
    ///
    /// with the chords L, along the rows, of the lens-shaped overlap of two discs of diameter 1 at
    /// the distance s: K is L² for thin rows and L for tall ones. Directions of an extended source
    /// displace the discs along the rows as well.
    ///
    /// A centroid depends on the power at low frequencies, to which the overlap of the pupils
    /// contributes with its area or its chords and not, as in the contrast, with the square of its
    /// area.
    ///
    /// # Validity
    ///
    /// The ratio holds for lines at least four speckles wide; at a width of two speckles, first
    /// order gives up to 10 % more. Defocus drops out as long as the wavelengths are displaced by
    /// less than the width of the line. For thin rows, a correlation length of the relief is
    /// treated with a mean of two kernels: to 0.005 of the standard deviation without a tilt of the
    /// cell, and to 0.01 with a tilt.
    ///
    /// # References
    ///
    /// - R. G. Dorsch, G. Häusler, J. M. Herrmann, *Laser triangulation: fundamental uncertainty in
    ///   distance measurement*, Applied Optics 33, 1994: the line in light of one wavelength.
    pub fn line_noise_ratio(&self, rows: Rows) -> f64 {
        let variance = if self.cell.source_extent().is_point() {
            self.line_variance_by(rows, rows.shared_by_all())
        } else {
            self.line_variance_by(rows, rows.tabulated())
        };
        variance.sqrt()
    }

    fn line_variance_by(&self, rows: Rows, shared: impl Fn(DVec2) -> f64) -> f64 {
        let contrast_like = rows.weight_of_contrast();
        let kernel = LagKernel { contrast_like };
        let excess = self.cell.height_excess(kernel, self.is_of_many_parts());
        // Heights that are correlated over many speckles do not change f.
        let long = self.cell.correlation_length().powi(2);
        let long = long / (long + 4.0);
        self.mean(|difference| {
            let shared = shared(difference.shift);
            let heights = self.cell.height_correlation(difference.of_heights);
            let dense = shared * heights.powi(2);
            let chat = disc_overlap(difference.shift.length());
            if chat < 1e-9 {
                return dense;
            }
            let scale = shared / (chat * (1.0 - contrast_like * (1.0 - chat)));
            dense + scale.powf(long) * excess.at(difference.of_heights, difference.shift.length())
        })
    }

    /// Returns whether the light has enough parts for tables to save time.
    fn is_of_many_parts(&self) -> bool {
        !self.cell.source_extent().is_point() || self.spectrum.has_many_pairs()
    }

    /// Returns the mean over two parts of the light.
    fn mean(&self, f: impl Fn(Difference) -> f64) -> f64 {
        let (cell, spectrum) = (self.cell, self.spectrum);
        let (extent, scale) = (cell.source_extent(), cell.scale());
        let (wave_number, tilt) = (spectrum.wave_number(), cell.tilt_wave_number().recip());
        let between = |(moved, heights): (DVec2, f64), kappa: f64| {
            f(Difference {
                kappa,
                shift: moved + DVec2::new(kappa * tilt, 0.0),
                of_heights: kappa + heights,
            })
        };
        if extent.is_point() {
            return spectrum.mean_over_pairs(scale, |kappa| between((DVec2::ZERO, 0.0), kappa));
        }
        let feature = 0.5 / (wave_number * cell.greatest_change_with_source());
        let mut changes = Vec::new();
        extent.for_each_difference(cell.source(), feature, |change, share| {
            let (moved, heights) = cell.change_with_source(change);
            changes.push(((wave_number * moved, wave_number * heights), share));
        });
        let over_source = |kappa: f64| {
            let terms = changes.iter();
            terms.fold(0.0, |sum, &(change, share)| {
                sum + share * between(change, kappa)
            })
        };
        if !spectrum.has_width() {
            return spectrum.mean_over_pairs(scale, over_source);
        }
        // There are many directions, and their mean is smooth over wave numbers.
        let unit = scale.min(1e200);
        let over_source =
            Tabulated::new(breaks_about([(0.0, unit)], LADDER_END * unit), over_source);
        spectrum.mean_over_pairs(scale, |kappa| over_source.at(kappa))
    }
}

#[cfg(test)]
pub(crate) mod tests;
