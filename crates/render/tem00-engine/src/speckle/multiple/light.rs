use tem00_decorrelation::pupil_overlap_correlation;
use tem00_numerics::disc_overlap_inverse;
use tem00_shading::SpeckleShift;

use super::super::SpecklePoint;

/// Light at a place of the image that has met several rough surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MultipleLight {
    /// The mean radiance, in W/(m² sr).
    pub radiance: f64,
    /// Radiance of single light.
    pub single: f64,
    /// The mutual coherence in the line of the laser: with itself, and with the single light.
    pub within: f64,
    pub with_single: f64,
    /// Squared correlation of its fields with the reference frame, without the displacement of the
    /// pupil: of multiple light, and of its product with single light.
    pub kept: f64,
    pub kept_with_single: f64,
    /// The degree of polarisation.
    pub polarisation: f64,
    /// The relative variance over a resolution cell of the speckle that the lit surfaces send
    /// there.
    pub cascade: f64,
    /// A point where it is seen.
    pub point: SpecklePoint,
}

impl MultipleLight {
    /// Returns the shift of the speckle of single and multiple light together at a point, from the
    /// shifts of both; `fraction` is the fraction of the multiple light.
    ///
    /// ```text
    /// γ = |f₁ chat(s₁) + f₂ chat(s₂) ⟨e^{ik(δ − δ₁)}⟩|²
    /// ```
    ///
    /// s₁ is the displacement of the pupil over the speckle of the single light; s₂ is the
    /// displacement without the source, which other surfaces replace: their paths change by δ, over
    /// which the mean is taken.
    pub(in crate::speckle) fn shift(
        &self,
        [single, multiple]: [SpeckleShift; 2],
        fraction: f64,
    ) -> SpeckleShift {
        let [f1, f2] = [1.0 - fraction, fraction];
        let [c1, c2] = [single, multiple].map(|shift| pupil_overlap_correlation(shift.pupil));
        let cross = 2.0 * f1 * f2 * (c1 * c2).sqrt() * self.kept_with_single;
        let correlation = f1 * f1 * c1 + cross + f2 * f2 * c2 * self.kept;
        let pupil = disc_overlap_inverse(correlation.clamp(0.0, 1.0).sqrt());
        SpeckleShift {
            displacement: f1 * single.displacement + f2 * multiple.displacement,
            across: f1 * single.across + f2 * multiple.across,
            axial: f1 * single.axial + f2 * multiple.axial,
            pupil: if pupil < 1.0 {
                pupil
            } else {
                pupil.max(f1 * single.pupil + f2 * multiple.pupil)
            },
        }
    }

    /// Returns whether multiple light makes one pattern with single light of this degree of
    /// polarisation.
    pub(crate) fn is_coherent(&self, polarisation: f64) -> bool {
        let is_same_state = (self.polarisation - polarisation).abs() < 1e-9;
        self.within >= 1.0 && self.with_single >= 1.0 && is_same_state
    }

    /// Returns the fraction of the multiple light when it is added to single light of a given
    /// radiance.
    pub(crate) fn fraction_beside(&self, single: f64) -> f64 {
        let all = self.radiance + single;
        if all > 0.0 { self.radiance / all } else { 0.0 }
    }

    /// Returns the weighted mean with other light, whose weight is `fraction`.
    pub(super) fn mixed(&self, other: &Self, fraction: f64) -> Self {
        let mean = |a: f64, b: f64| a + fraction * (b - a);
        Self {
            radiance: mean(self.radiance, other.radiance),
            single: mean(self.single, other.single),
            within: mean(self.within, other.within),
            with_single: mean(self.with_single, other.with_single),
            kept: mean(self.kept, other.kept),
            kept_with_single: mean(self.kept_with_single, other.kept_with_single),
            polarisation: mean(self.polarisation, other.polarisation),
            cascade: mean(self.cascade, other.cascade),
            point: self.point,
        }
    }
}
