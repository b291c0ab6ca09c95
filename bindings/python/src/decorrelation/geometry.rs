use pyo3::prelude::*;
use tem00_decorrelation::{self as physics, DVec2, Focus};

use crate::{
    arrays::{LIMIT, Numbers, Values, columns, evaluate, length},
    error::{OrRaise, refused},
    pickling::Made,
};

kept_class! {
    /// A camera focused on a surface: a lens, its pupils and the sensor behind it.
    ///
    /// All lengths are in metres. Wavelengths are those in vacuum, f-numbers those of focus at
    /// infinity.
    "tem00.decorrelation" ImagingGeometry(physics::ImagingGeometry)
}

methods! {
    impl ImagingGeometry as this: this.inner;

    unmade "from_lens, from_thick_lens or from_distances";

    /// Return the geometry of a lens of many elements.
    ///
    /// Parameters
    /// ----------
    /// wavelength, focal_length : float
    ///     Vacuum wavelength and focal length, in metres.
    /// f_number : float
    ///     Focal length by diameter of the entrance pupil.
    /// pupil_magnification : float
    ///     Diameter of the exit pupil over that of the entrance pupil.
    /// pixel_pitch : float
    ///     Pixel pitch of the sensor, in metres.
    /// magnification, surface_to_principal_plane, surface_to_pupil : float, optional
    ///     The focus, by one of these; distances in metres.
    #[staticmethod]
    #[pyo3(signature = (
        wavelength, focal_length, f_number, pupil_magnification, pixel_pitch, *,
        magnification = None, surface_to_principal_plane = None, surface_to_pupil = None,
    ))]
    build from_thick_lens(_py;
        wavelength: Bound<'py, PyAny>, focal_length: f64, f_number: f64, pupil_magnification: f64,
        pixel_pitch: f64, magnification: Option<f64>, surface_to_principal_plane: Option<f64>,
        surface_to_pupil: Option<f64>
    ) = {
        take!(wavelength: f64);
        let given = [magnification, surface_to_principal_plane, surface_to_pupil];
        let (name, value, focus) = match given {
            [Some(x), None, None] => ("magnification", x, Focus::Magnification(x)),
            [None, Some(x), None] => (
                "surface_to_principal_plane",
                x,
                Focus::SurfaceToPrincipalPlane(x),
            ),
            [None, None, Some(x)] => ("surface_to_pupil", x, Focus::SurfaceToPupil(x)),
            _ => {
                let message = "magnification, surface_to_principal_plane and surface_to_pupil: one \
                               of them must be given, and only one";
                return Err(refused("magnification", message.to_owned()));
            }
        };
        let geometry = physics::ImagingGeometry::from_thick_lens(physics::ThickLensData {
            wavelength,
            focal_length,
            f_number,
            pupil_magnification,
            focus,
            pixel_pitch,
        });
        let made = Made {
            name: "from_thick_lens",
            keywords: vec![
                ("wavelength", wavelength),
                ("focal_length", focal_length),
                ("f_number", f_number),
                ("pupil_magnification", pupil_magnification),
                ("pixel_pitch", pixel_pitch),
                (name, value),
            ],
        };
        let inner = geometry.or_raise_renamed(&["pupil_diameter"], "f_number")?;
        Ok(Self { inner, made })
    };

    /// Return the geometry of the same camera in light of another wavelength, in metres.
    call with_wavelength(_py; wavelength: Bound<'py, PyAny>) -> Self = {
        take!(wavelength: f64);
        let inner = this.inner.with_wavelength(wavelength);
        let inner = inner.or_raise_renamed(&["pupil_diameter"], "wavelength")?;
        let mut made = this.made.clone();
        made.keywords[0].1 = wavelength;
        Ok(Self { inner, made })
    };

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
    call pattern_coordinate(py;
        pixel: [Numbers<'py>; 2], image_displacement: [Numbers<'py>; 2], pattern_speckle_size: f64
    ) -> [Values<'py>; 2] = {
        length("pattern_speckle_size", pattern_speckle_size)?;
        let ([x, y], [dx, dy]) = (&pixel, &image_displacement);
        let (place, motion) = ("pixel", "image_displacement");
        let named = [
            (place, x, 0),
            (place, y, 0),
            (motion, dx, 0),
            (motion, dy, 0),
        ];
        let columns = columns(&named, LIMIT)?;
        evaluate(py, columns, [&[]; 2], |[x, y, dx, dy], [right, up]| {
            for i in 0..x.len() {
                let (pixel, moved) = (DVec2::new(x[i], y[i]), DVec2::new(dx[i], dy[i]));
                let found = this
                    .inner
                    .pattern_coordinate(pixel, moved, pattern_speckle_size);
                [right[i], up[i]] = found.to_array();
            }
        })
    };

    /// Return the geometry of a thin lens that images a surface at a given distance sharply.
    ///
    /// Parameters
    /// ----------
    /// wavelength, focal_length : float
    ///     Vacuum wavelength and focal length, in metres.
    /// f_number : float
    ///     Focal length by diameter of the pupil.
    /// surface_to_pupil : float
    ///     Distance of the surface from the lens, in metres.
    /// pixel_pitch : float
    ///     Pixel pitch of the sensor, in metres.
    keep from_lens(wavelength, focal_length, f_number, surface_to_pupil, pixel_pitch) =
        physics::ImagingGeometry::from_lens(physics::LensData {
            wavelength, focal_length, f_number, surface_to_pupil, pixel_pitch,
        }).or_raise_renamed(&["pupil_diameter"], "f_number");

    /// Return the geometry of a camera whose pupil and distances are known.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Vacuum wavelength, in metres.
    /// surface_to_pupil, pupil_to_image : float
    ///     Distances from the entrance pupil to the surface and from the exit pupil to the sensor,
    ///     in metres.
    /// pupil_diameter : float
    ///     Diameter of the entrance pupil, in metres.
    /// pixel_pitch : float
    ///     Pixel pitch of the sensor, in metres.
    keep from_distances(wavelength, surface_to_pupil, pupil_to_image, pupil_diameter, pixel_pitch) =
        physics::ImagingGeometry::from_distances(physics::PupilDistances {
            wavelength, surface_to_pupil, pupil_to_image, pupil_diameter, pixel_pitch,
        });

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

    /// Return the axial decorrelation length of points at positive depths before the pupil, in
    /// metres.
    map axial_decorrelation_length_at(depth: positive);

    /// Return the defocus 1/Z − 1/L of points at depths Z before the pupil, in 1/m.
    ///
    /// Parameters
    /// ----------
    /// depth : float or array_like
    ///     Depth in metres, positive.
    map defocus_at(depth: positive);
}
