use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use tem00_coherence::{self as physics, DVec3, PolychromaticSpeckle, Refusal, Rows};

use crate::{
    arrays::{Array, Floats},
    error::{OrRaise, refused},
};

class! {
    /// The paths of the light that one resolution cell of a camera brings to one point of the
    /// image.
    ///
    /// Parameters
    /// ----------
    /// to_source, to_pupil, normal : array_like, shape (3,)
    ///     Directions from the surface, of any length.
    /// sin_aperture : float
    ///     Half the diameter of the pupil over its distance.
    /// wavelength : float
    ///     Wavelength in metres, that of the spectra asked about to 1 %.
    /// rms_height : float
    ///     Root mean square height of the relief that is finer than the cell, in metres.
    /// correlation_length : float
    ///     Distance in metres at which the correlation of these heights falls to 1/e.
    /// defocus : float
    ///     Distance of the surface from the plane of focus, in metres.
    /// source_half_angle : float
    ///     Half-angle in radians, at most 0.3, of the disc from which the light reaches the
    ///     surface, seen from there.
    "tem00.coherence" ResolutionCell(physics::ResolutionCell)
}

impl ResolutionCell {
    fn speckle<'a>(
        &'a self,
        spectrum: &'a physics::Spectrum,
    ) -> Result<PolychromaticSpeckle<'a>, Refusal> {
        PolychromaticSpeckle::new(spectrum, &self.0)
    }
}

methods! {
    impl ResolutionCell as this: this.0;

    #[new]
    #[pyo3(signature = (
        to_source, to_pupil, normal, sin_aperture, wavelength, rms_height=0.0,
        correlation_length=0.0, defocus=0.0, source_half_angle=0.0
    ))]
    build new(_py;
        to_source: Bound<'py, PyAny>, to_pupil: Bound<'py, PyAny>, normal: Bound<'py, PyAny>,
        sin_aperture: f64, wavelength: f64, rms_height: f64, correlation_length: f64, defocus: f64,
        source_half_angle: f64
    ) = {
        take!(to_source: DVec3, to_pupil: DVec3, normal: DVec3);
        let cell = physics::ResolutionCell::new(physics::CellGeometry {
            to_source,
            to_pupil,
            normal,
            sin_aperture,
            wavelength,
        });
        let relief = physics::Relief {
            rms_height,
            correlation_length,
        };
        let cell = cell.or_raise()?.with_relief(relief).or_raise()?;
        let extent = physics::SourceExtent::disc(source_half_angle);
        let cell = cell.with_defocus(defocus).or_raise()?;
        Ok(Self(cell.with_source_extent(extent.or_raise()?)))
    };

    /// Return the standard deviation of the position of a laser line over that in light of one
    /// wavelength.
    ///
    /// The tilt lies across the line, whose rows are finer than a speckle, or much taller.
    #[pyo3(signature = (spectrum, tall_rows=false))]
    call line_noise_ratio(py; spectrum: Bound<'py, PyAny>, tall_rows: bool) -> f64 = {
        take!(spectrum: physics::Spectrum);
        let rows = if tall_rows { Rows::Tall } else { Rows::Thin };
        let speckle = this.speckle(&spectrum).or_raise()?;
        Ok(py.detach(|| speckle.line_noise_ratio(rows)))
    };

    /// Return the patterns of one wavelength that together have the contrast, as two arrays of
    /// float64.
    ///
    /// Returns
    /// -------
    /// fractions : (n,)
    ///     Fractions of the light in patterns whose intensities add, at most 1024.
    /// heights : (m, 2)
    ///     Heights of the relief in metres whose fields add, each with the root of its fraction of
    ///     the light; none where the patterns are looked up as in one wavelength.
    call patterns(py; spectrum: Bound<'py, PyAny>) -> (Floats, Array<'py>) = {
        take!(spectrum: physics::Spectrum);
        let speckle = this.speckle(&spectrum).or_raise()?;
        let patterns = py.detach(|| speckle.patterns(|speckle| speckle.contrast().powi(2)));
        let physics::PatternSum { fractions, heights } = patterns;
        let size = [heights.len(), 2];
        let heights = PyArray1::from_vec(py, heights.into_flattened()).reshape(size)?;
        Ok((fractions.into(), heights.into_any()))
    };

    /// Return the contrast of the speckle in the light of a spectrum.
    try contrast(spectrum: physics::Spectrum) -> f64 =
        this.speckle(&spectrum).map(|speckle| speckle.contrast());

    /// Return the covariance, over the squared mean, of two frames by the displacement of the
    /// pupil, of shape (2,).
    try covariance(spectrum: physics::Spectrum, displacement: [f64; 2]) -> f64 =
        this.speckle(&spectrum).map(|speckle| speckle.covariance(displacement));

    /// Return the autocovariance, over the squared mean, at a lag of shape (2,), at most 1000
    /// speckles long.
    try autocovariance(spectrum: physics::Spectrum, lag: [f64; 2]) -> f64 = {
        if lag[0].hypot(lag[1]) > 1e3 {
            let message = format!("lag must be at most 1000 speckles long, got {lag:?}");
            return Err(refused("lag", message));
        }
        this.speckle(&spectrum).or_raise().map(|speckle| speckle.autocovariance(lag))
    };

    /// Return the fractions of the light in its coherent modes, float64 of shape (n,), the largest
    /// first.
    try modes(spectrum: physics::Spectrum) -> Floats =
        this.speckle(&spectrum).map(|speckle| speckle.modes());

    /// Path per length on the object by the tilt of the cell, across the line of sight, of shape
    /// (3,).
    get tilt -> Floats;

    /// Path per height.
    get height_factor -> f64;

    /// Standard deviation of the paths by heights, in metres.
    get path_spread -> f64;

    /// Difference of wave numbers by which the tilt displaces the field by the pupil's diameter, in
    /// rad/m.
    get tilt_wave_number -> f64;

    /// Size of a speckle on the object, in metres.
    get speckle_size -> f64;

    shown speckle_size, tilt, path_spread;
}
