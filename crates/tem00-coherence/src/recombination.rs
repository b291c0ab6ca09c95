use crate::mode_ratio;

/// Fractions of light in independent patterns of mean 1, whose sum is a mix of single and multiple light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recombination {
    /// The fractions: the first two are the fields of the single light and of the first mode of the multiple light,
    /// which overlap; then the further modes of the multiple light.
    pub patterns: [f64; Self::PATTERNS],
    /// What is left of the multiple light: so many patterns that they add up to an even radiance.
    pub even: f64,
}

impl Recombination {
    /// The number of patterns.
    pub const PATTERNS: usize = 5;

    /// Finds the patterns of polarised light.
    ///
    /// The multiple light is a sum of modes with the fractions `bₙ = (1 − t) tⁿ` of it, with `Σ bₙ² = c₂₂`; the first
    /// shares the coherence c₁₂ with the single light. Their two fields are those of the eigenvalues of
    ///
    /// ```text
    /// ( L₁            √(c₁₂ L₁ L₂) )
    /// ( √(c₁₂ L₁ L₂)  b₀ L₂        )
    /// ```
    ///
    /// so that the sum of the patterns has the mean `L₁ + L₂` and the variance `L₁² + 2 c₁₂ L₁ L₂ + c₂₂ L₂²`, but for
    /// `c₁₂ > b₀`, which no pair of such fields has and which counts as b₀, and for the modes from the fifth on, which
    /// are taken as even: the variance then lacks less than 0.03 L₂².
    ///
    /// `radiances` are L₁ of the single and L₂ of the multiple light; `with_single` is c₁₂ and `within_multiple` c₂₂,
    /// both from 0 to 1.
    pub fn new(radiances: [f64; 2], with_single: f64, within_multiple: f64) -> Self {
        let [single, multiple] = radiances;
        let ratio = mode_ratio(within_multiple);
        let first = 1.0 - ratio;
        let overlap = with_single.min(first) * single * multiple;
        let (mean, half) = (
            0.5 * (single + first * multiple),
            0.5 * (single - first * multiple),
        );
        let root = (half * half + overlap).sqrt();
        let mut patterns = [mean + root, (mean - root).max(0.0), 0.0, 0.0, 0.0];
        let mut mode = first * multiple;
        for fraction in &mut patterns[2..] {
            mode *= ratio;
            *fraction = mode;
        }
        Self {
            patterns,
            even: multiple * ratio.powi(4),
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
            for within in [1.0, 0.7, 0.4, 0.1, 0.0] {
                let first = 1.0 - mode_ratio(within);
                for with_single in [0.0, 0.5 * first, first] {
                    let mix = Recombination::new([single, multiple], with_single, within);
                    let [mean, variance] = moments(&mix);
                    assert!((mean - single - multiple).abs() < 1e-14, "{mix:?}");
                    let cross = 2.0 * with_single * single * multiple;
                    let law = single * single + cross + within * multiple * multiple;
                    // The squares of the modes from the fourth on: c₂₂ t⁸.
                    let left_out = within * mode_ratio(within).powi(8) * multiple * multiple;
                    assert!((variance + left_out - law).abs() < 1e-13, "{mix:?}");
                    assert!(left_out < 0.03 * multiple * multiple, "{left_out}");
                    assert!(
                        mix.patterns.iter().all(|&fraction| fraction >= 0.0),
                        "{mix:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn light_of_one_wavelength_is_one_pattern() {
        let mix = Recombination::new([1.0, 0.3], 1.0, 1.0);
        assert!((mix.patterns[0] - 1.3).abs() < 1e-15, "{mix:?}");
        assert!(
            mix.patterns[1..].iter().all(|&rest| rest < 1e-15),
            "{mix:?}"
        );
    }

    #[test]
    fn light_that_does_not_interfere_is_one_pattern_on_an_even_ground() {
        let mix = Recombination::new([1.0, 0.3], 0.0, 0.0);
        assert!((mix.patterns[0] - 1.0).abs() < 1e-15, "{mix:?}");
        assert!((mix.even - 0.3).abs() < 1e-15, "{mix:?}");
    }
}
