use crate::Spectrum;

/// Light that met several rough surfaces on one path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DelayedLight {
    /// Radiance of the light, or any other measure of energy: finite and not negative.
    pub weight: f64,
    /// Group path of the light minus the group path of the light that met only the surface seen, in
    /// metres.
    pub delay: f64,
}

/// Mutual coherence of light that met several rough surfaces, from pairs of independently drawn
/// paths.
///
/// ```text
/// c₂₂ = ∬ p₂(l) p₂(l') |γ(l − l')|² dl dl'     of the multiply scattered light with itself
/// c₁₂ = ∫ p₂(l) |γ(l)|² dl                     with the singly scattered light
/// ```
///
/// with the density p₂ of the delays, weighted by their light. Pairs of draws estimate the double
/// integral, so that no histogram is needed and p₂ may have any shape, with long tails or several
/// peaks.
///
/// # Validity
///
/// Both samples of a pair must be *independent*: neighbours of a low-discrepancy sequence are not.
/// The spread of paths within the resolution cell, by its tilt and its relief, is not included; it
/// is a separate factor.
///
/// # Examples
///
/// Half of the light has a path 2 mm longer than the other half, beyond the coherence length of the
/// line:
///
/// ```
/// use tem00_coherence::{DelayedLight, PeakShape, PathPairs, Spectrum};
///
/// let line = Spectrum::new(450e-9, 1e-9, PeakShape::Gaussian)?;
/// let paths = [0.0, 2e-3].map(|delay| DelayedLight { weight: 1.0, delay });
/// let mut pairs = PathPairs::default();
/// pairs.add(&line, &paths, &paths);
/// assert!((pairs.self_coherence().unwrap() - 0.5).abs() < 1e-6);
/// assert!((pairs.coherence_with_single().unwrap() - 0.5).abs() < 1e-6);
/// # Ok::<(), tem00_coherence::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathPairs {
    /// Σ E E' |γ|² and Σ E E' over pairs.
    of_pairs: [f64; 2],
    /// Σ E |γ|² and Σ E over paths.
    with_single: [f64; 2],
}

impl PathPairs {
    /// Adds the paths of a camera sample and of another, independent sample of the same position.
    pub fn add(&mut self, spectrum: &Spectrum, sample: &[DelayedLight], other: &[DelayedLight]) {
        for path in sample {
            let with_single = path.weight * spectrum.squared_coherence(path.delay);
            add_to(&mut self.with_single, [with_single, path.weight], 1.0);
            for second in other {
                let energy = path.weight * second.weight;
                let coherent = energy * spectrum.squared_coherence(path.delay - second.delay);
                add_to(&mut self.of_pairs, [coherent, energy], 1.0);
            }
        }
    }

    /// Adds the sums of other pairs, times a factor, to average over neighbouring positions of an
    /// image.
    pub fn add_scaled(&mut self, other: &Self, factor: f64) {
        add_to(&mut self.of_pairs, other.of_pairs, factor);
        add_to(&mut self.with_single, other.with_single, factor);
    }

    /// Returns c₂₂ = Σ E E' |γ(Δ − Δ')|² / Σ E E' over the pairs; `None` without light.
    pub fn self_coherence(&self) -> Option<f64> {
        ratio(self.of_pairs)
    }

    /// Returns c₁₂ = Σ E |γ(Δ)|² / Σ E over the paths of the first samples, so that each counts
    /// once; `None` without light.
    pub fn coherence_with_single(&self) -> Option<f64> {
        ratio(self.with_single)
    }
}

/// Returns the ratio t of the fractions `(1 − t) tⁿ` of independent patterns whose squares sum to a
/// squared contrast between 0 and 1.
///
/// They are the modes of a Gaussian line over normally distributed paths, and approximate the modes
/// of other densities.
pub const fn mode_ratio(squared_contrast: f64) -> f64 {
    (1.0 - squared_contrast) / (1.0 + squared_contrast)
}

fn add_to(sums: &mut [f64; 2], terms: [f64; 2], factor: f64) {
    for (sum, term) in sums.iter_mut().zip(terms) {
        *sum += factor * term;
    }
}

fn ratio([coherent, all]: [f64; 2]) -> Option<f64> {
    (all > 0.0).then(|| coherent / all)
}

#[cfg(test)]
mod tests;
