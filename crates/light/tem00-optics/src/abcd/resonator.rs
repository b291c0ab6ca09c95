//! Systems that light travels through repeatedly.

use tem00_beam::Refusal;
use tem00_numerics::check;

use super::AbcdMatrix;
use crate::ComplexBeamParameter;

/// # Resonators
impl AbcdMatrix {
    /// Returns half the trace, `(A + D) / 2`, of the matrix.
    ///
    /// For the round trip of a two-mirror resonator it is `2 g₁ g₂ − 1` with `g = 1 − L/R`.
    pub fn half_trace(&self) -> f64 {
        0.5 * self.a + 0.5 * self.d
    }

    /// Returns whether rays stay near the axis after any number of passes through the system: for
    /// the round trip of a resonator, whether the resonator is stable.
    ///
    /// ```text
    /// |A + D| / 2 < √det      where √det = 1 for a round trip
    /// ```
    ///
    /// The limits themselves (plane, concentric and confocal resonators) do not count as stable: in
    /// them no beam, or every beam, reproduces itself.
    pub fn is_stable(&self) -> bool {
        self.stability() > 0.0
    }

    /// Returns the beam parameter that reproduces itself from the input plane to the output plane:
    /// for the round trip of a resonator, the parameter of its eigenmode.
    ///
    /// ```text
    /// z = (A − D) / (2 C)      z_R = √(det − (A + D)²/4) / |C|
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if the system is not [stable](Self::is_stable), or if the parameter is
    /// outside the range of [`ComplexBeamParameter::new`].
    ///
    /// # Examples
    ///
    /// A helium–neon laser of 0.3 m with a plane mirror, where the round trip begins, and a mirror
    /// of 1 m radius:
    ///
    /// ```
    /// use tem00_optics::AbcdMatrix;
    ///
    /// let arm = AbcdMatrix::free_space(0.3)?;
    /// let round_trip = arm.then(AbcdMatrix::curved_mirror(1.0)?).then(arm);
    /// let mode = round_trip.eigenmode()?.to_located_beam(632.8e-9, 1.0)?;
    ///
    /// assert!(mode.waist_distance().abs() < 1e-15, "the waist is on the plane mirror");
    /// assert!((mode.beam().waist_radius() - 0.304e-3).abs() < 0.001e-3);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn eigenmode(&self) -> Result<ComplexBeamParameter, Refusal> {
        let stability = self.stability();
        let allowed = "in (-1, 1) for a beam to reproduce itself";
        check::that(
            stability > 0.0,
            "half_trace",
            self.half_trace(),
            "",
            allowed,
        )?;
        let distance = (0.5 * self.a - 0.5 * self.d) / self.c;
        ComplexBeamParameter::new(distance, stability.sqrt() / self.c.abs())
    }

    /// det − (A + D)²/4, in the form that does not cancel for almost plane mirrors.
    fn stability(&self) -> f64 {
        let half_difference = 0.5 * self.a - 0.5 * self.d;
        -self.b * self.c - half_difference * half_difference
    }
}

#[cfg(test)]
mod tests;
