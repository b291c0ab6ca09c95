use core::f64::consts::PI;
use std::borrow::Cow;

use glam::DMat2;
use glam::DVec2;
use tem00_camera::Camera;
use tem00_numerics::{cast::to_usize, jinc, quadrature::gauss_legendre};

use crate::ScanError;
use crate::speckle_table::SpeckleTable;

/// Speckle as the pixels of a sensor see it, at a place of the image.
///
/// The autocovariance of fully developed speckle behind a circular pupil is that of Airy's pattern,
/// in directions that the pupil tells apart:
///
/// ```text
/// c(Δ) = C² |2 J₁(π|M Δ|) / π|M Δ||²      M = (D/λ) ∂t/∂x
/// ```
///
/// with the tangents t of the chief rays, at the image points x. On a plain sensor speckle is as wide
/// everywhere and in all directions; a tilt of the sensor and a lens that distorts stretch it as they
/// stretch the image.
///
/// # Validity
///
/// Paraxial: at the angle θ off the axis speckle is longer by up to 1/cos³θ.
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007: the autocovariance of speckle in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorSpeckle {
    /// M, how many speckles a pixel to the right (first column) and a pixel down (second) are, along the
    /// axes of the camera.
    pub speckles_per_pixel: DMat2,
    /// The side of the sensitive part of a pixel, in pixels.
    pub sensitive_side: f64,
    /// The variance C² of the speckle factor in a point: 1 for one polarised pattern.
    pub variance: f64,
}

impl SensorSpeckle {
    /// Returns the speckle size along rows and along columns, in pixels.
    pub fn size(&self) -> [f64; 2] {
        let DMat2 { x_axis, y_axis } = self.speckles_per_pixel;
        [x_axis.length().recip(), y_axis.length().recip()]
    }

    /// Returns the covariance of the speckle factors of two pixels, a displacement in pixels apart.
    pub(super) fn covariance(&self, displacement: [f64; 2]) -> f64 {
        let [across, down] = [0, 1].map(|axis| self.nodes(axis, displacement[axis]));
        let sum: f64 = across
            .iter()
            .flat_map(|a| down.iter().map(move |d| (a, d)))
            .map(|((x, weight_x), (y, weight_y))| {
                let speckles = self.speckles_per_pixel * DVec2::new(*x, *y);
                let field = jinc(PI * speckles.length());
                weight_x * weight_y * field * field
            })
            .sum();
        self.variance * sum
    }

    /// The distances, in pixels, at which the integral along an axis takes its values, with the weights.
    fn nodes(&self, axis: usize, displacement: f64) -> Vec<(f64, f64)> {
        // Each panel is at most half a speckle wide, to either side of the kink of the triangle.
        let panels = (2.0 * self.sensitive_side / self.size()[axis])
            .ceil()
            .clamp(1.0, 64.0);
        let half_width = 0.5 / panels;
        let half = (0..to_usize(panels)).flat_map(|panel| {
            let middle = 2.0 * panel as f64 + 1.0;
            RULE.map(|(node, weight)| (half_width * (middle + node), half_width * weight))
        });
        half.flat_map(|(u, weight)| [(u, weight), (-u, weight)])
            .map(|(u, weight)| {
                let distance = displacement + self.sensitive_side * u;
                (distance, weight * (1.0 - u.abs()))
            })
            .collect()
    }
}

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
    pub(super) fn at(&self, pixel: DVec2) -> SensorSpeckle {
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
        let local = self.at(pixel);
        if local == self.middle {
            return Ok(&self.table);
        }
        Err(local)
    }
}

/// How many speckles the pixels at an image point are, or `None` if no ray reaches it.
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

/// Four points per panel.
const RULE: [(f64, f64); 4] = gauss_legendre();
