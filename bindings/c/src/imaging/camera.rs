use tem00_decorrelation::{DVec2, ImagingGeometry, LensData, Refusal, ThickLensData};

use super::Imaging;
use crate::{
    numbers::{check_result, check_size, code, read_point},
    pointers::borrow,
    status::{Failure, Status},
};

/// Meaning of `focus` of a description: the position of the surface in focus before a lens.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    /// The distance from the surface to the entrance pupil, in metres.
    SurfaceToPupil = 0,
    /// The distance from the surface to the front principal plane, in metres.
    SurfaceToPrincipalPlane = 1,
    /// The magnification, counted positive.
    Magnification = 2,
}

const FOCUS_KINDS: [Focus; 3] = [
    Focus::SurfaceToPupil,
    Focus::SurfaceToPrincipalPlane,
    Focus::Magnification,
];

/// A lens and a sensor.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct LensDescription {
    /// Vacuum wavelength of the light, in metres.
    pub wavelength: f64,
    /// Focal length of the lens, in metres.
    pub focal_length: f64,
    /// F-number as engraved on the lens, for focus at infinity, at least 0.5.
    pub f_number: f64,
    /// Diameter of the exit pupil over that of the entrance pupil; 1 for a thin lens.
    pub pupil_magnification: f64,
    /// Meaning of `focus`: a `tem00_focus`.
    pub focus_kind: u32,
    /// Position of the surface in focus.
    pub focus: f64,
    /// Distance between the centres of neighbouring pixels on the sensor, in metres.
    pub pixel_pitch: f64,
}

/// The distances and the pupil of a camera as such. Entrance and exit pupil are one, at the lens.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PupilDistances {
    /// Vacuum wavelength of the light, in metres.
    pub wavelength: f64,
    /// Distance from the surface in focus to the pupil along the optical axis, in metres.
    pub surface_to_pupil: f64,
    /// Distance from the pupil to the sensor, in metres.
    pub pupil_to_image: f64,
    /// Diameter of the pupil, in metres.
    pub pupil_diameter: f64,
    /// Distance between the centres of neighbouring pixels on the sensor, in metres.
    pub pixel_pitch: f64,
}

/// Properties of a camera.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImagingInfo {
    /// Vacuum wavelength of the light, in metres.
    pub wavelength: f64,
    /// Focal length, in metres.
    pub focal_length: f64,
    /// F-number for focus at infinity.
    pub f_number: f64,
    /// F-number of the light on the sensor.
    pub working_f_number: f64,
    /// Diameter of the entrance pupil, in metres.
    pub pupil_diameter: f64,
    /// Diameter of the exit pupil over that of the entrance pupil.
    pub pupil_magnification: f64,
    /// Distance from the surface in focus to the entrance pupil, in metres.
    pub surface_to_pupil: f64,
    /// Distance from the exit pupil to the sensor, in metres.
    pub pupil_to_image: f64,
    /// Length of the image of a unit tangent of the viewing angle, in metres.
    pub principal_distance: f64,
    /// Magnification at the surface in focus, without a sign.
    pub magnification: f64,
    /// Distance between the centres of neighbouring pixels on the sensor, in metres.
    pub pixel_pitch: f64,
    /// Speckle size on the sensor, the period of its finest fringes, in metres.
    pub speckle_size: f64,
    /// Speckle size on the sensor, in pixels.
    pub speckle_size_in_pixels: f64,
    /// Speckle size projected onto the surface in focus, in metres.
    pub object_speckle_size: f64,
    /// Displacement along the axis that first decorrelates the speckle entirely, in metres.
    pub axial_decorrelation_length: f64,
}

impl LensDescription {
    /// The camera; a refusal names what the description says.
    fn geometry(&self) -> Result<ImagingGeometry, Failure> {
        let kind = code("focus_kind", self.focus_kind, &FOCUS_KINDS)?;
        self.geometry_of(kind).map_err(|error| {
            let parameter = match error.parameter() {
                "surface_to_pupil" | "surface_to_principal_plane" | "magnification" => "focus",
                other => other,
            };
            Failure::argument(parameter, error)
        })
    }

    /// A thin lens by the formulas of a thin lens, which round in their own way.
    fn geometry_of(&self, kind: Focus) -> Result<ImagingGeometry, Refusal> {
        use tem00_decorrelation::Focus as F;
        let focus = match kind {
            Focus::SurfaceToPupil if self.is_thin() => return self.thin(),
            Focus::SurfaceToPupil => F::SurfaceToPupil(self.focus),
            Focus::SurfaceToPrincipalPlane => F::SurfaceToPrincipalPlane(self.focus),
            Focus::Magnification => F::Magnification(self.focus),
        };
        ImagingGeometry::from_thick_lens(ThickLensData {
            wavelength: self.wavelength,
            focal_length: self.focal_length,
            f_number: self.f_number,
            pupil_magnification: self.pupil_magnification,
            focus,
            pixel_pitch: self.pixel_pitch,
        })
    }

    fn is_thin(&self) -> bool {
        (1.0..=1.0).contains(&self.pupil_magnification)
    }

    fn thin(&self) -> Result<ImagingGeometry, Refusal> {
        ImagingGeometry::from_lens(LensData {
            wavelength: self.wavelength,
            focal_length: self.focal_length,
            f_number: self.f_number,
            surface_to_pupil: self.focus,
            pixel_pitch: self.pixel_pitch,
        })
    }
}

impl PupilDistances {
    fn geometry(&self) -> Result<ImagingGeometry, Failure> {
        Ok(ImagingGeometry::from_distances((*self).into())?)
    }
}

type Distances = tem00_decorrelation::PupilDistances;

same_fields! {
    PupilDistances =>
        Distances { wavelength, surface_to_pupil, pupil_to_image, pupil_diameter, pixel_pitch }
}

impl ImagingInfo {
    pub(super) fn new(geometry: &ImagingGeometry) -> Self {
        macro_rules! each {
            ($($name:ident)*) => { Self { $($name: geometry.$name()),* } };
        }
        each! {
            wavelength focal_length f_number working_f_number pupil_diameter pupil_magnification
            surface_to_pupil pupil_to_image principal_distance magnification pixel_pitch
            speckle_size speckle_size_in_pixels object_speckle_size axial_decorrelation_length
        }
    }
}

/// Creates a camera from its lens.
///
/// On failure `*imaging` is null.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_imaging_create_lens(
    description: *const LensDescription,
    imaging: *mut *mut Imaging,
) -> Status {
    create!(description: borrow => imaging: description.geometry().map(Imaging))
}

/// Creates a camera from its distances and its pupil.
///
/// On failure `*imaging` is null.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_imaging_create_distances(
    distances: *const PupilDistances,
    imaging: *mut *mut Imaging,
) -> Status {
    create!(distances: borrow => imaging: distances.geometry().map(Imaging))
}

/// Tells what a camera is: among others, the size of its speckle.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_imaging_describe(
    imaging: *const Imaging,
    info: *mut ImagingInfo,
) -> Status {
    answer!(imaging: borrow => info: ImagingInfo::new(&imaging.0))
}

/// Computes where in a speckle pattern a pixel lies, in pattern samples, not wrapped to its period.
///
/// `pixel` holds its position in pixels, x to the right and y down as rows count, from any origin;
/// `displacement` the motion of the speckle since the reference state to the right and up, in
/// metres on the sensor; `pattern_speckle_size` is the speckle size of the pattern in samples.
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
    let coordinate = coordinate.cast::<[f64; 2]>();
    answer!(
        imaging: borrow, pixel: read_point, displacement: read_point,
        pattern_speckle_size: check_size =>
        coordinate: {
            let [pixel, displacement] = [pixel, displacement].map(DVec2::from_array);
            let imaging = &imaging.0;
            let found = imaging.pattern_coordinate(pixel, displacement, pattern_speckle_size);
            check_result("coordinate", &found.to_array())?;
            found.to_array()
        }
    )
}
