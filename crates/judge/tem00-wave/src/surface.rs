use glam::DVec3;
use tem00_numerics::check;

use crate::{
    Amplitudes, PatchDescription, Refusal, RigidMotion, Roughness, Scatterer,
    heights::add_heights,
    length::{LENGTHS, checked_position},
    patch::{COUNT, PatchFrame},
    random::{Purpose, Random},
};

/// A rough surface, modelled as many point scatterers.
///
/// The scattered field at a distance `r` is `amplitude · incident · exp(ikr) / r`. Multiple
/// scattering, shadowing and polarisation are not modelled.
///
/// # Validity
///
/// A resolution cell of the camera should hold many scatterers: [`Amplitudes`] states the bias of
/// too few. A lattice with the spacing `d` repeats its speckle after λ/d in the sine of the angle,
/// at the distance L after λL/d. This period must exceed the pupil and all motion of the speckle
/// across it; the random offsets of [`Arrangement::Stratified`](crate::Arrangement::Stratified)
/// break the repetition.
///
/// # Examples
///
/// ```
/// use tem00_wave::{
///     Amplitudes, Arrangement, DVec3, PatchDescription, Roughness, RoughSurface,
/// };
///
/// let surface = RoughSurface::patch(&PatchDescription {
///     centre: DVec3::ZERO,
///     normal: DVec3::Z,
///     along: DVec3::X,
///     size: [2e-3, 1e-3],
///     scatterers: [200, 100],
///     arrangement: Arrangement::Lattice,
///     roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
///     seed: 1,
/// })?;
/// assert_eq!(surface.scatterers().len(), 20_000);
/// # Ok::<(), tem00_wave::Refusal>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RoughSurface {
    scatterers: Vec<Scatterer>,
}

impl RoughSurface {
    /// Creates a rectangular patch.
    ///
    /// Its mean brightness does not depend on the number of scatterers: a surface of area A under
    /// the irradiance E scatters `E A` per steradian in every direction.
    ///
    /// A scatterer takes 40 bytes, and about as many again while it is lit; heights take up to 128
    /// further bytes while they are generated.
    ///
    /// # Errors
    ///
    /// Returns an error if a length is not between 1 pm and 10 km, if a component of the centre is
    /// not finite or above 10 km, if a direction is zero or not finite, if `along` is parallel to
    /// the normal, if the number of scatterers is zero or above 2²⁸, or if a height or correlation
    /// length is negative, not finite or above 10 km.
    pub fn patch(patch: &PatchDescription) -> Result<Self, Refusal> {
        let frame = PatchFrame::new(patch)?;
        let mut scatterers = frame.arranged(patch);
        match patch.roughness {
            Roughness::FullyDeveloped(amplitudes) => {
                randomise(&mut scatterers, amplitudes, patch.seed);
            }
            Roughness::Heights {
                rms,
                correlation_length,
            } => {
                let lengths = [("rms", rms), ("correlation_length", correlation_length)];
                for (name, length) in lengths {
                    let holds = length == 0.0 || LENGTHS.contains(&length);
                    let allowed = "0 or from 1e-12 to 1e4, in metres";
                    check::that(holds, name, length, "", allowed)?;
                }
                add_heights(
                    &mut scatterers,
                    &frame,
                    [rms, correlation_length],
                    patch.seed,
                );
            }
        }
        Ok(Self { scatterers })
    }

    /// Creates a surface from its scatterers.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no scatterers, or if a component of a position or amplitude is
    /// not finite or above 10⁴ m in magnitude.
    pub fn from_scatterers(scatterers: Vec<Scatterer>) -> Result<Self, Refusal> {
        check::that(!scatterers.is_empty(), "scatterers", 0.0, "", COUNT)?;
        for scatterer in &scatterers {
            checked_position(scatterer.position, "position")?;
            let amplitude = scatterer.amplitude;
            checked_position(DVec3::new(amplitude.re, amplitude.im, 0.0), "amplitude")?;
        }
        Ok(Self { scatterers })
    }

    /// Returns the scatterers.
    pub fn scatterers(&self) -> &[Scatterer] {
        &self.scatterers
    }

    /// Returns the surface after a rigid motion.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        let moved = |scatterer: &Scatterer| Scatterer {
            position: motion.point(scatterer.position),
            ..*scatterer
        };
        Self {
            scatterers: self.scatterers.iter().map(moved).collect(),
        }
    }
}

fn randomise(scatterers: &mut [Scatterer], amplitudes: Amplitudes, seed: u64) {
    let mut random = Random::new(seed, Purpose::Amplitudes);
    for scatterer in scatterers {
        scatterer.amplitude *= match amplitudes {
            Amplitudes::ComplexGaussian => random.complex_gaussian(),
            Amplitudes::Unit => random.unit_phasor(),
        };
    }
}

#[cfg(test)]
mod tests;
