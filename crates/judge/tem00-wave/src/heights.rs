//! Gaussian random heights with a given correlation length.

use glam::DVec3;
use tem00_numerics::Grid;

use crate::{
    Scatterer,
    patch::PatchFrame,
    random::{Purpose, Random},
};

/// Nodes of white noise per correlation length. The variance between nodes then has a ripple of
/// exp(−π²) = 5e−5 before normalisation.
const NODES: f64 = 2.0;

/// Reach of the kernel in nodes: it falls to exp(−2 · 2.5²) = 4e−6.
const REACH: usize = 5;
const TAPS: usize = 2 * REACH + 1;

/// Displaces scatterers along the normal by heights of the given rms and correlation length.
///
/// White noise on a lattice is smoothed by the kernel exp(−2d²/ℓ²), whose convolution with itself
/// is the wanted autocorrelation exp(−d²/ℓ²). The weights are normalised at each point, so that the
/// variance is the same everywhere.
pub(crate) fn add_heights(
    scatterers: &mut [Scatterer],
    frame: &PatchFrame,
    [rms, correlation_length]: [f64; 2],
    seed: u64,
) {
    let mut random = Random::new(seed, Purpose::Heights);
    let normal = frame.axes.z_axis;
    if correlation_length < 0.5 * frame.spacing[0].max(frame.spacing[1]) {
        for scatterer in scatterers {
            scatterer.position += normal * rms * random.gaussian();
        }
        return;
    }
    let noise = Noise::new(frame.size, correlation_length, &mut random);
    for scatterer in scatterers {
        let local: DVec3 = frame.axes.transpose() * (scatterer.position - frame.centre);
        scatterer.position += normal * rms * noise.smooth_at([local.x, local.y]);
    }
}

/// White noise on nodes that cover a patch and the reach of the kernel around it.
struct Noise {
    nodes: Grid<f64>,
    spacing: f64,
    size: [f64; 2],
}

impl Noise {
    fn new(size: [f64; 2], correlation_length: f64, random: &mut Random) -> Self {
        let spacing = correlation_length / NODES;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "positive, and at most four nodes per scatterer along a side"
        )]
        let [width, height] = size.map(|side| (side / spacing).ceil() as usize + 2 * REACH + 2);
        let mut nodes = Grid::filled(width, height, 0.0);
        for node in nodes.values_mut() {
            *node = random.gaussian();
        }
        Self {
            nodes,
            spacing,
            size,
        }
    }

    /// A Gaussian number of variance 1, correlated with its neighbours.
    fn smooth_at(&self, at: [f64; 2]) -> f64 {
        let nodes = [self.nodes.width(), self.nodes.height()];
        let [(column, x), (row, y)] =
            [0, 1].map(|i| self.weights(at[i] + 0.5 * self.size[i], nodes[i]));
        let (mut sum, mut squares) = (0.0, 0.0);
        for (j, wy) in y.iter().enumerate() {
            let noise = &self.nodes.row(row + j)[column..][..x.len()];
            for (wx, node) in x.iter().zip(noise) {
                let weight = wx * wy;
                sum += weight * node;
                squares += weight * weight;
            }
        }
        sum / squares.sqrt()
    }

    /// The first of `nodes` in reach along one axis, and the weights from there on.
    fn weights(&self, from_edge: f64, nodes: usize) -> (usize, [f64; TAPS]) {
        let at = from_edge / self.spacing;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a node of the grid, whatever the rounding of a position far from the origin"
        )]
        let first = (at.floor().max(0.0) as usize).min(nodes - TAPS);
        let before = at - first as f64 + REACH as f64;
        let mut weights = [0.0; TAPS];
        for (offset, weight) in (0_u32..).zip(&mut weights) {
            let distance = (f64::from(offset) - before).clamp(-6.0, 6.0);
            *weight = (-2.0 * (distance / NODES).powi(2)).exp();
        }
        (first, weights)
    }
}
