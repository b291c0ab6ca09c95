use core::fmt;

use tem00_tracer::{OpticalRoughness, OpticalRoughnessQuery, Scene, TracerError};

/// A surface that is too smooth for the theory of speckle under a laser.
///
/// Its `Display` is one line that says why.
#[derive(Clone, Debug, PartialEq)]
pub struct RoughnessNote {
    /// The name of the surface.
    pub surface: String,
    /// The index of the laser.
    pub laser: usize,
    /// The effect of its roughness on the light.
    pub roughness: OpticalRoughness,
}

impl fmt::Display for RoughnessNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (surface, laser) = (&self.surface, self.laser);
        let text = "is too smooth for fully developed speckle of laser";
        write!(f, "surface `{surface}` {text} {laser}: {}", self.roughness)
    }
}

/// A surface that gets light of a laser from so small a part of another that the speckle of that
/// part shows.
///
/// Its `Display` is one line that says why.
#[derive(Clone, Debug, PartialEq)]
pub struct CascadeNote {
    /// The name of the surface that is seen.
    pub surface: String,
    /// The index of the laser.
    pub laser: usize,
    /// The contrast of the speckle there, at its highest, in light of one wavelength.
    pub contrast: f64,
}

impl fmt::Display for CascadeNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (surface, laser, contrast) = (&self.surface, self.laser, self.contrast);
        write!(
            f,
            "surface `{surface}` gets light of laser {laser} from a small part of another surface, \
             whose own speckle would raise the contrast to {contrast:.2}; it is rendered as 1 at \
             most"
        )
    }
}

/// Returns a note for each surface and laser whose speckle the theory does not hold for, in the
/// order of the surfaces.
///
/// A surface counts as lit and seen along its normal, where it is the roughest to light, and as
/// resolved by the camera as one in focus. Mirrors and glass make no speckle and get no note.
///
/// # Errors
///
/// Returns an error if the imaging geometry is not possible, or if a wavelength or a height is
/// beyond what [`Material::optical_roughness`](tem00_tracer::Material::optical_roughness) judges.
pub fn roughness_notes(scene: &Scene) -> Result<Vec<RoughnessNote>, TracerError> {
    let mut notes = Vec::new();
    for surface in &scene.surfaces {
        for (index, laser) in scene.lasers.iter().enumerate() {
            let wavelength = laser.wavelength();
            let geometry = scene.camera.imaging_geometry(wavelength)?;
            let roughness = surface.material.optical_roughness(&OpticalRoughnessQuery {
                wavelength,
                incidence: 0.0,
                viewing: 0.0,
                resolution_cell: geometry.object_speckle_size(),
                rms_height: Some(surface.relief.rms_height).filter(|height| *height > 0.0),
            })?;
            let smooth = roughness.filter(|roughness| !roughness.is_fully_developed());
            notes.extend(smooth.map(|roughness| RoughnessNote {
                surface: surface.name.clone(),
                laser: index,
                roughness,
            }));
        }
    }
    Ok(notes)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use tem00_tracer::{LaserDescription, Material, Metal, Spectrum};

    use super::roughness_notes;
    use crate::testing::{self, camera, plate, spot};

    /// A camera that resolves λ L/D = 62 µm at 650 nm and 51 µm at 532 nm.
    fn scene() -> tem00_tracer::Scene {
        let red = spot(DVec3::new(0.1, 0.0, 0.3), 0.1e-3);
        let green = LaserDescription {
            spectrum: Spectrum::monochromatic(532e-9).unwrap(),
            ..red.clone()
        };
        let plate = plate(DVec3::ZERO, DVec3::Z, [0.02, 0.02]);
        testing::scene(camera(0.3 * DVec3::Z, [640, 480]), &[red, green], plate)
    }

    #[test]
    fn what_is_too_smooth_is_noted_for_each_laser_and_nothing_else_is() {
        let mut scene = scene();
        let mut noted = |material: Material, rms_height: Option<f64>| -> Vec<usize> {
            scene.surfaces[0].material = material;
            scene.surfaces[0].relief.rms_height = rms_height.unwrap_or(0.0);
            let notes = roughness_notes(&scene).unwrap();
            notes.iter().map(|note| note.laser).collect()
        };
        let metal = |roughness| Material::conductor(Metal::Iron, roughness).unwrap();
        // N = (2π α d/λ)²/2 with d/λ = 96 for both: 20 patches take α = 0.0105.
        assert_eq!(noted(metal(0.0101), None), [0, 1]);
        assert_eq!(noted(metal(0.0109), None), [0_usize; 0]);
        // exp(−σ²) = 0.01 takes σ = 4π σ_h/λ = 2.146: 111 nm in red, 90.9 nm in green.
        assert_eq!(noted(metal(0.1), Some(112e-9)), [0_usize; 0]);
        assert_eq!(noted(metal(0.1), Some(100e-9)), [0]);
        assert_eq!(noted(metal(0.1), Some(90e-9)), [0, 1]);
        let mirror = Material::mirror(0.9).unwrap();
        assert_eq!(noted(mirror, Some(1e-9)), [0_usize; 0]);
        let paper = Material::lambertian(0.8).unwrap();
        assert_eq!(noted(paper, None), [0_usize; 0]);
    }
}
