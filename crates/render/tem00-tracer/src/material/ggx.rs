use core::f64::consts::PI;

use glam::{DVec2, DVec3};
use tem00_numerics::circle_point_at_turn;

/// Isotropic microfacets with the GGX (Trowbridge–Reitz) distribution of slopes.
///
/// All directions are unit vectors above the surface. Masking and shadowing are Smith's with
/// correlated heights (Heitz 2014, eq. 72 and 99):
///
/// ```text
/// G₁(w) = 2 w_z / (w_z + r(w))        r(w) = √(w_z² + α² (1 − w_z²))
/// G₂(o, i) = 2 o_z i_z / (i_z r(o) + o_z r(i))
/// ```
///
/// In this form the cosines in the denominators of the BRDF and of the density cancel, so nothing
/// is divided by zero at grazing angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ggx {
    /// The roughness α, positive.
    pub(super) alpha: f64,
}

impl Ggx {
    /// Returns the density D of facet normals, in 1/sr (Walter et al. 2007, eq. 33).
    ///
    /// ```text
    /// D(h) = α² / (π (1 − h_z² + α² h_z²)²)
    /// ```
    pub(super) fn density(self, facet: DVec3) -> f64 {
        let square = self.alpha * self.alpha;
        // The squared sine as h_x² + h_y²: 1 − h_z² would cancel near the peak.
        let sine_square = facet.x * facet.x + facet.y * facet.y;
        let root = sine_square + square * facet.z * facet.z;
        square / (PI * root * root)
    }

    /// Returns `G₂(wo, wi) / (4 cos θo cos θi)`.
    pub(super) fn visibility(self, wo: DVec3, wi: DVec3) -> f64 {
        0.5 / (wi.z * self.reach(wo) + wo.z * self.reach(wi))
    }

    /// Returns `G₂(wo, wi) / G₁(wo)`, the weight of a direction drawn from the visible facets.
    pub(super) fn masking_ratio(self, wo: DVec3, wi: DVec3) -> f64 {
        let reach = self.reach(wo);
        wi.z * (wo.z + reach) / (wi.z * reach + wo.z * self.reach(wi))
    }

    /// Returns the density, per steradian, of the directions into which facets that `wo` sees
    /// reflect: `G₁ D / (4 cos θo)` (Heitz 2018, eq. 17).
    pub(super) fn reflected_pdf(self, wo: DVec3, facet: DVec3) -> f64 {
        0.5 * self.density(facet) / (wo.z + self.reach(wo))
    }

    /// Draws a facet that `wo` sees, and returns the direction that it reflects into `wo`.
    pub(super) fn reflect(self, wo: DVec3, u: [f64; 2]) -> DVec3 {
        let facet = self.sample_visible(wo, u);
        2.0 * wo.dot(facet) * facet - wo
    }

    /// Draws the normal of a facet in proportion to its area as `wo` sees it (Heitz 2018).
    pub(super) fn sample_visible(self, wo: DVec3, [u, v]: [f64; 2]) -> DVec3 {
        // Stretch the surface until the facets form a hemisphere.
        let view = DVec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        let across = DVec3::new(-view.y, view.x, 0.0)
            .try_normalize()
            .unwrap_or(DVec3::X);
        let upward = view.cross(across);
        // Draw a point of the hemisphere's projection: a half disc next to a half ellipse.
        let DVec2 { x, y: up } = u.sqrt() * DVec2::from(circle_point_at_turn(v));
        let lift = 0.5 * (1.0 + view.z);
        let half_disc = ((1.0 - x) * (1.0 + x)).sqrt();
        let y = (1.0 - lift) * half_disc + lift * up;
        // Rounding can leave the disc by 1e−16.
        let z = (1.0 - x * x - y * y).max(0.0).sqrt();
        let normal = x * across + y * upward + z * view;
        // Undo the stretching.
        DVec3::new(
            self.alpha * normal.x,
            self.alpha * normal.y,
            normal.z.max(0.0),
        )
        .normalize()
    }

    /// Returns `r(w) = √(cos²θ + α² sin²θ)`.
    fn reach(self, w: DVec3) -> f64 {
        let sine_square = w.x * w.x + w.y * w.y;
        (w.z * w.z + self.alpha * self.alpha * sine_square).sqrt()
    }
}

/// Returns the unit vector half-way between two directions above the surface.
///
/// Opposite directions along the surface leave only their heights, whose product is not 0.
pub(super) fn half_vector(wo: DVec3, wi: DVec3) -> DVec3 {
    (wo + wi).normalize()
}
