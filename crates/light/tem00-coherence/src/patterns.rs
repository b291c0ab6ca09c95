//! Sums of single-wavelength patterns that reproduce the speckle of other light.

use num_complex::Complex;

use crate::{
    PolychromaticSpeckle, Relief, ResolutionCell, SourceExtent,
    chebyshev::Tabulated,
    eigenvalues::hermitian_eigenvalues,
    heights::representative_heights,
    mode_ratio,
    spectrum::{LADDER_END, breaks_about},
};

/// Speckle patterns of one wavelength whose sum reproduces the speckle of other light, for
/// renderers.
///
/// ```text
/// I = Σⱼ fⱼ ⟨ |Σₕ rₕ exp(iκ q zₕ) Uⱼₕ|² ⟩      mean over wave numbers κ drawn from the line
/// ```
///
/// For each wave number the patterns are displaced across the pupil by `κ/κ_t` diameters along the
/// tilt of the cell.
///
/// # Validity
///
/// Contrasts are correct, with representative heights to 0.006. Where heights dominate, the
/// patterns are the coherent modes and are the same for all wave numbers. The directions of an
/// extended source add patterns that leave speckle shape and correlation of frames as for a point
/// source; the true [`autocovariance`](PolychromaticSpeckle::autocovariance) and
/// [`covariance`](PolychromaticSpeckle::covariance) extend a little farther.
#[derive(Clone, Debug, PartialEq)]
pub struct PatternSum {
    /// Fractions f of the light in independent patterns whose intensities add, the largest first;
    /// their sum is 1, and there are at most 1024.
    pub fractions: Vec<f64>,
    /// Heights z of the relief in metres whose fields add, each with the square root r of its
    /// fraction of the light; empty if the patterns are looked up as for one wavelength.
    pub heights: Vec<[f64; 2]>,
}

/// The largest fraction of the light in the last modes, which are dropped.
const NEGLIGIBLE_FRACTION: f64 = 1e-4;

/// The largest number of wave numbers that represent a line in its modes.
const MAX_NODES: usize = 400;

/// The largest number of patterns that add up.
const MAX_PATTERNS: u32 = 1024;

impl PolychromaticSpeckle<'_> {
    /// Returns the patterns whose sum has a given variance: the squared
    /// [`contrast`](Self::contrast) or [`line_noise_ratio`](Self::line_noise_ratio).
    ///
    /// The smallest variance is that of 1024 equal patterns, a contrast of 1/32.
    pub fn patterns(&self, variance: impl Fn(&PolychromaticSpeckle<'_>) -> f64) -> PatternSum {
        let of = |cell: &ResolutionCell| {
            let spectrum = self.spectrum;
            variance(&PolychromaticSpeckle { spectrum, cell })
        };
        let from_point = self
            .cell
            .clone()
            .with_source_extent(SourceExtent::default());
        let of_point = of(&from_point);
        let dense = dense_equivalent(from_point, of_point, of);
        let heights =
            representative_heights(2.0 * self.spectrum.effective_spread() * dense.path_spread());
        let is_point = self.cell.source_extent().is_point();
        let fractions = match (&heights, is_point) {
            (None, true) => self.modes(),
            (None, false) => geometric_fractions(of(self.cell)),
            (Some(_), true) => vec![1.0],
            (Some(_), false) => geometric_fractions(of(self.cell) / of_point),
        };
        let rms_height = dense.relief().rms_height;
        let node = |[z, fraction]: [f64; 2]| [z * rms_height, fraction.sqrt()];
        PatternSum {
            fractions,
            heights: heights.into_iter().flatten().map(node).collect(),
        }
    }

    /// Returns the fractions of the light in its coherent modes, the largest first; their squares
    /// sum to the squared contrast.
    ///
    /// They are the eigenvalues of `√S(k) P̂(k − k') √S(k')`: the intensity is the sum of as many
    /// independent speckle patterns. The last modes, which together hold 10⁻⁴ of the light, are
    /// dropped. The correlation length of the relief is neglected.
    ///
    /// Where the paths are spread so widely that more than some hundred modes would matter, the
    /// fractions form a geometric series, which is exact for a Gaussian line and heights alone, and
    /// keep the contrast down to 1/32, the contrast of 1024 modes. The fractions of an extended
    /// source also form a geometric series.
    pub fn modes(&self) -> Vec<f64> {
        let is_point = self.cell.source_extent().is_point();
        let nodes = is_point.then(|| self.spectrum.nodes(self.cell.scale(), MAX_NODES));
        let Some(nodes) = nodes.flatten() else {
            return geometric_fractions(self.contrast().powi(2));
        };
        let mut matrix = vec![Complex::ZERO; nodes.len() * nodes.len()];
        let correlation = self.field_correlation();
        for (i, first) in nodes.iter().enumerate() {
            for (j, second) in nodes.iter().enumerate() {
                let root = (first[1] * second[1]).sqrt();
                matrix[i * nodes.len() + j] = correlation(first[0] - second[0]) * root;
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
}

impl<'a> PolychromaticSpeckle<'a> {
    /// Returns the correlation of the fields of two wave numbers; out of focus it comes from a
    /// table.
    fn field_correlation(&self) -> impl Fn(f64) -> Complex<f64> + use<'a> {
        let cell = self.cell;
        let unit = cell.scale().min(1e200);
        let part = |of: fn(Complex<f64>) -> f64| {
            let breaks = breaks_about([(0.0, unit)], LADDER_END * unit);
            Tabulated::new(breaks, move |kappa| of(cell.field_correlation(kappa)))
        };
        let parts = [part(|field| field.re), part(|field| field.im)];
        move |kappa| match cell.is_in_focus() {
            true => cell.field_correlation(kappa),
            false => Complex::new(parts[0].at(kappa), parts[1].at(kappa)),
        }
    }
}

/// Returns the cell with a relief without correlation length that has this variance.
fn dense_equivalent(
    cell: ResolutionCell,
    wanted: f64,
    variance: impl Fn(&ResolutionCell) -> f64,
) -> ResolutionCell {
    let relief = cell.relief();
    if relief.correlation_length == 0.0 {
        return cell;
    }
    let with_height = |rms_height| {
        let dense = Relief {
            rms_height,
            correlation_length: 0.0,
        };
        let dense = cell.clone().with_relief(dense);
        dense.unwrap_or_else(|_| cell.clone())
    };
    let [mut low, mut high] = [0.0, relief.rms_height];
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if variance(&with_height(middle)) > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    with_height(0.5 * (low + high))
}

/// Returns fractions ∝ tⁿ whose squares sum to a variance from 1/1024 to 1.
fn geometric_fractions(variance: f64) -> Vec<f64> {
    let of_ratio = |ratio: f64| {
        let powers = core::iter::successors(Some(1.0), |power| Some(power * ratio));
        let powers = powers.take_while(|power| *power > NEGLIGIBLE_FRACTION);
        let powers: Vec<f64> = powers.take(MAX_PATTERNS as usize).collect();
        let total: f64 = powers.iter().sum();
        powers.iter().map(|power| power / total).collect::<Vec<_>>()
    };
    let [mut low, mut high] = [mode_ratio(variance.min(1.0)), 1.0];
    let fractions = of_ratio(low);
    if fractions.len() < MAX_PATTERNS as usize {
        return fractions;
    }
    // Light beyond the last pattern is lost: a ratio nearer to 1 makes up for it.
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let squares: f64 = of_ratio(middle).iter().map(|part| part * part).sum();
        if squares > variance {
            low = middle;
        } else {
            high = middle;
        }
    }
    of_ratio(high)
}

#[cfg(test)]
mod tests;
