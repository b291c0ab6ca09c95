use tem00_decorrelation::{DVec3, FieldSlices, MotionField};

use super::{
    Imaging,
    motion::{CameraAxes, Motion, orientation},
};
use crate::{
    numbers::{check_coordinates, code},
    pointers::{Named, borrow, columns, read, write},
    status::{Failure, Status, call},
};

/// The light on the points of a field, by the curvature of its wavefront there.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldLight {
    /// Plane waves.
    Collimated = 0,
    /// Spherical waves that diverge from `source`.
    PointSource = 1,
    /// Waves of the curvature tensor `curvature`.
    Curvature = 2,
}

/// Settings common to all points of a field.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FieldSetup {
    /// The axes of the camera.
    pub camera: CameraAxes,
    /// Centre of the pupil in world coordinates, in metres.
    pub pupil_centre: [f64; 3],
    /// Orientation in which image displacements are counted: a `tem00_image_orientation`.
    pub orientation: u32,
    /// Speckle size of the pattern, in samples.
    pub pattern_speckle_size: f64,
    /// Motion of camera, source and all surfaces, added to those of the points.
    pub shared_motion: Motion,
}

/// Points of rough surfaces: pointers to as many numbers as there are points, in world coordinates.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FieldPoints {
    /// Positions x, y, z in the reference state, in metres.
    pub position: [*const f64; 3],
    /// Surface normals x, y, z of any length, to either side.
    pub normal: [*const f64; 3],
    /// Translations x, y, z of the surface since the reference state, in metres.
    pub motion: [*const f64; 3],
    /// The light on the points: a `tem00_field_light`.
    pub light: u32,
    /// The point source in world coordinates, in metres; not read for other lights.
    pub source: [f64; 3],
    /// Components xx, xy, xz, yy, yz, zz of the curvature tensors, in 1/m; not read for other lights.
    pub curvature: [*const f64; 6],
}

/// Destination of the results of a field: pointers to as many numbers as there are points.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FieldResults {
    /// Motion of the speckle in the image to the right and upwards, in metres on the sensor.
    pub speckle_displacement: [*mut f64; 2],
    /// Motion of the speckle field across the pupil, in metres; infinite where it left the pupil.
    pub pupil_displacement: [*mut f64; 2],
    /// Correlation of intensity with the pattern before, in [0, 1]; for
    /// `tem00_stack_coordinate_of`.
    pub correlation: *mut f64,
    /// Coordinates at which to look the pattern up, in pattern samples from the optical axis, to the
    /// right and upwards, not wrapped: at the images of the points in the reference state, less what
    /// their speckle moves beside them out of focus. 0 out of sight.
    pub pattern_coordinate: [*mut f64; 2],
}

impl FieldSetup {
    fn field(&self, Imaging(geometry): &Imaging) -> Result<MotionField, Failure> {
        let field = MotionField::new(tem00_decorrelation::FieldSetup {
            geometry: *geometry,
            camera: self.camera.frame()?,
            pupil_centre: DVec3::from_array(self.pupil_centre),
            orientation: orientation(self.orientation)?,
            pattern_speckle_size: self.pattern_speckle_size,
        })
        .map_err(|error| match error.parameter() {
            "geometry" => Failure::argument("imaging", error),
            _ => error.into(),
        })?;
        Ok(field.with_shared_motion(&self.shared_motion.motion()?))
    }
}

const INPUTS: [&str; 15] = [
    "position",
    "position",
    "position",
    "normal",
    "normal",
    "normal",
    "motion",
    "motion",
    "motion",
    "curvature",
    "curvature",
    "curvature",
    "curvature",
    "curvature",
    "curvature",
];

impl FieldPoints {
    /// The columns in order; those of the curvature repeat others where the light needs none.
    fn columns(&self, light: FieldLight) -> [Named<*const f64>; 15] {
        let [px, py, pz] = self.position;
        let [nx, ny, nz] = self.normal;
        let [ax, ay, az] = self.motion;
        let [xx, xy, xz, yy, yz, zz] = match light {
            FieldLight::Curvature => self.curvature,
            FieldLight::Collimated | FieldLight::PointSource => [px; 6],
        };
        let pointers = [px, py, pz, nx, ny, nz, ax, ay, az, xx, xy, xz, yy, yz, zz];
        core::array::from_fn(|i| (INPUTS[i], pointers[i]))
    }

    fn light(&self) -> Result<FieldLight, Failure> {
        const LIGHTS: [FieldLight; 3] = [
            FieldLight::Collimated,
            FieldLight::PointSource,
            FieldLight::Curvature,
        ];
        let light = code("light", self.light, &LIGHTS)?;
        if light == FieldLight::PointSource {
            check_coordinates("source", &self.source)?;
        }
        Ok(light)
    }

    /// The points as the library takes them.
    fn borrowed<'a>(
        &self,
        light: FieldLight,
        columns: [&'a [f64]; 15],
    ) -> tem00_decorrelation::FieldPoints<'a> {
        use tem00_decorrelation::FieldLight as L;
        let [px, py, pz, nx, ny, nz, ax, ay, az, xx, xy, xz, yy, yz, zz] = columns;
        tem00_decorrelation::FieldPoints {
            position: [px, py, pz],
            normal: [nx, ny, nz],
            motion: [ax, ay, az],
            light: match light {
                FieldLight::Collimated => L::Collimated,
                FieldLight::PointSource => L::PointSource(DVec3::from_array(self.source)),
                FieldLight::Curvature => L::Curvature([xx, xy, xz, yy, yz, zz]),
            },
        }
    }
}

impl FieldResults {
    fn columns(&self) -> [Named<*mut f64>; 7] {
        let [speckle_x, speckle_y] = self.speckle_displacement;
        let [pupil_x, pupil_y] = self.pupil_displacement;
        let [pattern_x, pattern_y] = self.pattern_coordinate;
        [
            ("speckle_displacement", speckle_x),
            ("speckle_displacement", speckle_y),
            ("pupil_displacement", pupil_x),
            ("pupil_displacement", pupil_y),
            ("correlation", self.correlation),
            ("pattern_coordinate", pattern_x),
            ("pattern_coordinate", pattern_y),
        ]
    }
}

fn slices(columns: [&mut [f64]; 7]) -> FieldSlices<'_> {
    let [
        speckle_x,
        speckle_y,
        pupil_x,
        pupil_y,
        correlation,
        pattern_x,
        pattern_y,
    ] = columns;
    FieldSlices {
        speckle_displacement: [speckle_x, speckle_y],
        pupil_displacement: [pupil_x, pupil_y],
        correlation,
        pattern_coordinate: [pattern_x, pattern_y],
    }
}

/// Computes what motions do to the speckle at `count` surface points, such as those behind the pixels
/// of an image, at first order in the motion.
///
/// A point that the camera cannot see is decorrelated. The columns of `results` are written; they must
/// not overlap with each other nor with those of `points`.
///
/// # Safety
///
/// The pointers are null or valid, those to columns for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_imaging_motion_field(
    imaging: *const Imaging,
    setup: *const FieldSetup,
    points: *const FieldPoints,
    count: usize,
    results: *const FieldResults,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let imaging = unsafe { borrow("imaging", imaging) }?;
        // SAFETY: by the contract of this function.
        let field = unsafe { borrow("setup", setup) }?.field(imaging)?;
        // SAFETY: by the contract of this function.
        let points = unsafe { borrow("points", points) }?;
        let light = points.light()?;
        // SAFETY: by the contract of this function.
        let results = unsafe { borrow("results", results) }?.columns();
        // SAFETY: by the contract of this function.
        let (read, write) = unsafe { columns(count, points.columns(light), results) }?;
        for (name, values) in INPUTS.iter().zip(read) {
            check_coordinates(name, values)?;
        }
        field.evaluate(&points.borrowed(light, read), slices(write));
        Ok(())
    })
}

/// Computes where in a speckle pattern a surface point at rest lies, in pattern samples from the optical
/// axis, to the right and upwards, not wrapped: what `tem00_imaging_motion_field` makes of a point that
/// has not moved.
///
/// `position` holds x, y, z in metres; it is refused where the camera cannot see it. Of the setup,
/// orientation and motion play no part.
///
/// # Safety
///
/// The pointers are null or valid, `position` for three numbers and `coordinate` for two.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_imaging_field_coordinate(
    imaging: *const Imaging,
    setup: *const FieldSetup,
    position: *const f64,
    coordinate: *mut f64,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let imaging = unsafe { borrow("imaging", imaging) }?;
        // SAFETY: by the contract of this function.
        let field = unsafe { borrow("setup", setup) }?.field(imaging)?;
        // SAFETY: by the contract of this function.
        let position: [f64; 3] = unsafe { read("position", position) }?;
        check_coordinates("position", &position)?;
        let result = field.pattern_coordinate(DVec3::from_array(position));
        let result = result.ok_or_else(|| {
            let message = format!("position must be in sight of the camera, got {position:?}");
            Failure::argument("position", message)
        })?;
        // SAFETY: by the contract of this function.
        unsafe { write("coordinate", coordinate.cast(), result.to_array()) }
    })
}
