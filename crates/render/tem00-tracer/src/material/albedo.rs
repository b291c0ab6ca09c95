use glam::DVec3;

use super::ggx::Ggx;

const NODES: usize = 32;
const LAST: f64 = (NODES - 1) as f64;

/// Directional albedo of rough facets, by the cosine of the viewing direction.
///
/// The albedo is tabulated at equal steps of the fourth root of the cosine, which resolves the
/// shadows at grazing incidence, and interpolated by cubics through four nodes. For roughnesses
/// from 0.01 to 1 the interpolation errs by 3e-4 at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Albedo {
    nodes: [f64; NODES],
    mean: f64,
}

impl Albedo {
    /// Tabulates the albedo of facets with a `reflectance` by the cosine of incidence on them.
    pub(super) fn new(facets: Ggx, reflectance: impl Fn(f64) -> f64) -> Self {
        let nodes = core::array::from_fn(|node| {
            let root = node as f64 / LAST;
            // Facets along the line of sight cannot be drawn: the limit is taken nearby.
            let cosine = root.powi(4).max(1e-12);
            directional(facets, cosine, &reflectance)
        });
        let mut table = Self { nodes, mean: 0.0 };
        table.mean = table.integrate();
        table
    }

    /// Returns the albedo seen from a direction with this `cosine`.
    pub(super) fn at_cosine(&self, cosine: f64) -> f64 {
        self.at_root(cosine.sqrt().sqrt())
    }

    /// Returns the mean `∫ 2 E(μ) μ dμ` of the interpolated albedo: the reflected fraction of light
    /// that comes evenly from everywhere.
    pub(super) const fn mean(&self) -> f64 {
        self.mean
    }

    fn at_root(&self, root: f64) -> f64 {
        let position = root.clamp(0.0, 1.0) * LAST;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and the last node"
        )]
        let first = (position as usize).saturating_sub(1).min(NODES - 4);
        let t = position - first as f64;
        let (a, b, c, d) = (t, t - 1.0, t - 2.0, t - 3.0);
        let [e, f, g, h] = [0, 1, 2, 3].map(|i| self.nodes[first + i]);
        (3.0 * a * c * d * f - b * c * d * e + a * b * c * h - 3.0 * a * b * d * g) / 6.0
    }

    /// With μ = x⁴ the mean is `∫ 8 E x⁷ dx`: Gauss's rule with six points is exact for the cubics.
    fn integrate(&self) -> f64 {
        const POINTS: [(f64, f64); 3] = [
            (0.238_619_186_083_196_93, 0.467_913_934_572_691_04),
            (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
            (0.932_469_514_203_152, 0.171_324_492_379_170_36),
        ];
        let at = |x: f64| 8.0 * self.at_root(x) * x.powi(7);
        let mut sum = 0.0;
        for interval in 0..NODES - 1 {
            for (offset, weight) in POINTS {
                let half = 0.5 / LAST;
                let middle = (interval as f64 + 0.5) / LAST;
                let pair = at(middle - half * offset) + at(middle + half * offset);
                sum += half * weight * pair;
            }
        }
        sum
    }
}

/// Averages the reflectance of the facets over the visible ones, by the midpoint rule.
fn directional(facets: Ggx, cosine: f64, reflectance: &impl Fn(f64) -> f64) -> f64 {
    const RINGS: u32 = 48;
    const ANGLES: u32 = 32;
    let wo = DVec3::new(((1.0 - cosine) * (1.0 + cosine)).sqrt(), 0.0, cosine);
    let mut sum = 0.0;
    for i in 0..RINGS {
        // The depth below the rim of the disc that facets are drawn from: they vary as its root.
        let depth = (f64::from(i) + 0.5) / f64::from(RINGS);
        for j in 0..ANGLES {
            // Half a turn is enough: the facets to the left of the line of sight are those to the
            // right.
            let turn = 0.5 * (f64::from(j) + 0.5) / f64::from(ANGLES) - 0.25;
            let facet = facets.sample_visible(wo, [1.0 - depth * depth, turn]);
            let wi = 2.0 * wo.dot(facet) * facet - wo;
            if wi.z > 0.0 {
                let reflected = reflectance(wo.dot(facet).clamp(0.0, 1.0));
                sum += depth * reflected * facets.masking_ratio(wo, wi);
            }
        }
    }
    2.0 * sum / f64::from(RINGS * ANGLES)
}
