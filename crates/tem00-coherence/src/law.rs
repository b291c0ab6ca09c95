use core::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex;
use tem00_numerics::{cast::to_usize, disc_overlap, quadrature::integrate, sinc_pi_squared};

use crate::{
    Relief, ResolutionCell, SpectralLine,
    cell::{image_autocorrelation, image_of_point},
    eigenvalues::hermitian_eigenvalues,
    lens, mode_ratio,
};

/// The speckle that light of a finite bandwidth makes of one rough surface.
///
/// The detector adds the intensities of all wave numbers, and fields of a rough surface are jointly circular Gaussian
/// over place and wave number, so that
///
/// ```text
/// ⟨I(x) I(x')⟩ − ⟨I⟩⟨I'⟩ = ∬ S(k) S(k') |⟨U(x, k) U*(x', k')⟩|² dk dk'
/// ```
///
/// All answers are cases of this one law: the contrast at `x = x'`, the covariance of two frames where the second is
/// displaced across the pupil, the autocovariance along the image, and the noise of a line's centroid, the power at
/// low frequencies. They differ: *a contrast does not tell the noise of a line*.
///
/// # Validity
///
/// That of [`ResolutionCell`] and of [`SpectralLine`], polarised light, and a detector that integrates over many coherence
/// times.
///
/// # Examples
///
/// A superluminescent diode of 20 nm, head-on, seen under 30°:
///
/// ```
/// use tem00_coherence::{
///     CellGeometry, DVec3, LineShape, PolychromaticSpeckle, ResolutionCell, Rows, SpectralLine,
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
/// let line = SpectralLine::new(450e-9, 20e-9, LineShape::Gaussian)?;
/// let speckle = PolychromaticSpeckle { line: &line, cell: &cell };
/// assert!((speckle.contrast() - 0.731).abs() < 1e-3);
/// assert!((speckle.line_noise(Rows::Thin).sqrt() - 0.809).abs() < 1e-3);
/// # Ok::<(), tem00_coherence::CoherenceError>(())
/// ```
///
/// # References
///
/// - G. Parry, *Speckle patterns in partially coherent light*, in *Laser Speckle and Related Phenomena*, ed. J. C.
///   Dainty, 1975.
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007.
#[derive(Clone, Copy, Debug)]
pub struct PolychromaticSpeckle<'a> {
    /// The spectrum of the light.
    pub line: &'a SpectralLine,
    /// The paths of a resolution cell.
    pub cell: &'a ResolutionCell,
}

/// The rows or columns of a sensor along which a line is looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rows {
    /// Finer than a speckle.
    #[default]
    Thin,
    /// Of this height, in speckle sizes.
    Height(f64),
    /// Much taller than a speckle; round spots are alike.
    Tall,
}

impl Rows {
    /// Rows taller than so many speckles count as tall: to 0.005 in f.
    const TALLEST: f64 = 40.0;

    /// Returns f of [`line_noise`](PolychromaticSpeckle::line_noise) for s from 0 to 1.
    fn shared_by_all(self) -> impl Fn(f64) -> f64 {
        const STEPS: f64 = 128.0;
        let table: Vec<f64> = match self {
            Self::Height(_) => (0..=128)
                .map(|i| self.shared(f64::from(i) / STEPS))
                .collect(),
            Self::Thin | Self::Tall => Vec::new(),
        };
        move |s| {
            if table.is_empty() {
                return self.shared(s);
            }
            let at = (s * STEPS).min(STEPS - 1e-9);
            let (first, t) = (to_usize(at), at.fract());
            (1.0 - t) * table[first] + t * table[first + 1]
        }
    }

    /// Returns how much of the kernel of a contrast, in place of that of tall rows, the correlation of heights takes:
    /// 0.6 for thin rows, and for others as f lies between both.
    fn weight_of_contrast(self) -> f64 {
        const OF_THIN_ROWS: f64 = 0.6;
        let [this, thin, tall] = [self, Self::Thin, Self::Tall].map(|rows| rows.shared(0.5));
        OF_THIN_ROWS * (tall - this) / (tall - thin)
    }

    /// Returns f(s) of [`line_noise`](PolychromaticSpeckle::line_noise).
    fn shared(self, s: f64) -> f64 {
        match self {
            Self::Thin => 1.0 - s * (1.5 - 0.5 * s * s),
            Self::Tall => disc_overlap(s),
            Self::Height(height) if height > Self::TALLEST => disc_overlap(s),
            Self::Height(height) if height > 0.0 => power_in(height, s) / power_in(height, 0.0),
            Self::Height(_) => Self::Thin.shared(s),
        }
    }
}

/// ∫ A(s, g) sinc²(πag) dg.
fn power_in(height: f64, s: f64) -> f64 {
    let reach = (1.0 - s * s).sqrt();
    // The overlap ends with a root.
    let by_angle = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        lens_overlap(s, reach * sin) * sinc_pi_squared(height * reach * sin) * reach * cos
    };
    integrate(by_angle, [0.0, FRAC_PI_2], (0.5 / height).min(1.0))
}

/// The overlap, in areas of a disc, of the lens that two discs s diameters apart share with itself g diameters across
/// that direction: all of its chords get shorter by g diameters.
fn lens_overlap(s: f64, g: f64) -> f64 {
    let end = (1.0 - g * g).max(0.0).sqrt();
    let primitive = |t: f64| 0.5 * (t * (1.0 - t * t).max(0.0).sqrt() + t.asin()) - g * t;
    if s < end {
        4.0 / PI * (primitive(end) - primitive(s))
    } else {
        0.0
    }
}

/// The largest fraction of the light in the last modes that are left out.
const NEGLIGIBLE_FRACTION: f64 = 1e-4;

/// The largest number of wave numbers that stand for a line in its modes.
const MAX_NODES: usize = 400;

impl PolychromaticSpeckle<'_> {
    /// Returns the contrast, standard deviation over mean, `C² = ∫ R(κ) |P̂(κ)|² dκ`.
    pub fn contrast(&self) -> f64 {
        let squared = |kappa| self.cell.squared_correlation(kappa);
        self.mean(squared).sqrt()
    }

    /// Returns the covariance over ⟨I⟩² of two frames between which the field moved across the pupil by `displacement`,
    /// in pupil diameters along the tilt and across it, in focus.
    ///
    /// ```text
    /// cov(I₁, I₂) / ⟨I⟩² = ∫ R(κ) exp(−κ² σ_L²) chat²(|m + κ v̂ / κ_t|) dκ
    /// ```
    pub fn covariance(&self, displacement: [f64; 2]) -> f64 {
        let [along, across] = displacement;
        let tilt = self.cell.tilt_wave_number().recip();
        self.mean(|kappa| {
            let overlap = disc_overlap((along + kappa * tilt).hypot(across));
            (overlap * self.cell.height_correlation(kappa)).powi(2)
        })
    }

    /// Returns the autocovariance over ⟨I⟩² at a lag on the object, in speckle sizes along the tilt and across it, in
    /// focus: grains grow along the tilt.
    pub fn autocovariance(&self, lag: [f64; 2]) -> f64 {
        let lag = lag.map(|lag| PI * lag);
        let tilt = self.cell.tilt_wave_number().recip();
        self.mean(|kappa| {
            let phase = |along: f64, across: f64| lag[0] * along + lag[1] * across;
            let lens = lens::mean_over_lens(kappa * tilt, lag.map(f64::abs), phase);
            lens.norm_sqr() * self.cell.height_correlation(kappa).powi(2)
        })
    }

    /// Returns the variance of the position of a line over that in light of one wavelength, for a tilt across the line.
    ///
    /// ```text
    /// ∫ R(κ) exp(−κ² σ_L²) f(s) dκ,     s = |κ| / κ_t
    /// f = 1 − 3s/2 + s³/2               thin rows
    /// f = chat(s)                       tall rows
    /// f = ∫ A(s, g) sinc²(πag) dg / ∫ chat(g) sinc²(πag) dg      rows of a speckle sizes
    /// ```
    ///
    /// with the overlap A of the lens that two discs s diameters apart share, and of that lens g diameters along the rows,
    /// in areas of a disc.
    ///
    /// A centroid asks for the power at low frequencies, to which a lens of the pupil counts with its area or its
    /// chords, and not, as in the contrast, with the square of its area.
    ///
    /// # Validity
    ///
    /// Lines four speckles wide or wider; at two first order is up to 10 % higher. Defocus drops out as long as the wavelengths
    /// are displaced by less than the width of the line. A correlation length of the relief takes for thin rows a mean of
    /// two kernels: to 0.005 of the deviation without a tilt of the cell, and to 0.01 with one.
    ///
    /// # References
    ///
    /// - R. G. Dorsch, G. Häusler, J. M. Herrmann, *Laser triangulation: fundamental uncertainty in distance
    ///   measurement*, Applied Optics 33, 1994: the line in light of one wavelength.
    pub fn line_noise(&self, rows: Rows) -> f64 {
        let tilt = self.cell.tilt_wave_number().recip();
        let shared = rows.shared_by_all();
        let contrast_like = rows.weight_of_contrast();
        let kernel = |lag: f64| {
            let tall = (1.0 - contrast_like) * image_of_point(lag);
            tall + contrast_like * image_autocorrelation(lag)
        };
        // Heights that are correlated over many speckles leave f alone.
        let long = self.cell.correlation_length().powi(2);
        let long = long / (long + 4.0);
        self.mean(|kappa| {
            let s = (kappa * tilt).abs().min(1.0);
            let dense = shared(s) * self.cell.height_correlation(kappa).powi(2);
            let chat = disc_overlap(s);
            if chat < 1e-9 {
                return dense;
            }
            let scale = shared(s) / (chat * (1.0 - contrast_like * (1.0 - chat)));
            dense + scale.powf(long) * self.cell.height_excess(kappa, kernel)
        })
    }

    /// Returns the fractions of the light in its coherent modes, the largest first; their squares sum to the squared
    /// contrast.
    ///
    /// They are the eigenvalues of `√S(k) P̂(k − k') √S(k')`: the intensity is the sum of as many independent speckle
    /// patterns. The last modes, of together 10⁻⁴ of the light, are left out. The correlation length of the relief is left
    /// out.
    ///
    /// Where the paths are spread so widely that more than some hundred modes would count, the fractions fall by one
    /// ratio, which is exact for a Gaussian line and heights alone, and keep the contrast.
    pub fn modes(&self) -> Vec<f64> {
        let Some(nodes) = self.line.nodes(self.cell.scale(), MAX_NODES) else {
            return self.geometric_modes();
        };
        let mut matrix = vec![Complex::ZERO; nodes.len() * nodes.len()];
        for (i, first) in nodes.iter().enumerate() {
            for (j, second) in nodes.iter().enumerate() {
                let correlation = self.cell.field_correlation(first[0] - second[0]);
                matrix[i * nodes.len() + j] = correlation * (first[1] * second[1]).sqrt();
            }
        }
        let mut modes = hermitian_eigenvalues(matrix, nodes.len());
        modes.sort_unstable_by(|a, b| b.total_cmp(a));
        let total: f64 = modes.iter().sum();
        let mut left = total;
        modes.retain(|mode| {
            let is_kept = left > NEGLIGIBLE_FRACTION * total;
            left -= mode;
            is_kept
        });
        let kept: f64 = modes.iter().sum();
        modes.iter().map(|mode| mode / kept).collect()
    }

    /// Returns the cell with a relief without correlation length that leaves `measure`, a contrast or a noise, as it is.
    ///
    /// What draws light in a few representative heights knows no correlation length; this one is as good for one measure.
    pub fn dense_equivalent(
        &self,
        measure: impl Fn(&PolychromaticSpeckle<'_>) -> f64,
    ) -> ResolutionCell {
        let relief = self.cell.relief();
        if relief.correlation_length == 0.0 {
            return *self.cell;
        }
        let with_height = |rms_height| {
            let dense = Relief {
                rms_height,
                correlation_length: 0.0,
            };
            self.cell.with_relief(dense).unwrap_or(*self.cell)
        };
        let of = |cell: &ResolutionCell| {
            measure(&PolychromaticSpeckle {
                line: self.line,
                cell,
            })
        };
        let wanted = of(self.cell);
        let [mut low, mut high] = [0.0, relief.rms_height];
        for _ in 0..12 {
            let middle = 0.5 * (low + high);
            if of(&with_height(middle)) > wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        with_height(0.5 * (low + high))
    }

    /// Fractions (1 − t) tⁿ with the contrast of the law.
    fn geometric_modes(&self) -> Vec<f64> {
        let ratio = mode_ratio(self.contrast().powi(2));
        let powers = core::iter::successors(Some(1.0), |power| Some(power * ratio));
        let powers: Vec<f64> = powers
            .take_while(|power| *power > NEGLIGIBLE_FRACTION)
            .collect();
        let total: f64 = powers.iter().sum();
        powers.iter().map(|power| power / total).collect()
    }

    pub(crate) fn mean(&self, f: impl Fn(f64) -> f64) -> f64 {
        self.line.mean_over_pairs(self.cell.scale(), f)
    }
}

#[cfg(test)]
mod tests;
