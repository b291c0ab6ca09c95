use glam::DVec3;

use crate::Artefact;

/// Measured point of an artefact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The column of the sensor that saw it.
    pub column: usize,
    /// The position on the artefact, in metres.
    pub position: DVec3,
}

/// Reach of a sensor, from which the sizes of artefacts follow; lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// The length of a profile.
    pub width: f64,
    /// The lowest and the highest height that can be measured.
    pub heights: [f64; 2],
    /// The distance of neighbouring points of a profile.
    pub column: f64,
    /// The thickness of the line across the profile.
    pub thickness: f64,
    /// The depth of grooves, small compared with the depth at which the sensor separates two lines.
    pub groove_depth: f64,
}

/// Sensor that measures profiles of the object under it.
pub trait ProfileSensor {
    /// The reason why nothing could be measured.
    type Error;

    /// Returns the field of the sensor.
    fn field(&self) -> Field;

    /// Measures the section y = 0 through an artefact at each of its places: where the origin of
    /// the artefact stands, in metres.
    ///
    /// Where a place is the same as the place before, nothing moves: a repetition has the same
    /// speckle and new noise. Points that the sensor does not trust are left out.
    ///
    /// # Errors
    ///
    /// Returns an error if the sensor cannot measure; an artefact that it does not see has no
    /// points.
    fn measure(
        &mut self,
        artefact: &Artefact,
        places: &[DVec3],
    ) -> Result<Vec<Vec<SurfacePoint>>, Self::Error>;
}
