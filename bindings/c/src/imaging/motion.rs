use tem00_decorrelation::{CameraFrame, DMat3, DVec2, DVec3, LineOfSight};

use super::Imaging;
use crate::{
    numbers::{check_coordinates, check_result, check_size, code},
    pointers::{borrow, read, write},
    status::{Failure, Status, call},
};

/// Orientation in which image displacements are counted: along `right` and `up` of the camera.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageOrientation {
    /// The picture as shown on a screen.
    ScreenUpright = 0,
    /// The picture on the sensor behind the lens, upside down and mirrored.
    SensorInverted = 1,
}

/// The axes of a camera in world coordinates: right-handed and orthonormal within 1e-6.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraAxes {
    /// To the right in the image.
    pub right: [f64; 3],
    /// Upwards in the image.
    pub up: [f64; 3],
    /// From the scene towards the camera, against the direction of view.
    pub towards_camera: [f64; 3],
}

/// The light on a point: where it comes from and how its wavefront is curved.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavefront {
    /// From the surface to the source, of any length.
    pub direction_to_source: [f64; 3],
    /// A principal axis of the curvature, of any length and not along the direction to the source;
    /// not read if both curvatures are equal.
    pub axis: [f64; 3],
    /// Curvature 1/R along that axis, in 1/m: positive where the wave diverges, 0 for a plane wave.
    pub curvature_along: f64,
    /// Curvature 1/R across that axis, in 1/m.
    pub curvature_across: f64,
}

/// A point of a rough surface, as the camera sees it and as the laser lights it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The axes of the camera.
    pub camera: CameraAxes,
    /// From the point to the centre of the entrance pupil, in metres.
    pub to_pupil: [f64; 3],
    /// Normal of the surface, of any length and to either side.
    pub normal: [f64; 3],
    /// The light on the point.
    pub wavefront: Wavefront,
}

/// Small translations since the reference state, in world coordinates and metres. Only differences
/// count.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Translation of the surface.
    pub surface: [f64; 3],
    /// Translation of the camera.
    pub camera: [f64; 3],
    /// Translation of the light source and its wavefront.
    pub source: [f64; 3],
}

/// Effect of a motion on the speckle at one surface point.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpeckleMotion {
    /// Motion of the image of the surface along right and up, in metres on the sensor.
    pub image_displacement: [f64; 2],
    /// Additional displacement of the speckle of a point out of focus, in metres on the sensor.
    pub defocus_displacement: [f64; 2],
    /// Motion of the speckle field across the pupil along right and up, in metres; infinite if it
    /// left the pupil in a grazing view.
    pub pupil_displacement: [f64; 2],
    /// Motion of the surface towards the camera along the optical axis, in metres.
    pub axial_displacement: f64,
    /// Correlation of intensity with the pattern before, in [0, 1], where it is looked up
    /// at the sum of both displacements in the image.
    pub correlation: f64,
}

impl CameraAxes {
    pub(super) fn frame(&self) -> Result<CameraFrame, Failure> {
        let [right, up, back] = [self.right, self.up, self.towards_camera].map(DVec3::from_array);
        Ok(CameraFrame::from_axes(DMat3::from_cols(right, up, back))?)
    }
}

impl Wavefront {
    fn wavefront(&self) -> Result<tem00_decorrelation::Wavefront, Failure> {
        use tem00_decorrelation::Wavefront as W;
        let to_source = DVec3::from_array(self.direction_to_source);
        let (along, across) = (self.curvature_along, self.curvature_across);
        check_coordinates("curvature_along", &[along])?;
        check_coordinates("curvature_across", &[across])?;
        if (along..=along).contains(&across) {
            return Ok(W::spherical(to_source, along)?);
        }
        Ok(W::astigmatic(
            to_source,
            DVec3::from_array(self.axis),
            along,
            across,
        )?)
    }
}

impl SurfacePoint {
    fn point(&self) -> Result<tem00_decorrelation::SurfacePoint, Failure> {
        check_coordinates("to_pupil", &self.to_pupil)?;
        let to_pupil = DVec3::from_array(self.to_pupil);
        let sight = LineOfSight::new(&self.camera.frame()?, to_pupil)?;
        let normal = DVec3::from_array(self.normal);
        let wavefront = self.wavefront.wavefront()?;
        Ok(tem00_decorrelation::SurfacePoint::new(
            sight, normal, wavefront,
        )?)
    }
}

impl Motion {
    pub(super) fn motion(&self) -> Result<tem00_decorrelation::Motion, Failure> {
        check_coordinates("surface", &self.surface)?;
        check_coordinates("camera", &self.camera)?;
        check_coordinates("source", &self.source)?;
        Ok(tem00_decorrelation::Motion {
            surface: DVec3::from_array(self.surface),
            camera: DVec3::from_array(self.camera),
            source: DVec3::from_array(self.source),
        })
    }
}

impl SpeckleMotion {
    fn numbers(&self) -> [f64; 8] {
        let [image_x, image_y] = self.image_displacement;
        let [defocus_x, defocus_y] = self.defocus_displacement;
        let [pupil_x, pupil_y] = self.pupil_displacement;
        let (axial, correlation) = (self.axial_displacement, self.correlation);
        [
            image_x,
            image_y,
            defocus_x,
            defocus_y,
            pupil_x,
            pupil_y,
            axial,
            correlation,
        ]
    }
}

impl From<tem00_decorrelation::SpeckleMotion> for SpeckleMotion {
    fn from(speckle: tem00_decorrelation::SpeckleMotion) -> Self {
        let pupil_displacement = speckle.pupil_displacement.unwrap_or(DVec2::INFINITY);
        Self {
            image_displacement: speckle.image_displacement.to_array(),
            defocus_displacement: speckle.defocus_displacement.to_array(),
            pupil_displacement: pupil_displacement.to_array(),
            axial_displacement: speckle.axial_displacement,
            correlation: speckle.correlation,
        }
    }
}

pub(super) fn orientation(value: u32) -> Result<tem00_decorrelation::ImageOrientation, Failure> {
    use tem00_decorrelation::ImageOrientation::{ScreenUpright, SensorInverted};
    code("orientation", value, &[ScreenUpright, SensorInverted])
}

/// Computes the axes of a camera at `position` that looks at `target`, with `up` upwards in the image
/// as far as possible.
///
/// `position`, `target` and `up` hold x, y, z.
///
/// # Safety
///
/// The pointers are null or valid, those to numbers for three.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_camera_axes_look_at(
    position: *const f64,
    target: *const f64,
    up: *const f64,
    axes: *mut CameraAxes,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let position = DVec3::from_array(unsafe { read("position", position) }?);
        // SAFETY: by the contract of this function.
        let target = DVec3::from_array(unsafe { read("target", target) }?);
        // SAFETY: by the contract of this function.
        let up = DVec3::from_array(unsafe { read("up", up) }?);
        let frame = CameraFrame::look_at(position, target, up)?;
        let result = CameraAxes {
            right: frame.right().to_array(),
            up: frame.up().to_array(),
            towards_camera: frame.towards_camera().to_array(),
        };
        // SAFETY: by the contract of this function.
        unsafe { write("axes", axes, result) }
    })
}

/// Computes the curvature tensor of a wave, in 1/m, from how the direction to its source turns along a
/// surface, as a renderer has it from its ray differentials: after mirrors and lenses, too.
///
/// `direction_to_source`, of any length, holds x, y, z. `dp` holds the differentials of the surface point
/// by two parameters, in metres, one after the other, `dl` those of the unit vector to the source.
/// `curvature` receives xx, xy, xz, yy, yz, zz, as `tem00_field_points` takes them.
///
/// # Safety
///
/// The pointers are null or valid, those of the differentials and of the result for six numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_curvature_from_differentials(
    direction_to_source: *const f64,
    dp: *const f64,
    dl: *const f64,
    curvature: *mut f64,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let to_source = unsafe { read("direction_to_source", direction_to_source) }?;
        // SAFETY: by the contract of this function.
        let dp: [f64; 6] = unsafe { read("dp", dp) }?;
        // SAFETY: by the contract of this function.
        let dl: [f64; 6] = unsafe { read("dl", dl) }?;
        let pair =
            |[ux, uy, uz, vx, vy, vz]: [f64; 6]| [DVec3::new(ux, uy, uz), DVec3::new(vx, vy, vz)];
        let wave = tem00_decorrelation::Wavefront::from_differentials(
            DVec3::from_array(to_source),
            pair(dp),
            pair(dl),
        )?;
        let DMat3 {
            x_axis: x,
            y_axis: y,
            z_axis: z,
        } = wave.curvature();
        // SAFETY: by the contract of this function.
        unsafe {
            write(
                "curvature",
                curvature.cast(),
                [x.x, y.x, z.x, y.y, z.y, z.z],
            )
        }
    })
}

/// Computes the motion of the speckle at a surface point since the reference state, at first order in
/// the motion.
///
/// `orientation` is a `tem00_image_orientation`.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_imaging_speckle_motion(
    imaging: *const Imaging,
    point: *const SurfacePoint,
    motion: *const Motion,
    orientation: u32,
    speckle: *mut SpeckleMotion,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let Imaging(geometry) = unsafe { borrow("imaging", imaging) }?;
        // SAFETY: by the contract of this function.
        let point = unsafe { borrow("point", point) }?.point()?;
        // SAFETY: by the contract of this function.
        let motion = unsafe { borrow("motion", motion) }?.motion()?;
        let orientation = self::orientation(orientation)?;
        let result =
            tem00_decorrelation::SpeckleMotion::new(geometry, &point, &motion, orientation);
        let result = SpeckleMotion::from(result);
        check_result("speckle", &result.numbers())?;
        // SAFETY: by the contract of this function.
        unsafe { write("speckle", speckle, result) }
    })
}

/// Computes where in a speckle pattern a pixel lies, in pattern samples, not wrapped to its period.
///
/// `pixel` holds its position in pixels, x to the right and y down as rows count, from any origin;
/// `displacement` the motion of the speckle since the reference state to the right and up, in metres on
/// the sensor; `pattern_speckle_size` is the speckle size of the pattern in samples.
///
/// # Safety
///
/// The pointers are null or valid, those to numbers for two.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_imaging_pattern_coordinate(
    imaging: *const Imaging,
    pixel: *const f64,
    displacement: *const f64,
    pattern_speckle_size: f64,
    coordinate: *mut f64,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let Imaging(geometry) = unsafe { borrow("imaging", imaging) }?;
        // SAFETY: by the contract of this function.
        let pixel: [f64; 2] = unsafe { read("pixel", pixel) }?;
        // SAFETY: by the contract of this function.
        let displacement: [f64; 2] = unsafe { read("displacement", displacement) }?;
        check_coordinates("pixel", &pixel)?;
        check_coordinates("displacement", &displacement)?;
        check_size("pattern_speckle_size", pattern_speckle_size)?;
        let [pixel, displacement] = [pixel, displacement].map(DVec2::from_array);
        let result = geometry.pattern_coordinate(pixel, displacement, pattern_speckle_size);
        check_result("coordinate", &result.to_array())?;
        // SAFETY: by the contract of this function.
        unsafe { write("coordinate", coordinate.cast(), result.to_array()) }
    })
}
