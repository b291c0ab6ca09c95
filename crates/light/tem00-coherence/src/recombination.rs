use crate::mode_ratio;

/// Fractions of light in independent patterns of mean 1 whose sum is a mixture of single and
/// multiple light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recombination {
    /// The fractions: the first two are the fields of the single light and of the first mode of the
    /// multiple light, which overlap; then the further modes of the multiple light.
    pub patterns: [f64; Self::PATTERNS],
    /// Fraction of multiple light in patterns so numerous that their sum is uniform.
    pub even: f64,
}

impl Recombination {
    /// The number of patterns.
    pub const PATTERNS: usize = 5;

    /// Finds the patterns of polarised light.
    ///
    /// The multiple light is a sum of modes with the fractions bₙ, where `Σ bₙ² = c₂₂`; the first
    /// mode shares the coherence c₁₂ with the single light. The first two patterns are the
    /// eigenvalues of
    ///
    /// ```text
    /// ( L₁            √(c₁₂ L₁ L₂) )
    /// ( √(c₁₂ L₁ L₂)  b₀ L₂        )
    /// ```
    ///
    /// so that the sum of the patterns has the mean `L₁ + L₂` and the variance
    /// `L₁² + 2 c₁₂ L₁ L₂ + c₂₂ L₂²`. The fractions of the modes form a geometric series, unless
    /// c₁₂ needs a larger first mode; the modes from the fifth on are uniform, and the three before
    /// them carry their variance.
    ///
    /// `radiances` are L₁ of the single and L₂ of the multiple light; `with_single` is c₁₂ and
    /// `within_multiple` c₂₂, both from 0 to 1. By Schwarz's inequality `c₁₂² ≤ c₂₂`: if estimates
    /// violate it, c₁₂ counts as `√c₂₂`.
    pub fn new(radiances: [f64; 2], with_single: f64, within_multiple: f64) -> Self {
        let with_single = with_single.min(within_multiple.sqrt());
        let first = (1.0 - mode_ratio(within_multiple)).max(with_single);
        Self::with_first(first, radiances, with_single, within_multiple)
    }

    /// Finds two patterns with the same mean and variance: the first mode, a fraction √c₂₂ of the
    /// multiple light, carries all of its variance, and the rest is uniform.
    ///
    /// The distribution of the intensities equals the one of [`new`](Self::new) only where c₂₂ is 0
    /// or 1; use it for light too faint for the difference to be visible.
    pub fn of_two(radiances: [f64; 2], with_single: f64, within_multiple: f64) -> Self {
        let first = within_multiple.sqrt();
        Self::with_first(first, radiances, with_single.min(first), within_multiple)
    }

    fn with_first(
        first: f64,
        [single, multiple]: [f64; 2],
        with_single: f64,
        within_multiple: f64,
    ) -> Self {
        let overlap = with_single * single * multiple;
        let (mean, half) = (
            0.5 * (single + first * multiple),
            0.5 * (single - first * multiple),
        );
        let root = (half * half + overlap).sqrt();
        let mut patterns = [mean + root, (mean - root).max(0.0), 0.0, 0.0, 0.0];
        let rest = (1.0 - first) * multiple;
        let mut even = rest;
        if rest > 0.0 {
            let squared = (within_multiple - first * first) / (1.0 - first).powi(2);
            let squared = squared.clamp(0.0, 1.0); // Rounding may leave the range.
            let ratio = mode_ratio(squared);
            // The squares of three modes must sum to the squares of all modes: the partial sum of
            // (1 − t)² t²ⁿ over three terms lacks the fraction t⁶.
            let mut mode = rest * (squared / (1.0 + ratio * ratio + ratio.powi(4))).sqrt();
            for fraction in &mut patterns[2..] {
                *fraction = mode;
                even -= mode;
                mode *= ratio;
            }
        }
        Self {
            patterns,
            even: even.max(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(mix: &Recombination) -> [f64; 2] {
        let sum: f64 = mix.patterns.iter().sum();
        [
            sum + mix.even,
            mix.patterns
                .iter()
                .map(|fraction| fraction * fraction)
                .sum(),
        ]
    }

    #[test]
    fn mean_and_variance_are_those_of_the_mix() {
        for [single, multiple] in [[1.0, 0.0], [0.0, 1.0], [1.0, 0.3], [0.4, 2.0]] {
            for within in [1.0, 1.0 - 1e-9, 0.7, 0.4, 0.1, 0.0] {
                let first = 1.0 - mode_ratio(within);
                let largest = within.sqrt();
                for with_single in [0.0, 0.5 * first, first, largest] {
                    for find in [Recombination::new, Recombination::of_two] {
                        let mix = find([single, multiple], with_single, within);
                        let [mean, variance] = moments(&mix);
                        assert!((mean - single - multiple).abs() < 1e-14, "{mix:?}");
                        let cross = 2.0 * with_single * single * multiple;
                        let law = single * single + cross + within * multiple * multiple;
                        assert!((variance - law).abs() < 1e-13, "{mix:?}");
                        assert!(mix.even >= 0.0, "{mix:?}");
                        assert!(
                            mix.patterns.iter().all(|&fraction| fraction >= 0.0),
                            "{mix:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_coherence_beyond_the_inequality_counts_as_its_bound() {
        for find in [Recombination::new, Recombination::of_two] {
            let [found, bound] = [0.9, 0.5].map(|with_single| find([1.0, 0.3], with_single, 0.25));
            assert_eq!(found, bound);
        }
    }

    #[test]
    fn light_that_does_not_interfere_is_one_pattern_on_an_even_ground() {
        let mix = Recombination::new([1.0, 0.3], 0.0, 0.0);
        assert!((mix.patterns[0] - 1.0).abs() < 1e-15, "{mix:?}");
        assert!((mix.even - 0.3).abs() < 1e-15, "{mix:?}");
    }
}
