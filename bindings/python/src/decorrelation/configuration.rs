use pyo3::prelude::*;
use tem00_decorrelation::{self as physics, DVec3};

use super::rigid::RigidMotion;
use crate::{
    arrays::{Floats, named_tuple},
    error::{OrRaise, refused},
};

class! {
    /// A point of a rough surface, its light and its camera, all in the world: one state of a
    /// scene.
    ///
    /// One state is made with ``Configuration(…)``, the other from it, by moving the bodies or
    /// changing the light.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Vacuum wavelength of the light in metres.
    /// point : array_like, shape (3,)
    ///     Position of the surface point in metres.
    /// normal : array_like, shape (3,)
    ///     Normal of the surface, of any length and to either side.
    /// illumination : Illumination
    ///     The light on the surface.
    /// camera : CameraFrame
    ///     Orientation of the camera.
    /// pupil : array_like, shape (3,)
    ///     Position of the centre of the entrance pupil in metres.
    "tem00.decorrelation" Configuration(physics::Configuration): Copy
}

methods! {
    impl Configuration as this: this.0;

    /// Return the state after surface, camera and light source have moved, as rigid bodies.
    ///
    /// Parameters
    /// ----------
    /// surface, camera, source : RigidMotion, optional
    ///     Motions of each; what is left out stands still.
    #[pyo3(signature = (*, surface = None, camera = None, source = None))]
    call moved(_py;
        surface: Option<PyRef<'py, RigidMotion>>, camera: Option<PyRef<'py, RigidMotion>>,
        source: Option<PyRef<'py, RigidMotion>>
    ) -> Self = {
        let [surface, camera, source] = [surface, camera, source]
            .map(|motion| motion.map_or(physics::RigidMotion::IDENTITY, |motion| motion.0));
        let motions = physics::RigidMotions {
            surface,
            camera,
            source,
        };
        let state = this.0.moved(&motions);
        Ok(Self(
            state.or_raise_renamed(&["to_pupil", "point"], "motions")?,
        ))
    };

    make new(
        wavelength: f64, point: DVec3, normal: DVec3, illumination: physics::Illumination,
        camera: physics::CameraFrame, pupil: DVec3
    ) = physics::Configuration::new(physics::ConfigurationData {
        wavelength, point, normal, illumination, camera, pupil,
    }).or_raise_renamed(&["to_pupil"], "pupil");

    /// Return the state with other light on the surface.
    try with_illumination(illumination: physics::Illumination) -> Configuration =
        this.0.with_illumination(illumination).or_raise_renamed(&["point"], "illumination");

    /// Return the state with another wavelength, in metres.
    ///
    /// The heights of a rough surface decorrelate its speckle then: see ``speckle_motion``.
    try with_wavelength(wavelength: f64) -> Configuration = this.0.with_wavelength(wavelength);

    /// Return the change, in rad/m, of the phase per height between this state and another.
    ///
    /// Normally distributed heights of standard deviation σ multiply the correlation of intensity
    /// by exp(−σ² Δq²), where Δq is this change, of q = 2π (cos i + cos o)/λ.
    ///
    /// Parameters
    /// ----------
    /// after : Configuration
    ///     The other state of the same surface point.
    ///
    /// Returns
    /// -------
    /// float or None
    ///     None where the pattern is decorrelated, as in a grazing view.
    fn height_phase_change(after: physics::Configuration) -> Option<f64> =
        this.0.height_phase_change(&after);

    /// Vacuum wavelength in metres.
    get wavelength -> f64;

    /// Position of the surface point in metres, of shape (3,).
    get point -> Floats;

    /// Unit normal of the surface, of shape (3,).
    get normal -> Floats;

    /// Unit vector from the surface point to the light source, of shape (3,).
    get direction_to_source -> Floats;

    /// Position of the centre of the entrance pupil in metres, of shape (3,).
    get pupil -> Floats;

    shown wavelength, point, normal, direction_to_source, pupil;
}

named_tuple! {
    SpeckleMotion(physics::SpeckleMotion) as motion: (
        Floats::from(motion.image_displacement),
        Floats::from(motion.defocus_displacement),
        Floats::from(motion.speckle_displacement()),
        motion.pupil_displacement.map(Floats::from),
        motion.axial_displacement,
        motion.correlation,
    )
}

functions! {
    /// Return the motion of the speckle between two states of the same surface point.
    ///
    /// The correlation is that of a surface without depth. Where the wavelength or the directions
    /// of light and sight change, heights multiply it by a factor that follows from
    /// ``Configuration.height_phase_change``: for visible light of another colour on a surface of
    /// 1 µm almost nothing is left.
    ///
    /// Parameters
    /// ----------
    /// geometry : ImagingGeometry
    ///     The camera in both states; its wavelength does not count here.
    /// before, after : Configuration
    ///     The states, however far apart.
    try speckle_motion(
        geometry: physics::ImagingGeometry, before: physics::Configuration,
        after: physics::Configuration
    ) -> SpeckleMotion = numbers(physics::SpeckleMotion::between(&geometry, &before, &after));
}

/// Refuses what moved so far that the result is NaN.
fn numbers(motion: physics::SpeckleMotion) -> PyResult<physics::SpeckleMotion> {
    let pupil = motion.pupil_displacement.unwrap_or_default();
    let vectors = motion.speckle_displacement() + pupil;
    if vectors.is_nan() || motion.axial_displacement.is_nan() || motion.correlation.is_nan() {
        let message = "after must be less extreme to have a result".to_owned();
        return Err(refused("after", message));
    }
    Ok(motion)
}
