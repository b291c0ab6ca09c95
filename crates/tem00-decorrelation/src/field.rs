mod kernel;
mod slices;
#[cfg(test)]
mod tests;

use glam::DVec3;
use tem00_numerics::cast::to_f32;

use crate::{CameraFrame, DecorrelationError, ImageOrientation, ImagingGeometry, Motion};

pub use slices::{FieldLight, FieldPoints, FieldSlices};

/// Camera and pattern that all points of a [`MotionField`] share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldSetup {
    /// The lens, its pupil and the sensor.
    pub geometry: ImagingGeometry,
    /// The axes of the camera.
    pub camera: CameraFrame,
    /// Centre of the pupil in world coordinates, in metres.
    pub pupil_centre: DVec3,
    /// Orientation in which image displacements are counted.
    pub orientation: ImageOrientation,
    /// Speckle size `h_p` of the pattern, in pattern samples.
    pub pattern_speckle_size: f64,
}

/// Changes of the speckle by motions at many surface points, such as those behind the pixels of an
/// image.
///
/// It is [`SpeckleMotion`](crate::SpeckleMotion) for slices, from world points to the coordinate of the
/// look-up in the pattern: everything that the points share is worked out once, and the loop over them needs no
/// more than arithmetic and square roots. A stack of patterns turns the correlation into a coordinate
/// along its own path. The results of a point do not depend, to the last bit, on the
/// points around it. They differ from those of [`SpeckleMotion::new`](crate::SpeckleMotion::new) by
/// rounding, but for the correlation: here it is the product law, which needs no integral.
///
/// A point out of focus adds to the motion of its image what the pupil displacement does there:
///
/// ```text
/// ± [(c / Z) Π (a − c_P) − c (1/Z − 1/L) a_P]        + screen upright, − sensor inverted
/// ```
///
/// with the depth Z of the point, the motion `c_P` of the pupil, and c = m L.
///
/// A point that the camera cannot see, one that it sees edge-on under a curved wave, and one whose
/// numbers overflow are decorrelated: their correlation is 0, their pupil displacement infinite in
/// both components, and their speckle moves with the image of the surface or, out of sight, not at
/// all.
///
/// # Validity
///
/// That of [`SpeckleMotion`](crate::SpeckleMotion): first order in the motion. The correlation is
/// the product law. At the displacement returned with it, it is too small by up to 0.048, where a
/// point moves across the pupil and along the axis at once:
/// [`CorrelationLaw::AtImageDisplacement`](crate::CorrelationLaw::AtImageDisplacement) is exact there.
///
/// # Examples
///
/// Two points in collimated light, one of which moves sideways by a quarter of a millimetre:
///
/// ```
/// use tem00_decorrelation::{
///     CameraFrame, DVec2, DVec3, FieldLight, FieldPoints, FieldSetup, FieldSlices, ImageOrientation,
///     ImagingGeometry, LensData, MotionField,
/// };
///
/// let eye = DVec3::new(0.0, 0.0, 0.3);
/// let field = MotionField::new(FieldSetup {
///     geometry: ImagingGeometry::from_lens(LensData {
///         wavelength: 650e-9,
///         focal_length: 25e-3,
///         f_number: 8.0,
///         surface_to_pupil: 0.3,
///         pixel_pitch: 3.45e-6,
///     })?,
///     camera: CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y)?,
///     pupil_centre: eye,
///     orientation: ImageOrientation::ScreenUpright,
///     pattern_speckle_size: 4.0,
/// })?;
///
/// let (zero, one) = ([0.0; 2], [1.0; 2]);
/// let points = FieldPoints {
///     position: [&[0.0, 1e-3], &zero, &zero],
///     normal: [&zero, &zero, &one],
///     motion: [&[0.0, 0.25e-3], &zero, &zero],
///     light: FieldLight::Collimated,
/// };
/// let mut out = [[0.0; 2]; 7];
/// let [speckle_x, speckle_y, pupil_x, pupil_y, correlation, pattern_x, pattern_y] = &mut out;
/// field.evaluate(&points, FieldSlices {
///     speckle_displacement: [speckle_x, speckle_y],
///     pupil_displacement: [pupil_x, pupil_y],
///     correlation,
///     pattern_coordinate: [pattern_x, pattern_y],
/// });
///
/// assert_eq!(correlation[0], 1.0);
/// assert!((speckle_x[1] / 3.45e-6 - 6.588).abs() < 1e-3);
/// assert!((correlation[1] - 0.807).abs() < 1e-3);
/// // In focus the pattern moves with the point: it is looked up at the image that the point had.
/// assert_eq!(Some(DVec2::new(pattern_x[1], pattern_y[1])), field.pattern_coordinate(DVec3::X * 1e-3));
/// # Ok::<(), tem00_decorrelation::DecorrelationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionField {
    setup: FieldSetup,
    /// The length c of the image of a unit tangent, in metres, positive if the image is upright.
    signed_principal_distance: f64,
    /// 1/L, in 1/m.
    per_surface_to_pupil: f64,
    /// 1/D, in 1/m.
    per_pupil_diameter: f64,
    /// The axial decorrelation length at a depth of 1 m, inverted: 1/(8 λ (1 m/D)²), in 1/m.
    per_axial_length: f64,
    samples_per_metre: f64,
    /// Added to the `motion` of the points to give `a − c` and `a − s`.
    seen: DVec3,
    within_illumination: DVec3,
}

/// Up to here products with coordinates of up to 1e50 stay far from infinity, of which two would
/// make a difference that is NaN.
const LARGEST_SCALE: f64 = 1e250;

impl MotionField {
    /// Creates a field in which the surface moves alone.
    ///
    /// # Errors
    ///
    /// Returns an error if the centre of the pupil is not finite or the speckle size of the pattern not
    /// positive and finite, or if geometry and pattern are so far apart in scale that products of their
    /// lengths overflow.
    pub fn new(setup: FieldSetup) -> Result<Self, DecorrelationError> {
        let FieldSetup {
            geometry,
            pupil_centre,
            pattern_speckle_size,
            ..
        } = setup;
        if !pupil_centre.is_finite() {
            return Err(DecorrelationError::vector(
                "pupil_centre",
                pupil_centre,
                "finite, in metres",
            ));
        }
        if !(pattern_speckle_size > 0.0 && pattern_speckle_size.is_finite()) {
            return Err(DecorrelationError::refused(
                "pattern_speckle_size",
                pattern_speckle_size,
                "positive and finite, in samples",
            ));
        }
        let sign = match setup.orientation {
            ImageOrientation::ScreenUpright => 1.0,
            ImageOrientation::SensorInverted => -1.0,
        };
        let field = Self {
            setup,
            signed_principal_distance: sign
                * (geometry.magnification() * geometry.surface_to_pupil()),
            per_surface_to_pupil: 1.0 / geometry.surface_to_pupil(),
            per_pupil_diameter: 1.0 / geometry.pupil_diameter(),
            per_axial_length: 1.0 / geometry.axial_decorrelation_length_at(1.0),
            samples_per_metre: pattern_speckle_size / geometry.speckle_size(),
            seen: DVec3::ZERO,
            within_illumination: DVec3::ZERO,
        };
        let scales = [
            field.per_pupil_diameter,
            field.per_axial_length,
            field.samples_per_metre,
        ];
        match scales.into_iter().find(|scale| *scale > LARGEST_SCALE) {
            Some(scale) => Err(DecorrelationError::refused(
                "geometry",
                scale,
                "of the scale of the pattern, with ratios of lengths of at most 1e250",
            )),
            None => Ok(field),
        }
    }

    /// Returns the field with a motion of camera, source and all surfaces added to those of the
    /// points.
    #[must_use]
    pub fn with_shared_motion(self, motion: &Motion) -> Self {
        Self {
            seen: motion.surface_seen_by_camera(),
            within_illumination: motion.surface_within_illumination(),
            ..self
        }
    }

    /// Returns the camera and the pattern as the struct `Tem00Imaging` of the functions for
    /// [kernels](crate::closed_form), byte for byte. Shared motions are not part of it.
    ///
    /// # Errors
    ///
    /// Returns an error if a number overflows in single precision.
    pub fn to_rows(&self) -> Result<[[f32; 4]; 4], DecorrelationError> {
        let camera = &self.setup.camera;
        let row = |axis: DVec3, number: f64| axis.extend(number).to_array();
        let rows = [
            row(camera.right(), self.signed_principal_distance),
            row(camera.up(), self.per_surface_to_pupil),
            row(camera.towards_camera(), self.per_pupil_diameter),
            [self.per_axial_length, self.samples_per_metre, 0.0, 0.0],
        ];
        let largest = |number: &&f64| number.abs() > f64::from(f32::MAX);
        match rows.as_flattened().iter().find(largest) {
            Some(&number) => Err(DecorrelationError::refused(
                "geometry",
                number,
                "of lengths whose ratios are numbers in f32",
            )),
            None => Ok(rows.map(|row| row.map(to_f32))),
        }
    }

    /// Returns what all points share.
    pub const fn setup(&self) -> &FieldSetup {
        &self.setup
    }
}
