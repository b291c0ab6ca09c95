use core::f64::consts::{PI, TAU};

use tem00_numerics::{quadrature::for_each_node, sinc};

use super::{axial_correlation, pupil_overlap_correlation};

/// Law of the correlation after a combined pupil displacement and axial displacement.
///
/// Defocus moves a displaced pattern. Relative to the image of the surface it shifts by
///
/// ```text
/// Δr = 4 s |x| h      reference state in focus, upright image
/// ```
///
/// with the pupil displacement s in pupil diameters, the axial displacement x in axial
/// decorrelation lengths and the speckle size h. The shift is against the pupil displacement if the
/// surface has approached, and along it if the surface has receded. The remaining correlation
/// depends on whether the look-up follows this shift: [`SpeckleMotion`](crate::SpeckleMotion)
/// follows it, to [`AtPeak`](Self::AtPeak); a look-up at the projected displacement of the surface
/// point has [`AtImageDisplacement`](Self::AtImageDisplacement). Without defocus, or without pupil
/// displacement, both are [`pupil_overlap_correlation`] times [`axial_correlation`].
///
/// Both integrals run over the overlap ℓ of two discs of radius 1 with centres at ±s:
///
/// ```text
/// γ = |μ|²,   μ = (1/π) ∫_ℓ exp(iβ |p − c|²) d²p,   β = 2π x
/// ```
///
/// By Stokes' theorem they are line integrals of a smooth function along its two arcs:
///
/// ```text
/// μ = (1/π) Σ_k ∫₀^acos(s) (1 − k cos t) E(β (1 + k² − 2k cos t)) dt,   E(z) = (exp(iz) − 1)/(iz)
/// ```
///
/// with k = s for both arcs if c is the middle of the overlap, and k = 0 and 2s if c is the centre
/// of a disc.
///
/// # Validity
///
/// The pupil is circular and free of aberrations. The sign of μ, negative in the first revival of a
/// pattern out of focus, is lost in γ.
///
/// # Examples
///
/// A tenth of the pupil, and 0.625 axial decorrelation lengths:
///
/// ```
/// use tem00_decorrelation::CorrelationLaw;
///
/// let left = |law: CorrelationLaw| law.correlation(0.1, 0.625);
/// assert!((left(CorrelationLaw::AtImageDisplacement) - 0.2166).abs() < 5e-5);
/// assert!((left(CorrelationLaw::AtPeak) - 0.2484).abs() < 5e-5);
/// ```
///
/// # References
///
/// - D. W. Li and F. P. Chiang, *Decorrelation functions in laser speckle photography*, 1986.
/// - S. Bergmann et al. 2016, §6.4.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CorrelationLaw {
    /// The correlation at Δr from the displacement of the projected point. It is the largest
    /// correlation as long as the correlation is large: around the first zero the peak breaks up,
    /// and there is no single peak to follow.
    ///
    /// It is also the correlation at the displacement of the projected point itself if the focus
    /// lies midway, so that reference and moved state are out of focus by ∓x/2.
    #[default]
    AtPeak,
    /// The correlation at the displacement of the projected surface point, with the reference state
    /// (or the moved one) in focus; out of focus, at the displacement that the defocus of that
    /// state alone gives.
    AtImageDisplacement,
}

impl CorrelationLaw {
    /// Returns the intensity correlation γ in [0, 1] left after a displacement across the pupil, in
    /// pupil diameters, and along the axis, in axial decorrelation lengths.
    ///
    /// It is even in both. The integrals are exact to 1e−8. From axial displacements of 3e−5 up to
    /// 3200 lengths they are computed by Gauss–Legendre quadrature, in half a microsecond to one at
    /// small displacements and in a time proportional to the displacement beyond a few lengths.
    /// Outside of this range the product of the laws of both displacements is returned: it is
    /// equally exact at smaller displacements, and at larger ones all values are below 4/β² = 1e−8.
    pub fn correlation(self, pupil_shift: f64, axial_shift: f64) -> f64 {
        let (s, x) = (pupil_shift.abs(), axial_shift.abs());
        // NaN counts as decorrelated in the product.
        if s > 0.0 && s < 1.0 && x > SMALLEST_AXIAL_SHIFT && x < LARGEST_AXIAL_SHIFT {
            self.integral(s, x)
        } else {
            pupil_overlap_correlation(s) * axial_correlation(x)
        }
    }

    /// γ by the integral over the lens, for s in [0, 1] and x from 0 to the largest shift.
    pub(super) fn integral(self, s: f64, x: f64) -> f64 {
        let beta = TAU * x;
        let [re, im] = match self {
            Self::AtImageDisplacement => sum(arc(s, beta, 0.0), arc(s, beta, 2.0 * s)),
            Self::AtPeak => arc(s, beta, s).map(|part| 2.0 * part),
        };
        // Rounding may end a unit above 1.
        (re * re + im * im).min(1.0)
    }
}

/// Axial displacement up to which the product is exact to 1e−8, too: the phase of the defocus lies
/// between 0 and β over the pupil, so that its variance over any part of the pupil, which is the
/// loss of γ, is at most β²/4.
const SMALLEST_AXIAL_SHIFT: f64 = 3e-5;

/// Axial displacement from which γ ≤ (2/β)² < 1e−8: |E(z)| ≤ 2/z, and the arcs are seen from c
/// under 2π at most.
const LARGEST_AXIAL_SHIFT: f64 = 3_200.0;

/// Returns the part of μ, as [re, im], from the arc whose own centre lies `k` from the centre of
/// the defocus.
fn arc(s: f64, beta: f64, k: f64) -> [f64; 2] {
    let end = s.acos();
    // The phase changes fastest at the end of the arc, which spans at most a right angle.
    let longest = PHASE_PER_PANEL / (beta * 2.0 * k * end.sin());
    let mut total = [0.0; 2];
    for_each_node([0.0, end], longest, |t, weight| {
        let cosine = t.cos();
        let factor = weight * (1.0 - k * cosine);
        let [re, im] = mean_phasor(beta * (1.0 + k * k - 2.0 * k * cosine));
        total = sum(total, [factor * re, factor * im]);
    });
    total.map(|part| part / PI)
}

/// E(z) = (exp(iz) − 1)/(iz) = exp(iz/2) sinc(z/2), the mean of the phasors from 0 to z.
fn mean_phasor(z: f64) -> [f64; 2] {
    let (sin, cos) = (0.5 * z).sin_cos();
    let length = sinc(0.5 * z);
    [length * cos, length * sin]
}

fn sum(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// Sixteen nodes integrate exp(iωt) over [−1, 1] to 2e−16 up to ω = 8.
const PHASE_PER_PANEL: f64 = 16.0;
