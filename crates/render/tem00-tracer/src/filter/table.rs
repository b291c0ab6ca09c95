use tem00_numerics::quadrature::gauss_legendre;

/// Straight pieces of the density: even, so that an edge falls on the joint of cubic splines.
const PIECES: u32 = 256;

/// Three points per piece.
const RULE: [(f64, f64); 3] = gauss_legendre();

/// Half of a symmetric density, on [0, radius], made of straight pieces.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HalfTable {
    /// The length of a piece.
    step: f64,
    /// The density at the ends of the pieces, per unit of length; its integral is 1.
    density: Vec<f64>,
    /// The integral of the density up to the ends of the pieces.
    cumulative: Vec<f64>,
    /// The integral of the kernel itself.
    integral: f64,
}

impl HalfTable {
    /// Tabulates the magnitude of a kernel.
    pub(super) fn new(kernel: impl Fn(f64) -> f64, radius: f64) -> Self {
        let step = radius / f64::from(PIECES);
        let integral = (0..PIECES)
            .flat_map(|piece| {
                RULE.map(|(node, weight)| (f64::from(piece) + 0.5 + 0.5 * node, weight))
            })
            .map(|(x, weight)| 0.5 * weight * step * kernel(step * x))
            .sum();
        let mut density: Vec<_> = (0..=PIECES)
            .map(|end| kernel(radius * (f64::from(end) / f64::from(PIECES))).abs())
            .collect();
        let area: f64 = density.windows(2).map(|ends| trapezium(ends, step)).sum();
        for value in &mut density {
            *value /= area;
        }
        let mut sum = 0.0;
        let cumulative = core::iter::once(0.0)
            .chain(density.windows(2).map(|ends| {
                sum += trapezium(ends, step);
                sum
            }))
            .collect();
        Self {
            step,
            density,
            cumulative,
            integral,
        }
    }

    /// Returns the integral of the kernel over its side.
    pub(super) const fn integral(&self) -> f64 {
        self.integral
    }

    /// Returns the position up to which the density integrates to `target`, in [0, 1], and the
    /// density there.
    pub(super) fn sample(&self, target: f64) -> (f64, f64) {
        let behind = self.cumulative.partition_point(|sum| *sum <= target);
        let piece = behind.min(self.cumulative.len() - 1) - 1;
        let (start, end) = (self.density[piece], self.density[piece + 1]);
        let rest = (target - self.cumulative[piece]) / self.step;
        // start t + (end − start) t²/2 = rest, solved without cancellation.
        let root = (start * start + 2.0 * (end - start) * rest).max(0.0).sqrt();
        let t = if rest > 0.0 {
            (2.0 * rest / (start + root)).min(1.0)
        } else {
            0.0
        };
        (self.step * (piece as f64 + t), start + t * (end - start))
    }
}

fn trapezium(ends: &[f64], step: f64) -> f64 {
    0.5 * step * ends.iter().sum::<f64>()
}
