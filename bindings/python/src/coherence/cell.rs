use numpy::PyArray1;
use pyo3::prelude::*;
use tem00_coherence::{self as physics, DVec3, PolychromaticSpeckle, Rows};

use super::line::SpectralLine;
use crate::{
    arrays::{Array, Components, array, vector_array},
    error::{OrRaise, refused},
};

/// The paths of the light that one resolution cell of a camera brings to one point of the image.
///
/// Parameters
/// ----------
/// to_source, to_pupil, normal : array_like, shape (3,)
///     Directions from the surface, of any length.
/// sin_aperture : float
///     Half the diameter of the pupil over its distance.
/// wavelength : float
///     Wavelength in metres.
/// rms_height : float
///     Root mean square height of the relief that is finer than the cell, in metres.
/// correlation_length : float
///     Distance in metres at which the correlation of these heights falls to 1/e.
/// defocus : float
///     Distance of the surface from the plane of focus, in metres.
/// source_half_angle : float
///     Half-angle in radians, at most 0.3, of the disc from which the light reaches the surface, seen from there.
#[pyclass(frozen, eq, module = "tem00.coherence")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ResolutionCell(physics::ResolutionCell);

#[pymethods]
impl ResolutionCell {
    #[new]
    #[pyo3(signature = (to_source, to_pupil, normal, sin_aperture, wavelength, rms_height=0.0, correlation_length=0.0, defocus=0.0, source_half_angle=0.0))]
    #[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
    fn new(
        to_source: Components<'_>,
        to_pupil: Components<'_>,
        normal: Components<'_>,
        sin_aperture: f64,
        wavelength: f64,
        rms_height: f64,
        correlation_length: f64,
        defocus: f64,
        source_half_angle: f64,
    ) -> PyResult<Self> {
        let vector = |name, argument: &Components<'_>| argument.vector(name).map(DVec3::from_array);
        let cell = physics::ResolutionCell::new(physics::CellGeometry {
            to_source: vector("to_source", &to_source)?,
            to_pupil: vector("to_pupil", &to_pupil)?,
            normal: vector("normal", &normal)?,
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
    }

    fn __repr__(&self) -> String {
        let (size, tilt, spread) = (self.0.speckle_size(), self.0.tilt(), self.0.path_spread());
        format!(
            "<ResolutionCell: speckle_size={size:?}, tilt={:?}, path_spread={spread:?}>",
            tilt.to_array()
        )
    }

    /// Path per length on the object by the tilt of the cell, across the line of sight, of shape (3,).
    #[getter]
    fn tilt<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector_array(py, self.0.tilt().to_array())
    }

    /// Return the contrast of the speckle in the light of a line.
    fn contrast(&self, py: Python<'_>, line: &SpectralLine) -> f64 {
        py.detach(|| self.speckle(line).contrast())
    }

    /// Return the standard deviation of the position of a laser line over that in light of one wavelength.
    ///
    /// The tilt lies across the line, whose rows are finer than a speckle, or much taller.
    #[pyo3(signature = (line, tall_rows=false))]
    fn line_noise_ratio(&self, py: Python<'_>, line: &SpectralLine, tall_rows: bool) -> f64 {
        let rows = if tall_rows { Rows::Tall } else { Rows::Thin };
        py.detach(|| self.speckle(line).line_noise_ratio(rows))
    }

    /// Return the covariance, over the squared mean, of two frames by the displacement of the pupil, of shape (2,).
    fn covariance(
        &self,
        py: Python<'_>,
        line: &SpectralLine,
        displacement: Components<'_>,
    ) -> PyResult<f64> {
        let displacement = displacement.vector("displacement")?;
        Ok(py.detach(|| self.speckle(line).covariance(displacement)))
    }

    /// Return the autocovariance, over the squared mean, at a lag of shape (2,), at most 1000 speckles long.
    fn autocovariance(
        &self,
        py: Python<'_>,
        line: &SpectralLine,
        lag: Components<'_>,
    ) -> PyResult<f64> {
        let lag: [f64; 2] = lag.vector("lag")?;
        if lag[0].hypot(lag[1]) > 1e3 {
            return Err(refused(
                "lag",
                format!("lag must be at most 1000 speckles long, got {lag:?}"),
            ));
        }
        Ok(py.detach(|| self.speckle(line).autocovariance(lag)))
    }

    /// Return the patterns of one wavelength that together have the contrast, as two arrays of float64.
    ///
    /// Returns
    /// -------
    /// fractions : (n,)
    ///     Fractions of the light in patterns whose intensities add, at most 1024.
    /// heights : (m, 2)
    ///     Heights of the relief in metres whose fields add, each with the root of its fraction of the light; none where the
    ///     patterns are looked up as in one wavelength.
    fn patterns<'py>(
        &self,
        py: Python<'py>,
        line: &SpectralLine,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        let patterns = py.detach(|| {
            let speckle = self.speckle(line);
            speckle.patterns(|speckle| speckle.contrast().powi(2))
        });
        let physics::PatternSum { fractions, heights } = patterns;
        let size = [heights.len(), 2];
        Ok((
            array(py, &[fractions.len()], fractions)?.into_any(),
            array(py, &size, heights.into_flattened())?.into_any(),
        ))
    }

    /// Return the fractions of the light in its coherent modes, float64 of shape (n,), the largest first.
    fn modes<'py>(&self, py: Python<'py>, line: &SpectralLine) -> PyResult<Array<'py>> {
        let modes = py.detach(|| self.speckle(line).modes());
        Ok(array(py, &[modes.len()], modes)?.into_any())
    }
}

impl ResolutionCell {
    const fn speckle<'a>(&'a self, line: &'a SpectralLine) -> PolychromaticSpeckle<'a> {
        PolychromaticSpeckle {
            line: &line.0,
            cell: &self.0,
        }
    }
}

methods! {
    impl ResolutionCell as this: this.0;

    /// Path per height.
    get height_factor -> f64;

    /// Standard deviation of the paths by heights, in metres.
    get path_spread -> f64;

    /// Difference of wave numbers by which the tilt displaces the field by the pupil's diameter, in rad/m.
    get tilt_wave_number -> f64;

    /// Size of a speckle on the object, in metres.
    get speckle_size -> f64;
}
