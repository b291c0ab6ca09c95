use std::borrow::Cow;

use glam::{DMat2, DVec2};
use tem00_camera::Camera;

use crate::{ScanError, sensor_speckle::SensorSpeckle, speckle_table::SpeckleTable};

/// The speckle of a laser all over an image.
#[derive(Clone, Debug)]
pub(super) struct ImageSpeckle {
    camera: Camera,
    wavelength: f64,
    middle: SensorSpeckle,
    /// The covariances in the middle of the image.
    table: SpeckleTable,
}

impl ImageSpeckle {
    /// Takes the light of a wavelength, in metres, to have a variance of the speckle factor, in pixels with
    /// a sensitive part.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength exceeds the pupil of the camera.
    pub(super) fn new(
        camera: Camera,
        wavelength: f64,
        (sensitive_side, variance): (f64, f64),
    ) -> Result<Self, ScanError> {
        camera.imaging_geometry(wavelength)?;
        let middle = 0.5 * DVec2::new(camera.width() as f64, camera.height() as f64);
        let speckles_per_pixel =
            speckles_per_pixel(&camera, middle, wavelength).ok_or_else(|| {
                ScanError::Scene("the camera must see something in the middle".to_owned())
            })?;
        let middle = SensorSpeckle {
            speckles_per_pixel,
            sensitive_side,
            variance,
        };
        Ok(Self {
            camera,
            wavelength,
            table: SpeckleTable::new(&middle, [0.0; 2]),
            middle,
        })
    }

    /// Returns the speckle in the middle of the image.
    pub(super) const fn middle(&self) -> &SensorSpeckle {
        &self.middle
    }

    /// Returns the speckle at an image point.
    pub(super) fn speckle_at(&self, pixel: DVec2) -> SensorSpeckle {
        let local = speckles_per_pixel(&self.camera, pixel, self.wavelength);
        SensorSpeckle {
            speckles_per_pixel: local.unwrap_or(self.middle.speckles_per_pixel),
            ..self.middle
        }
    }

    /// Returns the covariances of the pixels about an image point.
    pub(super) fn table(&self, pixel: DVec2) -> Cow<'_, SpeckleTable> {
        self.known(pixel).map_or_else(
            |local| Cow::Owned(SpeckleTable::new(&local, [0.0; 2])),
            Cow::Borrowed,
        )
    }

    /// Returns the covariances of the pixels of one column about an image point.
    pub(super) fn column(&self, pixel: DVec2) -> Cow<'_, SpeckleTable> {
        self.known(pixel).map_or_else(
            |local| Cow::Owned(SpeckleTable::of_column(&local)),
            Cow::Borrowed,
        )
    }

    /// The covariances in the middle of the image where they hold at an image point, as on a plain
    /// sensor, or else the speckle there.
    fn known(&self, pixel: DVec2) -> Result<&SpeckleTable, SensorSpeckle> {
        let local = self.speckle_at(pixel);
        if local == self.middle {
            return Ok(&self.table);
        }
        Err(local)
    }
}

/// Pixel size in speckles at an image point, or `None` if no ray reaches it.
fn speckles_per_pixel(camera: &Camera, pixel: DVec2, wavelength: f64) -> Option<DMat2> {
    let (_, steps) = camera.sight(pixel)?;
    let axes = camera.axes();
    let [right, down] = steps.map(|step| {
        let tangent = DVec2::new(step.dot(axes.x_axis), step.dot(axes.y_axis));
        tangent * (camera.pupil_diameter() / wavelength)
    });
    let matrix = DMat2::from_cols(right, down);
    (matrix.is_finite() && matrix.determinant() != 0.0).then_some(matrix)
}
