//! Mean of a band-limited, periodic function over an interval of any length.

use tem00_numerics::quadrature::gauss_legendre;

/// A position and its weight in a mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) position: f64,
    pub(crate) weight: f64,
}

/// The rule on [−1, 1], whose weights add up to 2.
const GAUSS: [(f64, f64); 5] = gauss_legendre();

/// Nodes for the mean over the interval of `size` about `centre` of a function with the period
/// `period` and without frequencies above 1/`finest`.
///
/// Whole periods are summed by the trapezoidal rule, which is exact for them, and the rest of the
/// interval by panels of at most one period of the finest waves.
pub(crate) fn mean_nodes(centre: f64, size: f64, period: f64, finest: f64) -> Vec<Node> {
    let rest = size % period;
    let whole = if size > rest {
        (size - rest) / size
    } else {
        0.0
    };
    let mut nodes = Vec::new();
    if whole > 0.0 {
        let count = (period / finest).floor() + 2.0;
        let node = |i| Node {
            position: i * period / count,
            weight: whole / count,
        };
        nodes.extend(counted(count).map(node));
    }
    if whole < 1.0 {
        // The centre is reduced first, so that nodes far out keep their distances.
        let middle = centre.rem_euclid(period) - (0.5 * size).rem_euclid(period) + 0.5 * rest;
        let count = (rest / finest).ceil().max(1.0);
        let width = rest / count;
        let panel = |i| {
            let middle = middle + (i + 0.5 - 0.5 * count) * width;
            GAUSS.map(|(x, weight)| Node {
                position: middle + 0.5 * width * x,
                weight: 0.5 * weight * (1.0 - whole) / count,
            })
        };
        nodes.extend(counted(count).flat_map(panel));
    }
    nodes
}

/// 0, 1, … below `count`.
fn counted(count: f64) -> impl Iterator<Item = f64> {
    core::iter::successors(Some(0.0), |i| Some(i + 1.0)).take_while(move |&i| i < count)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::*;

    /// The mean of cos(2π k x / period + 1) over the interval.
    fn exact(k: f64, centre: f64, size: f64, period: f64) -> f64 {
        let w = 2.0 * PI * k / period;
        let half = 0.5 * w * size;
        let sinc = if half == 0.0 { 1.0 } else { half.sin() / half };
        (w * centre + 1.0).cos() * sinc
    }

    fn sum(k: f64, nodes: &[Node], period: f64) -> f64 {
        let term = |n: &Node| n.weight * (2.0 * PI * k * n.position / period + 1.0).cos();
        nodes.iter().map(term).sum()
    }

    #[test]
    fn means_of_waves_are_right_up_to_the_cut_off() {
        let (period, finest) = (64.0, 3.2);
        let mut worst = 0.0_f64;
        for size in [0.0, 0.5, 3.2, 3.3, 17.0, 63.9, 64.0, 64.1, 128.0, 1000.3] {
            // The last centre is 5.25 after 2⁴⁰ periods, where numbers are 2⁻⁶ apart.
            for centre in [0.0, 5.3, -700.25, 5.25 + 64.0 * 2.0_f64.powi(40)] {
                let nodes = mean_nodes(centre, size, period, finest);
                let weights: f64 = nodes.iter().map(|n| n.weight).sum();
                assert!((weights - 1.0).abs() < 1e-13, "size {size}: {weights}");
                for k in 0..=20 {
                    let k = f64::from(k);
                    let error = sum(k, &nodes, period) - exact(k, centre % period, size, period);
                    worst = worst.max(error.abs());
                }
            }
        }
        // The five-point rule over half a turn to either side:
        // π¹⁰ 2¹¹ (5!)⁴ / (11 (10!)³) / 2 = 3.8e−5.
        assert!(worst < 3.8e-5, "error {worst:e}");
        assert!(
            worst > 1e-5,
            "the stated error is not met by far: {worst:e}"
        );
    }

    #[test]
    fn intervals_of_any_length_have_nodes() {
        for size in [1e-300, 1e-30, 1e15, 1e30, 1e300, f64::MAX] {
            for centre in [-f64::MAX, -1e30, 0.0, 1e-30, 1e300, f64::MAX] {
                let nodes = mean_nodes(centre, size, 48.0, 2.0);
                assert!(nodes.len() < 200, "{} nodes", nodes.len());
                let finite = |n: &Node| n.position.is_finite() && n.weight.is_finite();
                assert!(nodes.iter().all(finite), "size {size:e} at {centre:e}");
            }
        }
    }
}
