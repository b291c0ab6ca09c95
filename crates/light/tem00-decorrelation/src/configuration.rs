use glam::{DMat3, DVec3};

use tem00_numerics::check;

use crate::{CameraFrame, Illumination, LineOfSight, Refusal, RigidMotions, vector::unit};

/// Parameters of a [`Configuration`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConfigurationData {
    /// Vacuum wavelength λ of the light, in metres.
    pub wavelength: f64,
    /// Position of the surface point, in metres.
    pub point: DVec3,
    /// Normal of the surface at the point, of any length and to either side.
    pub normal: DVec3,
    /// The light on the surface.
    pub illumination: Illumination,
    /// Orientation of the camera.
    pub camera: CameraFrame,
    /// Position of the centre of the entrance pupil, in metres.
    pub pupil: DVec3,
}

/// State of a scene: a point of a rough surface, its light and its camera, all in world
/// coordinates.
///
/// Two states determine the change of the speckle between them. The first is created with
/// [`new`](Self::new), the second from the first, by moving the bodies or by changing the light.
/// Both states describe the same material point.
///
/// # Examples
///
/// A surface seen and lit along its normal from 0.3 m tilts by 0.3 mrad. The reflected light turns
/// by twice this angle, and the speckle moves by 180 µm across the pupil:
///
/// ```
/// use tem00_decorrelation::{
///     CameraFrame, Configuration, ConfigurationData, DVec2, DVec3, Illumination, RigidMotion,
///     RigidMotions,
/// };
///
/// let pupil = DVec3::new(0.0, 0.0, 0.3);
/// let before = Configuration::new(ConfigurationData {
///     wavelength: 632.8e-9,
///     point: DVec3::ZERO,
///     normal: DVec3::Z,
///     illumination: Illumination::collimated(DVec3::Z)?,
///     camera: CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::Y)?,
///     pupil,
/// })?;
/// let after = before.moved(&RigidMotions {
///     surface: RigidMotion::about(DVec3::ZERO, DVec3::Y, 0.3e-3)?,
///     ..RigidMotions::default()
/// })?;
///
/// let moved = before.pupil_point_after(&after, DVec2::ZERO).unwrap();
/// assert!((moved - DVec2::new(180e-6, 0.0)).length() < 1e-9);
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    pub(crate) wavelength: f64,
    pub(crate) point: DVec3,
    /// Two tangents and the normal as columns. They turn with the surface.
    pub(crate) surface_axes: DMat3,
    pub(crate) illumination: Illumination,
    pub(crate) to_source: DVec3,
    pub(crate) sight: LineOfSight,
    pub(crate) pupil: DVec3,
}

impl Configuration {
    /// Creates a state of the scene.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not positive and finite, if the normal is zero or not
    /// finite, if the point does not lie in front of the camera, or if the light has no direction
    /// there, as in a focus.
    pub fn new(data: ConfigurationData) -> Result<Self, Refusal> {
        let normal = unit("normal", data.normal)?;
        let (n1, n2) = normal.any_orthonormal_pair();
        let sight = LineOfSight::new(&data.camera, data.pupil - data.point)?;
        Self {
            wavelength: data.wavelength,
            point: data.point,
            surface_axes: DMat3::from_cols(n1, n2, normal),
            illumination: data.illumination,
            to_source: DVec3::ZERO,
            sight,
            pupil: data.pupil,
        }
        .lit()
    }

    /// Returns the state after surface, camera and source have moved.
    ///
    /// # Errors
    ///
    /// Returns an error if the point no longer lies in front of the camera, or if the light has no
    /// direction there. The speckle, if any, is then decorrelated.
    pub fn moved(&self, motions: &RigidMotions) -> Result<Self, Refusal> {
        let point = motions.surface.point(self.point);
        let pupil = motions.camera.point(self.pupil);
        let camera = self.sight.camera().turned(motions.camera.rotation());
        Self {
            wavelength: self.wavelength,
            point,
            surface_axes: motions.surface.rotation() * self.surface_axes,
            illumination: self.illumination.moved(&motions.source),
            to_source: DVec3::ZERO,
            sight: LineOfSight::new(&camera, pupil - point)?,
            pupil,
        }
        .lit()
    }

    /// Returns the state with other light on the surface.
    ///
    /// # Errors
    ///
    /// Returns an error if the new light has no direction at the point.
    pub fn with_illumination(self, illumination: Illumination) -> Result<Self, Refusal> {
        Self {
            illumination,
            ..self
        }
        .lit()
    }

    /// Returns the state with another wavelength, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not positive and finite.
    pub fn with_wavelength(self, wavelength: f64) -> Result<Self, Refusal> {
        Self { wavelength, ..self }.lit()
    }

    fn lit(self) -> Result<Self, Refusal> {
        check::positive("wavelength", self.wavelength, "m")?;
        let to_source = self
            .illumination
            .direction_from(self.point)
            .ok_or_else(|| {
                let allowed = "neither at the source nor in a focus";
                Refusal::new("point", self.point.to_array(), allowed).in_unit("m")
            })?;
        Ok(Self { to_source, ..self })
    }

    /// Returns the vacuum wavelength λ, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the position of the surface point, in metres.
    pub const fn point(&self) -> DVec3 {
        self.point
    }

    /// Returns the unit normal of the surface.
    pub const fn normal(&self) -> DVec3 {
        self.surface_axes.z_axis
    }

    /// Returns the unit vector from the surface point to the light source.
    pub const fn direction_to_source(&self) -> DVec3 {
        self.to_source
    }

    /// Returns the line of sight to the point.
    pub const fn sight(&self) -> &LineOfSight {
        &self.sight
    }

    /// Returns the position of the centre of the entrance pupil, in metres.
    pub const fn pupil(&self) -> DVec3 {
        self.pupil
    }
}
