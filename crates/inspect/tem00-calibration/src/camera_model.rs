use tem00_numerics::check;
use tem00_triangulation::TriangulationError;

/// Known parameters of a camera before its calibration, and the choice of the parameters that are
/// estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraModel {
    /// The pixel pitch, in metres, of the data sheet.
    pub pixel_pitch: f64,
    /// The numbers of pixel columns and rows.
    pub resolution: [usize; 2],
    /// The focal length, in metres, of the data sheet; `None` if it is not known. The calibration
    /// estimates the image distance; the focal length decides where the image is sharp.
    pub focal_length: Option<f64>,
    /// The f-number, which decides blur and speckle and is not estimated.
    pub f_number: f64,
    /// True if the sensor is tilted (Scheimpflug): then its tilt is estimated, and the axis of the
    /// lens is taken to meet the middle of the image. Otherwise the principal point is estimated.
    ///
    /// Without distortion both describe the same images: a pinhole in front of a tilted sensor is
    /// equivalent to a pinhole in front of an upright sensor, with the principal point where the
    /// perpendicular meets it. Therefore they are not estimated together.
    pub tilted: bool,
    /// The number of coefficients of radial distortion that are estimated, from 0 to 3.
    pub radial: usize,
}

impl CameraModel {
    pub(super) fn check(&self) -> Result<(), TriangulationError> {
        check::positive("pixel_pitch", self.pixel_pitch, "m")?;
        check::positive("focal_length", self.focal_length.unwrap_or(1.0), "m")?;
        let allowed = "from 0 to 3 coefficients of distortion";
        Ok(check::that(
            self.radial <= 3,
            "radial",
            self.radial,
            "",
            allowed,
        )?)
    }

    /// Returns the distance at which the image is sharp: by the lens equation if the focal length
    /// is known and shorter than the image distance, else where the boards stood.
    pub(super) fn focus_distance(&self, image_distance: f64, mean_depth: f64) -> f64 {
        let by_lens = self
            .focal_length
            .map(|f| f * image_distance / (image_distance - f));
        by_lens
            .filter(|focus| *focus > 0.0 && focus.is_finite())
            .unwrap_or(mean_depth)
    }
}
