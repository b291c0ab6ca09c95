use std::borrow::Cow;

use glam::{DMat2, DVec2};
use tem00_camera::Camera;
use tem00_numerics::{Grid, cast::to_usize};

use crate::{ScanError, sensor_speckle::SensorSpeckle, speckle_table::SpeckleTable};

/// The speckle of a laser all over an image.
#[derive(Clone, Debug)]
pub(super) struct ImageSpeckle {
    camera: Camera,
    wavelength: f64,
    middle: SensorSpeckle,
    /// The covariances in the middle of the image.
    table: SpeckleTable,
    /// Tables of one column at the corners of `CELLS`² cells of the image, unless they are equal
    /// everywhere.
    columns: Option<Grid<SpeckleTable>>,
}

/// Cells along each side of the image, between whose corners covariances are interpolated: with a
/// sensor tilted by 7° within 10⁻⁵ of the variance.
const CELLS: usize = 4;

impl ImageSpeckle {
    /// Creates the speckle of light of a wavelength, in metres, with a variance of the speckle
    /// factor, in pixels with a sensitive part.
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
        let middle = 0.5 * camera.description().size();
        let speckles_per_pixel =
            speckles_per_pixel(&camera, middle, wavelength).ok_or_else(|| {
                ScanError::Scene("the camera must see something in the middle".to_owned())
            })?;
        let middle = SensorSpeckle {
            speckles_per_pixel,
            sensitive_side,
            variance,
        };
        let mut speckle = Self {
            camera,
            wavelength,
            table: SpeckleTable::new(&middle, [0.0; 2]),
            middle,
            columns: None,
        };
        speckle.columns = speckle.tables_of_columns();
        Ok(speckle)
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
        let local = self.speckle_at(pixel);
        if local == self.middle {
            Cow::Borrowed(&self.table)
        } else {
            Cow::Owned(SpeckleTable::new(&local, [0.0; 2]))
        }
    }

    /// Returns the covariances of the pixels of one column about an image point.
    pub(super) fn column(&self, pixel: DVec2) -> Cow<'_, SpeckleTable> {
        let Some(columns) = &self.columns else {
            return Cow::Borrowed(&self.table);
        };
        let last = CELLS as f64 - 1.0;
        let position = (pixel / self.cell()).clamp(DVec2::ZERO, DVec2::splat(CELLS as f64));
        let corner = position.floor().min(DVec2::splat(last));
        let within = position - corner;
        let [x, y] = corner.to_array().map(to_usize);
        let corners = [y, y + 1].map(|y| [x, x + 1].map(|x| &columns.row(y)[x]));
        Cow::Owned(SpeckleTable::between(corners, within))
    }

    /// The covariances of one column at the corners of the cells, if they differ.
    fn tables_of_columns(&self) -> Option<Grid<SpeckleTable>> {
        let speckles = Grid::from_fn(CELLS + 1, CELLS + 1, |x, y| {
            self.speckle_at(self.cell() * DVec2::new(x as f64, y as f64))
        });
        let mut all = speckles.values().iter();
        if all.all(|speckle| *speckle == self.middle) {
            return None;
        }
        let reaches = speckles
            .values()
            .iter()
            .map(SpeckleTable::rows_within_reach);
        let reach = reaches.max()?;
        Some(speckles.map(|speckle| SpeckleTable::of_column(speckle, reach)))
    }

    /// The size of a cell, in pixels.
    fn cell(&self) -> DVec2 {
        self.camera.description().size() / CELLS as f64
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

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use tem00_camera::{CameraDescription, SensorTilt};

    use super::*;

    #[test]
    fn columns_between_corners_have_the_covariances_of_their_place() {
        let camera = Camera::new(CameraDescription {
            position: DVec3::new(0.0, -0.125, 0.2165),
            up: DVec3::Z,
            focal_length: 0.016,
            f_number: 11.0,
            focus_distance: 0.25,
            pixel_pitch: 6.9e-6,
            resolution: [1040, 400],
            tilt: SensorTilt {
                angle: -0.118,
                azimuth: 0.0,
            },
            ..CameraDescription::default()
        });
        let speckle = ImageSpeckle::new(camera.expect("a camera"), 660e-9, (0.9, 1.0));
        let speckle = speckle.expect("speckle");
        for pixel in [[0.0, 0.0], [130.0, 50.0], [650.0, 150.0], [1040.0, 399.0]] {
            let pixel = DVec2::from_array(pixel);
            let (column, local) = (speckle.column(pixel), speckle.speckle_at(pixel));
            for rows in [0.0, 1.0, 2.0, 5.0] {
                let error = column.covariance([0.0, rows]) - local.covariance([0.0, rows]);
                // 7.8e-6 in the middle of a cell.
                assert!(error.abs() < 1e-5, "{pixel}, {rows}: {error:e}");
            }
        }
    }
}
