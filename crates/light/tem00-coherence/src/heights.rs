/// Returns nodes `z` and weights `w` of the Gauss–Hermite rule of the standard normal distribution:
/// the weights sum to 1, and the means of polynomials up to degree 2n − 1 are exact.
///
/// # References
///
/// - M. Abramowitz, I. A. Stegun, *Handbook of Mathematical Functions*, 1964, 25.4.46.
pub(crate) fn gauss_hermite(count: usize) -> Vec<[f64; 2]> {
    let n = count as f64;
    // Normalised polynomials: h₀ = 1, √n hₙ = x hₙ₋₁ − √(n−1) hₙ₋₂.
    let last_two = |x: f64| {
        (1..=count).fold([0.0, 1.0], |[before, last], k| {
            let k = k as f64;
            [last, (x * last - (k - 1.0).sqrt() * before) / k.sqrt()]
        })
    };
    let reach = (4.0 * n + 2.0).sqrt();
    let steps = 64 * count;
    let place = |i: usize| reach * (2.0 * i as f64 / steps as f64 - 1.0) + 1e-9;
    (0..steps)
        .filter_map(|i| {
            let [mut low, mut high] = [place(i), place(i + 1)];
            let rising = last_two(low)[1] < 0.0;
            if (last_two(high)[1] < 0.0) == rising {
                return None;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (last_two(middle)[1] < 0.0) == rising {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let z = 0.5 * (low + high);
            Some([z, (n * last_two(z)[0].powi(2)).recip()])
        })
        .collect()
}

/// Heights that stand for a normal distribution in light of a finite bandwidth, in units of the
/// root mean square height, each with its fraction of the light. A small `spread = 2 σ_k σ_L` needs
/// few heights.
///
/// The fields of patterns of these heights, with independent seeds, add up to a field whose wave
/// numbers correlate as `exp(−κ² σ_L²/2)`: to 0.006 in the contrast with one height at spreads
/// below 0.15, and to 0.004 with more heights up to a spread of 4. Beyond it there is no such rule,
/// and coherent modes do equally well.
pub(crate) fn representative_heights(spread: f64) -> Option<Vec<[f64; 2]>> {
    const COUNTS: [(f64, usize); 7] = [
        (0.15, 1),
        (0.5, 2),
        (1.0, 3),
        (1.5, 5),
        (2.0, 6),
        (3.0, 12),
        (4.0, 20),
    ];
    let (_, count) = COUNTS.into_iter().find(|(limit, _)| spread <= *limit)?;
    Some(gauss_hermite(count))
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    #[test]
    fn moments_are_those_of_the_normal_distribution() {
        for count in [1, 2, 3, 6, 12, 20] {
            let nodes = gauss_hermite(count);
            assert_eq!(nodes.len(), count);
            let mut moment = 1.0;
            for (half, _) in (0_i32..).zip(&nodes) {
                let even: f64 = nodes.iter().map(|[z, w]| w * z.powi(2 * half)).sum();
                assert_relative(even, moment, 1e-10);
                moment *= f64::from(2 * half + 1);
            }
        }
    }

    #[test]
    fn few_heights_keep_the_contrast() {
        for spread in [0.1, 0.15, 0.4, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0_f64] {
            let nodes = representative_heights(spread).unwrap();
            // ⟨|Σ w e^{iκσz}|²⟩ over the difference of two draws from a Gaussian line, where κσ_L
            // has the variance spread²/2.
            let pairs = nodes.iter().flat_map(|a| nodes.iter().map(move |b| (a, b)));
            let squared: f64 = pairs
                .map(|(a, b)| a[1] * b[1] * (-0.25 * (spread * (a[0] - b[0])).powi(2)).exp())
                .sum();
            let exact = (1.0 + spread * spread).sqrt().sqrt().recip();
            assert_absolute(squared.sqrt(), exact, 0.0062);
        }
        assert_eq!(representative_heights(4.1), None);
    }
}
