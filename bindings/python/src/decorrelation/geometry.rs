use pyo3::prelude::*;
use tem00_decorrelation::{self as physics, DVec2};

use super::lens::{LensData, PupilDistances, ThickLensData};
use crate::{
    arrays::{Numbers, Values, map, map_many, wavelength_of_light},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// A camera focused on a surface: a lens, its pupils and the sensor behind it.
///
/// All lengths are in metres.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImagingGeometry {
    pub(super) geometry: physics::ImagingGeometry,
    made: Made,
}

/// Data that make a geometry again.
#[derive(Clone, Copy, Debug)]
enum Made {
    Lens(LensData),
    ThickLens(ThickLensData),
    Distances(PupilDistances),
}

impl Made {
    fn with_wavelength(mut self, wavelength: f64) -> Self {
        let (Self::Lens(LensData {
            wavelength: old, ..
        })
        | Self::ThickLens(ThickLensData {
            wavelength: old, ..
        })
        | Self::Distances(PupilDistances {
            wavelength: old, ..
        })) = &mut self;
        *old = wavelength;
        self
    }
}

impl PartialEq for ImagingGeometry {
    fn eq(&self, other: &Self) -> bool {
        self.geometry == other.geometry
    }
}

#[pymethods]
impl ImagingGeometry {
    /// Return the geometry of a thin lens that images a surface at a given distance sharply.
    #[staticmethod]
    fn from_lens(lens: PyRef<'_, LensData>) -> PyResult<Self> {
        let geometry = physics::ImagingGeometry::from_lens(lens.physics())
            .or_raise_renamed(&["pupil_diameter"], "f_number")?;
        let made = Made::Lens(*lens);
        Ok(Self { geometry, made })
    }

    /// Return the geometry of a lens of many elements.
    #[staticmethod]
    fn from_thick_lens(lens: PyRef<'_, ThickLensData>) -> PyResult<Self> {
        let geometry = physics::ImagingGeometry::from_thick_lens(lens.physics())
            .or_raise_renamed(&["pupil_diameter"], "f_number")?;
        let made = Made::ThickLens(*lens);
        Ok(Self { geometry, made })
    }

    /// Return the geometry of a camera whose pupil and distances are known.
    #[staticmethod]
    fn from_distances(distances: PyRef<'_, PupilDistances>) -> PyResult<Self> {
        let geometry = physics::ImagingGeometry::from_distances(distances.physics()).or_raise()?;
        let made = Made::Distances(*distances);
        Ok(Self { geometry, made })
    }

    /// Return the geometry of the same camera in light of another wavelength, in metres.
    fn with_wavelength(&self, wavelength: f64) -> PyResult<Self> {
        let wavelength = wavelength_of_light("wavelength", wavelength)?;
        let changed = self.geometry.with_wavelength(wavelength);
        let geometry = changed.or_raise_renamed(&["pupil_diameter"], "wavelength")?;
        let made = self.made.with_wavelength(wavelength);
        Ok(Self { geometry, made })
    }

    /// Return the coordinate in a speckle pattern that belongs to a place in the image.
    ///
    /// Parameters
    /// ----------
    /// pixel : pair of float or array_like
    ///     Place in pixels, to the right and down as rows count, from any origin.
    /// image_displacement : pair of float or array_like
    ///     Motion of the speckle since the reference state, in metres on the sensor to the right
    ///     and up.
    /// pattern_speckle_size : float
    ///     Speckle size of the pattern in samples.
    ///
    /// Returns
    /// -------
    /// (float, float) or (ndarray, ndarray)
    ///     Coordinate in samples, to the right and up, not wrapped, in the common shape.
    fn pattern_coordinate<'py>(
        &self,
        py: Python<'py>,
        pixel: [Numbers<'py>; 2],
        image_displacement: [Numbers<'py>; 2],
        pattern_speckle_size: f64,
    ) -> PyResult<[Values<'py>; 2]> {
        check_pattern(pattern_speckle_size)?;
        let named = coordinate_arguments(&pixel, &image_displacement);
        map_many(py, named, |[x, y, ax, ay]| {
            self.geometry
                .pattern_coordinate(DVec2::new(x, y), DVec2::new(ax, ay), pattern_speckle_size)
                .to_array()
        })
    }

    pub(super) fn __repr__(&self) -> String {
        let made = match &self.made {
            Made::Lens(lens) => format!("from_lens({})", lens.__repr__()),
            Made::ThickLens(lens) => format!("from_thick_lens({})", lens.__repr__()),
            Made::Distances(distances) => format!("from_distances({})", distances.__repr__()),
        };
        format!("ImagingGeometry.{made}")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        match self.made {
            Made::Lens(lens) => by_constructor::<Self>(py, "from_lens", (lens,)),
            Made::ThickLens(lens) => by_constructor::<Self>(py, "from_thick_lens", (lens,)),
            Made::Distances(distances) => {
                by_constructor::<Self>(py, "from_distances", (distances,))
            }
        }
    }
}

methods! {
    impl ImagingGeometry as this: this.geometry;

    unmade "from_lens, from_thick_lens or from_distances";

    /// Vacuum wavelength in metres.
    get wavelength -> f64;

    /// Focal length in metres.
    get focal_length -> f64;

    /// F-number, that of focus at infinity.
    get f_number -> f64;

    /// F-number of the light on the sensor.
    get working_f_number -> f64;

    /// Distance from the surface in focus to the entrance pupil, in metres.
    get surface_to_pupil -> f64;

    /// Pixel pitch of the sensor in metres.
    get pixel_pitch -> f64;

    /// Principal distance in metres, which takes the tangent of a viewing angle to the sensor.
    get principal_distance -> f64;

    /// Distance from the exit pupil to the sensor, in metres.
    get pupil_to_image -> f64;

    /// Magnification at the surface in focus, without a sign.
    get magnification -> f64;

    /// Pupil magnification, 1 for a thin lens.
    get pupil_magnification -> f64;

    /// Diameter of the entrance pupil in metres.
    get pupil_diameter -> f64;

    /// Diameter of the exit pupil in metres.
    get exit_pupil_diameter -> f64;

    /// Speckle size on the sensor in metres.
    get speckle_size -> f64;

    /// Speckle size on the sensor in pixels.
    get speckle_size_in_pixels -> f64;

    /// Speckle size projected onto the surface in focus, in metres.
    get object_speckle_size -> f64;

    /// Displacement along the axis that first decorrelates the speckle of the surface, in metres.
    get axial_decorrelation_length -> f64;

    /// Depth of focus of the speckle at the surface, in metres.
    get depth_of_focus -> f64;

    /// Depth of focus of the speckle at the sensor, in metres.
    get sensor_depth_of_focus -> f64;

    /// Return the axial decorrelation length of points at positive depths before the pupil, in metres.
    map axial_decorrelation_length_at(depth: positive);

    /// Return the defocus 1/Z − 1/L of points at depths Z before the pupil, in 1/m.
    ///
    /// Parameters
    /// ----------
    /// depth : float or array_like
    ///     Depth in metres, positive.
    map defocus_at(depth: positive);
}

/// The two pairs of a pattern coordinate by their names.
pub(super) fn coordinate_arguments<'a, 'py>(
    [x, y]: &'a [Numbers<'py>; 2],
    [ax, ay]: &'a [Numbers<'py>; 2],
) -> [(&'static str, &'a Numbers<'py>); 4] {
    let displacement = "image_displacement";
    [
        ("pixel", x),
        ("pixel", y),
        (displacement, ax),
        (displacement, ay),
    ]
}

/// Refuses a speckle size that is not positive and finite.
pub(super) fn check_pattern(pattern_speckle_size: f64) -> PyResult<()> {
    let checked = tem00_numerics::check::positive("pattern_speckle_size", pattern_speckle_size, "");
    checked.or_raise().map(drop)
}
